#include "light/sweep/shadow_strip.h"

#include <algorithm>
#include <cmath>

namespace relevo::light {

ColumnRange lines_with_far_ground(const SweepLines& lines, int row, int columns) {
    const int far = row - lines.sampling().near_rows - 1;
    if (far < lines.begin()) return {};
    // At that row the ray of the post of line i is at column i - moved.
    const SweepLines::Row& at = lines.row(row);
    const double moved = at.shift - lines.row(far).shift - at.column;
    return {ceil_of(moved - SweepLines::kOnPost),
            floor_of(columns - 1 + moved + SweepLines::kOnPost) + 1};
}

EdgeLines edge_lines(const SweepLines& lines, int set, int row, int columns) {
    constexpr double kBeside = 0.25 + SweepLines::kOnPost;
    const double shift = lines.row(row).shift + double(set) / lines.sampling().line_sets;
    const int before = ceil_of(-shift) - 1, behind = floor_of(columns - 1 - shift) + 1;
    EdgeLines found;
    if (shift + before >= -kBeside) found.before = before;
    if (shift + behind <= columns - 1 + kBeside) found.behind = behind;
    return found;
}

float ShadowStrip::height_origin_m(float lowest_m) {
    return std::isfinite(lowest_m) ? kHeightOrigins_m * std::floor(lowest_m / kHeightOrigins_m) : 0;
}

double ShadowStrip::fall_origin_m(const SweepLines& lines, int row) {
    return kFallOrigins_m * std::floor(lines.row(row).fall_m / kFallOrigins_m);
}

ShadowStrip::ShadowStrip(const SweepLines& lines, int line, int count, float lowest_m,
                         float floor_m)
    : lines_(lines),
      line_(line),
      count_(count),
      height_origin_m_(height_origin_m(lowest_m)),
      floor_m_(floor_m),
      ground_(lines, line, count + 1),
      shadow_m_(static_cast<std::size_t>(in_vectors(count) + kVectorFloats)) {
    for (std::vector<float>& set : height_m_)
        set.assign(static_cast<std::size_t>(in_vectors(count + 1) + kVectorFloats), kNothing_m);
}

float ShadowStrip::fallen_m(int row) const {
    return static_cast<float>(lines_.row(row).fall_m - fall_origin_m_);
}

/// Counts what rays have fallen by from another origin on, where it is too much or too little.
void ShadowStrip::move_fall_origin(int row) {
    const double fallen_m = lines_.row(row).fall_m - fall_origin_m_;
    if (fallen_m >= 0 && fallen_m < kFallOrigins_m) return;
    const double origin_m = fall_origin_m(lines_, row);
    const auto more_m = static_cast<float>(origin_m - fall_origin_m_);
    fall_origin_m_ = origin_m;
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
    for (int set = 0; set < kSampling.line_sets; ++set) {
        const std::span<const Crossing> crossings = lines_.of_lines(set, row);
        raise_lines(height_m_[static_cast<std::size_t>(set)].data() + from, to - from,
                    ground_.from(line_ + from), crossings.data(),
                    static_cast<int>(crossings.size()));
    }
}

void ShadowStrip::raise_beside(int row) {
    for (int set = 0; set < kSampling.line_sets; ++set) {
        const auto raise_line = [&](int line, int column) {
            if (line < line_ || line > line_ + count_) return;
            float& height_m =
                height_m_[static_cast<std::size_t>(set)][static_cast<std::size_t>(line - line_)];
            height_m = std::max(height_m, ground_.at(row, column));
        };
        const EdgeLines beside = edge_lines(lines_, set, row, columns_);
        raise_line(beside.before, 0);
        raise_line(beside.behind, columns_ - 1);
    }
}

void ShadowStrip::advance_to(int row, const Sheet& sheet) {
    move_fall_origin(row);
    columns_ = sheet.columns;
    ground_.load(sheet, row, fallen_m(row), static_cast<float>(lines_.row(row).fall_per_line_m),
                 -height_origin_m_);
    if (const int far = row - kSampling.near_rows - 1; far >= lines_.begin()) {
        raise(far);
        raise_beside(far);
    }
}

/// Finds the shadows at the posts of lines [first, end).
/// @param far  with those of ground beyond the nearest rows
void ShadowStrip::find_with(int row, int first, int end, bool far, float* shadow_m) {
    const SweepLines::Row& at = lines_.row(row);
    const std::span<const Crossing> crossings = lines_.of_posts(row);
    ShadowLook look{.shadow_m = shadow_m,
                    .count = end - first,
                    .left_m = nullptr,
                    .right_m = nullptr,
                    .weight = 0,
                    .fall_m = fallen_m(row),
                    .fall_per_line_m = static_cast<float>(at.fall_per_line_m),
                    .line = first,
                    .post_offset = at.post_offset,
                    .height_offset_m = height_origin_m_,
                    .floor_m = floor_m_,
                    .ground_m = ground_.from(first),
                    .crossings = crossings.data(),
                    .crossing_count = static_cast<int>(crossings.size())};
    if (far) {
        const float on = at.post_offset * kSampling.line_sets;
        const auto set = static_cast<std::size_t>(on);
        look.weight = on - static_cast<float>(set);
        look.left_m = look.right_m = height_m_[set].data() + (first - line_);
        // The line after those of the last set is the next one of the first set.
        if (look.weight != 0)
            look.right_m = set + 1 < kSampling.line_sets
                               ? height_m_[set + 1].data() + (first - line_)
                               : height_m_[0].data() + (first - line_) + 1;
    }
    look_for_shadows(look);
}

const float* ShadowStrip::find(int row, int first, int end) {
    // Each call writes whole vectors, of which the next one overwrites what is too much.
    float* const shadow_m = shadow_m_.data();
    const ColumnRange far = lines_with_far_ground(lines_, row, columns_);
    const int begin = std::clamp(far.begin, first, end), last = std::clamp(far.end, begin, end);
    find_with(row, first, begin, false, shadow_m);
    find_with(row, begin, last, true, shadow_m + (begin - first));
    find_with(row, last, end, false, shadow_m + (last - first));
    return shadow_m;
}

}  // namespace relevo::light
