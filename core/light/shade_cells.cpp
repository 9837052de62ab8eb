#include "light/shade_cells.h"

#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "base/parallel_for.h"
#include "base/wide_loops.h"

namespace relevo::light {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kPosts = ShadeCells::kPosts;
constexpr float kSteep_m = 1e9F;  // more than ground goes down anywhere
constexpr float kNone_m = -4e9F;  // lines that shade nothing: lower than any hole
constexpr double kSlack_m = 0.1;  // more than bounds of what rays fall by, and floats, are off
constexpr int kSlack_posts = 2;   // as far as posts look beside them for lines
/// Beyond its nearest rows a post has the mean of two lines' heights, which may be higher than what
/// its own ray met. Ground that goes aside by a metre from column to column is then higher by so
/// much for each of those rows; and where one line has fallen from afar and the other one lies on
/// ground, they are to have fallen so far below all ground that may be told to be lit.
constexpr float kMeanOfGround = 0.5F / (kLinesFromPostToPost * (kNearRows + 1)),
                kMeanOfLines = 1.0F / kLinesFromPostToPost;
/// Cells around one that its posts look back over as far as that.
constexpr int kCellsBack = (kNearRows + 1 + kPosts - 1) / kPosts;

using Floats = std::vector<float>;

// --- The ground

/// Of the columns of a few rows of posts. What is lowest is negative, so that the most of all
/// figures is looked for.
struct ColumnFigures {
    static constexpr int kBeside = 2;  // columns before the first one and behind the last one

    int columns;
    std::array<Floats, ShadeCells::kFigures> of;
    Floats most;

    explicit ColumnFigures(int count) : columns(count) {
        for (Floats& each : of)
            each.resize(static_cast<std::size_t>(whole() + 2 * kBeside));
        most.resize(of[0].size());
    }
    /// Whole cells of columns.
    int whole() const { return (columns + kPosts - 1) / kPosts * kPosts; }
    float* at(ShadeCells::Figure figure) { return of[figure].data() + kBeside; }
    void clear() {
        for (Floats& each : of)
            std::fill(each.begin(), each.end(), -kSteep_m);
    }
};

RELEVO_WIDE_LOOPS void add_lowest(const float* height_m, int count, float* negative_m) {
#pragma GCC ivdep
    for (int i = 0; i < count; ++i) {
        const float low = height_m[i] == height_m[i] ? -height_m[i] : -ShadeCells::kHole_m;
        negative_m[i] = low > negative_m[i] ? low : negative_m[i];
    }
}

/// @param down_m  from each post to another
RELEVO_WIDE_LOOPS void add_down(const float* from_m, const float* to_m, int count, float* down_m) {
#pragma GCC ivdep
    for (int i = 0; i < count; ++i) {
        const float by = from_m[i] - to_m[i];
        const float down = by == by ? by : kSteep_m;
        down_m[i] = down > down_m[i] ? down : down_m[i];
    }
}

RELEVO_WIDE_LOOPS void add_most(const float* from, int count, float* to) {
#pragma GCC ivdep
    for (int i = 0; i < count; ++i)
        to[i] = from[i] > to[i] ? from[i] : to[i];
}

/// The most of each figure and of those behind it.
/// @param beside  0: of 4 figures, 1: of those two on either side of them, too
RELEVO_WIDE_LOOPS void find_most(const float* from, int count, int beside, float* most) {
#pragma GCC ivdep
    for (int i = 0; i < count; ++i) {
        const float a = from[i] > from[i + 1] ? from[i] : from[i + 1],
                    b = from[i + 2] > from[i + 3] ? from[i + 2] : from[i + 3],
                    c = from[i - beside] > from[i + 3 + beside] ? from[i - beside]
                                                                : from[i + 3 + beside];
        const float d = a > b ? a : b;
        most[i] = c > d ? c : d;
    }
}
static_assert(kPosts == 4);

}  // namespace

ShadeCells::ShadeCells(const float* height_m, int columns, int rows, std::ptrdiff_t stride)
    : columns_((columns + kPosts - 1) / kPosts), rows_((rows + kPosts - 1) / kPosts) {
    for (Floats& figures : figures_)
        figures.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    for (Floats& most : most_of_rows_)
        most.resize(static_cast<std::size_t>(rows_));
    const auto row = [=](int at) { return height_m + at * stride; };
    const auto add = [&](int cells, ColumnFigures& to) {
        const int first = cells * kPosts, end = std::min(rows, first + kPosts);
        to.clear();
        for (int at = std::max(0, first - 1); at < std::min(rows, end + 1); ++at) {
            add_down(row(at), row(at) + 1, columns - 1, to.at(kDownToNextColumn));
            add_down(row(at) + 1, row(at), columns - 1, to.at(kDownToColumnBefore) + 1);
            add_most(row(at), columns, to.at(kHighest));
        }
        for (int at = first; at < end; ++at) {
            add_lowest(row(at), columns, to.at(kLowest));
            if (at + 1 < rows) add_down(row(at), row(at + 1), columns, to.at(kDownToNextRow));
            if (at > 0) add_down(row(at), row(at - 1), columns, to.at(kDownToRowBefore));
        }
    };
    parallel_for(0, rows_, 16, [&](int begin, int end) {
        ColumnFigures found(columns);
        for (int cells = begin; cells < end; ++cells) {
            add(cells, found);
            const std::size_t first =
                static_cast<std::size_t>(cells) * static_cast<std::size_t>(columns_);
            for (const Figure figure : {kLowest, kHighest, kDownToNextRow, kDownToRowBefore,
                                        kDownToNextColumn, kDownToColumnBefore}) {
                const bool is_height = figure == kLowest || figure == kHighest;
                float* const most = found.most.data();
                find_most(found.at(figure), found.whole() - kPosts + 1, is_height ? 0 : 1, most);
                float* const to = figures_[figure].data() + first;
                for (int cell = 0; cell < columns_; ++cell)
                    to[cell] = figure == kLowest ? -most[cell * kPosts] : most[cell * kPosts];
            }
            for (std::size_t i = first; i < first + static_cast<std::size_t>(columns_); ++i)
                if (figures_[kLowest][i] == kHole_m)
                    for (const Figure down :
                         {kDownToNextRow, kDownToRowBefore, kDownToNextColumn, kDownToColumnBefore})
                        figures_[down][i] = kSteep_m;
        }
    });
    find_aside();
    const auto width = static_cast<std::size_t>(columns_);
    for (std::size_t k = 0; k < kFigures; ++k) {
        for (std::size_t i = 0; i < most_of_rows_[k].size(); ++i) {
            const float* const of_row = figures_[k].data() + i * width;
            most_of_rows_[k][i] = *std::max_element(of_row, of_row + width);
        }
        most_[k] = *std::max_element(most_of_rows_[k].begin(), most_of_rows_[k].end());
    }
}

void ShadeCells::find_aside() {
    const auto width = static_cast<std::size_t>(columns_);
    parallel_for(0, rows_, 16, [&](int begin, int end) {
        Floats most(width);
        for (int row = begin; row < end; ++row) {
            std::fill(most.begin(), most.end(), 0.0F);
            for (int at = std::max(0, row - kCellsBack);
                 at <= std::min(rows_ - 1, row + kCellsBack); ++at)
                for (const Figure down : {kDownToNextColumn, kDownToColumnBefore})
                    add_most(this->row(down, at), columns_, most.data());
            float* const to = figures_[kAside].data() + static_cast<std::size_t>(row) * width;
            for (int aside = -kCellsBack; aside <= kCellsBack; ++aside) {
                const int from = std::max(0, -aside), last = columns_ - std::max(0, aside);
                if (from < last) add_most(most.data() + from + aside, last - from, to + from);
            }
        }
    });
}

namespace {

// --- Rays over it

/// How rays go from row to row of posts: at least and at most aside, and down at least.
struct Steepness {
    double least_aside = kInfinity, most_aside = -kInfinity, least_fall_m = kInfinity;

    /// @param plan  rows next to each other, over columns of the sheet
    Steepness(const PatchSheet& sheet, std::span<const RowPlan> plan) {
        if (plan.size() < 2) least_aside = most_aside = 0;
        for (std::size_t k = 1; k < plan.size(); ++k) {
            const RowPlan &a = plan[k - 1], &b = plan[k];
            const double aside = b.shift - a.shift;
            least_aside = std::min(least_aside, aside);
            most_aside = std::max(most_aside, aside);
            for (const int column : {0, sheet.columns()}) {
                const double line = sheet.first_column(column) - a.shift;
                least_fall_m = std::min(least_fall_m, b.fall - a.fall + (b.ramp - a.ramp) * line);
            }
        }
        least_fall_m -= kSlack_m / 16;
    }

    /// What goes down that way, and how often that counts.
    struct Aside {
        ShadeCells::Figure down;
        double posts;
    };
    static Aside of(double aside) {
        if (aside < 0) return {ShadeCells::kDownToColumnBefore, -aside};
        return {ShadeCells::kDownToNextColumn, aside};
    }
    /// Whether ground is anywhere so steep that it may shade anything.
    /// @param most  a figure of the ground there
    template <typename Most>
    bool may_shade(bool mirrored, const Most& most) const {
        double beside_m = -kSteep_m;
        for (const double aside : {least_aside, most_aside})
            beside_m = std::max(beside_m, of(aside).posts * double{most(of(aside).down)});
        return most(away(mirrored)) + beside_m + kMeanOfGround * most(ShadeCells::kAside) >=
               least_fall_m;
    }
    static ShadeCells::Figure away(bool mirrored) {
        return mirrored ? ShadeCells::kDownToRowBefore : ShadeCells::kDownToNextRow;
    }
};

/// A row of cells and what rays have fallen by over it: over the k-th of them, the slack included,
/// what two lines have there at least and at most.
struct GroundBounds {
    int cells;
    const float *lowest_m, *highest_m;
    std::array<float, 2> fall_m, fall_a_cell_m;
    float slack_m;
    const float* away_m;  // down to the next row
    std::array<const float*, 2> beside_m;
    std::array<float, 2> aside;
    const float* aside_m;
    float least_fall_m;
    // What is found: the ground, level with the rays, how high what may shade anything is, and how
    // much more steeply it goes down than rays at most, of this row and those before.
    float *low_m, *high_m, *source_m, *steeper_m;
};

RELEVO_WIDE_LOOPS void bound_ground(const GroundBounds& given) {
    const GroundBounds of = given;
#pragma GCC ivdep
    for (int k = 0; k < of.cells; ++k) {
        const auto at = static_cast<float>(k);
        const float a = of.fall_m[0] + of.fall_a_cell_m[0] * at,
                    b = of.fall_m[1] + of.fall_a_cell_m[1] * at;
        const float high = of.highest_m[k] + ((a > b ? a : b) + of.slack_m);
        const float first = of.aside[0] * of.beside_m[0][k],
                    second = of.aside[1] * of.beside_m[1][k];
        const float steeper = of.away_m[k] + (first > second ? first : second) +
                              kMeanOfGround * of.aside_m[k] - of.least_fall_m;
        of.low_m[k] =
            of.lowest_m[k] + ((a < b ? a : b) - of.slack_m) - kMeanOfLines * of.aside_m[k];
        of.high_m[k] = high;
        of.source_m[k] = steeper >= 0 ? high : kNone_m;
        of.steeper_m[k] = steeper > of.steeper_m[k] ? steeper : of.steeper_m[k];
    }
}

/// The most and the least of three numbers, and of three so far on: of 3 to 6 next to each other.
[[gnu::always_inline]] inline float most_of(const float* from, int on) {
    const float a = from[0] > from[1] ? from[0] : from[1], b = from[2];
    const float c = from[on] > from[on + 1] ? from[on] : from[on + 1], d = from[on + 2];
    const float e = a > b ? a : b, f = c > d ? c : d;
    return e > f ? e : f;
}
[[gnu::always_inline]] inline float least_of(const float* from, int on) {
    const float a = from[0] < from[1] ? from[0] : from[1], b = from[2];
    const float c = from[on] < from[on + 1] ? from[on] : from[on + 1], d = from[on + 2];
    const float e = a < b ? a : b, f = c < d ? c : d;
    return e < f ? e : f;
}

/// Bundles of lines over a row of cells.
struct Bundles {
    int bundles;
    const float *source_m, *low_m;  // of the first one's first cell
    int on;                         // as most_of() has it
    float *most_m, *least_m;        // how high they are: where they may shade anything, and at all
    float *before_m, *least_before_m;  // as they come to posts: the row's own sources included
};

RELEVO_WIDE_LOOPS void raise_bundles(const Bundles& given) {
    const Bundles of = given;
#pragma GCC ivdep
    for (int k = 0; k < of.bundles; ++k) {
        const float source = most_of(of.source_m + k, of.on), low = least_of(of.low_m + k, of.on);
        const float before = of.most_m[k] > source ? of.most_m[k] : source;
        const float least = of.least_m[k];
        of.before_m[k] = before;
        of.least_before_m[k] = least;
        of.most_m[k] = before <= low ? kNone_m : before;
        of.least_m[k] = least > low ? least : low;
    }
}

RELEVO_WIDE_LOOPS bool is_any_over(const float* most_m, int bundles) {
    int any = 0;
    for (int k = 0; k < bundles; ++k)
        any |= most_m[k] > kNone_m;
    return any != 0;
}

/// How far the lines that come over cells are over their ground, at most and at least.
struct Cover {
    int cells;
    const float *before_m, *least_before_m;  // of the first cell's first bundle
    int on;
    const float *low_m, *high_m;
    float *over_m, *least_over_m;
};

RELEVO_WIDE_LOOPS void find_cover(const Cover& given) {
    const Cover of = given;
#pragma GCC ivdep
    for (int k = 0; k < of.cells; ++k) {
        of.over_m[k] = most_of(of.before_m + k, of.on) - of.low_m[k];
        of.least_over_m[k] = least_of(of.least_before_m + k, of.on) - of.high_m[k];
    }
}

/// The edge that the smooth Earth makes over cells, at least and at most: the sun's tangent is a
/// line from cell to cell.
struct EarthCover {
    int cells;
    float tangent, tangent_a_cell, spread;
    float earth_lowest_m, earth_highest_m, a_tangent2_m;
    const float *lowest_m, *highest_m;
    float *over_m, *least_over_m;
};

RELEVO_WIDE_LOOPS void add_earth(const EarthCover& given) {
    const EarthCover of = given;
    constexpr auto kSlack = static_cast<float>(kSlack_m);
#pragma GCC ivdep
    for (int k = 0; k < of.cells; ++k) {
        const float tangent = of.tangent + of.tangent_a_cell * static_cast<float>(k);
        const float least = tangent - of.spread, most = tangent + of.spread;
        const float high = of.earth_highest_m + least * least * of.a_tangent2_m + kSlack,
                    low = of.earth_lowest_m + most * most * of.a_tangent2_m - kSlack;
        const float over = (least < 0 ? high : kNone_m) - of.lowest_m[k],
                    least_over = (most < 0 ? low : kNone_m) - of.highest_m[k];
        of.over_m[k] = over > of.over_m[k] ? over : of.over_m[k];
        of.least_over_m[k] = least_over > of.least_over_m[k] ? least_over : of.least_over_m[k];
    }
}

RELEVO_WIDE_LOOPS void add_cover(const float* over_m, const float* least_over_m, int cells,
                                 float* most_m, float* least_m) {
#pragma GCC ivdep
    for (int k = 0; k < cells; ++k) {
        most_m[k] = over_m[k] > most_m[k] ? over_m[k] : most_m[k];
        least_m[k] = least_over_m[k] < least_m[k] ? least_over_m[k] : least_m[k];
    }
}

/// The figures of each cell and of those behind it that a patch has, too.
RELEVO_WIDE_LOOPS void join_cells(int cells, float* steeper_m, float* over_m, float* covered_m,
                                  float* covered_by_lines_m) {
    static_assert(PatchSheet::kCellsAcross == 4);
#pragma GCC ivdep
    for (int k = 0; k < cells; ++k) {
        const auto most = [k](const float* of) {
            const float a = of[k] > of[k + 1] ? of[k] : of[k + 1],
                        b = of[k + 2] > of[k + 3] ? of[k + 2] : of[k + 3];
            return a > b ? a : b;
        };
        const auto least = [k](const float* of) {
            const float a = of[k] < of[k + 1] ? of[k] : of[k + 1],
                        b = of[k + 2] < of[k + 3] ? of[k + 2] : of[k + 3];
            return a < b ? a : b;
        };
        steeper_m[k] = most(steeper_m);
        over_m[k] = most(over_m);
        covered_m[k] = least(covered_m);
        covered_by_lines_m[k] = least(covered_by_lines_m);
    }
}

/// Lines that go from row to row of cells, kPosts together. Bundle b has lines [kPosts b, kPosts b
/// + kPosts), a line being a column of the patches' less where the ray is there.
class LinesOverCells {
  public:
    LinesOverCells(const PatchSheet& sheet, const SweepSun& sun, std::span<const RowPlan> plan,
                   int begin, const std::optional<EarthAround>& earth)
        : sheet_(sheet),
          sun_(sun),
          plan_(plan),
          begin_(begin),
          earth_(earth),
          first_cell_(sheet.some.begin * PatchSheet::kCellsAcross),
          cells_(std::min(sheet.columns() * PatchSheet::kCellsAcross,
                          sheet.cells.columns() - first_cell_)) {
        for (Floats* const each : {&low_m_, &source_m_})
            each->assign(static_cast<std::size_t>(cells_ + 2 * kBeside), kNone_m);
        for (Floats* const each : {&high_m_, &over_m_, &least_over_m_})
            each->resize(static_cast<std::size_t>(cells_));
        const auto in_patches =
            static_cast<std::size_t>(sheet.columns() * PatchSheet::kCellsAcross + 4);
        for (Floats* const each : {&steeper_m_, &most_over_m_, &covered_m_, &covered_by_lines_m_})
            each->resize(in_patches);
        double least = kInfinity, most = -kInfinity;
        for (const RowPlan& row : plan) {
            least = std::min(least, row.shift - sheet.first_column(0));
            most = std::max(most, row.shift - sheet.first_column(0));
        }
        first_bundle_ = -bundle(most) - 4;
        const int bundles = cells_ - bundle(least) + 4 - first_bundle_;
        for (Floats* const each : {&most_m_, &least_m_, &before_m_, &least_before_m_})
            each->assign(static_cast<std::size_t>(bundles), kNone_m);
    }

    /// A row of patches, to be called for one after the other. What is not known beforehand is to
    /// be 0.
    /// @return  whether any is known: not where rays go too far aside
    bool go_over(int row, ShadedPatches& patches) {
        std::fill(steeper_m_.begin(), steeper_m_.end(), -kSteep_m);
        std::fill(most_over_m_.begin(), most_over_m_.end(), kNone_m);
        for (Floats* const each : {&covered_m_, &covered_by_lines_m_})
            std::fill(each->begin(), each->end(), kSteep_m);
        constexpr int kDown = PatchSheet::kRows / kPosts;
        const bool mirrored = sheet_.mirrored;
        const int of_grid = mirrored ? sheet_.rows() - 1 - row : row;
        for (int k = 0; k < kDown; ++k) {
            const int cells = of_grid * kDown + (mirrored ? kDown - 1 - k : k);
            if (cells < sheet_.cells.rows() && !go_over_cells(cells)) return false;
        }
        join_cells(cells_, steeper_m_.data(), most_over_m_.data(), covered_m_.data(),
                   covered_by_lines_m_.data());
        const Floats& by_lines_m = earth_ ? covered_by_lines_m_ : covered_m_;
        const std::span<PatchFlags::Word> lit = patches.lit.row(row), dark = patches.dark.row(row),
                                          steep = patches.steep.row(row),
                                          covered = patches.covered.row(row);
        for (int column = 0; column < sheet_.columns(); ++column) {
            const auto i = static_cast<std::size_t>(column * PatchSheet::kCellsAcross),
                       word = static_cast<std::size_t>(column / PatchFlags::kBits);
            const int bit = column % PatchFlags::kBits;
            const bool is_dark = covered_m_[i] > 0;
            dark[word] |= PatchFlags::Word{is_dark} << bit;
            lit[word] |= PatchFlags::Word{!is_dark && !(most_over_m_[i] > 0)} << bit;
            steep[word] |= PatchFlags::Word{steeper_m_[i] >= 0} << bit;
            covered[word] |= PatchFlags::Word{by_lines_m[i] > 0} << bit;
        }
        return true;
    }

  private:
    static constexpr int kBeside = 8;        // cells beside that bundles may come over
    static constexpr double kBase_m = 4096;  // as Strip has it

    static int bundle(double lines) { return static_cast<int>(std::floor(lines / kPosts)); }

    /// Rows [first, end) of the sheet that a row of cells has, of those that there are.
    std::pair<int, int> rows_of(int cells) const {
        int first = cells * kPosts, end = std::min(first + kPosts, sheet_.lines);
        if (sheet_.mirrored) {
            first = sheet_.lines - first, end = sheet_.lines - end;
            std::swap(first, end);
        }
        const int last = begin_ + static_cast<int>(plan_.size());
        return {std::max(first, begin_), std::min(end, last)};
    }
    const RowPlan& row(int at) const { return plan_[static_cast<std::size_t>(at - begin_)]; }

    bool go_over_cells(int cells) {
        const auto [first, end] = rows_of(cells);
        if (first >= end) return true;
        const int last = begin_ + static_cast<int>(plan_.size());
        const Steepness steps(
            sheet_, plan_.subspan(static_cast<std::size_t>(first - begin_),
                                  static_cast<std::size_t>(std::min(end + 1, last) - first)));
        const auto most_of_row = [&](ShadeCells::Figure figure) {
            return sheet_.cells.most(figure, cells);
        };
        // Nothing is in the shade, nor gets there.
        if (!earth_ && !any_ && !steps.may_shade(sheet_.mirrored, most_of_row)) {
            std::fill(covered_m_.begin(), covered_m_.end(), -kSteep_m);
            return true;
        }
        rebase(row(first).fall);
        find_bounds(cells, first, end, steps);
        double least = kInfinity, most = -kInfinity;
        for (int at = std::max(first - 1, begin_); at < end; ++at) {
            least = std::min(least, row(at).shift - sheet_.first_column(0));
            most = std::max(most, row(at).shift - sheet_.first_column(0));
        }
        // Bundle b comes over cells [b + to_first, b + to_last].
        const int to_first = bundle(least - kSlack_posts),
                  to_last = bundle(most + kPosts + kSlack_posts), on = to_last - to_first - 2;
        if (on > 3) return false;
        const int from = -to_last - first_bundle_;
        raise_bundles({.bundles = cells_ + to_last - to_first,
                       .source_m = source_m_.data() + kBeside - (to_last - to_first),
                       .low_m = low_m_.data() + kBeside - (to_last - to_first),
                       .on = on,
                       .most_m = most_m_.data() + from,
                       .least_m = least_m_.data() + from,
                       .before_m = before_m_.data(),
                       .least_before_m = least_before_m_.data()});
        any_ = is_any_over(most_m_.data(), static_cast<int>(most_m_.size()));
        find_cover({.cells = cells_,
                    .before_m = before_m_.data(),
                    .least_before_m = least_before_m_.data(),
                    .on = on,
                    .low_m = low_m_.data() + kBeside,
                    .high_m = high_m_.data(),
                    .over_m = over_m_.data(),
                    .least_over_m = least_over_m_.data()});
        if (earth_) {
            add_cover(over_m_.data(), least_over_m_.data(), cells_, most_over_m_.data(),
                      covered_by_lines_m_.data());
            cover_by_earth(cells, first, end);
        }
        add_cover(over_m_.data(), least_over_m_.data(), cells_, most_over_m_.data(),
                  covered_m_.data());
        return true;
    }

    const float* figures(ShadeCells::Figure figure, int cells) const {
        return sheet_.cells.row(figure, cells) + first_cell_;
    }

    void find_bounds(int cells, int first, int end, const Steepness& steps) {
        const Steepness::Aside least = Steepness::of(steps.least_aside),
                               most = Steepness::of(steps.most_aside);
        const int last = begin_ + static_cast<int>(plan_.size());
        const RowPlan &a = row(std::max(first - 1, begin_)), &b = row(std::min(end, last - 1));
        // Of a cell's middle; its posts are less than two beside.
        const double middle = sheet_.first_column(0) + (kPosts - 1) / 2.0;
        const auto fall_m = [&](const RowPlan& at) {
            return static_cast<float>(at.fall - base_m_ + at.ramp * (middle - at.shift));
        };
        const double across_m = 2 * std::max(std::abs(a.ramp), std::abs(b.ramp));
        bound_ground(
            {.cells = cells_,
             .lowest_m = figures(ShadeCells::kLowest, cells),
             .highest_m = figures(ShadeCells::kHighest, cells),
             .fall_m = {fall_m(a), fall_m(b)},
             .fall_a_cell_m = {static_cast<float>(a.ramp * kPosts),
                               static_cast<float>(b.ramp * kPosts)},
             .slack_m = static_cast<float>(kSlack_m + across_m),
             .away_m = figures(
                 sheet_.mirrored ? ShadeCells::kDownToRowBefore : ShadeCells::kDownToNextRow,
                 cells),
             .beside_m = {figures(least.down, cells), figures(most.down, cells)},
             .aside = {static_cast<float>(least.posts), static_cast<float>(most.posts)},
             .aside_m = figures(ShadeCells::kAside, cells),
             .least_fall_m = static_cast<float>(std::min(steps.least_fall_m, double{kSteep_m})),
             .low_m = low_m_.data() + kBeside,
             .high_m = high_m_.data(),
             .source_m = source_m_.data() + kBeside,
             .steeper_m = steeper_m_.data()});
    }

    void cover_by_earth(int cells, int first, int end) {
        const GridPair& more = sun_.tangent_a_post;
        const double middle_row = (first + end - 1) / 2.0;
        // Posts are half a cell from its middle, and as far beside.
        const double spread =
            std::abs(more.column) * kPosts + std::abs(more.row) * ((end - first) / 2.0 + 1) + 1e-7;
        add_earth({.cells = cells_,
                   .tangent = static_cast<float>(
                       sun_.tangent_at(sheet_.first_column(0) + (kPosts - 1) / 2.0, middle_row)),
                   .tangent_a_cell = static_cast<float>(more.column * kPosts),
                   .spread = static_cast<float>(spread),
                   .earth_lowest_m = static_cast<float>(earth_->lowest_m),
                   .earth_highest_m = static_cast<float>(earth_->highest_m),
                   .a_tangent2_m = static_cast<float>(1 / (2 * earth_->curvature)),
                   .lowest_m = figures(ShadeCells::kLowest, cells),
                   .highest_m = figures(ShadeCells::kHighest, cells),
                   .over_m = over_m_.data(),
                   .least_over_m = least_over_m_.data()});
    }

    /// Takes another base where rays have fallen by so much, so that floats do.
    void rebase(double fall_m) {
        if (std::abs(fall_m - base_m_) < kBase_m) return;
        const auto more_m = static_cast<float>(fall_m - base_m_);
        base_m_ = fall_m;
        for (Floats* const each : {&most_m_, &least_m_})
            for (float& height_m : *each)
                height_m = std::max(height_m - more_m, kNone_m);
    }

    const PatchSheet& sheet_;
    const SweepSun& sun_;
    std::span<const RowPlan> plan_;
    int begin_;
    const std::optional<EarthAround>& earth_;
    int first_cell_, cells_;
    int first_bundle_ = 0;
    double base_m_ = 0;
    bool any_ = false;                       // of the bundles is over ground somewhere
    Floats low_m_, high_m_, source_m_;       // of a row of cells
    Floats over_m_, least_over_m_;           // likewise
    Floats steeper_m_, most_over_m_;         // of all of a row of patches
    Floats covered_m_, covered_by_lines_m_;  // likewise: the Earth included, and not
    Floats most_m_, least_m_;                // of bundles
    Floats before_m_, least_before_m_;       // of those over a row of cells
};

/// Whether the smooth Earth makes any edge over a sheet.
bool has_earth_edge(const PatchSheet& sheet, const SweepSun& sun) {
    for (const double y : {-1.0, sheet.lines + 1.0})
        for (const int column : {0, sheet.columns()})
            if (sun.tangent_at(sheet.first_column(column) + (column == 0 ? -1 : 1), y) < 0)
                return true;
    return false;
}

// --- Flags

using Word = PatchFlags::Word;

/// Flags of columns so many before those of a word, and behind them; less than kBits.
Word before(std::span<const Word> row, std::size_t i, int by) {
    if (by == 0) return row[i];
    return row[i] << by | (i > 0 ? row[i - 1] >> (PatchFlags::kBits - by) : 0);
}
Word behind(std::span<const Word> row, std::size_t i, int by) {
    if (by == 0) return row[i];
    return row[i] >> by | (i + 1 < row.size() ? row[i + 1] << (PatchFlags::kBits - by) : 0);
}

/// None behind the last column.
void trim(std::span<Word> row, int columns) {
    const int some = columns % PatchFlags::kBits;
    if (some != 0) row.back() &= (Word{1} << some) - 1;
}

/// Sets flags, and those so many columns beside.
void add_beside(std::span<const Word> flags, int columns, int reach, std::span<Word> to) {
    for (std::size_t i = 0; i < to.size(); ++i)
        for (int by = 0; by <= reach; ++by)
            to[i] |= before(flags, i, by) | behind(flags, i, by);
    trim(to, columns);
}

/// Sets what lies between flags that are not far apart: there is less work in some posts than in
/// going about them.
void fill_gaps(std::span<Word> flags) {
    constexpr int kGap = 3;
    std::vector<Word> first(flags.size());  // of gaps
    for (int gap = 1; gap <= kGap; ++gap) {
        for (std::size_t i = 0; i < flags.size(); ++i)
            first[i] = before(flags, i, 1) & behind(flags, i, gap);
        for (std::size_t i = 0; i < flags.size(); ++i)
            for (int by = 0; by < gap; ++by)
                flags[i] |= before(first, i, by);
    }
}

/// The next column from one on whose flag is set, or is not; or the one behind all.
int next_column(std::span<const Word> flags, int columns, int column, bool set) {
    while (column < columns) {
        const Word word = flags[static_cast<std::size_t>(column / PatchFlags::kBits)];
        const Word left = (set ? word : ~word) >> (column % PatchFlags::kBits);
        if (left != 0) return std::min(columns, column + std::countr_zero(left));
        column += PatchFlags::kBits - column % PatchFlags::kBits;
    }
    return columns;
}

/// @param flags  of columns of patches
void add_ranges(const PatchSheet& sheet, std::span<const Word> flags,
                std::vector<ColumnRange>& ranges) {
    constexpr int kFar = 1 << 28;
    const int columns = sheet.columns();
    for (int end = 0;;) {
        const int first = next_column(flags, columns, end, true);
        if (first == columns) return;
        end = next_column(flags, columns, first, false);
        ranges.push_back({first == 0 ? -kFar : sheet.first_column(first),
                          end == columns ? kFar : sheet.first_column(end)});
    }
}

}  // namespace

void PatchFlags::set_all(int first, int end) {
    for (int at = first; at < end; ++at) {
        std::fill(row(at).begin(), row(at).end(), ~Word{0});
        trim(row(at), columns_);
    }
}

std::int64_t PatchFlags::count(int first, int end) const {
    std::int64_t found = 0;
    for (int at = first; at < end; ++at)
        for (const Word word : row(at))
            found += std::popcount(word);
    return found;
}

ShadedPatches::ShadedPatches(const PatchSheet& sheet, const SweepSun& sun,
                             std::span<const RowPlan> plan, int begin,
                             std::optional<EarthAround> earth)
    : lit(sheet.columns(), sheet.rows()),
      dark(sheet.columns(), sheet.rows()),
      steep(sheet.columns(), sheet.rows()),
      covered(sheet.columns(), sheet.rows()),
      first_(sheet.row_of(begin)),
      end_(sheet.row_of(begin + static_cast<int>(plan.size()) - 1) + 1) {
    if (earth && !has_earth_edge(sheet, sun)) earth.reset();
    const auto most = [&](ShadeCells::Figure figure) { return sheet.cells.most(figure); };
    if (!earth && !Steepness(sheet, plan).may_shade(sheet.mirrored, most)) {
        lit.set_all(0, sheet.rows());
        return;
    }
    lit.set_all(0, first_);
    lit.set_all(end_, sheet.rows());
    LinesOverCells lines(sheet, sun, plan, begin, earth);
    for (int row = first_; row < end_; ++row) {
        if (lines.go_over(row, *this)) continue;
        lit = dark = covered = PatchFlags(sheet.columns(), sheet.rows());
        steep.set_all(0, sheet.rows());
        return;
    }
}

void ShadedPatches::rise_to(const ShadedPatches& higher) {
    dark = higher.dark;
    covered = higher.covered;
}

void ShadedPatches::join(const ShadedPatches& other) {
    for (int row = 0; row < std::max(end_, other.end_); ++row)
        for (std::size_t i = 0; i < lit.row(row).size(); ++i) {
            lit.row(row)[i] &= other.lit.row(row)[i];
            dark.row(row)[i] &= other.dark.row(row)[i];
            steep.row(row)[i] |= other.steep.row(row)[i];
            covered.row(row)[i] &= other.covered.row(row)[i];
        }
    first_ = std::min(first_, other.first_), end_ = std::max(end_, other.end_);
}

bool ShadedPatches::is_mixed() const {
    constexpr double kLeast = 0.1;
    const std::int64_t known = lit.count(first_, end_) + dark.count(first_, end_);
    return static_cast<double>(known) < kLeast * (end_ - first_) * lit.columns();
}

ShadeRanges shade_ranges(const PatchSheet& sheet, const ShadedPatches* before,
                         const ShadedPatches& sun, const ShadedPatches* after) {
    const int columns = sheet.columns(), rows = sheet.rows();
    PatchFlags look(columns, rows), raise(columns, rows), take(columns, rows);
    const auto differ = [](const ShadedPatches* a, const ShadedPatches& b, int row, std::size_t i) {
        if (!a) return Word{0};
        return (a->lit.row(row)[i] ^ b.lit.row(row)[i]) |
               (a->dark.row(row)[i] ^ b.dark.row(row)[i]);
    };
    for (int row = 0; row < rows; ++row) {
        const std::span<Word> to = look.row(row);
        for (std::size_t i = 0; i < to.size(); ++i)
            to[i] = ~(sun.lit.row(row)[i] | sun.dark.row(row)[i]) | differ(before, sun, row, i) |
                    differ(after, sun, row, i);
        trim(to, columns);
        fill_gaps(to);
    }
    // Lines are raised to sources, and to what is before the nearest rows of a post.
    std::vector<Word> wanted(look.row(0).size());
    for (int row = 0; row < rows; ++row) {
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            wanted[i] = look.row(row)[i] | (sun.steep.row(row)[i] & ~sun.covered.row(row)[i]);
            if (row + 1 < rows) wanted[i] |= look.row(row + 1)[i];
        }
        add_beside(wanted, columns, 1, raise.row(row));
        fill_gaps(raise.row(row));
    }
    // A line beside the grid is as high as the ground that it has left, be that how far off it may.
    for (const int column : {0, columns - 1}) {
        if (!sheet.is_border(column)) continue;
        const auto word = static_cast<std::size_t>(column / PatchFlags::kBits);
        const Word bit = Word{1} << (column % PatchFlags::kBits);
        bool is_looked_at = false;
        for (int row = rows - 1; row >= 0; --row) {
            is_looked_at = is_looked_at || (look.row(row)[word] & bit) != 0;
            if (is_looked_at) raise.row(row)[word] |= bit;
        }
    }
    for (int row = 0; row < rows; ++row) {
        add_beside(raise.row(row), columns, 2, take.row(row));
        if (row + 1 < rows) add_beside(raise.row(row + 1), columns, 2, take.row(row));
        fill_gaps(take.row(row));
    }
    ShadeRanges found;
    const auto set = [&](ShadeRanges::Of of, const PatchFlags& flags) {
        ShadeRanges::OfRows& to = found.of[of];
        to.begins.reserve(static_cast<std::size_t>(rows) + 1);
        for (int row = 0; row < rows; ++row) {
            add_ranges(sheet, flags.row(row), to.ranges);
            to.begins.push_back(static_cast<std::uint32_t>(to.ranges.size()));
        }
    };
    set(ShadeRanges::kLook, look);
    set(ShadeRanges::kRaise, raise);
    set(ShadeRanges::kTake, take);
    set(ShadeRanges::kDark, sun.dark);
    return found;
}

}  // namespace relevo::light
