#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "light/sweep/ground_rows.h"
#include "light/sweep/lines.h"

namespace relevo::light {

/// The lines whose posts have far ground at a row: where the own ray of a post is beside the grid
/// at the row where lines take over from it, there is none.
/// @param columns  of the sheet
ColumnRange lines_with_far_ground(const SweepLines& lines, int row, int columns);

/// Lines up to a quarter of a post beside the grid meet the ground of its edge. A post at the edge
/// stands between one line within and one beside, and is shaded by the mean of both: with ground
/// under the inner one alone it would be lit until its own ray is a quarter of a post within.
struct EdgeLines {
    static constexpr std::int32_t kNone = std::numeric_limits<std::int32_t>::min();
    std::int32_t before = kNone;  ///< meets the ground of the first column
    std::int32_t behind = kNone;  ///< and that of the last one
};
/// @param columns  of the sheet
EdgeLines edge_lines(const SweepLines& lines, int set, int row, int columns);

/// Finds heights of shadows over posts of lines next to each other, row by row away from the sun.
/// Of two ridges the one whose ray is higher at the post counts; no line remembers the other one.
///
/// A line is as high as the highest ground that it has passed, lowered by what its ray has fallen
/// by since. So that nothing has to be lowered at every row, what rays have fallen by is added to
/// the ground instead (RowTilt), and taken away again from what is found: among such heights rays
/// are level. As rays may fall by any amount, whole multiples of kFallOrigins_m are taken from
/// that. Which multiple depends on the row alone, so that every window rounds alike.
class ShadowStrip {
  public:
    static constexpr Sampling kSampling{.near_rows = 4, .line_sets = 2, .distances = false};
    static constexpr int kMostLines = 2047;  ///< so that the rows kept fit into the cache
    // Heights, and what rays have fallen by, count from whole multiples of these.
    static constexpr float kHeightOrigins_m = 256;
    static constexpr double kFallOrigins_m = 2048;
    static float height_origin_m(float lowest_m);
    static double fall_origin_m(const SweepLines& lines, int row);

    /// @param line, count  the first line, and how many
    /// @param lowest_m     of all ground; heights count from near to it
    /// @param floor_m      shadows are no lower; minus infinity: they may be
    ShadowStrip(const SweepLines& lines, int line, int count, float lowest_m, float floor_m);

    /// Goes on to a row: takes its ground from the sheet, and raises the lines to the ground of the
    /// row that has become far.
    void advance_to(int row, const Sheet& sheet);
    /// The shadows at the posts of this row that belong to lines [first, end) of the strip, from
    /// the first one on.
    const float* find(int row, int first, int end);

  private:
    float fallen_m(int row) const;
    void move_fall_origin(int row);
    void raise(int row);
    void raise_beside(int row);
    void find_with(int row, int first, int end, bool far, float* shadow_m);

    const SweepLines& lines_;
    int line_, count_;
    int columns_ = 0;  // of the sheet
    float height_origin_m_, floor_m_;
    double fall_origin_m_ = 0;
    GroundRows ground_;
    std::array<std::vector<float>, kSampling.line_sets> height_m_;  // of the lines of each set
    std::vector<float> shadow_m_;
};

}  // namespace relevo::light
