#include "light/shade_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/parallel_for.h"

namespace relevo::light {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kPosts = ShadeCells::kPosts;
constexpr double kSlack_m = 0.1;    // more than bounds of what rays fall by, and floats, are off
constexpr double kSlack_posts = 2;  // as far as posts look beside them for lines

using Flags = std::vector<unsigned char>;

/// A hole is as low as can be.
float or_lowest(float height_m) {
    return height_m == height_m ? height_m : -kInfinity;
}

/// What is known of the columns of some rows of posts, which are those of a row of cells. Loops go
/// over columns, so that processors do many at once.
class CellRow {
  public:
    CellRow(const float* height_m, int columns, int rows, std::ptrdiff_t stride, int first_row)
        : height_m_(height_m),
          columns_(columns),
          rows_(rows),
          stride_(stride),
          first_row_(first_row) {
        for (auto* const each : {&lowest_m_, &ridge_m_[0], &ridge_m_[1]})
            each->assign(static_cast<std::size_t>(columns), kInfinity);
        for (auto* const each : {&highest_m_, &down_m_[0], &down_m_[1], &down_m_[2], &down_m_[3]})
            each->assign(static_cast<std::size_t>(columns), -kInfinity);
        const int end = std::min(rows, first_row + kPosts + 1);
        for (int row = std::max(0, first_row - 1); row < end; ++row)
            add(row, row + 1 < end);
        find_column_ridges();
        find_row_ridges();
    }

    ShadeCells::Cell cell(int first_column) const {
        const int from = std::max(0, first_column - 1),
                  end = std::min(columns_, first_column + kPosts + 1);
        const auto of = [&](const std::vector<float>& figures, int last, bool highest) {
            float found = highest ? -kInfinity : kInfinity;
            for (int column = from; column < last; ++column) {
                const float figure = figures[static_cast<std::size_t>(column)];
                found = highest ? std::max(found, figure) : std::min(found, figure);
            }
            return found;
        };
        ShadeCells::Cell cell{of(lowest_m_, end, false),
                              of(highest_m_, end, true),
                              {of(down_m_[0], end, true), of(down_m_[1], end, true),
                               of(down_m_[2], end - 1, true), of(down_m_[3], end - 1, true)},
                              {-kInfinity, -kInfinity},
                              {-kInfinity, -kInfinity}};
        if (cell.lowest_m == -kInfinity)
            std::fill(std::begin(cell.down_m), std::end(cell.down_m), kInfinity);
        if (first_column + kPosts > columns_ || first_row_ + kPosts > rows_) return cell;
        const int k = first_column / kPosts;
        for (const int after : {0, 1}) {
            if (has_ridges(first_row_, after, rows_))
                cell.column_ridge_m[after] = *std::max_element(
                    ridge_m_[static_cast<std::size_t>(after)].begin() + first_column,
                    ridge_m_[static_cast<std::size_t>(after)].begin() + first_column + kPosts);
            if (has_ridges(first_column, after, columns_))
                cell.row_ridge_m[after] =
                    row_ridge_m_[static_cast<std::size_t>(after)][static_cast<std::size_t>(k)];
        }
        return cell;
    }

  private:
    static constexpr int kRidge = 2 * kPosts + 2;  // posts along which one is looked for

    /// Where the posts of a ridge begin along a row, or a column, of a cell that begins there.
    static int begin_of_ridge(int first, int after) { return first - (after == 0 ? kPosts : 2); }
    static bool has_ridges(int first, int after, int posts) {
        const int begin = begin_of_ridge(first, after);
        return begin >= 0 && begin + kRidge <= posts;
    }
    const float* row(int at) const { return height_m_ + at * stride_; }

    /// Posts of a row, and how far it is down to the next one.
    void add(int at, bool has_next) {
        const float* const here = row(at);
        float *const low = lowest_m_.data(), *const high = highest_m_.data();
        for (int i = 0; i < columns_; ++i) {
            const float least = or_lowest(here[i]);
            low[i] = least < low[i] ? least : low[i];
            high[i] = here[i] > high[i] ? here[i] : high[i];
        }
        add_down(here, here + 1, columns_ - 1, 2);
        if (has_next) add_down(here, row(at + 1), columns_, 0);
    }
    void add_down(const float* from, const float* to, int count, std::size_t k) {
        float *const down = down_m_[k].data(), *const up = down_m_[k + 1].data();
        for (int i = 0; i < count; ++i) {
            const float by = from[i] - to[i];
            down[i] = by > down[i] ? by : down[i];
            up[i] = -by > up[i] ? -by : up[i];
        }
    }

    void find_column_ridges() {
        for (const int after : {0, 1}) {
            if (!has_ridges(first_row_, after, rows_)) continue;
            const int begin = begin_of_ridge(first_row_, after);
            float* const ridge = ridge_m_[static_cast<std::size_t>(after)].data();
            for (int at = begin; at < begin + kRidge; ++at) {
                const float* const here = row(at);
                for (int i = 0; i < columns_; ++i) {
                    const float least = or_lowest(here[i]);
                    ridge[i] = least < ridge[i] ? least : ridge[i];
                }
            }
        }
    }

    /// The highest of the rows by its lowest post, along each cell and the one before or after.
    void find_row_ridges() {
        const int cells = columns_ / kPosts;
        for (auto& ridges : row_ridge_m_)
            ridges.assign(static_cast<std::size_t>(cells), -kInfinity);
        if (first_row_ + kPosts > rows_) return;
        std::vector<float> least_m(static_cast<std::size_t>(cells));
        for (int at = first_row_; at < first_row_ + kPosts; ++at) {
            const float* const here = row(at);
            const auto least = [&](int begin, int end) {
                float found = kInfinity;
                for (int i = begin; i < end; ++i)
                    found = std::min(found, or_lowest(here[i]));
                return found;
            };
            for (int k = 0; k < cells; ++k)
                least_m[static_cast<std::size_t>(k)] = least(k * kPosts, (k + 1) * kPosts);
            for (int k = 0; k < cells; ++k)
                for (const int after : {0, 1}) {
                    const int column = k * kPosts;
                    if (!has_ridges(column, after, columns_)) continue;
                    const auto i = static_cast<std::size_t>(k);
                    // All of two cells, and two posts of the one on the other side.
                    const int beside = after == 0 ? column + kPosts : column - 2;
                    const float found = std::min({least_m[i], least_m[after == 0 ? i - 1 : i + 1],
                                                  least(beside, beside + 2)});
                    float& ridge = row_ridge_m_[static_cast<std::size_t>(after)][i];
                    ridge = std::max(ridge, found);
                }
        }
    }

    const float* height_m_;
    int columns_, rows_;
    std::ptrdiff_t stride_;
    int first_row_;
    std::vector<float> lowest_m_, highest_m_;        // of each column, with the rows beside
    std::array<std::vector<float>, 4> down_m_;       // likewise, as Cell has it
    std::array<std::vector<float>, 2> ridge_m_;      // likewise
    std::array<std::vector<float>, 2> row_ridge_m_;  // of each cell
};

/// How rays go over rows of posts: at least and at most aside from each to the next, and down.
struct Steepness {
    double least_aside = kInfinity, most_aside = -kInfinity, least_fall_m = kInfinity;

    /// @param plan  rows next to each other, over columns of the sheet
    Steepness(const CellSheet& sheet, std::span<const RowPlan> plan) {
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
    }

    /// Ground goes down so steeply somewhere that it may shade what is behind it.
    /// @param away, before, after  how far at most: to the next row, and to the column before and
    ///     after
    bool may_shade(double away_m, double before_m, double after_m) const {
        return !(away_m + std::max(down_m(least_aside, before_m, after_m),
                                   down_m(most_aside, before_m, after_m)) <
                 least_fall_m - kSlack_m / kPosts);
    }

  private:
    static double down_m(double aside, double before_m, double after_m) {
        if (aside == 0) return 0;
        return aside > 0 ? aside * after_m : -aside * before_m;
    }
};

/// What rays have fallen by over a row of cells.
class RowOfRays {
  public:
    RowOfRays(const CellSheet& sheet, std::span<const RowPlan> plan, int begin, int row)
        : rows_(rows_of(sheet, plan, begin, row)), steepness_(sheet, rows_) {
        const double to_left = std::max(aside(), 0.0) + kSlack_posts,
                     to_right = std::max(-aside(), 0.0) + kSlack_posts;
        from_ = {-static_cast<int>(std::ceil(to_left / kPosts)),
                 static_cast<int>(std::floor(to_right / kPosts)) + 2};
        for (std::size_t k = 0; k < 2; ++k) {
            const RowPlan& end = k == 0 ? rows_.front() : rows_.back();
            // With a post on either side.
            const double across = end.ramp * (kPosts + 2);
            const double first = end.fall + end.ramp * (sheet.first_column(0) - 1 - end.shift);
            least_m_[k] = first + std::min(across, 0.0) - kSlack_m;
            most_m_[k] = first + std::max(across, 0.0) + kSlack_m;
            more_m_[k] = end.ramp * kPosts;
        }
    }

    /// Ground goes down more steeply somewhere.
    bool is_source(const CellSheet& sheet, const ShadeCells::Cell& cell) const {
        const CellSheet::Down down = sheet.down_m(cell.down_m);
        return steepness_.may_shade(down.away, down.before, down.after);
    }

    /// Of rays over a column of cells, from the row of the reference on.
    double least_fall_m(int column) const {
        return std::min(least_m_[0] + more_m_[0] * column, least_m_[1] + more_m_[1] * column);
    }
    double most_fall_m(int column) const {
        return std::max(most_m_[0] + more_m_[0] * column, most_m_[1] + more_m_[1] * column);
    }

    /// Columns that lines go aside by, over the row.
    double aside() const { return rows_.back().shift - rows_.front().shift; }

    /// Columns of cells whose lines come over one while they go over the row.
    ColumnRange from(int column, int columns) const {
        return {std::max(0, column + from_.begin), std::min(columns, column + from_.end)};
    }

  private:
    /// Those of a row of cells, and one on either side.
    static std::span<const RowPlan> rows_of(const CellSheet& sheet, std::span<const RowPlan> plan,
                                            int begin, int row) {
        const int last_row = static_cast<int>(plan.size()) - 1;
        const int first = std::clamp(sheet.first_row(row) - 1 - begin, 0, last_row),
                  last = std::clamp(sheet.end_row(row) - begin, 0, last_row);
        return plan.subspan(static_cast<std::size_t>(first),
                            static_cast<std::size_t>(last - first + 1));
    }

    std::span<const RowPlan> rows_;
    Steepness steepness_;
    ColumnRange from_;
    double least_m_[2], most_m_[2], more_m_[2];  // over the first row, and over the last one
};

/// Sets flags, and those so many columns beside.
void add_beside(const unsigned char* flags, int columns, int reach, unsigned char* to) {
    for (int aside = -reach; aside <= reach; ++aside)
        for (int i = std::max(0, -aside); i < std::min(columns, columns - aside); ++i)
            to[i] |= flags[i + aside];
}

/// Sets what lies between flags that are not far apart: there is less work in some posts than in
/// going about them.
void fill_gaps(unsigned char* flags, int columns) {
    constexpr int kGap = 4;
    for (int column = 0, last = -kGap - 1; column < columns; ++column) {
        if (!flags[column]) continue;
        if (column - last <= kGap) std::fill(flags + std::max(last, 0), flags + column, 1);
        last = column;
    }
}

/// @param flags  of columns of cells
void add_ranges(const CellSheet& sheet, const unsigned char* flags,
                std::vector<ColumnRange>& ranges) {
    constexpr int kFar = 1 << 28;
    const int columns = sheet.columns();
    for (int column = 0; column < columns; ++column) {
        if (!flags[column]) continue;
        const int first = column;
        while (column + 1 < columns && flags[column + 1])
            ++column;
        ranges.push_back({first == 0 ? -kFar : sheet.first_column(first),
                          column + 1 == columns ? kFar : sheet.first_column(column + 1)});
    }
}

}  // namespace

ShadeCells::ShadeCells(const float* height_m, int columns, int rows, std::ptrdiff_t stride)
    : columns_((columns + kPosts - 1) / kPosts), rows_((rows + kPosts - 1) / kPosts) {
    cells_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    parallel_for(0, rows_, 4, [&](int first, int last) {
        for (int row = first; row < last; ++row) {
            const CellRow found(height_m, columns, rows, stride, row * kPosts);
            for (int column = 0; column < columns_; ++column)
                cells_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                       static_cast<std::size_t>(column)] = found.cell(column * kPosts);
        }
    });
    std::fill(std::begin(steepest_m_), std::end(steepest_m_), -kInfinity);
    for (const Cell& cell : cells_)
        for (std::size_t k = 0; k < std::size(steepest_m_); ++k)
            steepest_m_[k] = std::max(steepest_m_[k], cell.down_m[k]);
}

namespace {

/// The edge that the smooth Earth makes over a cell, at least and at most.
struct EarthEdge {
    double least_m = -kInfinity, most_m = -kInfinity;

    EarthEdge(const CellSheet& sheet, const SweepSun& sun, int column, int row,
              const EarthAround& earth) {
        double least = kInfinity, most = -kInfinity;
        for (const double y : {sheet.first_row(row) - 1.0, sheet.end_row(row) + 1.0})
            for (const double x :
                 {sheet.first_column(column) - 1.0, sheet.first_column(column + 1) + 1.0}) {
                least = std::min(least, sun.tangent_at(x, y));
                most = std::max(most, sun.tangent_at(x, y));
            }
        const auto edge_m = [&](double tangent) {
            return earth.lowest_m + tangent * tangent / (2 * earth.curvature);
        };
        if (most < 0) least_m = edge_m(most) - kSlack_m;
        if (least < 0) most_m = edge_m(least) + kSlack_m;
    }

    /// Whether it makes any over some cell of a sheet.
    static bool is_any(const CellSheet& sheet, const SweepSun& sun) {
        for (const double y : {-1.0, sheet.lines + 1.0})
            for (const int column : {0, sheet.columns()})
                if (sun.tangent_at(sheet.first_column(column) + (column == 0 ? -1 : 1), y) < 0)
                    return true;
        return false;
    }
};

/// How high lines are where they leave the cells of a row, their fall added: at most, for what may
/// hide anything, and at least.
class Carried {
  public:
    explicit Carried(std::size_t columns)
        : most_(columns, -kInfinity),
          least_(columns, -kInfinity),
          next_(most_),
          next_least_(most_),
          over_(most_) {}

    /// The states of a row of cells, lines coming from the one before it.
    /// @param earth  none: it hides nothing
    void go_over(const CellSheet& sheet, const SweepSun& sun, int row, const RowOfRays& rays,
                 const std::optional<EarthAround>& earth, const unsigned char* sources,
                 unsigned char* states) {
        const int columns = sheet.columns();
        const bool after = rays.aside() < 0;
        const bool narrow = std::abs(rays.aside()) <= kPosts + 1;
        for (int column = 0; column < columns; ++column) {
            const auto i = static_cast<std::size_t>(column);
            over_[i] = most_[i];
            if (sources[i])
                over_[i] =
                    std::max(over_[i], sheet.at(column, row).highest_m + rays.most_fall_m(column));
        }
        for (int column = 0; column < columns; ++column) {
            const auto i = static_cast<std::size_t>(column);
            const ShadeCells::Cell& cell = sheet.at(column, row);
            const ColumnRange from = rays.from(column, columns);
            double most = -kInfinity, least = kInfinity;
            for (int k = from.begin; k < from.end; ++k) {
                const auto at = static_cast<std::size_t>(k);
                most = std::max(most, over_[at]);
                least = std::min(least, least_[at]);
            }
            const bool at_end = column == 0 || column + 1 == columns;
            if (at_end) least = -kInfinity;  // others come in from outside
            const double least_fall_m = rays.least_fall_m(column);
            const bool may_shade = most > cell.lowest_m + least_fall_m;
            bool is_dark = least > cell.highest_m + rays.most_fall_m(column), is_lit = !may_shade;
            if (earth) {
                const EarthEdge edge(sheet, sun, column, row, *earth);
                is_dark = is_dark || edge.least_m > cell.highest_m;
                is_lit = is_lit && cell.lowest_m > edge.most_m;
            }
            states[i] = is_dark  ? ShadedCells::kDark
                        : is_lit ? ShadedCells::kLit
                                 : ShadedCells::kMixed;
            next_[i] = may_shade ? most : -kInfinity;
            next_least_[i] = least;
            if (narrow && !at_end)
                next_least_[i] = std::max(least, sheet.ridge_m(cell, after) + least_fall_m);
        }
        most_.swap(next_);
        least_.swap(next_least_);
    }

  private:
    std::vector<double> most_, least_, next_, next_least_, over_;
};

}  // namespace

ShadedCells::ShadedCells(const CellSheet& sheet, const SweepSun& sun, std::span<const RowPlan> plan,
                         int begin, std::optional<EarthAround> earth) {
    const auto width = static_cast<std::size_t>(sheet.columns());
    sources.resize(width * static_cast<std::size_t>(sheet.rows()), 0);
    states.resize(sources.size(), kLit);
    const int first = sheet.row_of(begin),
              last = sheet.row_of(begin + static_cast<int>(plan.size()) - 1);
    first_ = static_cast<std::size_t>(first) * width;
    end_ = static_cast<std::size_t>(last + 1) * width;
    if (earth && !EarthEdge::is_any(sheet, sun)) earth.reset();
    const CellSheet::Down steepest = sheet.down_m(sheet.cells.steepest_m());
    if (!earth && !Steepness(sheet, plan).may_shade(steepest.away, steepest.before, steepest.after))
        return;
    Carried carried(width);
    for (int row = first; row <= last; ++row) {
        const RowOfRays rays(sheet, plan, begin, row);
        unsigned char* const of_row = sources.data() + static_cast<std::size_t>(row) * width;
        for (int column = 0; column < sheet.columns(); ++column)
            of_row[column] = rays.is_source(sheet, sheet.at(column, row));
        carried.go_over(sheet, sun, row, rays, earth, of_row,
                        states.data() + static_cast<std::size_t>(row) * width);
    }
}

void ShadedCells::join(const ShadedCells& other) {
    for (std::size_t i = 0; i < states.size(); ++i) {
        if (states[i] != other.states[i]) states[i] = kMixed;
        sources[i] |= other.sources[i];
    }
    first_ = std::min(first_, other.first_), end_ = std::max(end_, other.end_);
}

bool ShadedCells::is_mixed() const {
    constexpr double kMost = 0.9;
    const std::span<const unsigned char> all = std::span(states).subspan(first_, end_ - first_);
    return static_cast<double>(std::count(all.begin(), all.end(), kMixed)) >
           kMost * static_cast<double>(all.size());
}

ShadeRanges shade_ranges(const CellSheet& sheet, const ShadedCells* before, const ShadedCells& sun,
                         const ShadedCells* after) {
    const int columns = sheet.columns(), rows = sheet.rows();
    const auto width = static_cast<std::size_t>(columns);
    Flags look(sun.states.size()), raise(look.size()), take(look.size()), dark(look.size()),
        sources = sun.sources;
    for (std::size_t i = 0; i < look.size(); ++i) {
        dark[i] = sun.states[i] == ShadedCells::kDark;
        look[i] = sun.states[i] == ShadedCells::kMixed ||
                  (before && before->states[i] != sun.states[i]) ||
                  (after && after->states[i] != sun.states[i]);
        if (dark[i]) sources[i] = 0;  // all lines are over it
    }
    const auto row_of = [&](Flags& flags, int row) {
        return flags.data() + static_cast<std::size_t>(row) * width;
    };
    for (int row = 0; row < rows; ++row)
        fill_gaps(row_of(look, row), columns);
    // Lines are raised to sources, and to what is before the nearest rows of a post.
    for (int row = 0; row < rows; ++row) {
        unsigned char* const to = row_of(raise, row);
        add_beside(row_of(sources, row), columns, 1, to);
        add_beside(row_of(look, row), columns, 1, to);
        if (row + 1 < rows) add_beside(row_of(look, row + 1), columns, 1, to);
        fill_gaps(to, columns);
    }
    // A line beside the grid is as high as the ground that it has left, be that how far off it may.
    for (const int column : {0, columns - 1}) {
        if (!sheet.is_border(column)) continue;
        bool is_looked_at = false;
        for (int row = rows - 1; row >= 0; --row) {
            is_looked_at = is_looked_at || row_of(look, row)[column];
            if (is_looked_at) row_of(raise, row)[column] = 1;
        }
    }
    for (int row = 0; row < rows; ++row) {
        add_beside(row_of(raise, row), columns, 2, row_of(take, row));
        if (row + 1 < rows) add_beside(row_of(raise, row + 1), columns, 2, row_of(take, row));
        fill_gaps(row_of(take, row), columns);
    }
    ShadeRanges found;
    const auto set = [&](ShadeRanges::Of of, Flags& flags) {
        ShadeRanges::OfRows& to = found.of[of];
        to.begins.reserve(static_cast<std::size_t>(rows) + 1);
        for (int row = 0; row < rows; ++row) {
            add_ranges(sheet, row_of(flags, row), to.ranges);
            to.begins.push_back(static_cast<std::uint32_t>(to.ranges.size()));
        }
    };
    set(ShadeRanges::kLook, look);
    set(ShadeRanges::kRaise, raise);
    set(ShadeRanges::kTake, take);
    set(ShadeRanges::kDark, dark);
    return found;
}

}  // namespace relevo::light
