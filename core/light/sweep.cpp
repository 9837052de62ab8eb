#include "light/sweep.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <numeric>
#include <span>
#include <utility>

#include "base/parallel_for.h"
#include "base/units.h"
#include "base/wide_loops.h"
#include "light/shade_cells.h"
#include "light/sweep_kernels.h"

namespace relevo::light {
namespace {

using namespace kernel;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// How a sweep looks at ground.
struct Nearness {
    int near_rows;          // whose ground a post's own ray is followed over
    std::size_t line_sets;  // lines from post to post
    int kept_rows;          // whose ground is kept, a power of two: those and three more
    bool distances;         // how far off ground is matters
};
constexpr std::size_t kMostLineSets = 2;
constexpr Nearness kOfEdges{kNearRows, kLinesFromPostToPost, 8, false};
constexpr Nearness kOfHorizons{8, 1, 16, true};  // a row near costs less than a fan of rays
static_assert(kMostLevels == Sweep::Blocks::kMostLevels);
constexpr double kSteepest = 1e4;  // tangent: 0.006 degrees from the zenith
constexpr double kOnLine = 1e-6;   // of a post: a ray that meets a row there meets the post
constexpr int kStripLines = 2047;  // which a thread sweeps together: its rows stay in the cache
constexpr int kFanLines = 63;      // likewise, where each line has a fan
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr ColumnRange kAllColumns{-(1 << 28), 1 << 28};
constexpr std::array<double, 1> kOneLevel{0};

/// Numbers of floats are filled up to whole vectors.
constexpr int in_vectors(int count) {
    return (count + Sweep::kMostLanes - 1) / Sweep::kMostLanes * Sweep::kMostLanes;
}

/// Memory in which a vector of numbers that comes after whole vectors lies in one line of the
/// cache.
template <typename T>
struct InLines {
    using value_type = T;
    static constexpr std::align_val_t kLine{64};

    InLines() = default;
    template <typename U>
    InLines(const InLines<U>&) {}
    T* allocate(std::size_t count) {
        return static_cast<T*>(::operator new(count * sizeof(T), kLine));
    }
    void deallocate(T* at, std::size_t) { ::operator delete(at, kLine); }
    bool operator==(const InLines&) const { return true; }
};
using FloatsInLines = std::vector<float, InLines<float>>;

/// The whole numbers beside one, which are near enough to 0 to be ints.
constexpr int floor_of(double x) {
    const int whole = static_cast<int>(x);
    return whole - (whole > x);
}
constexpr int ceil_of(double x) {
    const int whole = static_cast<int>(x);
    return whole + (whole < x);
}

/// A grid as the sweep goes over it: `row` 0 is the one nearest to the sun.
struct Sheet {
    const float* first;
    std::ptrdiff_t stride;
    int columns, rows;
};

/// The posts that a sweep is for.
struct Wanted {
    SweepWindow window;               // of the sheet
    std::vector<ColumnRange> band{};  // of each row of that; none: all of them

    bool is_band() const { return !band.empty(); }
    ColumnRange at(int row) const {
        if (!is_band()) return {window.column, window.column + window.columns};
        return band[static_cast<std::size_t>(row - window.row)];
    }
};

/// A ray from row to row, at a fraction of what SweepSun::distance_m() costs.
class RayWalk {
  public:
    /// @param ray  outlives this
    RayWalk(const SweepSun& ray, int row) : ray_(&ray) { start(row); }

    /// To the next row, or to the one before; NaN where it has turned back.
    void step(int rows) {
        const double guess_m = distance_m_ + rows / slope_;
        slope_ = slope(guess_m);
        row_ += rows;
        distance_m_ = guess_m - off(guess_m) / slope_;
        // Near to where it turns a step leads too far, and from beyond that none leads back.
        if (!(std::abs(off(distance_m_)) < kOnLine)) start(row_);
    }
    double distance_m() const { return distance_m_; }
    double column() const {
        const double s = distance_m_;
        return ray_->reference.column +
               ((ray_->twist.column / 6 * s + ray_->bend.column / 2) * s + ray_->towards.column) *
                   s;
    }

  private:
    void start(int row) {
        row_ = row;
        distance_m_ = ray_->distance_m(row);
        slope_ = slope(distance_m_);
    }
    /// Rows beyond the one that it is to come to.
    double off(double s) const {
        return ((ray_->twist.row / 6 * s + ray_->bend.row / 2) * s + ray_->towards.row) * s -
               (row_ - ray_->reference.row);
    }
    double slope(double s) const {
        const double slope = (ray_->twist.row / 2 * s + ray_->bend.row) * s + ray_->towards.row;
        return slope * ray_->towards.row > 0 ? slope : std::numeric_limits<double>::quiet_NaN();
    }

    const SweepSun* ray_;
    int row_ = 0;
    double distance_m_ = 0, slope_ = 0;
};

/// Where a ray is at rows that it meets at nearly one angle: the first row, and how many.
/// @param distance_m, column  get NaN where it is not found so
RELEVO_WIDE_LOOPS void find_ray(const SweepSun& ray, int first, int rows, double* distance_m,
                                double* column) {
    const double begin = first - ray.reference.row, column_0 = ray.reference.column;
    const double r1 = ray.towards.row, r2 = ray.bend.row / 2, r3 = ray.twist.row / 6;
    const double c1 = ray.towards.column, c2 = ray.bend.column / 2, c3 = ray.twist.column / 6;
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
#pragma GCC ivdep
    for (int i = 0; i < rows; ++i) {
        const double to = begin + i;
        double s = to / r1;
        const auto off = [&] { return ((r3 * s + r2) * s + r1) * s - to; };
        const auto slope = [&] { return (3 * r3 * s + 2 * r2) * s + r1; };
        s -= off() / slope();
        s -= off() / slope();
        s -= off() / slope();
        const bool is_found = std::abs(off()) < kOnLine * kOnLine && slope() * r1 > r1 * r1 / 2;
        distance_m[i] = is_found ? s : kNone;
        column[i] = is_found ? column_0 + ((c3 * s + c2) * s + c1) * s : kNone;
    }
}

/// Where the ray through the reference is at rows of a sheet.
struct RayRows {
    int begin;
    std::vector<double> distance_m, column;  // NaN from where it turns back on

    RayRows(const SweepSun& ray, int first, int end) : begin(first) {
        distance_m.resize(static_cast<std::size_t>(end - first));
        column.resize(distance_m.size());
        fill(ray, first, end);
    }
    /// Rows before those that are there, too.
    void add_before(const SweepSun& ray, int first) {
        if (first >= begin) return;
        const auto more = static_cast<std::size_t>(begin - first);
        distance_m.insert(distance_m.begin(), more, 0);
        column.insert(column.begin(), more, 0);
        fill(ray, first, std::exchange(begin, first));
    }
    double distance_at(int row) const { return distance_m[static_cast<std::size_t>(row - begin)]; }
    double column_at(int row) const { return column[static_cast<std::size_t>(row - begin)]; }

  private:
    void fill(const SweepSun& ray, int first, int end) {
        const auto at = static_cast<std::size_t>(first - begin);
        find_ray(ray, first, end - first, distance_m.data() + at, column.data() + at);
        // Where it nearly turns back it is followed from whole numbers of rows on, so that bits do
        // not hang on which rows are asked for.
        constexpr int kRows = 64;
        for (int from = floor_of(double(first) / kRows) * kRows; from < end; from += kRows) {
            const int to = std::min(from + kRows, end);
            const auto is_found = [&](int row) { return !std::isnan(distance_at(row)); };
            int row = std::max(from, first);
            while (row < to && is_found(row))
                ++row;
            if (row == to) continue;
            RayWalk walk(ray, from);
            for (row = from; row < to; ++row, walk.step(1)) {
                if (row < first || is_found(row)) continue;
                const auto here = static_cast<std::size_t>(row - begin);
                distance_m[here] = walk.distance_m();
                column[here] = walk.column();
            }
        }
    }
};

/// The rows that matter to some posts, and all that is the same for their posts.
class Plan {
  public:
    /// @param drop_m  what lines may fall by before they matter no more
    /// @param begin   its first row, begin_of_window() or one before
    Plan(const Sheet& sheet, const SweepSun& sun, const SweepWindow& window, double drop_m,
         int begin)
        : sheet_(sheet), sun_(sun), reach_m_(reach(sun, window, drop_m)), begin_(begin) {
        const int first = static_cast<int>(sun_.reference.row), end = window.row + window.rows;
        const RayRows ray(sun_, std::min(first, begin_), std::max(first + 1, end));
        for (int row = window.row - 1; row >= begin_; --row)
            if (std::isnan(ray.distance_at(row))) begin_ = row + 1;
        rows_.resize(static_cast<std::size_t>(end - begin_));
        fill(1, ray);
        fill(-1, ray);
    }
    /// Of a band, rows [begin, end).
    Plan(const Sheet& sheet, const SweepSun& sun, const RayRows& ray, int begin, int end)
        : sheet_(sheet), sun_(sun), begin_(begin) {
        rows_.reserve(static_cast<std::size_t>(end - begin));
        const auto integral = [](double first, double second, double third, double s) {
            return ((third / 24 * s + second / 6) * s + first / 2) * s * s;
        };
        const GridPair& more = sun.tangent_a_post;
        for (int row = begin; row < end; ++row) {
            const double s = ray.distance_at(row);
            const double risen =
                sun.tangent * s +
                more.column * integral(sun.towards.column, sun.bend.column, sun.twist.column, s) +
                more.row * integral(sun.towards.row, sun.bend.row, sun.twist.row, s);
            rows_.push_back({s, ray.column_at(row), -risen, -s * more.column});
        }
    }
    Plan(const Plan&) = delete;
    Plan& operator=(const Plan&) = delete;

    /// The first row from which shade can reach a window.
    static int begin_of_window(const SweepSun& sun, const SweepWindow& window, double drop_m) {
        const double reach_m = reach(sun, window, drop_m), from_m = sun.distance_m(window.row);
        int begin = window.row;
        for (RayWalk walk(sun, begin); begin > 0 && walk.distance_m() - from_m <= reach_m;
             --begin) {
            walk.step(-1);
            if (std::isnan(walk.distance_m())) break;
        }
        return begin;
    }
    /// The first row from which shade can reach a band while lines are over the grid.
    /// @param ray  at the band's rows; gets those from there on, too
    static int begin_of_band(const Sheet& sheet, const SweepSun& sun, const Wanted& wanted,
                             double drop_m, RayRows& ray) {
        const SweepWindow& window = wanted.window;
        double tangent = std::numeric_limits<double>::infinity();
        double first = std::numeric_limits<double>::infinity(), last = -first;  // lines
        for (int row = window.row; row < window.row + window.rows; ++row) {
            const ColumnRange range = wanted.at(row);
            if (range.begin >= range.end) continue;
            const double shift = ray.column_at(row);
            first = std::min(first, range.begin - shift - kBeside);
            last = std::max(last, range.end - shift + kBeside);
            tangent = std::min(
                {tangent, sun.tangent_at(range.begin, row), sun.tangent_at(range.end - 1, row)});
        }
        constexpr int kRows = 64;
        const double reach_m = reach(sun, tangent, drop_m), from_m = ray.distance_at(window.row);
        int begin = window.row;
        for (int row = window.row - 1; row >= 0; --row) {
            if (row < ray.begin) ray.add_before(sun, std::max(0, row - kRows));
            const double shift = ray.column_at(row);
            if (!(ray.distance_at(row + 1) - from_m <= reach_m) || std::isnan(shift)) break;
            if (shift + last > 0 && shift + first < sheet.columns) begin = row;
        }
        return begin;
    }

    double reach_m() const { return reach_m_; }
    int begin() const { return begin_; }
    int end() const { return begin_ + static_cast<int>(rows_.size()); }
    const RowPlan& row(int row) const { return rows_[static_cast<std::size_t>(row - begin_)]; }
    std::span<const RowPlan> rows() const { return rows_; }
    int width() const { return sheet_.columns; }

    /// Lines never turn back over the columns that they came from.
    bool is_monotonic() const {
        bool falls = true, rises = true;
        for (std::size_t k = 1; k < rows_.size(); ++k) {
            falls &= rows_[k].shift <= rows_[k - 1].shift;
            rises &= rows_[k].shift >= rows_[k - 1].shift;
        }
        return falls || rises;
    }

    /// The last row which the shade of a row reaches, or the next one; of the window.
    /// @param from  such a row of one that is nearer to the sun
    int reached(int at, int from) const {
        int last = std::max(at, from);
        while (last + 1 < end() && row(at).distance_m - row(last).distance_m <= reach_m_)
            ++last;
        return last;
    }

    /// The columns that line 0 goes through over rows [first, end).
    std::pair<double, double> columns(int first, int end_row) const {
        std::pair<double, double> range{row(first).shift, row(first).shift};
        for (int at = first + 1; at < end_row; ++at) {
            range.first = std::min(range.first, row(at).shift);
            range.second = std::max(range.second, row(at).shift);
        }
        return range;
    }

  private:
    /// The rows from that of the reference on, so that what is found does not hang on where a sweep
    /// begins. @param step  1: away from the sun, -1: towards it
    void fill(int step, const RayRows& ray) {
        const int first = static_cast<int>(sun_.reference.row);
        const int end = begin_ + static_cast<int>(rows_.size());
        RowPlan last;
        double before_m = 0, before_tangent = 0;
        for (int row = first; step > 0 ? row < end : row >= begin_; row += step) {
            const double s = ray.distance_at(row);
            RowPlan at{s, ray.column_at(row)};
            const double tangent = sun_.tangent_at(at.shift, row);
            if (row != first) {
                const double step_m = before_m - s;
                at.fall = last.fall + step_m * (before_tangent + tangent) / 2;
                at.ramp = last.ramp + step_m * sun_.tangent_a_post.column;
            }
            if (row >= begin_ && row < end) rows_[static_cast<std::size_t>(row - begin_)] = at;
            last = at;
            before_m = s;
            before_tangent = tangent;
        }
    }

    /// How far shade can reach over posts for which the sun has such a tangent, or a higher one.
    static double reach(const SweepSun& sun, double tangent, double drop_m) {
        const GridPair& more = sun.tangent_a_post;
        // Towards the sun it stands higher still, by so much with each metre.
        const double a_metre = more.column * sun.towards.column + more.row * sun.towards.row;
        const double sum = tangent + std::sqrt(tangent * tangent + 2 * a_metre * drop_m);
        return a_metre >= 0 && sum > 0 ? kMargin * 2 * drop_m / sum
                                       : std::numeric_limits<double>::infinity();
    }

    /// Likewise of a window.
    static double reach(const SweepSun& sun, const SweepWindow& window, double drop_m) {
        const GridPair& more = sun.tangent_a_post;
        const int right = window.column + window.columns - 1, end = window.row + window.rows - 1;
        return reach(sun,
                     sun.tangent_at(more.column > 0 ? window.column : right,
                                    more.row > 0 ? window.row : end),
                     drop_m);
    }

    static constexpr double kMargin = 1.05;  // of a reach
    static constexpr double kBeside = 3;     // columns beside posts whose ground matters to them

    const Sheet& sheet_;
    const SweepSun& sun_;
    double reach_m_ = 0;
    int begin_ = 0;
    std::vector<RowPlan> rows_;
};

/// The column of the post that belongs to line 0.
int column_at(const RowPlan& row) {
    return ceil_of(row.shift - kOnLine);
}

/// Where posts and lines are on each row, the same for all strips.
struct Steps {
    struct Row {
        int column = 0;      // column_at()
        float between = 0;   // how far on towards the next line each post stands
        float far_part = 0;  // of posts, between the lines before and behind
        int far_set = 0;
        int first_line = 0, end_line = 0;  // which come over posts of the window that it shades
        int ground_column = 0;             // the first one that terms of line 0 have
        double per_column = 0;             // of the way from the row before, where rays go aside
    };
    std::vector<Row> rows;  // from `begin` on
    int begin = 0;
    int ground_columns = 0;  // that terms of a line have at most
    int first_row = 0;       // of the window: none before has terms of posts
    Nearness nearness;

    Steps(const Plan& plan, const Wanted& wanted, const Nearness& of);

    const Row& row(int row) const { return rows[static_cast<std::size_t>(row - begin)]; }

    /// Of the rows of ground that so many lines need.
    int width(int lines) const { return in_vectors(lines + ground_columns); }
    int pitch(int lines) const { return width(lines) + Sweep::kMostLanes; }
    /// Where a row of ground has what is under line 0 of a strip, and it has column 0 there.
    int origin(int row, int pitch) const {
        return (row & (nearness.kept_rows - 1)) * pitch - this->row(row).ground_column;
    }
};

/// The ground that lines and posts of rows meet, the same for all strips of one width.
class Terms {
  public:
    /// Those of lines begin with their sets' first ones, and then come those of posts.
    struct Row {
        std::array<std::uint32_t, kMostLineSets + 2> begins{};

        std::uint32_t end() const { return begins.back(); }
    };

    /// Rows [first, end) that have none yet.
    /// @param pitch  of the rows of ground in a strip
    void clear(int first, int end, int pitch) {
        count_ = 0;
        first_ = first;
        pitch_ = pitch;
        rows_.assign(static_cast<std::size_t>(std::max(0, end - first)), {});
    }
    /// Makes those of a row, unless they are there.
    void add(const Plan& plan, const Steps& steps, int row);

    /// Those of the lines of a set, at a row.
    std::span<const Ground> of_lines(std::size_t set, int row) const { return part(set, row); }
    std::span<const Ground> of_posts(int row) const { return part(kMostLineSets, row); }
    /// For each of them, how far off it is [m], where the steps have distances.
    const double* distances(std::span<const Ground> of) const {
        return distances_.data() + (of.data() - grounds_.data());
    }

  private:
    class Maker;

    std::span<const Ground> part(std::size_t k, int row) const {
        const Row& of = rows_[static_cast<std::size_t>(row - first_)];
        return std::span(grounds_).subspan(of.begins[k], of.begins[k + 1] - of.begins[k]);
    }

    int first_ = 0, pitch_ = 0;
    std::vector<Row> rows_;
    std::size_t count_ = 0;
    std::vector<Ground> grounds_;  // and room for more
    std::vector<double> distances_;
};

/// Which lines matter at each row to the posts of the window. Before a line comes over the grid
/// nothing is under it, and behind the window nobody looks at it.
void set_lines(const Plan& plan, const Wanted& wanted, Steps& steps) {
    const SweepWindow& window = wanted.window;
    const auto over = [&](int row) {
        const int column = steps.row(row).column;
        const ColumnRange columns = wanted.at(row);
        return std::pair(columns.begin - column, columns.end - column + 1);
    };
    const int last_row = window.row + window.rows - 1;
    const bool is_monotonic = plan.is_monotonic() && !wanted.is_band();
    std::pair<int, int> all{std::numeric_limits<int>::max(), std::numeric_limits<int>::min()};
    for (int row = window.row; row <= last_row; ++row)
        if (wanted.at(row).begin < wanted.at(row).end)
            all = {std::min(all.first, over(row).first), std::max(all.second, over(row).second)};
    int reached = plan.begin();
    for (int row = plan.begin(); row <= last_row; ++row) {
        Steps::Row& step = steps.rows[static_cast<std::size_t>(row - steps.begin)];
        step.first_line = all.first, step.end_line = all.second;
        if (!is_monotonic) continue;
        reached = plan.reached(row, reached);
        const int next = std::max(row, window.row);
        const auto near = over(next), far = over(std::max(next, reached));
        // Lines that have ground there, or a few more.
        const auto [least, most] = plan.columns(std::max(row - 1, plan.begin()), row + 1);
        const int on_first = -ceil_of(most) - 1, on_end = plan.width() - floor_of(least);
        step.first_line = std::max(std::min(near.first, far.first), on_first);
        step.end_line = std::min(std::max(near.second, far.second), on_end);
    }
}

/// The columns that terms of rows beside a row, and of itself, may have.
void set_ground(const Plan& plan, Steps& steps) {
    for (int row = plan.begin(); row < plan.end(); ++row) {
        const auto [least, most] =
            plan.columns(std::max(plan.begin(), row - 1), std::min(plan.end(), row + 2));
        Steps::Row& step = steps.rows[static_cast<std::size_t>(row - steps.begin)];
        step.ground_column = floor_of(least) - 1;
        const int end = ceil_of(most) + 3;
        steps.ground_columns = std::max(steps.ground_columns, end - step.ground_column);
    }
}

Steps::Steps(const Plan& plan, const Wanted& wanted, const Nearness& of)
    : begin(plan.begin()), first_row(wanted.window.row), nearness(of) {
    rows.reserve(static_cast<std::size_t>(plan.end() - plan.begin()));
    for (int row = plan.begin(); row < plan.end(); ++row) {
        Row step;
        const RowPlan& here = plan.row(row);
        step.column = column_at(here);
        const double between = std::max(0.0, step.column - here.shift);
        step.between = static_cast<float>(between < kOnLine ? 0 : between);
        const float at = step.between * static_cast<float>(nearness.line_sets);
        step.far_set = static_cast<int>(at);
        step.far_part = at - static_cast<float>(step.far_set);
        if (row > begin) step.per_column = 1 / (here.shift - plan.row(row - 1).shift);
        rows.push_back(step);
    }
    set_lines(plan, wanted, *this);
    set_ground(plan, *this);
}

/// Of rays that all fall from there to one row.
class Terms::Maker {
  public:
    /// Room for what they meet, which is no more than so much.
    Maker(Terms& terms, const Plan& plan, const Steps& steps, const RowPlan& to, std::size_t most)
        : terms_(terms), plan_(plan), steps_(steps), to_(to) {
        if (terms.grounds_.size() < terms.count_ + most)
            terms.grounds_.resize(2 * (terms.count_ + most));
        if (steps.nearness.distances) terms.distances_.resize(terms.grounds_.size());
        ground_ = terms.grounds_.data() + terms.count_;
    }
    ~Maker() { terms_.count_ = static_cast<std::size_t>(ground_ - terms_.grounds_.data()); }
    Maker(const Maker&) = delete;
    Maker& operator=(const Maker&) = delete;

    /// What is the next one's number.
    std::uint32_t at() const {
        return static_cast<std::uint32_t>(ground_ - terms_.grounds_.data());
    }

    /// The ground of a row, for rays that are at `shift` there.
    void add_row(int row, double shift) {
        int column = floor_of(shift);
        double part = shift - column;
        if (part > 1 - kOnLine) {
            column += 1;
            part = 0;
        } else if (part < kOnLine) {
            part = 0;
        }
        const int at = origin(row) + column;  // at a post, what is beside it plays no part
        add({at, at + (part > 0), static_cast<float>(part)}, plan_.row(row).distance_m);
    }

    /// The ground of all columns that such rays cross between row `row - 1` and row `row`.
    /// @param offset  of the rays from the lines, columns
    void add_columns(int row, double offset) {
        const RowPlan &a = plan_.row(row - 1), &b = plan_.row(row);
        const double from = a.shift + offset, until = b.shift + offset;
        const double low = std::min(from, until) + kOnLine, high = std::max(from, until) - kOnLine;
        const int before = origin(row - 1), here = origin(row);
        const double per_column = steps_.row(row).per_column;
        // Rays that go with the rows cross one at most: what is put there counts if they do.
        for (int column = ceil_of(low);; ++column) {
            const double part = (column - from) * per_column;
            add({before + column, here + column, static_cast<float>(part)},
                a.distance_m + part * (b.distance_m - a.distance_m), column <= high);
            if (column + 1 > high) return;
        }
    }

  private:
    void add(const Ground& ground, double distance_m, bool counts = true) {
        if (steps_.nearness.distances)
            terms_.distances_[static_cast<std::size_t>(ground_ - terms_.grounds_.data())] =
                distance_m - to_.distance_m;
        *ground_ = ground;
        ground_ += counts;
    }
    int origin(int row) const { return steps_.origin(row, terms_.pitch_); }

    Terms& terms_;
    const Plan& plan_;
    const Steps& steps_;
    const RowPlan& to_;
    Ground* ground_;
};

void Terms::add(const Plan& plan, const Steps& steps, int row) {
    Row& of = rows_[static_cast<std::size_t>(row - first_)];
    if (of.end() > 0) return;
    const Nearness& nearness = steps.nearness;
    const RowPlan& here = plan.row(row);
    // Of each row one, and those of the columns that are crossed on the way there.
    const std::size_t most = (nearness.line_sets + static_cast<std::size_t>(nearness.near_rows)) *
                                 static_cast<std::size_t>(steps.ground_columns + 1) +
                             1;
    Maker maker(*this, plan, steps, here, most);
    for (std::size_t set = 0; set < kMostLineSets; ++set) {
        of.begins[set] = maker.at();
        if (set >= nearness.line_sets) continue;
        const double offset = double(set) / double(nearness.line_sets);
        maker.add_row(row, here.shift + offset);
        if (row > plan.begin()) maker.add_columns(row, offset);
    }
    of.begins[kMostLineSets] = maker.at();
    const double between = std::max(0.0, steps.row(row).column - here.shift);
    const int first =
        row >= steps.first_row ? std::max(row - nearness.near_rows, plan.begin()) : row;
    for (int at = row - 1; at >= first; --at) {
        maker.add_row(at, plan.row(at).shift + between);
        maker.add_columns(at + 1, between);
    }
    of.begins[kMostLineSets + 1] = maker.at();
}

/// The last rows of ground under lines next to each other: those that posts look back over, and the
/// two at which lines are meanwhile. Beside the grid there are holes.
class GroundRows {
  public:
    /// @param lines  how many
    GroundRows(const Steps& steps, int line, int lines)
        : steps_(steps),
          line_(line),
          width_(steps.width(lines)),
          pitch_(steps.pitch(lines)),
          height_m_(static_cast<std::size_t>(pitch_ * kept()), kNaN) {}

    /// @param sheet   that has the row where it looks for it
    /// @param wanted  columns; what is kept of others is of no use
    /// @param copy    puts so many heights from one place into another, the first on that column
    template <typename Copy>
    void take(const Sheet& sheet, int row, const ColumnRange& wanted, const Copy& copy) {
        const int column = first_of(row);
        const int first = std::max(0, wanted.begin - column),
                  end = std::min(width_, wanted.end - column);
        if (first >= end) return;
        float* const out = begin_of(row);
        const int from = std::clamp(-column, first, end),
                  to = std::clamp(sheet.columns - column, from, end);
        // What lies beside the grid: most of it is a hole already.
        ColumnRange& ground = ground_[static_cast<std::size_t>(row & (kept() - 1))];
        const auto clear = [&](int begin, int last) {
            begin = std::max(begin, ground.begin), last = std::min(last, ground.end);
            if (begin < last) std::fill(out + begin, out + last, kNaN);
        };
        clear(first, from);
        clear(to, end);
        if (first <= ground.begin) ground.begin = std::max(ground.begin, from);
        if (end >= ground.end) ground.end = std::min(ground.end, to);
        if (from >= to) return;
        ground = ground.begin < ground.end
                     ? ColumnRange{std::min(ground.begin, from), std::max(ground.end, to)}
                     : ColumnRange{from, to};
        copy(sheet.first + row * sheet.stride + column + from, to - from, out + from,
             column + from);
    }

    /// What terms are over, from a line on.
    const float* from(int line) const { return height_m_.data() + (line - line_); }
    /// @param line  of the first post that is looked at
    const float* at(int row, int column, int line) const {
        return from(line) + steps_.origin(row, pitch_) + column;
    }

    /// What a row begins with, for changes to all of it.
    float* begin_of(int row) { return height_m_.data() + (row & (kept() - 1)) * pitch_; }
    int first_of(int row) const { return steps_.row(row).ground_column + line_; }
    int width() const { return width_; }

    int kept() const { return steps_.nearness.kept_rows; }

  private:
    const Steps& steps_;
    int line_;
    int width_, pitch_;
    std::array<ColumnRange, 16> ground_{};  // of each row that is kept, where there may be any
    FloatsInLines height_m_;
};

/// Lines next to each other, from the sun to the end of the window.
///
/// To all heights is added what rays have fallen by from the row of the reference on, so that rays
/// are level, and a line is as high as the highest ground that it has met. Since rays may fall by
/// any amount, a whole number of kBase_m is taken from that, which changes no bits.
class Strip {
  public:
    static constexpr int kMostWidth = kStripLines;
    static constexpr Nearness kNearness = kOfEdges;
    static_assert(kNearness.kept_rows >= kNearness.near_rows + 3);

    /// @param plan   of the first level
    /// @param more   tangents of the levels, more than the first one's, which is 0; kMostLevels at
    ///     most. Steps of several have distances. Outlives this
    /// @param line   the first one
    /// @param width  how many whose posts it has, kMostWidth at most
    Strip(const Sheet& sheet, const Plan& plan, std::span<const double> more, const Steps& steps,
          const SweepKernel& kernel, int line, int width, float lowest_m, float floor_m)
        : sheet_(sheet),
          plan_(plan),
          more_(more),
          steps_(steps),
          kernel_(kernel),
          line_(line),
          width_(width),
          zero_m_(lowest_m < kInfinity ? kZero_m * std::floor(lowest_m / kZero_m) : 0),
          floor_m_(floor_m),
          rows_(steps, line, width + 1),
          pitch_(in_vectors(width + 1) + Sweep::kMostLanes),
          height_m_(static_cast<std::size_t>(level_pitch()) * more.size(), kNothing_m),
          edge_pitch_(in_vectors(width)),
          edge_m_(static_cast<std::size_t>(edge_pitch_) * more.size()) {
        assert(!more.empty() && more.size() <= kMostLevels);
    }

    std::ptrdiff_t edge_pitch() const { return edge_pitch_; }

    /// Where its ground is, from now on.
    Sheet& sheet() { return sheet_; }
    /// The columns of ground that it takes of a row, if the sheet has them.
    int first_ground(int row) const { return rows_.first_of(row); }
    int end_ground(int row) const { return rows_.first_of(row) + rows_.width(); }

    /// A row is the next one from now on.
    void come_to(int row) { rebase(row); }

    /// The ground of the row that it has come to.
    void take(int row, const ColumnRange& wanted = kAllColumns) {
        const Steps::Row& step = steps_.row(row);
        rows_.take(sheet_, row, wanted, [&](const float* from, int count, float* to, int column) {
            kernel_.tilt({.from = from,
                          .next = from + sheet_.stride,
                          .to = to,
                          .lines = count,
                          .line = column - step.column,
                          .between = step.between,
                          .slope = fallen(row),
                          .base_m = -zero_m_});
        });
    }

    /// Lines go to the next row.
    /// @param over  columns of that row; others are not raised
    void advance(int row, const Terms& terms, const ColumnRange& over = kAllColumns) {
        const Steps::Row& step = steps_.row(row);
        // A line is on the column of its post there, or on the one before it.
        const int first_line = std::max(step.first_line, over.begin - step.column),
                  end_line = std::min(step.end_line, over.end - step.column + 1);
        const int from = std::max(line_, first_line) - line_,
                  to = std::min(line_ + width_ + 1, end_line) - line_;
        if (from >= to) return;
        const int first = from / Sweep::kMostLanes * Sweep::kMostLanes;
        for (std::size_t set = 0; set < kNearness.line_sets; ++set) {
            const std::span<const Ground> ground = terms.of_lines(set, row);
            kernel_.raise({.height_m = lines_of(set) + first,
                           .lines = in_vectors(to - first),
                           .rows = rows_.from(line_ + first),
                           .ground = ground.data(),
                           .grounds = static_cast<int>(ground.size()),
                           .levels = levels(),
                           .pitch = level_pitch(),
                           .over_m = over_first(row, terms, ground)});
        }
    }

    /// The edge at the posts of a row, the lines having been left kNearness.near_rows + 1 rows
    /// before.
    /// @param first, end  of the columns that are wanted
    /// @param use         takes the first column, how many there are, and their edges, of the
    ///     first level; those of the next begin edge_pitch() on
    template <typename Use>
    void look(int row, const Terms& terms, int first, int end, const Use& use) {
        const Steps::Row& step = steps_.row(row);
        const int from = std::max(line_, first - step.column);
        const int to = std::min(line_ + width_, end - step.column);
        if (from >= to) return;
        const std::span<const Ground> ground = terms.of_posts(row);
        std::array<float, kMostLevels> falls;
        for (std::size_t level = 0; level < more_.size(); ++level)
            falls[level] = static_cast<float>(fallen_m(row, level));
        EdgeSight sight{.edge_m = edge_m_.data(),
                        .posts = in_vectors(to - from),
                        .before_m = nullptr,
                        .behind_m = nullptr,
                        .part = step.far_part,
                        .line = from,
                        .between = step.between,
                        .falls = falls.data(),
                        .ramp = static_cast<float>(plan_.row(row).ramp),
                        .base_m = zero_m_,
                        .floor_m = floor_m_,
                        .rows = rows_.from(from),
                        .ground = ground.data(),
                        .grounds = static_cast<int>(ground.size()),
                        .levels = levels(),
                        .edge_pitch = edge_pitch_,
                        .line_pitch = level_pitch(),
                        .over_m = over_first(row, terms, ground)};
        if (row - kNearness.near_rows - 1 >= steps_.begin) {
            // The next line of the last set is the first one's, one on.
            const auto set = static_cast<std::size_t>(step.far_set);
            sight.before_m = sight.behind_m = lines_of(set) + (from - line_);
            if (step.far_part != 0)
                sight.behind_m = set + 1 < kNearness.line_sets ? lines_of(set + 1) + (from - line_)
                                                               : lines_of(0) + (from - line_) + 1;
        }
        kernel_.look_for_edges(sight);
        use(step.column + from, to - from, sight.edge_m);
    }

  private:
    static constexpr float kZero_m = 256;  // of which heights have some taken away
    static constexpr double kBase_m = 2048;

    int levels() const { return static_cast<int>(more_.size()); }
    std::ptrdiff_t level_pitch() const {
        return pitch_ * static_cast<std::ptrdiff_t>(kNearness.line_sets);
    }
    double fall_m(int row, std::size_t level) const {
        const RowPlan& at = plan_.row(row);
        return at.fall - at.distance_m * more_[level];
    }
    /// From its base on.
    double fallen_m(int row, std::size_t level) const {
        return fall_m(row, level) - base_m_[level];
    }
    Slope fallen(int row) const {
        return {static_cast<float>(fallen_m(row, 0)), static_cast<float>(plan_.row(row).ramp)};
    }
    float* lines_of(std::size_t set) {
        return height_m_.data() + static_cast<std::ptrdiff_t>(set) * pitch_;
    }

    /// How much higher the ground is over further levels' rays, that are at a row, than over those
    /// of the first.
    const float* over_first(int row, const Terms& terms, std::span<const Ground> ground) {
        if (more_.size() == 1) return nullptr;
        over_m_.clear();
        const double* const distance_m = terms.distances(ground);
        for (std::size_t k = 0; k < ground.size(); ++k)
            for (std::size_t level = 1; level < more_.size(); ++level)
                over_m_.push_back(static_cast<float>(fallen_m(row, level) - fallen_m(row, 0) -
                                                     distance_m[k] * more_[level]));
        return over_m_.data();
    }

    /// Takes other bases where rays have fallen by so much.
    void rebase(int row) {
        for (std::size_t level = 0; level < more_.size(); ++level) {
            const double fallen_m = this->fallen_m(row, level);
            if (fallen_m >= 0 && fallen_m < kBase_m) continue;
            const double base_m = kBase_m * std::floor(fall_m(row, level) / kBase_m);
            const auto more_m = static_cast<float>(base_m - base_m_[level]);
            base_m_[level] = base_m;
            if (row == steps_.begin || more_m == 0) continue;
            const auto lower = [&](float* heights_m, int count) {
                kernel_.tilt({.from = heights_m,
                              .next = heights_m,
                              .to = heights_m,
                              .lines = count,
                              .line = 0,
                              .between = 0,
                              .slope = {},
                              .base_m = -more_m});
            };
            lower(height_m_.data() + static_cast<std::ptrdiff_t>(level) * level_pitch(),
                  static_cast<int>(level_pitch()));
            if (level > 0) continue;
            for (int at = std::max(steps_.begin, row - rows_.kept() + 1); at < row; ++at)
                lower(rows_.begin_of(at), rows_.width());
        }
    }

    Sheet sheet_;
    const Plan& plan_;
    std::span<const double> more_;
    const Steps& steps_;
    const SweepKernel& kernel_;
    int line_, width_;
    float zero_m_, floor_m_;
    std::array<double, kMostLevels> base_m_{};  // of each level
    GroundRows rows_;
    std::ptrdiff_t pitch_;    // from set to set, the next line, too
    FloatsInLines height_m_;  // of each level's, each set's lines
    std::ptrdiff_t edge_pitch_;
    FloatsInLines edge_m_;
    std::vector<float> over_m_;
};

/// Lines next to each other, each with a fan of rays over the ground behind it. Heights are less
/// what the ground has sunk by below the tangent plane of the reference.
class FanStrip {
  public:
    static constexpr int kMostWidth = kFanLines;
    static constexpr Nearness kNearness = kOfHorizons;
    static_assert(kNearness.kept_rows >= kNearness.near_rows + 3);

    /// @param plan       for a tangent of 1 everywhere: what lines fall by is how far they go
    /// @param line       the first one
    /// @param curvature  [1/m]
    /// @param least      the tangent under which no ray is looked at
    FanStrip(const Sheet& sheet, const Plan& plan, const Steps& steps, const SweepKernel& kernel,
             double curvature, int line, int width, double least)
        : sheet_(sheet),
          plan_(plan),
          steps_(steps),
          kernel_(kernel),
          curvature_(curvature),
          line_(line),
          width_(width),
          least_(least),
          rows_(steps, line, width + 1) {
        for (std::size_t k = 0; k < tangents_.size(); ++k)
            tangents_[k] = static_cast<float>(std::tan(kFanDegrees[k] * kPi / 180));
        for (Fans& fans : fans_) {
            fans.height_m.fill(kNothing_m);
            fans.distance_m.fill(-kFarther_m);  // whatever is seen there is infinitely low
        }
    }

    Sheet& sheet() { return sheet_; }
    void come_to(int) {}
    void take(int row) {
        rows_.take(sheet_, row, kAllColumns, [](const float* from, int count, float* to, int) {
            std::copy_n(from, count, to);
        });
    }

    /// The ground of the next row, and of the columns before it.
    void advance(int row, const Terms& terms) {
        const Steps::Row& step = steps_.row(row);
        const int from = std::max(line_, step.first_line) - line_,
                  to = std::min(line_ + width_ + 1, step.end_line) - line_;
        if (from >= to) return;
        const int first = from / Sweep::kMostLanes * Sweep::kMostLanes;
        for (std::size_t set = 0; set < kNearness.line_sets; ++set) {
            const std::span<const Ground> ground = terms.of_lines(set, row);
            for (std::size_t k = 0; k < ground.size(); k += kFanPoints)
                raise(set, row, terms,
                      ground.subspan(k, std::min<std::size_t>(kFanPoints, ground.size() - k)),
                      first, in_vectors(to - first));
        }
    }

    template <typename Use>
    void look(int row, const Terms& terms, int first, int end, const Use& use) {
        const Steps::Row& step = steps_.row(row);
        const int from = std::max(line_, first - step.column);
        const int to = std::min(line_ + width_, end - step.column);
        if (from >= to) return;
        const float* const ground_m = rows_.at(row, step.column, from);
        std::array<float, in_vectors(kFanLines)> tangent;
        // The line nearest to a post.
        const int half = static_cast<int>(step.between * 2 * kNearness.line_sets + 1) / 2;
        const Fans& fans = fans_[static_cast<std::size_t>(half) % kNearness.line_sets];
        const int on = half / static_cast<int>(kNearness.line_sets) + from - line_;
        const double s = distance_m(row);
        const double tilt = curvature_ * s;
        int ray = 0;
        while (ray < kRays && tangents_[static_cast<std::size_t>(ray)] - tilt < least_)
            ++ray;
        kernel_.look_over_fans({.tangent = tangent.data(),
                                .ground_m = ground_m,
                                .height_m = fans.height_m.data() + on,
                                .distance_m = fans.distance_m.data() + on,
                                .pitch = kPitch,
                                .posts = in_vectors(to - from),
                                .first_ray = ray,
                                .tangents = tangents_.data(),
                                .from_m = static_cast<float>(s),
                                .sunk_m = static_cast<float>(curvature_ * s * s / 2),
                                .tilt = static_cast<float>(tilt),
                                .both = least_ == -std::numeric_limits<double>::infinity()});
        look_near(terms, row, from, to, ground_m, tangent.data());
        use(step.column + from, to - from, tangent.data());
    }

  private:
    static constexpr float kFarther_m = 1e9F;  // than any ground
    static constexpr std::ptrdiff_t kPitch = in_vectors(kFanLines + 1) + Sweep::kMostLanes;
    struct Fans {
        alignas(64) std::array<float, kRays * kPitch> height_m, distance_m;
    };

    /// How far line 0 has come from the row of the reference on.
    double distance_m(int row) const { return plan_.row(row).fall; }

    void raise(std::size_t set, int row, const Terms& terms, std::span<const Ground> ground,
               int first, int lines) {
        std::array<FanPoint, kFanPoints> points;
        std::array<float, kRays * kFanPoints> rises;
        for (std::size_t k = 0; k < ground.size(); ++k) {
            const double s = distance_m(row) - terms.distances(ground)[k];
            points[k] = {ground[k], static_cast<float>(curvature_ * s * s / 2),
                         static_cast<float>(s)};
            for (std::size_t ray = 0; ray < kRays; ++ray)
                rises[ray * kFanPoints + k] = tangents_[ray] * points[k].distance_m;
        }
        kernel_.raise_fans({.height_m = fans_[set].height_m.data() + first,
                            .distance_m = fans_[set].distance_m.data() + first,
                            .pitch = kPitch,
                            .lines = lines,
                            .tangents = tangents_.data(),
                            .rows = rows_.from(line_ + first),
                            .points = points.data(),
                            .rises = rises.data()},
                           static_cast<int>(ground.size()));
    }

    void look_near(const Terms& terms, int row, int from, int to, const float* height_m,
                   float* tangent) const {
        const std::span<const Ground> all = terms.of_posts(row);
        std::array<Slope, 16> slopes;
        for (std::size_t first = 0; first < all.size(); first += slopes.size()) {
            const auto ground = all.subspan(first, std::min(slopes.size(), all.size() - first));
            for (std::size_t k = 0; k < ground.size(); ++k) {
                const double d = terms.distances(ground)[k];
                slopes[k] = {static_cast<float>(1 / d), static_cast<float>(curvature_ * d / 2)};
            }
            kernel_.look({tangent, height_m, in_vectors(to - from), rows_.from(from), ground.data(),
                          slopes.data(), static_cast<int>(ground.size())});
        }
    }

    Sheet sheet_;
    const Plan& plan_;
    const Steps& steps_;
    const SweepKernel& kernel_;
    double curvature_;
    int line_, width_;
    double least_;
    GroundRows rows_;
    std::array<float, kRays> tangents_;
    std::array<Fans, kNearness.line_sets> fans_;
};

/// Suns whose rays have one shape, from the lowest one on.
struct Levels {
    std::vector<double> more;     // of their tangents, than that of the lowest
    std::vector<std::size_t> of;  // the level of each

    explicit Levels(const std::vector<double>& given) : of(given.size()) {
        std::vector<std::size_t> order(given.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::stable_sort(order.begin(), order.end(),
                         [&](std::size_t a, std::size_t b) { return given[a] < given[b]; });
        for (std::size_t level = 0; level < order.size(); ++level) {
            of[order[level]] = level;
            more.push_back(given[order[level]] - given[order[0]]);
        }
    }
};

/// What lies where on a sheet for a sweep.
struct Extent {
    int first_line = std::numeric_limits<int>::max(), end_line = std::numeric_limits<int>::min();

    Extent(const Plan& plan, const Wanted& wanted) {
        const SweepWindow& window = wanted.window;
        for (int row = window.row; row < window.row + window.rows; ++row) {
            const ColumnRange columns = wanted.at(row);
            if (columns.begin >= columns.end) continue;
            const int column = column_at(plan.row(row));
            first_line = std::min(first_line, columns.begin - column);
            end_line = std::max(end_line, columns.end - column);
        }
    }
};

/// Rows of Sweep::Blocks: what is kept of their posts stays in the cache.
constexpr int block_rows(int columns) {
    constexpr int kPosts = 1 << 16, kLeast = 16, kMost = 256;
    return std::clamp(kPosts / columns, kLeast, kMost);
}

/// Rows that ground is read for together, and those before them.
constexpr int kReadRows = 256, kRowsBefore = 2;

constexpr int kTransposeBlock = 4;  // posts a side
using Vector4 [[gnu::vector_size(kTransposeBlock * sizeof(float))]] = float;

/// Four rows of four numbers.
[[gnu::always_inline]] inline void transpose_block(const float* from, std::ptrdiff_t from_stride,
                                                   float* to, std::ptrdiff_t to_stride) {
    std::array<Vector4, kTransposeBlock> r;
    for (std::size_t i = 0; i < r.size(); ++i)
        std::memcpy(&r[i], from + static_cast<std::ptrdiff_t>(i) * from_stride, sizeof r[i]);
    const Vector4 a = __builtin_shufflevector(r[0], r[1], 0, 4, 1, 5),
                  b = __builtin_shufflevector(r[2], r[3], 0, 4, 1, 5),
                  c = __builtin_shufflevector(r[0], r[1], 2, 6, 3, 7),
                  d = __builtin_shufflevector(r[2], r[3], 2, 6, 3, 7);
    r = {__builtin_shufflevector(a, b, 0, 1, 4, 5), __builtin_shufflevector(a, b, 2, 3, 6, 7),
         __builtin_shufflevector(c, d, 0, 1, 4, 5), __builtin_shufflevector(c, d, 2, 3, 6, 7)};
    for (std::size_t i = 0; i < r.size(); ++i)
        std::memcpy(to + static_cast<std::ptrdiff_t>(i) * to_stride, &r[i], sizeof r[i]);
}

/// The same about the nearest post, so that one line goes through posts.
SweepSun at_a_post(SweepSun sun) {
    const GridPair post{std::round(sun.reference.column), std::round(sun.reference.row)};
    sun.tangent = sun.tangent_at(post.column, post.row);
    sun.reference = post;
    return sun;
}

/// The same seen in a mirror: rows counted from the other end.
SweepSun mirrored(SweepSun sun, int rows) {
    sun.reference.row = rows - 1 - sun.reference.row;
    for (GridPair* const pair : {&sun.towards, &sun.bend, &sun.twist, &sun.tangent_a_post})
        pair->row = -pair->row;
    return sun;
}

}  // namespace

void transpose(const float* from, std::ptrdiff_t from_stride, int rows, int columns, float* to,
               std::ptrdiff_t to_stride) {
    constexpr int kBand =
        64;  // rows whose columns are next to each other: whole lines of the cache
    parallel_for(0, (rows + kBand - 1) / kBand, 4, [&](int first, int last) {
        for (int band = first; band < last; ++band) {
            const int begin = band * kBand, end = std::min(rows, begin + kBand);
            int c = 0;
            for (; c + kTransposeBlock <= columns; c += kTransposeBlock) {
                int r = begin;
                for (; r + kTransposeBlock <= end; r += kTransposeBlock)
                    transpose_block(from + r * from_stride + c, from_stride, to + c * to_stride + r,
                                    to_stride);
                for (; r < end; ++r)
                    for (int k = c; k < c + kTransposeBlock; ++k)
                        to[k * to_stride + r] = from[r * from_stride + k];
            }
            for (; c < columns; ++c)
                for (int r = begin; r < end; ++r)
                    to[c * to_stride + r] = from[r * from_stride + c];
        }
    });
}

GridPair SweepSun::way(double distance_m) const {
    const auto posts = [=](double first, double second, double third) {
        return ((third / 6 * distance_m + second / 2) * distance_m + first) * distance_m;
    };
    return {posts(towards.column, bend.column, twist.column),
            posts(towards.row, bend.row, twist.row)};
}

double SweepSun::distance_m(double row) const {
    const double posts = row - reference.row;
    double s = posts / towards.row;
    if (bend.row == 0 && twist.row == 0) return s;
    for (int step = 0; step < 8; ++step) {  // Newton's; two or three do
        const double slope = (twist.row / 2 * s + bend.row) * s + towards.row;
        if (!(slope * towards.row > 0)) return std::numeric_limits<double>::quiet_NaN();
        const double off_m = (way(s).row - posts) / slope;
        s -= off_m;
        if (std::abs(off_m) <= 1e-12 * std::abs(s)) break;
    }
    return s;
}

SweepSun SweepSun::transposed() const {
    SweepSun sun = *this;
    for (GridPair* const pair :
         {&sun.reference, &sun.towards, &sun.bend, &sun.twist, &sun.tangent_a_post})
        std::swap(pair->column, pair->row);
    return sun;
}

SweepSun sun_over_map(const GridPair& spacing_m, const GridPair& direction, double elevation_rad,
                      const GridPair& reference, double curvature) {
    SweepSun sun;
    sun.reference = reference;
    sun.towards = {direction.column / spacing_m.column, direction.row / spacing_m.row};
    sun.tangent = std::tan(elevation_rad);
    const double a_metre = curvature * (1 + sun.tangent * sun.tangent);
    sun.tangent_a_post = {a_metre * direction.column * spacing_m.column,
                          a_metre * direction.row * spacing_m.row};
    return sun;
}

Sweep::Sweep(const float* height_m, int columns, int rows, std::ptrdiff_t stride)
    : height_m_(height_m), columns_(columns), rows_(rows), stride_(stride) {
    assert(columns > 0 && rows > 0);
    const SweepKernel& kernel = widest_sweep_kernel(kMostLanes);
    HeightRange range;
    std::mutex mutex;
    parallel_for(0, rows, 64, [&](int first, int last) {
        HeightRange of_rows;
        for (int row = first; row < last; ++row)
            kernel.add_to_range(height_m + row * stride, columns, of_rows);
        const std::lock_guard lock(mutex);
        range.lowest_m = std::min(range.lowest_m, of_rows.lowest_m);
        range.highest_m = std::max(range.highest_m, of_rows.highest_m);
    });
    lowest_m_ = range.lowest_m, highest_m_ = range.highest_m;
}

const float* Sweep::transposed() const {
    std::call_once(once_, [&] {
        transposed_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
        transpose(height_m_, stride_, rows_, columns_, transposed_.data(), rows_);
    });
    return transposed_.data();
}

const ShadeCells& Sweep::cells(bool along_columns) const {
    const auto k = static_cast<std::size_t>(along_columns);
    std::call_once(cells_once_[k], [&] {
        cells_[k] = along_columns
                        ? std::make_shared<const ShadeCells>(transposed(), rows_, columns_, rows_)
                        : std::make_shared<const ShadeCells>(height_m_, columns_, rows_, stride_);
    });
    return *cells_[k];
}

Sweep::Sweep(Read read, int columns, int rows, float lowest_m, float highest_m)
    : read_(std::move(read)),
      columns_(columns),
      rows_(rows),
      lowest_m_(lowest_m),
      highest_m_(highest_m) {
    assert(columns > 0 && rows > 0);
}

/// The grid as a sweep goes over it.
struct Sweep::View {
    Sheet sheet;
    SweepSun sun;
    SweepWindow window;
    bool along_columns, mirrored;

    /// A piece of a row of a sheet, as it is on the grid.
    SweepRun run(const Sheet& of, int row, int column, int count, const float* found) const {
        const int line = mirrored ? sheet.rows - 1 - row : row;
        return {along_columns, line, column, count, of.first + row * of.stride + column, found};
    }

    /// Reads rows [row, end_row) and columns [column, end_column) of the sheet, so that it has them
    /// where it looks for them.
    void read(const Read& from, Sheet& to, int row, int end_row, int column, int end_column,
              std::vector<float>& buffer) const {
        const int rows = end_row - row, columns = end_column - column;
        const int line = mirrored ? sheet.rows - end_row : row;
        std::vector<float> packed;
        from(along_columns ? SweepWindow{line, column, rows, columns}
                           : SweepWindow{column, line, columns, rows},
             packed);
        buffer.resize(static_cast<std::size_t>(rows) * static_cast<std::size_t>(to.stride));
        float* const first = buffer.data() + (mirrored ? (rows - 1) * to.stride : 0);
        const std::ptrdiff_t stride = mirrored ? -to.stride : to.stride;
        if (along_columns)
            transpose(packed.data(), rows, columns, rows, first, stride);
        else
            for (int i = 0; i < rows; ++i)
                std::copy_n(packed.data() + std::ptrdiff_t{i} * columns, columns,
                            first + i * stride);
        to.first = buffer.data() - (row * to.stride + column);
    }
};

std::optional<std::vector<int>> first_posts(const SweepSun& ray, const SweepWindow& window) {
    const SweepSun by_rows = ray.along_columns() ? ray.transposed() : ray;
    const SweepWindow w = ray.along_columns()
                              ? SweepWindow{window.row, window.column, window.rows, window.columns}
                              : window;
    const RayRows rows(by_rows, w.row, w.row + w.rows);
    std::vector<int> first;
    first.reserve(static_cast<std::size_t>(w.rows));
    for (int row = w.row; row < w.row + w.rows; ++row) {
        const double column = rows.column_at(row);
        if (std::isnan(column)) return std::nullopt;
        first.push_back(static_cast<int>(
            std::ceil(std::clamp(column, double(w.column), double(w.column) + w.columns))));
    }
    return first;
}

Sweep::View Sweep::view(const SweepSun& given, const SweepWindow& window) const {
    assert(window.column >= 0 && window.row >= 0 && window.columns > 0 && window.rows > 0 &&
           window.column + window.columns <= columns_ && window.row + window.rows <= rows_);
    View view{{height_m_, stride_, columns_, rows_}, at_a_post(given), window, false, false};
    view.along_columns = given.along_columns();
    if (view.along_columns) {
        view.sheet = {read_ ? nullptr : transposed(), rows_, rows_, columns_};
        view.window = {window.row, window.column, window.rows, window.columns};
        view.sun = view.sun.transposed();
    }
    Sheet& sheet = view.sheet;
    view.mirrored = view.sun.towards.row > 0;
    if (view.mirrored) {
        view.sun = mirrored(view.sun, sheet.rows);
        if (!read_) {
            sheet.first += (sheet.rows - 1) * sheet.stride;
            sheet.stride = -sheet.stride;
        }
        view.window.row = sheet.rows - view.window.row - view.window.rows;
    }
    return view;
}

Sweep::View Sweep::edge_view(const SweepSun& given, const SweepWindow& window) const {
    View view = this->view(given, window);
    if (!(std::abs(view.sun.tangent) < kSteepest)) {
        view.sun.tangent = std::copysign(kSteepest, view.sun.tangent);
        view.sun.tangent_a_post = {};
    }
    return view;
}

double Sweep::drop_m(float floor_m) const {
    return std::max(0.0, double{highest_m_} - (floor_m > kNoFloor_m ? floor_m : lowest_m_));
}

/// Strips of one width, as many for every thread.
static int width_of_strips(int lines, int most) {
    const int threads = std::min(thread_count(), std::max(1, lines / (4 * Sweep::kMostLanes)));
    const int least = (lines + most - 1) / most;
    const int strips = (least + threads - 1) / threads * threads;
    const int width = (lines + strips - 1) / strips;
    return std::min(most, in_vectors(width + 1) - 1);  // and the line beside are whole vectors
}

/// Has strips of lines over a window go from the first row that matters to its last.
/// @param make  a strip from the steps, its first line and how many it has
/// @param look  at a row of the window with a strip
template <typename OneStrip, typename Make, typename Look>
void Sweep::sweep_strips(View& view, double drop_m, const Make& make, const Look& look) const {
    const SweepWindow& w = view.window;
    Sheet& sheet = view.sheet;
    const Wanted wanted{w};
    const Plan plan(sheet, view.sun, w, drop_m, Plan::begin_of_window(view.sun, w, drop_m));
    const Steps steps(plan, wanted, OneStrip::kNearness);
    const Extent extent(plan, wanted);
    const int lines = extent.end_line - extent.first_line;
    const int width = width_of_strips(lines, OneStrip::kMostWidth);
    const int strips = (lines + width - 1) / width;
    Terms terms;
    terms.clear(plan.begin(), plan.end(), steps.pitch(width + 1));
    for (int row = plan.begin(); row < plan.end(); ++row)
        terms.add(plan, steps, row);
    // Ground that is read has room for a strip's, and for how far that goes aside over the rows.
    const int ground = steps.width(width + 1);
    const auto columns_from = [&](int row) {
        return plan.columns(std::max(plan.begin(), row - kRowsBefore),
                            std::min(row + kReadRows + 1, plan.end()));
    };
    if (read_) {
        double aside = 0;
        for (int row = plan.begin(); row < plan.end(); row += kReadRows) {
            const auto [least, most] = columns_from(row);
            aside = std::max(aside, most - least);
        }
        sheet.stride = ground + static_cast<int>(std::ceil(aside)) + 8;
    }
    parallel_for(0, strips, 1, [&](int begin, int end) {
        std::vector<float> buffer;
        for (int k = begin; k < end; ++k) {
            const int line = extent.first_line + k * width;
            auto strip = make(plan, steps, line, width);
            for (int row = steps.begin; row < plan.end(); ++row) {
                if (read_ && (row - steps.begin) % kReadRows == 0) {
                    const int first = std::max(plan.begin(), row - kRowsBefore),
                              last = std::min(row + kReadRows, plan.end());
                    const auto [least, most] = columns_from(row);
                    const int column = std::max(0, static_cast<int>(std::floor(least)) + line - 2);
                    const int end_column = std::min(
                        sheet.columns, static_cast<int>(std::ceil(most)) + line + ground + 2);
                    if (column < end_column)
                        view.read(read_, strip->sheet(), first, last, column, end_column, buffer);
                }
                strip->come_to(row);
                strip->take(row);
                if (const int at = row - OneStrip::kNearness.near_rows - 1; at >= steps.begin)
                    strip->advance(at, terms);
                if (row >= w.row) look(*strip, row, terms);
            }
        }
    });
}

void Sweep::each_edge(const SweepSun& given, const SweepWindow& window, const Use& use, int lanes,
                      float floor_m) const {
    View view = edge_view(given, window);
    const SweepWindow& w = view.window;
    const SweepKernel& kernel = widest_sweep_kernel(lanes);
    sweep_strips<Strip>(
        view, drop_m(floor_m),
        [&](const Plan& plan, const Steps& steps, int line, int width) {
            return std::make_unique<Strip>(view.sheet, plan, kOneLevel, steps, kernel, line, width,
                                           lowest_m_, floor_m);
        },
        [&](Strip& strip, int row, const Terms& terms) {
            strip.look(row, terms, w.column, w.column + w.columns,
                       [&](int column, int count, const float* edge_m) {
                           use(view.run(strip.sheet(), row, column, count, edge_m));
                       });
        });
}

void Sweep::each_horizon(const SweepSun& way, double curvature, double reach_m,
                         const SweepWindow& window, const Use& use, int lanes) const {
    View view = this->view(way, window);
    view.sun.tangent = 1;
    view.sun.tangent_a_post = {};
    const SweepWindow& w = view.window;
    const SweepKernel& kernel = widest_sweep_kernel(lanes);
    // Of ground that is farther off some windows see more than others, but never higher than so.
    const double relief_m = std::max(0.0, double{highest_m_} - lowest_m_);
    const double across_m = reach_m * std::hypot(way.towards.column, way.towards.row);
    const double least = across_m > std::hypot(columns_, rows_)
                             ? -std::numeric_limits<double>::infinity()
                             : relief_m / reach_m - curvature * reach_m / 2;
    sweep_strips<FanStrip>(
        view, reach_m,
        [&](const Plan& plan, const Steps& steps, int line, int width) {
            return std::make_unique<FanStrip>(view.sheet, plan, steps, kernel, curvature, line,
                                              width, least);
        },
        [&](FanStrip& strip, int row, const Terms& terms) {
            strip.look(row, terms, w.column, w.column + w.columns,
                       [&](int column, int count, const float* tangent) {
                           use(view.run(strip.sheet(), row, column, count, tangent));
                       });
        });
}

/// A sun whose sweep goes on from block to block.
struct Sweep::Blocks::OneShape {
    View view;  // of the lowest one
    Levels levels;
    Plan plan;
    Extent extent;
    ColumnRange ground;                  // columns that its lines go over
    std::shared_ptr<const Steps> steps;  // none, nor strips: nothing is looked at
    std::vector<std::unique_ptr<Strip>> strips;
    int pitch = 0;  // of their rows of ground

    /// @param begin  as Plan has it
    OneShape(const View& of, const Levels& all, const Wanted& wanted, double drop_m, int begin)
        : view(of),
          levels(all),
          plan(view.sheet, view.sun, view.window, drop_m, begin),
          extent(plan, wanted),
          ground(columns()) {}
    /// Of a band.
    OneShape(const View& of, const Levels& all, const Wanted& wanted, const RayRows& ray, int begin)
        : view(of),
          levels(all),
          plan(view.sheet, view.sun, ray, begin, wanted.window.row + wanted.window.rows),
          extent(plan, wanted),
          ground(columns()) {}
    OneShape(const OneShape&) = delete;
    OneShape& operator=(const OneShape&) = delete;

    /// Of rows [first, end), those that it goes over.
    std::pair<int, int> rows(int first, int end) const {
        return {std::max(first, plan.begin()), std::min(end, plan.end())};
    }

    /// A strip comes to a row.
    void step(const Moment& moment, Strip& strip, int row, Terms& terms);

    /// What is known of the posts of patches before all of its suns are swept.
    ShadedPatches shaded(const PatchSheet& sheet, const EarthAround& earth) const {
        ShadedPatches found(sheet, view.sun, plan.rows(), plan.begin(), earth);
        if (levels.more.size() == 1) return found;
        std::vector<RowPlan> rows(plan.rows().begin(), plan.rows().end());
        for (RowPlan& row : rows)
            row.fall -= row.distance_m * levels.more.back();
        SweepSun highest = view.sun;
        highest.tangent += levels.more.back();
        found.rise_to(ShadedPatches(sheet, highest, rows, plan.begin(), earth));
        return found;
    }

    /// To be called before it goes over rows.
    /// @param of  its own, or of others whose rays go the same way from the same row on
    void make_strips(const std::shared_ptr<const Steps>& of, float lowest_m, float floor_m) {
        steps = of;
        const int lines = extent.end_line - extent.first_line;
        const int count = (lines + Strip::kMostWidth - 1) / Strip::kMostWidth;
        const int width =
            std::min(in_vectors((lines + count - 1) / count + 1) - 1, Strip::kMostWidth);
        pitch = steps->pitch(width + 1);
        for (int line = extent.first_line; line < extent.end_line; line += width)
            strips.push_back(std::make_unique<Strip>(view.sheet, plan, levels.more, *steps,
                                                     widest_sweep_kernel(kMostLanes), line, width,
                                                     lowest_m, floor_m));
    }

  private:
    ColumnRange columns() const {
        constexpr int kBeside = 3;  // columns beside lines whose ground matters to posts
        const auto [least, most] = plan.columns(plan.begin(), plan.end());
        return {static_cast<int>(std::floor(least)) + extent.first_line - kBeside,
                static_cast<int>(std::ceil(most)) + extent.end_line + kBeside};
    }
};

/// The suns of a band, where it has posts.
struct Sweep::Blocks::OneBand {
    Wanted wanted;
    std::vector<std::unique_ptr<OneShape>> shapes;

    void make_strips(float lowest_m, float floor_m) {
        if (shapes.empty()) return;
        // Of the sun whose shade reaches farthest, for all of them.
        const auto& farthest = *std::max_element(
            shapes.begin(), shapes.end(),
            [](const auto& a, const auto& b) { return a->plan.reach_m() < b->plan.reach_m(); });
        Nearness nearness = Strip::kNearness;
        for (const auto& shape : shapes)
            nearness.distances = nearness.distances || shape->levels.more.size() > 1;
        const auto steps = std::make_shared<const Steps>(farthest->plan, wanted, nearness);
        for (const auto& shape : shapes)
            shape->make_strips(steps, lowest_m, floor_m);
    }
};

/// What the suns of a band meet at the rows of a block.
struct Sweep::Blocks::BlockTerms {
    Terms terms;
    const Steps* of = nullptr;
    int row = 0;

    /// @param first, end  of the block
    void come_to(const OneShape& shape, int first, int end) {
        if (of == shape.steps.get() && row == first) return;
        of = shape.steps.get(), row = first;
        terms.clear(first - Strip::kNearness.near_rows - 1, end, shape.pitch);
    }
};

/// The suns of a moment, and what of the ground matters to them.
struct Sweep::Blocks::Moment {
    std::vector<OneBand> bands;
    std::optional<PatchSheet> sheet;
    std::optional<ShadeRanges> ranges;  // none: everywhere

    template <typename Use>
    void each_range(ShadeRanges::Of of, int row, const Use& use) const {
        if (!ranges) return use(kAllColumns);
        for (const ColumnRange& range : ranges->at(of, sheet->row_of(row)))
            use(range);
    }
    bool has_any(ShadeRanges::Of of, int row) const {
        return !ranges || !ranges->at(of, sheet->row_of(row)).empty();
    }
    /// No ground matters anywhere.
    bool has_none() const { return ranges && ranges->of[ShadeRanges::kTake].ranges.empty(); }
};

void Sweep::Blocks::OneShape::step(const Moment& moment, Strip& strip, int row, Terms& terms) {
    const int at = row - Strip::kNearness.near_rows - 1;
    const bool raises = at >= plan.begin() && moment.has_any(ShadeRanges::kRaise, at);
    if (!raises && !moment.has_any(ShadeRanges::kTake, row)) return;
    strip.come_to(row);
    moment.each_range(ShadeRanges::kTake, row,
                      [&](const ColumnRange& range) { strip.take(row, range); });
    if (!raises) return;
    moment.each_range(ShadeRanges::kRaise, at, [&](const ColumnRange& range) {
        terms.add(plan, *steps, at);
        strip.advance(at, terms, range);
    });
}

bool Sweep::Blocks::go_together(const std::vector<Sun>& suns) {
    const auto way = [](const SweepSun& sun) {
        return std::pair(sun.along_columns(),
                         (sun.along_columns() ? sun.towards.column : sun.towards.row) > 0);
    };
    for (const Sun& moment : suns)
        for (const Band& band : moment.bands)
            for (const Suns& shape : band.suns)
                if (way(shape.sun) != way(suns.front().bands.front().suns.front().sun))
                    return false;
    return true;
}

Sweep::Blocks::Blocks(const Sweep& sweep, const std::vector<Sun>& suns, const SweepWindow& window,
                      float floor_m, double earth_curvature)
    : sweep_(sweep), terms_(std::make_unique<BlockTerms>()) {
    assert(!suns.empty() && go_together(suns));
    view_ = std::make_unique<View>(
        sweep.edge_view(suns.front().bands.front().suns.front().sun, window));
    for (const Sun& of : suns) {
        moments_.push_back(std::make_unique<Moment>());
        for (const Band& band : of.bands)
            add_band(band, window, floor_m, *moments_.back());
    }
    // The first time that takes a look at all of the grid.
    const bool is_worth_it = std::int64_t{window.columns} * window.rows * std::ssize(suns) >=
                             std::int64_t{sweep.columns_} * sweep.rows_;
    if (is_worth_it && !sweep.read_) leave_out(suns, earth_curvature);
    row_ = view_->window.row;
    for (const auto& moment : moments_) {
        if (moment->has_none()) continue;
        for (OneBand& band : moment->bands) {
            band.make_strips(sweep.lowest_m_, floor_m);
            for (const auto& shape : band.shapes) {
                shapes_.push_back(shape.get());
                row_ = std::min(row_, shape->plan.begin());
            }
        }
    }
    end_row_ = row_;
}

Sweep::Blocks::~Blocks() = default;

/// The posts of a band on the rows of a sheet.
/// @param w  the window there
static Wanted wanted_of(const Sweep::Blocks::Band& band, const SweepWindow& w, bool mirrored) {
    if (!band.begin && !band.end) return {w};
    Wanted wanted{w};
    int first = w.row + w.rows, end = w.row;
    for (int row = w.row; row < w.row + w.rows; ++row) {
        const auto line =
            static_cast<std::size_t>(mirrored ? w.row + w.rows - 1 - row : row - w.row);
        ColumnRange range{w.column, w.column + w.columns};
        if (band.begin) range.begin = std::max(range.begin, (*band.begin)[line]);
        if (band.end) range.end = std::min(range.end, (*band.end)[line]);
        wanted.band.push_back(range);
        if (range.begin >= range.end) continue;
        first = std::min(first, row), end = row + 1;
    }
    if (first >= end) return {};
    wanted.band.erase(wanted.band.begin() + (end - w.row), wanted.band.end());
    wanted.band.erase(wanted.band.begin(), wanted.band.begin() + (first - w.row));
    wanted.window.row = first, wanted.window.rows = end - first;
    return wanted;
}

void Sweep::Blocks::add_band(const Band& band, const SweepWindow& window, float floor_m,
                             Moment& moment) {
    OneBand& to = moment.bands.emplace_back();
    to.wanted = wanted_of(band, view_->window, view_->mirrored);
    const SweepWindow& w = to.wanted.window;
    if (w.rows == 0) return;
    std::vector<View> views;
    std::vector<Levels> levels;
    for (const Suns& suns : band.suns) {
        levels.emplace_back(suns.more);
        SweepSun lowest = suns.sun;
        lowest.tangent += *std::min_element(suns.more.begin(), suns.more.end());
        views.push_back(sweep_.edge_view(lowest, window));
    }
    const double drop_m = sweep_.drop_m(floor_m);
    int begin = w.row;
    if (!to.wanted.is_band()) {
        for (const View& view : views)
            begin = std::min(begin, Plan::begin_of_window(view.sun, w, drop_m));
        for (std::size_t i = 0; i < views.size(); ++i)
            to.shapes.push_back(
                std::make_unique<OneShape>(views[i], levels[i], to.wanted, drop_m, begin));
        return;
    }
    RayRows ray(views.front().sun, w.row, w.row + w.rows);
    for (const View& view : views)
        begin = std::min(begin, Plan::begin_of_band(view.sheet, view.sun, to.wanted, drop_m, ray));
    for (std::size_t i = 0; i < views.size(); ++i)
        to.shapes.push_back(std::make_unique<OneShape>(views[i], levels[i], to.wanted, ray, begin));
}

void Sweep::Blocks::leave_out(const std::vector<Sun>& suns, double earth_curvature) {
    std::vector<std::optional<ShadedPatches>> shaded(suns.size());
    // What is known beforehand is so of one path over all of the grid.
    const auto is_known = [&](std::size_t k) {
        return !suns[k].all_posts && suns[k].bands.size() == 1;
    };
    ColumnRange ground{kAllColumns.end, kAllColumns.begin};
    for (std::size_t k = 0; k < suns.size(); ++k)
        if (is_known(k))
            for (const auto& shape : moments_[k]->bands.front().shapes)
                ground = {std::min(ground.begin, shape->ground.begin),
                          std::max(ground.end, shape->ground.end)};
    const auto find = [&](std::size_t k) {
        if (!is_known(k)) return;
        Moment& moment = *moments_[k];
        moment.sheet.emplace(sweep_.cells(view_->along_columns), view_->mirrored, view_->sheet.rows,
                             ground);
        for (const auto& shape : moment.bands.front().shapes) {
            const ShadedPatches found = shape->shaded(
                *moment.sheet, EarthAround{sweep_.lowest_m_, sweep_.highest_m_, earth_curvature});
            if (shaded[k])
                shaded[k]->join(found);
            else
                shaded[k] = found;
        }
    };
    // Between two suns of which little is known, little is of the others.
    constexpr std::size_t kSome = 4;
    const auto is_mixed = [&](std::size_t k) { return !shaded[k] || shaded[k]->is_mixed(); };
    for (std::size_t k = 0; k < suns.size(); k += kSome)
        find(k);
    for (std::size_t k = 0; k < suns.size(); k += kSome) {
        const std::size_t next = std::min(k + kSome, suns.size());
        if (next < suns.size() && is_mixed(k) && is_mixed(next)) continue;
        for (std::size_t i = k + 1; i < next; ++i)
            find(i);
    }
    for (std::size_t k = 0; k < suns.size(); ++k) {
        const bool is_first = k == 0, is_last = k + 1 == suns.size();
        if (!shaded[k] || (!is_first && !shaded[k - 1]) || (!is_last && !shaded[k + 1])) continue;
        if (shaded[k]->is_mixed()) continue;
        moments_[k]->ranges =
            shade_ranges(*moments_[k]->sheet, is_first ? nullptr : &*shaded[k - 1], *shaded[k],
                         is_last ? nullptr : &*shaded[k + 1]);
    }
}

/// Ground of rows for all suns, where it is not in memory.
void Sweep::Blocks::read(int row, int end_row) {
    Sheet sheet = view_->sheet;
    int column = sheet.columns, end_column = 0;
    for (const auto& shape : shapes_) {
        const auto [first, end] = shape->rows(row, end_row);
        for (int at = first; at < end; ++at) {
            column = std::min(column, shape->strips.front()->first_ground(at));
            end_column = std::max(end_column, shape->strips.back()->end_ground(at));
        }
    }
    column = std::max(column, 0), end_column = std::min(end_column, sheet.columns);
    if (column >= end_column) return;
    sheet.stride = end_column - column;
    view_->read(sweep_.read_, sheet, row, end_row, column, end_column, buffer_);
    for (const auto& shape : shapes_)
        for (const auto& strip : shape->strips)
            strip->sheet() = sheet;
}

std::optional<SweepWindow> Sweep::Blocks::next() {
    const View& view = *view_;
    const SweepWindow& w = view.window;
    const int end = w.row + w.rows;
    for (row_ = end_row_; row_ < end; row_ = end_row_) {
        end_row_ = std::min(row_ + block_rows(w.columns), row_ < w.row ? w.row : end);
        if (sweep_.read_) read(row_, end_row_);
        if (row_ >= w.row) {
            const int line = view.mirrored ? view.sheet.rows - end_row_ : row_;
            return view.along_columns ? SweepWindow{line, w.column, end_row_ - row_, w.columns}
                                      : SweepWindow{w.column, line, w.columns, end_row_ - row_};
        }
        for (const auto& moment : moments_) {
            if (moment->has_none()) continue;
            for (const OneBand& band : moment->bands)
                for (const auto& shape : band.shapes) {
                    terms_->come_to(*shape, row_, end_row_);
                    const auto [first, last] = shape->rows(row_, end_row_);
                    for (const auto& strip : shape->strips)
                        for (int row = first; row < last; ++row)
                            shape->step(*moment, *strip, row, terms_->terms);
                }
        }
    }
    return std::nullopt;
}

void Sweep::Blocks::each_edge(std::size_t index, std::size_t of_band, std::size_t of_suns,
                              const UseEach& use) {
    const Moment& moment = *moments_[index];
    const OneBand& band = moment.bands[of_band];
    if (band.shapes.empty() || moment.has_none()) return;
    OneShape& shape = *band.shapes[of_suns];
    Terms& terms = terms_->terms;
    terms_->come_to(shape, row_, end_row_);
    const std::vector<std::size_t>& levels = shape.levels.of;
    std::array<const float*, kMostLevels> found;
    const auto [first, end] = shape.rows(row_, end_row_);
    for (const auto& strip : shape.strips)
        for (int row = first; row < end; ++row) {
            shape.step(moment, *strip, row, terms);
            if (row < band.wanted.window.row) continue;
            const ColumnRange posts = band.wanted.at(row);
            moment.each_range(ShadeRanges::kLook, row, [&](const ColumnRange& range) {
                terms.add(shape.plan, *shape.steps, row);
                strip->look(row, terms, std::max(posts.begin, range.begin),
                            std::min(posts.end, range.end),
                            [&](int column, int count, const float* edge_m) {
                                for (std::size_t i = 0; i < levels.size(); ++i)
                                    found[i] = edge_m + static_cast<std::ptrdiff_t>(levels[i]) *
                                                            strip->edge_pitch();
                                use(shape.view.run(strip->sheet(), row, column, count, found[0]),
                                    found.data());
                            });
            });
        }
}

void Sweep::Blocks::each_dark(const Use& use) const {
    const Moment& moment = *moments_.front();
    if (!moment.ranges) return;
    const View& view = *view_;
    const SweepWindow& w = view.window;
    for (int row = row_; row < end_row_; ++row)
        moment.each_range(ShadeRanges::kDark, row, [&](const ColumnRange& range) {
            const int from = std::max(w.column, range.begin),
                      to = std::min(w.column + w.columns, range.end);
            const int line = view.mirrored ? view.sheet.rows - 1 - row : row;
            if (from < to) use({view.along_columns, line, from, to - from, nullptr, nullptr});
        });
}

void Sweep::shadow_edge(const SweepSun& sun, const SweepWindow& window, float* edge_m,
                        std::ptrdiff_t stride, int lanes) const {
    if (!sun.along_columns())
        return each_edge(
            sun, window,
            [&](const SweepRun& run) {
                std::copy_n(run.found, run.count,
                            edge_m + (run.line - window.row) * stride + run.first - window.column);
            },
            lanes);
    std::vector<float> turned(static_cast<std::size_t>(window.columns) *
                              static_cast<std::size_t>(window.rows));
    each_edge(
        sun, window,
        [&](const SweepRun& run) {
            std::copy_n(run.found, run.count,
                        turned.data() + std::ptrdiff_t{run.line - window.column} * window.rows +
                            run.first - window.row);
        },
        lanes);
    transpose(turned.data(), window.rows, window.columns, window.rows, edge_m, stride);
}

}  // namespace relevo::light
