#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "light/sweep.h"

/// Where shade can be at all: what spares sweeps most of the ground where the sun is high.
namespace relevo::light {

/// Lines of a sweep at a row. Line i is the ray through the reference, which is a post, moved by i
/// columns.
struct RowPlan {
    double distance_m = 0;  // from the reference towards the sun
    double shift = 0;       // column of line 0
    double fall = 0;        // of line 0, from the row of the reference on
    double ramp = 0;        // likewise, more for each line
};

/// Columns [begin, end) of a sheet.
struct ColumnRange {
    int begin = 0, end = 0;
};

/// What is known of the ground of squares of kPosts posts a side.
class ShadeCells {
  public:
    static constexpr int kPosts = 16;

    /// @param height_m  as Sweep has it
    ShadeCells(const float* height_m, int columns, int rows, std::ptrdiff_t stride);

    struct Cell {
        /// With the posts beside; minus infinity where there are holes for the lowest.
        float lowest_m, highest_m;
        /// How far the ground goes down from post to post at most, also to those beside: to the
        /// next row, to the one before, and to the next column, to the one before. Infinite
        /// by holes.
        float down_m[4];
        /// Some row has no lower post, neither here nor in the cell before on that row nor in the
        /// next one; likewise some column.
        float row_ridge_m[2], column_ridge_m[2];
    };
    int columns() const { return columns_; }
    int rows() const { return rows_; }
    const Cell& at(int column, int row) const {
        return cells_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                      static_cast<std::size_t>(column)];
    }
    /// Of all cells, what Cell::down_m is of one.
    const float (&steepest_m() const)[4] { return steepest_m_; }

  private:
    int columns_, rows_;
    std::vector<Cell> cells_;
    float steepest_m_[4];
};

/// What a sweep has to look at, for each row of cells of a sheet.
struct ShadeRanges {
    /// A post whose edge is asked for; a line that is raised to its ground; ground of either.
    /// Or that of posts in the dark.
    enum Of { kLook, kRaise, kTake, kDark };
    struct OfRows {
        std::vector<ColumnRange> ranges;       // of one row of cells after the other
        std::vector<std::uint32_t> begins{0};  // of each row's, and the end
    };
    OfRows of[4];
    /// Of a row of cells, one after the other; those at the border go on beyond it.
    std::span<const ColumnRange> at(Of what, int row) const {
        const OfRows& all = of[what];
        const auto i = static_cast<std::size_t>(row);
        return std::span(all.ranges).subspan(all.begins[i], all.begins[i + 1] - all.begins[i]);
    }
};

/// The cells of a grid as a sweep goes over them: away from the sun from row to row.
struct CellSheet {
    const ShadeCells& cells;
    bool along_columns, mirrored;
    int lines;               ///< of the sheet: rows of posts
    ColumnRange some{0, 0};  ///< columns of cells that it has

    /// @param posts  columns of the sheet that are looked at; it has all cells with any of them
    CellSheet(const ShadeCells& all, bool turned, bool in_a_mirror, int rows_of_posts,
              const ColumnRange& posts)
        : cells(all), along_columns(turned), mirrored(in_a_mirror), lines(rows_of_posts) {
        const int columns = all_columns();
        some.begin = std::clamp(posts.begin / ShadeCells::kPosts, 0, columns - 1);
        some.end = std::clamp((posts.end - 1) / ShadeCells::kPosts + 1, some.begin + 1, columns);
    }

    int all_columns() const { return along_columns ? cells.rows() : cells.columns(); }
    int columns() const { return some.end - some.begin; }
    int rows() const { return along_columns ? cells.columns() : cells.rows(); }
    /// Of the sheet, where a column of cells begins; it need not end in as many posts.
    int first_column(int column) const { return (some.begin + column) * ShadeCells::kPosts; }
    /// A column at which the grid ends.
    bool is_border(int column) const {
        return some.begin + column == 0 || some.begin + column + 1 == all_columns();
    }
    /// The row of cells that a row of the sheet is in.
    int row_of(int row) const {
        const int r = (mirrored ? lines - 1 - row : row) / ShadeCells::kPosts;
        return mirrored ? rows() - 1 - r : r;
    }
    /// The rows of the sheet [first, end) that a row of cells has.
    int first_row(int row) const {
        return mirrored ? (row == 0 ? 0 : lines - (rows() - row) * ShadeCells::kPosts)
                        : row * ShadeCells::kPosts;
    }
    int end_row(int row) const { return row + 1 < rows() ? first_row(row + 1) : lines; }
    const ShadeCells::Cell& at(int column, int row) const {
        const int r = mirrored ? rows() - 1 - row : row;
        const int c = some.begin + column;
        return along_columns ? cells.at(r, c) : cells.at(c, r);
    }
    /// So high is all ground of some row at least, here and on one side.
    float ridge_m(const ShadeCells::Cell& cell, bool after) const {
        return (along_columns ? cell.column_ridge_m : cell.row_ridge_m)[after];
    }
    /// How far ground goes down at most: to the next row, away from the sun, and to the column
    /// before and after.
    struct Down {
        float away, before, after;
    };
    /// @param down_m  as a cell has it
    Down down_m(const float (&down_m)[4]) const {
        const int along = along_columns ? 2 : 0, across = 2 - along;
        return {down_m[along + mirrored], down_m[across + 1], down_m[across]};
    }
};

/// The smooth Earth around a DEM, which hides suns that are lower than level.
struct EarthAround {
    double lowest_m = 0, curvature = 0;
};

/// What is known of the posts of cells before a sun is swept. Ground shades what is behind it only
/// from where it goes down more steeply than the rays do: elsewhere the ground next to it is higher
/// on the ray.
struct ShadedCells {
    enum State : unsigned char { kLit, kMixed, kDark };  ///< all of a cell's posts, or not known
    std::vector<unsigned char> states, sources;          ///< row by row

    /// @param sun    over the sheet; of its tangents
    /// @param plan   rows of the sheet from `begin` on
    /// @param earth  none: it hides nothing
    ShadedCells(const CellSheet& sheet, const SweepSun& sun, std::span<const RowPlan> plan,
                int begin, std::optional<EarthAround> earth);
    /// What is known where this sun is taken for some posts and another one for others.
    void join(const ShadedCells& other);
    /// So much of what the sun's rays go over is not known that all may be looked at.
    bool is_mixed() const;

  private:
    std::size_t first_ = 0, end_ = 0;  // of the cells that they go over
};

/// What is to be looked at so that posts that any of three suns can shade have the edge of the one
/// in the middle, to the bit, as if all were.
/// @param before, after  none: the sun is the first, or the last one
ShadeRanges shade_ranges(const CellSheet& sheet, const ShadedCells* before, const ShadedCells& sun,
                         const ShadedCells* after);

}  // namespace relevo::light
