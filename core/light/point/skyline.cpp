#include "light/point/skyline.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "base/units.h"

namespace relevo::light {
namespace {

Skyline::Range joined(const Skyline::Range& a, const Skyline::Range& b) {
    return {std::min(a.lowest_rad, b.lowest_rad), std::max(a.highest_rad, b.highest_rad)};
}

}  // namespace

Skyline::Skyline(std::vector<double> elevation_rad) {
    assert(!elevation_rad.empty());
    levels_.emplace_back();
    for (const double e : elevation_rad)
        levels_.front().push_back({e, e});
    while (levels_.back().size() > 1) {
        const std::vector<Range>& fine = levels_.back();
        std::vector<Range> coarse;
        for (std::size_t i = 0; i < fine.size(); i += 2)
            coarse.push_back(i + 1 < fine.size() ? joined(fine[i], fine[i + 1]) : fine[i]);
        levels_.push_back(std::move(coarse));
    }
}

double Skyline::step_rad() const {
    return 2 * kPi / count();
}

double Skyline::elevation_rad(double azimuth_rad) const {
    const double turns = azimuth_rad / (2 * kPi);
    const double at = (turns - std::floor(turns)) * count();
    const int before = static_cast<int>(at);
    const auto sample = [this](int i) {
        return levels_.front()[static_cast<std::size_t>(i % count())].lowest_rad;
    };
    return sample(before) + (at - before) * (sample(before + 1) - sample(before));
}

Skyline::Range Skyline::range(double azimuth_rad, double half_width_rad) const {
    if (!(half_width_rad < kPi - step_rad())) return range();
    const double first = std::floor((azimuth_rad - half_width_rad) / step_rad());
    const double last = std::ceil((azimuth_rad + half_width_rad) / step_rad());
    const double turn = std::floor(first / count()) * count();
    const int from = static_cast<int>(first - turn), to = static_cast<int>(last - turn);
    if (to < count()) return range_of(from, to);
    return joined(range_of(from, count() - 1), range_of(0, std::min(to - count(), count() - 1)));
}

Skyline::Range Skyline::range_of(int first, int last) const {
    Range found{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    auto a = static_cast<std::size_t>(first), b = static_cast<std::size_t>(last) + 1;
    for (std::size_t level = 0; a < b; ++level, a /= 2, b /= 2) {
        if (a % 2 == 1) found = joined(found, levels_[level][a++]);
        if (b % 2 == 1) found = joined(found, levels_[level][--b]);
    }
    return found;
}

}  // namespace relevo::light
