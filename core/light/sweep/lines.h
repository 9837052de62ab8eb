#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/window.h"
#include "light/sweep/kernels.h"
#include "light/sweep/ray.h"

namespace relevo::light {

/// As std::floor and std::ceil, which are calls on processors without SSE 4.1; of what an int
/// holds.
inline int floor_of(double x) {
    const int towards_zero = static_cast<int>(x);
    return towards_zero - (towards_zero > x);
}
inline int ceil_of(double x) {
    return -floor_of(-x);
}

/// A grid as a sweep goes over it, row by row away from the sun: row 0 is the one nearest to it.
/// The rows of a sheet are rows of the grid or, where rays go rather along these, columns of it.
struct Sheet {
    const float* first_m = nullptr;  ///< height of its first post
    std::ptrdiff_t stride = 0;       ///< from row to row
    int columns = 0, rows = 0;
};

/// Columns [begin, end).
struct ColumnRange {
    int begin = 0, end = 0;

    bool is_empty() const { return begin >= end; }
};

/// The posts that a sweep is for, on a sheet.
struct SheetPosts {
    Window window;
    std::vector<ColumnRange> ranges{};  ///< of each row of the window; none: all of its columns

    ColumnRange at(int row) const {
        if (ranges.empty()) return {window.column, window.end_column()};
        return ranges[static_cast<std::size_t>(row - window.row)];
    }
};

/// Which ground a sweep looks at, and how.
///
/// The nearest rows are tested on the post's own ray, as an error there shows as a false shadow.
/// Fewer such rows leave stripes along the lines, more cost time at every post. Farther ground is
/// met by the lines, of which each post has as many as there are sets.
struct Sampling {
    int near_rows;   ///< rows before a post that its own ray is followed over
    int line_sets;   ///< lines from one post to the next: sets of lines that are a post apart
    bool distances;  ///< whether it matters how far off ground is
};

/// Where the lines of a sweep are, and what ground they meet: all that is the same for the posts of
/// a row, so that a strip of them is swept by vectors.
///
/// Line i of a set is the sun's ray, moved by i columns (and by a part of one from set to set).
/// Each post belongs to a line: `column` is the post of line 0, column + i that of line i.
class SweepLines {
  public:
    /// Of a row of the sheet.
    struct Row {
        double distance_m = 0;  ///< of line 0, from the reference on, towards the sun
        double shift = 0;       ///< the column of line 0
        double fall_m = 0;      ///< that line 0 has come down by since the row of the reference
        double fall_per_line_m = 0;  ///< how much more that is for each further line
        int column = 0;  ///< of the first post on line 0 or after it: it belongs to that line
        float post_offset = 0;  ///< of each post from the line that it belongs to [columns], 0 to 1
        ColumnRange lines;      ///< those that matter to the posts wanted
        int ground_column = 0;  ///< the first one whose ground line 0, or its post, meets
    };

    /// @param sun      over the sheet; its ray comes from lower rows
    /// @param most_fall_m   a ray that has fallen by so much shades nothing any more
    SweepLines(const Sheet& sheet, const SweepSun& sun, const SheetPosts& posts,
               const Sampling& sampling, double most_fall_m);

    int begin() const { return begin_; }  ///< the first row whose ground matters
    int end() const { return begin_ + static_cast<int>(rows_.size()); }
    const Row& row(int row) const { return rows_[static_cast<std::size_t>(row - begin_)]; }
    const Sampling& sampling() const { return sampling_; }
    const ColumnRange& lines() const { return lines_; }  ///< to which any post wanted belongs
    /// How many columns of ground next to each other one line meets at most.
    int ground_columns() const { return ground_columns_; }
    /// The columns that line 0 goes through over rows [first, end).
    ColumnRange columns(int first, int end) const;

    /// Ground is kept in rows of `pitch` floats, row after row, of which the last `kept` are there;
    /// a row's first is `ground_column`. To be called before crossings are asked for.
    void find_crossings(int pitch, int kept);
    /// What the lines of a set meet at a row and on their way there from the row before.
    std::span<const Crossing> of_lines(int set, int row) const { return crossings_of(set, row); }
    /// What the rays of the posts of a row meet over the rows just before it.
    std::span<const Crossing> of_posts(int row) const {
        return crossings_of(sampling_.line_sets, row);
    }
    /// How far off each of these is [m]; where distances matter.
    const double* distances_m(std::span<const Crossing> of) const {
        return distances_m_.data() + (of.data() - crossings_.data());
    }
    /// Where a row of ground has the column 0 of the sheet.
    int origin(int row) const { return row % kept_ * pitch_ - this->row(row).ground_column; }

    static constexpr double kOnPost = 1e-6;  ///< columns: a ray so near to a post meets that

  private:
    void add_rows(const SweepSun& sun, const SheetPosts& posts, double most_fall_m);
    void find_line_ranges(const Sheet& sheet, const SheetPosts& posts, double reach_m);
    void find_ground_columns();
    void add_row_crossing(int row, double shift, double from_m);
    void add_column_crossings(int row, double offset, double from_m);
    void add_crossing(const Crossing& crossing, double distance_m);
    std::span<const Crossing> crossings_of(int k, int row) const;

    Sampling sampling_;
    int begin_ = 0, first_wanted_ = 0;
    std::vector<Row> rows_;
    ColumnRange lines_;
    int ground_columns_ = 0;
    int pitch_ = 0, kept_ = 1;
    std::vector<Crossing> crossings_;
    std::vector<double> distances_m_;
    std::vector<std::uint32_t> begins_;  // of each row: of each set, then of posts; then the end
};

/// How far shade can reach over posts of a window.
/// @param most_fall_m  as SweepLines has it
double reach_m(const SweepSun& sun, const Window& window, double most_fall_m);

}  // namespace relevo::light
