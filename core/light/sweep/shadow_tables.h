#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "light/sweep/lines.h"
#include "light/sweep/runs.h"
#include "light/sweep/shadow_strip.h"

namespace relevo::light {

/// A sweep of shadows as plain numbers: everything but the heights. A device that follows every
/// line on its own, row by row, finds the figures of ShadowStrip with them:
/// shaders/light_sweep.comp.glsl does. Rows and columns are the sheet's, rows from `first_row` on.
struct ShadowTables {
    /// Members of four bytes, in the order of the shader's struct.
    struct Row {
        float fall_m, fall_per_line_m, post_offset;  ///< as RowTilt; the fall is from its origin on
        std::int32_t fall_origin;                    ///< in ShadowStrip::kFallOrigins_m
        std::int32_t column;                         ///< SweepLines::Row::column
        ColumnRange lines;                           ///< those that are raised to ground here
        ColumnRange posts;                           ///< columns of the posts that are wanted
        ColumnRange far_lines;                       ///< lines_with_far_ground()
        std::array<EdgeLines, ShadowStrip::kSampling.line_sets> edge_lines;
        /// The first crossing of each set of lines, and of the posts' own rays. Where they end the
        /// next begin; the last posts' end where the next row's begin.
        std::array<std::int32_t, ShadowStrip::kSampling.line_sets + 1> crossings;
    };
    /// Of line 0, or of its post: others meet ground as many columns on. The ground is linear
    /// between a post and the next one.
    struct Crossing {
        std::int32_t row, column;
        enum Next : std::int32_t { kOnPost, kInRow, kInColumn } next;
        float weight;  ///< of the next one
    };

    Orientation orientation;
    int columns = 0;  ///< of the sheet
    int first_row = 0;
    ColumnRange lines;      ///< to which posts belong; empty: none is wanted
    std::vector<Row> rows;  ///< and one more, where crossings end
    std::vector<Crossing> crossings;
    float height_origin_m = 0;  ///< heights count from there on
    float floor_m = 0;

    /// @param lines     whose crossings have not been found yet
    /// @param lowest_m  of all ground
    void fill(SweepLines& lines, const SheetPosts& posts, float lowest_m);
};

}  // namespace relevo::light
