#pragma once

#include <optional>

#include "weather/metar.h"

namespace relevo::weather {

/// Pressure and temperature at a height, from a report.
struct StationAir {
    double station_m = 0;  ///< height of the station above sea level
    double qnh_hpa = 1013.25;
    double temperature_c = 15;  ///< at the station

    /// Pressure at a height above sea level [hPa], by the pressure altitude that an altimeter
    /// shows.
    /// @param height_m  -1000 to 11000, else the nearer end
    /// Source: ICAO Doc 7488, 1993; the definition of QNH in ICAO Doc 8896.
    double pressure_hpa(double height_m) const;

    /// Temperature at a height, 6.5 K colder each 1000 m up to 11 km [degC].
    double temperature_at_c(double height_m) const;

    bool operator==(const StationAir&) const = default;
};

/// The air of a report: none if it has neither pressure nor temperature; what it lacks of both is
/// the standard atmosphere's.
std::optional<StationAir> station_air(const Metar& report, double station_m);

}  // namespace relevo::weather
