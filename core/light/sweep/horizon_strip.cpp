#include "light/sweep/horizon_strip.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/units.h"

namespace relevo::light {

HorizonStrip::HorizonStrip(const SweepLines& lines, int line, int count, double curvature,
                           double least_tangent)
    : lines_(lines),
      curvature_(curvature),
      line_(line),
      count_(count),
      least_tangent_(least_tangent),
      ground_(lines, line, count + 1),
      height_m_(kFanRays * kPitch, kNothing_m),
      distance_m_(kFanRays * kPitch, -kFarther_m),  // whatever is seen there is infinitely low
      tangent_(static_cast<std::size_t>(in_vectors(count))) {
    static_assert(kSampling.line_sets == 1);
    for (std::size_t k = 0; k < tangents_.size(); ++k)
        tangents_[k] = static_cast<float>(std::tan(radians(kFanDegrees[k])));
}

Fans HorizonStrip::fans() {
    return {height_m_.data(), distance_m_.data(), kPitch, tangents_.data()};
}

void HorizonStrip::advance_to(int row, const Sheet& sheet) {
    ground_.load(sheet, row);
    if (const int far = row - kSampling.near_rows - 1; far >= lines_.begin()) raise(far);
}

/// To the ground of a row, and of the columns before it.
void HorizonStrip::raise(int row) {
    const ColumnRange& matter = lines_.row(row).lines;
    const int from = std::max(line_, matter.begin) - line_,
              to = std::min(line_ + count_ + 1, matter.end) - line_;
    if (from >= to) return;
    const std::span<const Crossing> crossings = lines_.of_lines(0, row);
    const double* const before_m = lines_.distances_m(crossings);
    Fans fans = this->fans();
    fans.height_m += from, fans.distance_m += from;
    std::array<FanPoint, kFanPoints> points;
    int count = 0;
    for (std::size_t k = 0; k < crossings.size(); ++k) {
        const double s = distance_m(row) - before_m[k];
        points[static_cast<std::size_t>(count++)] = {
            crossings[k], static_cast<float>(curvature_ * s * s / 2), static_cast<float>(s)};
        if (count < kFanPoints && k + 1 < crossings.size()) continue;
        raise_fans(fans, to - from, ground_.from(line_ + from), points.data(), count);
        count = 0;
    }
}

const float* HorizonStrip::find(int row, int first, int end) {
    // The line nearest to a post: its own, or the next one.
    const int nearest = first - line_ + (lines_.row(row).post_offset >= 0.5F);
    const float* const eyes_m = ground_.posts(row, first);
    const double s = distance_m(row), slope = curvature_ * s;
    int ray = 0;
    while (ray < kFanRays && tangents_[static_cast<std::size_t>(ray)] - slope < least_tangent_)
        ++ray;
    Fans fans = this->fans();
    fans.height_m += nearest, fans.distance_m += nearest;
    look_over_fans({.tangent = tangent_.data(),
                    .count = end - first,
                    .ground_m = eyes_m,
                    .fans = fans,
                    .first_ray = ray,
                    .from_m = static_cast<float>(s),
                    .sunk_m = static_cast<float>(curvature_ * s * s / 2),
                    .plane_slope = static_cast<float>(slope),
                    .also_next = least_tangent_ == -std::numeric_limits<double>::infinity()});
    look_at_near_ground(row, first, end, eyes_m);
    return tangent_.data();
}

void HorizonStrip::look_at_near_ground(int row, int first, int end, const float* eyes_m) {
    const std::span<const Crossing> crossings = lines_.of_posts(row);
    const double* const distance_m = lines_.distances_m(crossings);
    std::vector<NearGround> near(crossings.size());
    for (std::size_t k = 0; k < crossings.size(); ++k)
        near[k] = {crossings[k], static_cast<float>(1 / distance_m[k]),
                   static_cast<float>(curvature_ * distance_m[k] / 2)};
    look_near(tangent_.data(), end - first, eyes_m, ground_.from(first), near.data(),
              static_cast<int>(near.size()));
}

}  // namespace relevo::light
