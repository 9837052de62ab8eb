#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "light/sweep.h"

/// Where shade can be at all: what spares sweeps ground that is lit, or in the shade, anyway.
namespace relevo::light {

/// Lines of a sweep at a row. Line i is the ray through the reference, which is a post, moved by i
/// columns.
struct RowPlan {
    double distance_m = 0;  // from the reference towards the sun
    double shift = 0;       // column of line 0
    double fall = 0;        // of line 0, from the row of the reference on
    double ramp = 0;        // likewise, more for each line
};

/// How sweeps look for edges: over so many rows a post's own ray is followed, and beyond it lies
/// between two of so many lines from post to post.
constexpr int kNearRows = 4, kLinesFromPostToPost = 2;

/// Columns [begin, end) of a sheet.
struct ColumnRange {
    int begin = 0, end = 0;
};

/// What is known of the ground of cells of kPosts posts a side, row by row.
class ShadeCells {
  public:
    static constexpr int kPosts = 4;
    static constexpr float kHole_m = -1e9F;  ///< how low a hole counts as

    /// @param height_m  as Sweep has it
    ShadeCells(const float* height_m, int columns, int rows, std::ptrdiff_t stride);

    /// Of a cell.
    enum Figure {
        kLowest,
        kHighest,  ///< of the rows beside, too: rays meet columns between these
        /// How far the ground goes down from post to post at most: from posts of the cell, and of
        /// columns beside, to the next row or to the one before; from posts of the cell, and of
        /// columns and rows beside, to the next column or to the one before. More than anything by
        /// holes.
        kDownToNextRow,
        kDownToRowBefore,
        kDownToNextColumn,
        kDownToColumnBefore,
        /// How far the ground goes up or down from column to column at most: of the cell, and of
        /// those two beside on all sides.
        kAside,
    };
    static constexpr std::size_t kFigures = 7;

    int columns() const { return columns_; }
    int rows() const { return rows_; }
    /// A figure of a row of cells, from the first column on.
    const float* row(Figure figure, int row) const {
        return figures_[figure].data() +
               static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_);
    }
    /// The most of a row's, and of all.
    float most(Figure figure, int row) const {
        return most_of_rows_[figure][static_cast<std::size_t>(row)];
    }
    float most(Figure figure) const { return most_[figure]; }

  private:
    void find_aside();

    int columns_, rows_;
    std::array<std::vector<float>, kFigures> figures_, most_of_rows_;
    std::array<float, kFigures> most_;
};

/// What a sweep has to look at, for each row of patches of a sheet.
struct ShadeRanges {
    /// A post whose edge is asked for; a line that is raised to its ground; ground of either.
    /// Or that of posts in the dark.
    enum Of { kLook, kRaise, kTake, kDark };
    struct OfRows {
        std::vector<ColumnRange> ranges;       // of one row of patches after the other
        std::vector<std::uint32_t> begins{0};  // of each row's, and the end
    };
    OfRows of[4];
    /// Of a row of patches, one after the other; those at the border go on beyond it.
    std::span<const ColumnRange> at(Of what, int row) const {
        const OfRows& all = of[what];
        const auto i = static_cast<std::size_t>(row);
        return std::span(all.ranges).subspan(all.begins[i], all.begins[i + 1] - all.begins[i]);
    }
};

/// A grid as a sweep goes over it, away from the sun from row to row, in patches of some columns
/// and rows: what is looked at or left out as a whole.
struct PatchSheet {
    static constexpr int kColumns = 16, kRows = 8;  ///< of posts
    static constexpr int kCellsAcross = kColumns / ShadeCells::kPosts;

    const ShadeCells& cells;  ///< of the sheet, its rows as they are without a mirror
    bool mirrored;
    int lines;               ///< of the sheet: rows of posts
    ColumnRange some{0, 0};  ///< columns of patches that it has

    /// @param posts  columns of the sheet that are looked at; it has all patches with any of them
    PatchSheet(const ShadeCells& all, bool in_a_mirror, int rows_of_posts, const ColumnRange& posts)
        : cells(all), mirrored(in_a_mirror), lines(rows_of_posts) {
        const int columns = all_columns();
        some.begin = std::clamp(posts.begin / kColumns, 0, columns - 1);
        some.end = std::clamp((posts.end - 1) / kColumns + 1, some.begin + 1, columns);
    }

    int all_columns() const { return (cells.columns() + kCellsAcross - 1) / kCellsAcross; }
    int columns() const { return some.end - some.begin; }
    int rows() const { return (lines + kRows - 1) / kRows; }
    /// Of the sheet, where a column of patches begins; it need not end in as many posts.
    int first_column(int column) const { return (some.begin + column) * kColumns; }
    /// A column at which the grid ends.
    bool is_border(int column) const {
        return some.begin + column == 0 || some.begin + column + 1 == all_columns();
    }
    /// The row of patches that a row of the sheet is in.
    int row_of(int row) const {
        const int r = (mirrored ? lines - 1 - row : row) / kRows;
        return mirrored ? rows() - 1 - r : r;
    }
};

/// A flag for each patch of a sheet.
class PatchFlags {
  public:
    using Word = std::uint64_t;
    static constexpr int kBits = 64;

    PatchFlags() = default;
    PatchFlags(int columns, int rows)
        : columns_(columns),
          words_(static_cast<std::size_t>((columns + kBits - 1) / kBits)),
          bits_(words_ * static_cast<std::size_t>(rows), 0) {}

    int columns() const { return columns_; }
    /// Of column k the bit k % kBits of word k / kBits; further ones are 0.
    std::span<Word> row(int at) { return std::span(bits_).subspan(index(at), words_); }
    std::span<const Word> row(int at) const { return std::span(bits_).subspan(index(at), words_); }
    /// Rows [first, end).
    void set_all(int first, int end);
    std::int64_t count(int first, int end) const;

  private:
    std::size_t index(int at) const { return static_cast<std::size_t>(at) * words_; }

    int columns_ = 0;
    std::size_t words_ = 0;
    std::vector<Word> bits_;
};

/// The smooth Earth around a DEM, which hides suns that are lower than level: how high it is at
/// least and at most.
struct EarthAround {
    double lowest_m = 0, highest_m = 0, curvature = 0;
};

/// What is known of the posts of patches before a sun is swept. Ground shades what is behind it
/// only from where it goes down more steeply than the rays do, or nearly so: elsewhere the ground
/// next to it is higher on the ray. So lines are followed from cell to cell, some together: how
/// high they are at most where they may shade anything, and at least.
struct ShadedPatches {
    PatchFlags lit, dark;  ///< all of a patch's posts; where neither is set it is not known
    /// Some ground of a patch may shade anything, unless lines are over all of it. Ground that the
    /// Earth hides may: a post has the mean of two lines.
    PatchFlags steep, covered;

    /// @param sun    over the sheet; of its tangents
    /// @param plan   rows of the sheet from `begin` on
    /// @param earth  none: it hides nothing
    ShadedPatches(const PatchSheet& sheet, const SweepSun& sun, std::span<const RowPlan> plan,
                  int begin, std::optional<EarthAround> earth);
    /// What is known of this sun and of all between it and a higher one, whose rays have the same
    /// shape.
    void rise_to(const ShadedPatches& higher);
    /// What is known where this sun is taken for some posts and another one for others.
    void join(const ShadedPatches& other);
    /// So little of what the sun's rays go over is known that all may be looked at.
    bool is_mixed() const;

  private:
    int first_ = 0, end_ = 0;  // rows of patches that they go over
};

/// What is to be looked at so that posts that any of three suns can shade have the edge of the one
/// in the middle, to the bit, as if all were.
/// @param before, after  none: the sun is the first, or the last one
ShadeRanges shade_ranges(const PatchSheet& sheet, const ShadedPatches* before,
                         const ShadedPatches& sun, const ShadedPatches* after);

}  // namespace relevo::light
