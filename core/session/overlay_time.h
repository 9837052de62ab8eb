#pragma once

#include <map>
#include <optional>
#include <string>

#include "geo/geodetic.h"
#include "sun/zone.h"

/// The time whose sun a raster on the ground shows.
namespace relevo::session {

/// Sun of a `relevo sun` raster, from its metadata: a single sun direction, or a period.
struct OverlayTime {
    struct Sun {
        double azimuth_deg = 0;
        double apparent_elevation_deg = 0;  ///< with refraction
        std::optional<double> elevation_deg{};
    };
    std::optional<sun::Instant> utc{};  ///< of a single sun
    std::optional<Sun> sun{};           ///< at the DEM's centre
    std::string from{}, to{};           ///< of a period, ISO 8601 with offsets
    std::string zone{};                 ///< of the period: "Europe/Zurich"; empty: not known

    /// Whether the period is one day of 24 hours, from midnight.
    bool is_day() const;
};

/// @param about  metadata of a raster and its band
/// @returns nullopt if the raster is not one of sunlight
std::optional<OverlayTime> overlay_time(const std::map<std::string, std::string>& about);

/// "2026-06-21 10:12 UTC+02:00", "2026-06-21, Europe/Zurich", "2026-06-01 to 2026-06-30"; empty
/// without a time.
/// @param zone, middle  as clock_text()
std::string clock_text(const OverlayTime& time, const std::string& zone,
                       const geo::Geodetic& middle);

/// As the other sun_text(); empty for a period.
std::string sun_text(const OverlayTime& time);

}  // namespace relevo::session
