#include "render/displacement.h"

#include <algorithm>

namespace relevo::render {

std::pair<double, double> Displacement::range_m(double lowest_m, double highest_m) const {
    // The lowest (highest) drawn height is a concave (convex) function of the height: its extremes
    // are at the range's ends.
    std::pair<double, double> range{lowest_m, highest_m};
    for (const double height_m : {lowest_m, highest_m}) {
        double lowered_m = height_m - down_m, raised_m = height_m + up_m;
        for (const double end_m : to_m) {
            lowered_m -= std::max(height_m - end_m, 0.0);
            raised_m += std::max(end_m - height_m, 0.0);
        }
        range.first = std::min(range.first, lowered_m);
        range.second = std::max(range.second, raised_m);
    }
    return range;
}

Displacement displacement_of(const std::vector<effect::DisplaceSpec>& specs,
                             const shader::ParamStore& values) {
    const auto metres = [&](const effect::DisplaceSpec::Length& length) {
        return length.address.empty() ? length.metres : values.value(length.address)[0];
    };
    Displacement sum;
    for (const effect::DisplaceSpec& spec : specs) {
        sum.down_m += std::max(metres(spec.down), 0.0);
        sum.up_m += std::max(metres(spec.up), 0.0);
        sum.aside_m += std::max(metres(spec.aside), 0.0);
        if (spec.to) sum.to_m.push_back(metres(*spec.to));
    }
    return sum;
}

}  // namespace relevo::render
