#include "light/raster/level_hours.h"

#include <algorithm>
#include <cmath>

#include "base/parallel_for.h"
#include "base/units.h"
#include "sun/position.h"
#include "sun/position_table.h"

namespace relevo::light {
namespace {

/// Over one place: elevations are linear from one moment to the next.
double hours_over(const SunTerrain& terrain, const sun::PositionTable& table, sun::Instant begin,
                  double length_s, double step_s, const geo::Geodetic& place) {
    if (!std::isfinite(place.lat_rad)) return 0;
    const sun::Observer observer(place);
    const auto elevation = [&](double at_s) {
        return terrain.apparent_rad(sun::elevation_of(table.direction(begin + at_s, observer)),
                                    SunTerrain::kOfLowest);
    };
    double seconds = 0, before = elevation(0);
    for (double from_s = 0; from_s < length_s; from_s += step_s) {
        const double to_s = std::min(from_s + step_s, length_s), now = elevation(to_s);
        const double over = std::max(before, 0.0) + std::max(now, 0.0);
        if (over > 0) seconds += (to_s - from_s) * over / (std::abs(before) + std::abs(now));
        before = now;
    }
    return seconds / kHour_s;
}

}  // namespace

LevelHours level_hours(const SunTerrain& terrain, sun::Instant begin, double length_s) {
    const double step_s = length_s > 40 * kDay_s ? 600 : 60;
    const sun::PositionTable table(begin, begin + length_s);
    std::array<double, 9> hours;
    parallel_for(0, 9, 1, [&](int first, int last) {
        for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(last); ++i)
            hours[i] = hours_over(terrain, table, begin, length_s, step_s, terrain.marks()[i]);
    });
    return {hours[4], *std::max_element(hours.begin(), hours.end())};
}

}  // namespace relevo::light
