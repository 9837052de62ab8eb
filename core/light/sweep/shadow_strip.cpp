#include "light/sweep/shadow_strip.h"

#include <algorithm>
#include <cmath>

namespace relevo::light {

ShadowStrip::ShadowStrip(const SweepLines& lines, int line, int count, float lowest_m,
                         float floor_m)
    : lines_(lines),
      line_(line),
      count_(count),
      zero_m_(std::isfinite(lowest_m) ? kZero_m * std::floor(lowest_m / kZero_m) : 0),
      floor_m_(floor_m),
      ground_(lines, line, count + 1),
      shadow_m_(static_cast<std::size_t>(in_vectors(count))) {
    for (std::vector<float>& set : height_m_)
        set.assign(static_cast<std::size_t>(in_vectors(count + 1) + kVectorFloats), kNothing_m);
}

float ShadowStrip::fallen_m(int row) const {
    return static_cast<float>(lines_.row(row).fall_m - base_m_);
}

/// Counts what rays have fallen by from another base on, where it is too much or too little.
void ShadowStrip::rebase(int row) {
    const double fallen_m = lines_.row(row).fall_m - base_m_;
    if (fallen_m >= 0 && fallen_m < kBase_m) return;
    const double base_m = kBase_m * std::floor(lines_.row(row).fall_m / kBase_m);
    const auto more_m = static_cast<float>(base_m - base_m_);
    base_m_ = base_m;
    if (row == lines_.begin()) return;
    const auto lower = [&](float* heights_m, int count) {
        for (int i = 0; i < count; ++i)
            heights_m[i] -= more_m;
    };
    for (std::vector<float>& set : height_m_)
        lower(set.data(), static_cast<int>(set.size()));
    for (int at = std::max(lines_.begin(), row - GroundRows::kept(lines_) + 1); at < row; ++at)
        lower(ground_.begin_of(at), ground_.width());
}

void ShadowStrip::raise(int row) {
    const ColumnRange& matter = lines_.row(row).lines;
    const int from = std::max(line_, matter.begin) - line_,
              to = std::min(line_ + count_ + 1, matter.end) - line_;
    if (from >= to) return;
    for (int set = 0; set < kNearness.line_sets; ++set) {
        const std::span<const Crossing> crossings = lines_.of_lines(set, row);
        raise_lines(height_m_[static_cast<std::size_t>(set)].data() + from, to - from,
                    ground_.from(line_ + from), crossings.data(),
                    static_cast<int>(crossings.size()));
    }
}

void ShadowStrip::come_to(int row, const Sheet& sheet) {
    rebase(row);
    ground_.take(sheet, row,
                 {.from_m = nullptr,
                  .to_m = nullptr,
                  .count = 0,
                  .fall_m = fallen_m(row),
                  .ramp_m = static_cast<float>(lines_.row(row).ramp_m),
                  .line = 0,
                  .between = 0,
                  .base_m = -zero_m_});
    if (const int far = row - kNearness.near_rows - 1; far >= lines_.begin()) raise(far);
}

const float* ShadowStrip::look(int row, int first, int end) {
    const SweepLines::Row& at = lines_.row(row);
    const std::span<const Crossing> crossings = lines_.of_posts(row);
    ShadowLook look{.shadow_m = shadow_m_.data(),
                    .count = end - first,
                    .before_m = nullptr,
                    .behind_m = nullptr,
                    .part = 0,
                    .fall_m = fallen_m(row),
                    .ramp_m = static_cast<float>(at.ramp_m),
                    .line = first,
                    .between = at.between,
                    .base_m = zero_m_,
                    .floor_m = floor_m_,
                    .ground_m = ground_.from(first),
                    .crossings = crossings.data(),
                    .crossing_count = static_cast<int>(crossings.size())};
    if (row - kNearness.near_rows - 1 >= lines_.begin()) {
        const float on = at.between * kNearness.line_sets;
        const auto set = static_cast<std::size_t>(on);
        look.part = on - static_cast<float>(set);
        look.before_m = look.behind_m = height_m_[set].data() + (first - line_);
        // The line after those of the last set is the next one of the first set.
        if (look.part != 0)
            look.behind_m = set + 1 < kNearness.line_sets
                                ? height_m_[set + 1].data() + (first - line_)
                                : height_m_[0].data() + (first - line_) + 1;
    }
    look_for_shadows(look);
    return shadow_m_.data();
}

}  // namespace relevo::light
