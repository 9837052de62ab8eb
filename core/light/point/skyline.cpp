#include "light/point/skyline.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <tuple>
#include <utility>

#include "base/units.h"

namespace relevo::light {

Skyline::Skyline(std::vector<double> elevation_rad) : elevation_rad_(std::move(elevation_rad)) {
    assert(!elevation_rad_.empty());
}

double Skyline::step_rad() const {
    return 2 * kPi / count();
}

double Skyline::elevation_rad(double azimuth_rad) const {
    const double turns = azimuth_rad / (2 * kPi);
    const double at = (turns - std::floor(turns)) * count();
    const int before = static_cast<int>(at);
    const auto sample = [this](int i) {
        return elevation_rad_[static_cast<std::size_t>(i % count())];
    };
    return sample(before) + (at - before) * (sample(before + 1) - sample(before));
}

Skyline::Range Skyline::range(double azimuth_rad, double half_width_rad) const {
    const double half_rad = std::min(half_width_rad, kPi);
    const double first = std::floor((azimuth_rad - half_rad) / step_rad());
    const double last = std::ceil((azimuth_rad + half_rad) / step_rad());
    const int begin = static_cast<int>(first - std::floor(first / count()) * count());
    const int end = begin + std::min(static_cast<int>(last - first) + 1, count());
    // What goes on through north is a second stretch from there.
    const double* const north = elevation_rad_.data();
    auto [lowest, highest] = std::minmax_element(north + begin, north + std::min(end, count()));
    Range range{*lowest, *highest};
    if (end > count()) {
        std::tie(lowest, highest) = std::minmax_element(north, north + end - count());
        range = {std::min(range.lowest_rad, *lowest), std::max(range.highest_rad, *highest)};
    }
    return range;
}

}  // namespace relevo::light
