#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/array2d.h"
#include "light/point/direct_light.h"

namespace relevo::light {

/// What a point gets at a moment.
enum class Light : std::uint8_t {
    Night,     ///< the sun is down over a level horizon, too
    Twilight,  ///< likewise, but its centre is less than 6 degrees below: civil twilight
    Shaded,    ///< it is up over a level horizon, but behind terrain
    Lit,       ///< it shines on the point
};

/// "night", "twilight", "shaded", "lit".
std::string_view name_of(Light light);

/// A year of light at a point: a row for every day, a column for every step of the clock.
struct Carpet {
    int year = 0;
    sun::Zone zone;
    int step_s = 0;                   ///< of the clock, from column to column
    std::vector<LightDay> days;       ///< those that the zone has, in order
    Array2d<Light> light;             ///< column: time of day; row: as `days`
    double lit_s = 0;                 ///< of the year, from the exact edges
    double not_known_s = 0;           ///< of lit_s, for voids of the DEM
    double level_s = 0;               ///< as lit_s, over a level horizon
    std::vector<double> month_lit_s;  ///< of each of the twelve months
    std::vector<double> day_level_s;  ///< over a level horizon, of each of `days`
    std::string definition;

    /// What the clock shows in the middle of a column, from midnight [s].
    double time_of_day_s(int column) const { return (column + 0.5) * step_s; }
};

/// @param step_s  of the clock; divides a day
/// Level horizon: zero degrees all round, the same part of the sun and the same refraction as for
/// the light. Each cell says what is there in the middle of its step, by the clock of the zone:
/// where clocks are put forward, the hour that they skip shows the light as it would have been
/// without; where they are put back, the hour that comes twice shows its first time.
/// @throws Error (BadInput) for a year outside 1900-2100, a step that does not divide a day
Carpet carpet(const DirectLight& light, int year, const sun::Zone& zone, int step_s = 60);

}  // namespace relevo::light
