#pragma once

#include <array>
#include <string>

#include "light/point/carpet.h"
#include "light/point/doubt.h"
#include "report/asked.h"

namespace relevo::report {

/// A year of direct sun at a place.
struct Carpet {
    light::Carpet carpet;
    light::Doubt doubt;
    std::string assumption;  ///< of the zone
    geo::Geodetic place;
    std::string horizon_definition;
};

/// @param horizon  of the place
/// @param asked    days of the year; the first one says which
/// @param step_s   of the time of day; divides a day
Carpet carpet(const View& view, const light::TerrainHorizon& horizon, const Days& asked,
              int step_s);
std::string json_of(const Carpet& result);

struct MonthSums {
    double lit_s = 0, level_s = 0;
};
std::array<MonthSums, 12> months_of(const light::Carpet& carpet);

}  // namespace relevo::report
