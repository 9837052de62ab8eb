#pragma once

#include <optional>
#include <string>

#include "climate/cover.h"
#include "geo/geodetic.h"
#include "sun/time.h"

namespace relevo::session {

/// The climate of a place in a normal year, and the ground that it makes there on a day: what
/// pictures assume of a DEM's natural ground.
struct ClimateReport {
    double height_m = 0;
    double january_c = 0, july_c = 0;  ///< mean air temperatures at that height
    double year_mm = 0;                ///< rain and melted snow
    climate::Cover cover{};            ///< of level ground at that height on the day
    sun::Date date;                    ///< in UTC
    /// Above them no trees grow, ice lies for good, and half of the level open ground has snow on
    /// the day [m]; none where that is not so up to 9000 m. -500 m: all ground.
    std::optional<double> tree_line_m, ice_line_m, snow_line_m;
};

/// The middle of a DEM's heights, no lower than the sea where there is land above it, and of the
/// Earth whatever outliers it has [m].
double middle_height_m(double lowest_m, double highest_m);

/// @param place  its height is that of the temperatures and of the cover
/// @throws Error (BadInput) as climate::ClimateMap
ClimateReport climate_report(const climate::ClimateMap& map, const geo::Geodetic& place,
                             sun::Instant moment);

/// "January -4.1, July 13.2 degC at 1960 m, 1320 mm of rain a year".
std::string climate_text(const ClimateReport& report);

/// "trees up to 1890 m, permanent ice from 2990 m, snow from 2440 m on 2026-06-21".
std::string ground_text(const ClimateReport& report);

}  // namespace relevo::session
