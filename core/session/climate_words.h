#pragma once

#include <optional>
#include <string>

#include "climate/climate_map.h"
#include "climate/cover.h"
#include "dem/heightfield.h"
#include "geo/geodetic.h"
#include "sun/time.h"

namespace relevo::session {

/// Mean climate of a place, and the natural ground cover that pictures assume there on a day.
struct ClimateReport {
    double height_m = 0;
    double january_c = 0, july_c = 0;  ///< mean air temperatures at that height
    double year_mm = 0;                ///< precipitation a year
    climate::Cover cover{};            ///< on level ground at that height on the day
    sun::Date date;                    ///< in UTC
    /// Heights above which no trees grow, ice is permanent, and snow covers half of the level open
    /// ground on the day [m]. Empty if there is no such height below 9000 m; -500 m if all ground
    /// is above.
    std::optional<double> tree_line_m, ice_line_m, snow_line_m;
};

/// Mean of the lowest and the highest height [m], clamped to -500..9000 m against outliers. Land
/// below sea level is ignored if there is land above it.
double middle_height_m(double lowest_m, double highest_m);

/// @param place  temperatures and cover are those at its height
/// @throws Error (BadInput) as climate::ClimateMap
ClimateReport climate_report(const climate::ClimateMap& map, const geo::Geodetic& place,
                             sun::Instant utc);

/// Fraction of the land of a DEM that snow or ice covers on a day, by 16 x 16 posts; 0 without
/// land.
double snowy_share(const climate::ClimateMap& map, const dem::Heightfield& field, sun::Instant utc);

/// "January -4.1, July 13.2 degC at 1960 m, 1320 mm of rain a year".
std::string climate_text(const ClimateReport& report);

/// "trees up to 1890 m, permanent ice from 2990 m, snow from 2440 m on 2026-06-21".
std::string ground_text(const ClimateReport& report);

/// Where the land cover of pictures comes from if no map is given.
inline constexpr const char* kLandCoverText =
    "generated from shares of 0.05 degrees, not mapped; MODIS MCD12C1 (NASA LP DAAC), NASA Blue "
    "Marble";

}  // namespace relevo::session
