#include "web/height_planes.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace relevo::web {

Heights in_steps(const Array2d<float>& height_m, double step_m) {
    assert(step_m > 0);
    double low_m = std::numeric_limits<double>::infinity(), high_m = -low_m;
    for (const float h : height_m)
        if (!std::isnan(h)) {
            low_m = std::min<double>(low_m, h);
            high_m = std::max<double>(high_m, h);
        }
    Heights heights{.value = {height_m.width(), height_m.height(), kVoid}};
    if (low_m > high_m) return heights;  // voids alone
    heights.min_m = low_m;
    heights.step_m = std::max(step_m, (high_m - low_m) / (kVoid - 1));
    std::ranges::transform(height_m, heights.value.begin(), [&](float h) {
        if (std::isnan(h)) return kVoid;
        return static_cast<std::uint16_t>(std::lround((h - low_m) / heights.step_m));
    });
    return heights;
}

std::vector<std::byte> planes_of(const Array2d<std::uint16_t>& values) {
    std::vector<std::byte> planes(2 * values.size());
    const auto at = [&](int column, int row) {
        return column < 0 || row < 0 ? 0 : int{values.at(column, row)};
    };
    std::size_t i = 0;
    for (int row = 0; row < values.height(); ++row)
        for (int column = 0; column < values.width(); ++column, ++i) {
            const int predicted =
                at(column - 1, row) + at(column, row - 1) - at(column - 1, row - 1);
            const auto difference = static_cast<unsigned>(at(column, row) - predicted);
            planes[i] = static_cast<std::byte>(difference);
            planes[values.size() + i] = static_cast<std::byte>(difference >> 8U);
        }
    return planes;
}

}  // namespace relevo::web
