#include "light/sweep.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <utility>

#include "base/parallel_for.h"

namespace relevo::light {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

constexpr float kNothing_m = -kInfinity;  // where nothing shades

constexpr int kNearRows = 4;          // whose ground a post's own ray is followed over
constexpr std::size_t kLineSets = 2;  // lines from post to post
constexpr double kSteepest = 1e4;     // tangent: 0.006 degrees from the zenith
constexpr double kOnLine = 1e-6;      // of a post: a ray that meets a row there meets the post
constexpr int kStripLines = 512;      // which a thread sweeps together: its rows stay in the cache

/// How far lines fall: fall + ramp * line.
struct Slope {
    float fall = 0, ramp = 0;
};

/// Ground under rays: height p[i] + part * (q[i] - p[i]) at the i-th line, which falls from there
/// on.
struct Term {
    std::ptrdiff_t p, q;  // of line 0, from the first post
    float part;
    Slope slope;
    int begin, end;  // lines that have such ground
};

/// The same from some line on.
struct Ground {
    const float *p = nullptr, *q = nullptr;
    float part = 0;
    Slope slope;
};

/// Loads that cross lines of the cache are what a sweep waits for: what is used twice is loaded
/// once, whatever the compiler thinks of it.
#if defined(__x86_64__)
#define RELEVO_IN_REGISTER(v) asm("" : "+x"(v))
#else
#define RELEVO_IN_REGISTER(v)
#endif

/// Lines next to each other that rise to their ground: e[i] = max(before[i] - slope, all ground).
struct Lift {
    float* e;
    const float* before;       // or null: of ground alone
    float least = kNothing_m;  // without
    int line;                  // the number of the first
    int lines;
    Slope slope;
    const Ground* ground;
    int grounds;
};

/// kVectors vectors of lines, from the i-th on. NaN, a hole, changes nothing. Multiplications and
/// additions are not contracted (CMakeLists.txt), so that the bits are the same for every V.
template <typename V, int kVectors>
[[gnu::always_inline]] inline void raise_some(const Lift& lift, int i, const V& lane) {
    constexpr int kWidth = static_cast<int>(sizeof(V) / sizeof(float));
    V line[kVectors], height[kVectors];
#pragma GCC unroll 8
    for (int k = 0; k < kVectors; ++k) {
        line[k] = static_cast<float>(lift.line + i + k * kWidth) + lane;
        height[k] = V{} + lift.least;
        if (lift.before) std::memcpy(&height[k], lift.before + i + k * kWidth, sizeof(V));
        height[k] -= lift.slope.fall + lift.slope.ramp * line[k];
    }
    for (const Ground* g = lift.ground; g < lift.ground + lift.grounds; ++g)
#pragma GCC unroll 8
        for (int k = 0; k < kVectors; ++k) {
            V a, b;
            std::memcpy(&a, g->p + i + k * kWidth, sizeof(V));
            std::memcpy(&b, g->q + i + k * kWidth, sizeof(V));
            RELEVO_IN_REGISTER(a);
            const V h = (a + g->part * (b - a)) - (g->slope.fall + g->slope.ramp * line[k]);
            height[k] = h > height[k] ? h : height[k];
        }
#pragma GCC unroll 8
    for (int k = 0; k < kVectors; ++k)
        std::memcpy(lift.e + i + k * kWidth, &height[k], sizeof(V));
}

template <typename V>
[[gnu::always_inline]] inline void raise_all(const Lift& lift) {
    // As many as there are registers for.
    constexpr int kWidth = static_cast<int>(sizeof(V) / sizeof(float)),
                  kTogether = kWidth == 4 ? 2 : 4;
    V lane{};
    for (int k = 0; k < kWidth; ++k)
        lane[k] = static_cast<float>(k);
    int i = 0;
    for (; i + kTogether * kWidth <= lift.lines; i += kTogether * kWidth)
        raise_some<V, kTogether>(lift, i, lane);
    for (; i + kWidth <= lift.lines; i += kWidth)
        raise_some<V, 1>(lift, i, lane);
    for (; i < lift.lines; ++i)
        raise_some<float, 1>(lift, i, 0);
}

/// Ground before posts next to each other, as their own rays meet it.
struct Sight {
    float* tangent;  // max(tangent, that of all ground)
    const float* height_m;
    int posts;
    const Ground* ground;  // its slope is 1 / distance, and what the ground has sunk by there
    int grounds;
};

/// kVectors vectors of posts, likewise.
template <typename V, int kVectors>
[[gnu::always_inline]] inline void look_some(const Sight& sight, int i) {
    constexpr int kWidth = static_cast<int>(sizeof(V) / sizeof(float));
    V height[kVectors], tangent[kVectors];
#pragma GCC unroll 8
    for (int k = 0; k < kVectors; ++k) {
        std::memcpy(&height[k], sight.height_m + i + k * kWidth, sizeof(V));
        tangent[k] = V{} + kNothing_m;
    }
    for (const Ground* g = sight.ground; g < sight.ground + sight.grounds; ++g)
#pragma GCC unroll 8
        for (int k = 0; k < kVectors; ++k) {
            V a, b;
            std::memcpy(&a, g->p + i + k * kWidth, sizeof(V));
            std::memcpy(&b, g->q + i + k * kWidth, sizeof(V));
            RELEVO_IN_REGISTER(a);
            const V t = ((a + g->part * (b - a)) - height[k]) * g->slope.fall - g->slope.ramp;
            tangent[k] = t > tangent[k] ? t : tangent[k];
        }
#pragma GCC unroll 8
    for (int k = 0; k < kVectors; ++k) {
        V before;
        std::memcpy(&before, sight.tangent + i + k * kWidth, sizeof(V));
        before = tangent[k] > before ? tangent[k] : before;
        std::memcpy(sight.tangent + i + k * kWidth, &before, sizeof(V));
    }
}

template <typename V>
[[gnu::always_inline]] inline void look_all(const Sight& sight) {
    // As many as there are registers for.
    constexpr int kWidth = static_cast<int>(sizeof(V) / sizeof(float)),
                  kTogether = kWidth == 4 ? 2 : 4;
    int i = 0;
    for (; i + kTogether * kWidth <= sight.posts; i += kTogether * kWidth)
        look_some<V, kTogether>(sight, i);
    for (; i + kWidth <= sight.posts; i += kWidth)
        look_some<V, 1>(sight, i);
    for (; i < sight.posts; ++i)
        look_some<float, 1>(sight, i);
}

/// Both by vectors of some width.
struct Kernel {
    void (*raise)(const Lift& lift);
    void (*look)(const Sight& sight);
};

#define RELEVO_SWEEP_KERNEL(lanes, ...)                                      \
    using Vector##lanes [[gnu::vector_size(lanes * sizeof(float))]] = float; \
    __VA_ARGS__ void raise_##lanes(const Lift& lift) {                       \
        raise_all<Vector##lanes>(lift);                                      \
    }                                                                        \
    __VA_ARGS__ void look_##lanes(const Sight& sight) {                      \
        look_all<Vector##lanes>(sight);                                      \
    }

RELEVO_SWEEP_KERNEL(4)
#if defined(__x86_64__)
RELEVO_SWEEP_KERNEL(8, [[gnu::target("avx2")]])
RELEVO_SWEEP_KERNEL(16, [[gnu::target("avx512f")]])
#endif
#undef RELEVO_SWEEP_KERNEL

/// With the widest vectors that this processor has and that are allowed.
Kernel widest_kernel(int lanes) {
#if defined(__x86_64__)
    if (lanes >= 16 && __builtin_cpu_supports("avx512f")) return {raise_16, look_16};
    if (lanes >= 8 && __builtin_cpu_supports("avx2")) return {raise_8, look_8};
#endif
    assert(lanes >= 4);
    return {raise_4, look_4};
}

/// A grid as the sweep goes over it: `row` 0 is the one nearest to the sun.
struct Sheet {
    const float* first;
    std::ptrdiff_t stride;
    int columns, rows;
};

/// Lines at a row. Line i is the ray through the reference, which is a post, moved by i columns.
struct RowPlan {
    double distance_m = 0;  // from the reference towards the sun
    double shift = 0;       // column of line 0
    double fall = 0;        // of line 0, from the row of the reference on
    double ramp = 0;        // likewise, more for each line
};

/// The rows that matter to a window, and all that is the same for their posts.
class Plan {
  public:
    /// @param drop_m  what lines may fall by before they matter no more
    Plan(const Sheet& sheet, const SweepSun& sun, const SweepWindow& window, double drop_m)
        : sheet_(sheet), sun_(sun) {
        find_begin(window, drop_m);
        rows_.resize(static_cast<std::size_t>(window.row + window.rows - begin_));
        fill(1);
        fill(-1);
    }

    int begin() const { return begin_; }
    int end() const { return begin_ + static_cast<int>(rows_.size()); }
    const RowPlan& row(int row) const { return rows_[static_cast<std::size_t>(row - begin_)]; }

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

    /// The ground of a row, for rays that are at `shift` there, and fall from there to `to`.
    Term row_term(int at, double shift, const RowPlan& to) const {
        const RowPlan& from = row(at);
        double whole = std::floor(shift);
        double part = shift - whole;
        if (part > 1 - kOnLine) {
            whole += 1;
            part = 0;
        } else if (part < kOnLine) {
            part = 0;
        }
        const int column = static_cast<int>(whole);
        Term term;
        term.p = at * sheet_.stride + column;
        term.q = term.p + (part > 0);  // at a post, what is beside it plays no part
        term.part = static_cast<float>(part);
        term.slope = {static_cast<float>(to.fall - from.fall),
                      static_cast<float>(to.ramp - from.ramp)};
        term.begin = -column;
        term.end = sheet_.columns - column - (part > 0);
        return term;
    }

    /// Appends the ground of all columns that such rays cross between row `at - 1` and row `at`.
    /// @param offset  of the rays from the lines, columns
    template <typename Terms>
    void add_column_terms(int at, double offset, const RowPlan& to, Terms& terms) const {
        const RowPlan &a = row(at - 1), &b = row(at);
        const double from = a.shift + offset, until = b.shift + offset;
        const double low = std::min(from, until) + kOnLine, high = std::max(from, until) - kOnLine;
        for (double column = std::ceil(low); column <= high; ++column) {
            const double part = (column - from) / (until - from);
            Term term;
            term.p = (at - 1) * sheet_.stride + static_cast<int>(column);
            term.q = term.p + sheet_.stride;
            term.part = static_cast<float>(part);
            term.slope = {static_cast<float>(to.fall - (a.fall + part * (b.fall - a.fall))),
                          static_cast<float>(to.ramp - (a.ramp + part * (b.ramp - a.ramp)))};
            term.begin = -static_cast<int>(column);
            term.end = sheet_.columns - static_cast<int>(column);
            terms.push_back(term);
        }
    }

  private:
    /// The rows from that of the reference on, so that what is found does not hang on where a sweep
    /// begins. @param step  1: away from the sun, -1: towards it
    void fill(int step) {
        const int first = static_cast<int>(sun_.reference.row);
        const int end = begin_ + static_cast<int>(rows_.size());
        RowPlan last;
        double before_m = 0, before_tangent = 0;
        for (int row = first; step > 0 ? row < end : row >= begin_; row += step) {
            RowPlan at;
            const double s = at.distance_m = sun_.distance_m(row);
            at.shift = sun_.reference.column + sun_.way(s).column;
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

    /// How far shade can reach over the window, and the first row from which it can.
    void find_begin(const SweepWindow& window, double drop_m) {
        const GridPair& more = sun_.tangent_a_post;
        const int right = window.column + window.columns - 1, end = window.row + window.rows - 1;
        const double tangent = sun_.tangent_at(more.column > 0 ? window.column : right,
                                               more.row > 0 ? window.row : end);
        // Towards the sun it stands higher still, by so much with each metre.
        const double a_metre = more.column * sun_.towards.column + more.row * sun_.towards.row;
        const double sum = tangent + std::sqrt(tangent * tangent + 2 * a_metre * drop_m);
        reach_m_ = a_metre >= 0 && sum > 0 ? kMargin * 2 * drop_m / sum
                                           : std::numeric_limits<double>::infinity();
        const double from_m = sun_.distance_m(window.row);
        begin_ = window.row;
        while (begin_ > 0 && sun_.distance_m(begin_) - from_m <= reach_m_ &&
               !std::isnan(sun_.distance_m(begin_ - 1)))
            --begin_;
    }

    static constexpr double kMargin = 1.05;  // of a reach

    const Sheet& sheet_;
    const SweepSun& sun_;
    double reach_m_ = 0;
    int begin_ = 0;
    std::vector<RowPlan> rows_;
};

/// All that a sweep does, row by row, the same for all strips.
struct Steps {
    struct Row {
        std::array<std::size_t, kLineSets + 1> lines{};  // where terms begin, and of the posts
        std::size_t end = 0;
        int column = 0;                    // of the post that belongs to line 0
        float between = 0;                 // how far on towards the next line each post stands
        Slope slope;                       // of lines, from the row before
        double fallen = 0;                 // line 0 from the row of the reference on
        Slope far_slope;                   // of posts' rays, from the last row that is not near
        int first_line = 0, end_line = 0;  // which come over posts of the window that it shades

        std::size_t& posts() { return lines[kLineSets]; }
        std::size_t posts() const { return lines[kLineSets]; }
    };
    std::vector<Term> terms;
    std::vector<Row> rows;  // from `begin` on
    int begin = 0;

    const Row& row(int row) const { return rows[static_cast<std::size_t>(row - begin)]; }
    /// How far line 0 has come from the row of the reference on, where tangents are 1.
    double distance_m(int at) const { return row(at).fallen; }
};

/// Which lines matter at each row to the posts of the window. Before a line comes over the grid
/// nothing is under it, and behind the window nobody looks at it.
void set_lines(const Plan& plan, const SweepWindow& window, Steps& steps) {
    const auto over = [&](int row) {
        const int column = steps.row(row).column;
        return std::pair(window.column - column, window.column + window.columns - column + 1);
    };
    const int last_row = window.row + window.rows - 1;
    const bool is_monotonic = plan.is_monotonic();
    std::pair<int, int> all{std::numeric_limits<int>::max(), std::numeric_limits<int>::min()};
    for (int row = window.row; row <= last_row; ++row)
        all = {std::min(all.first, over(row).first), std::max(all.second, over(row).second)};
    int reached = plan.begin();
    for (int row = plan.begin(); row <= last_row; ++row) {
        Steps::Row& step = steps.rows[static_cast<std::size_t>(row - steps.begin)];
        step.first_line = all.first, step.end_line = all.second;
        if (!is_monotonic) continue;
        reached = plan.reached(row, reached);
        const int next = std::max(row, window.row);
        const auto near = over(next), far = over(std::max(next, reached));
        int on_first = all.second, on_end = all.first;
        for (std::size_t k = step.lines[0]; k < step.posts(); ++k) {
            on_first = std::min(on_first, steps.terms[k].begin);
            on_end = std::max(on_end, steps.terms[k].end);
        }
        step.first_line = std::max(std::min(near.first, far.first), on_first);
        step.end_line = std::min(std::max(near.second, far.second), on_end);
    }
}

Steps steps_of(const Plan& plan, const SweepWindow& window) {
    const int first_row = window.row, end_row = window.row + window.rows;
    Steps steps;
    steps.begin = plan.begin();
    for (int row = plan.begin(); row < end_row; ++row) {
        Steps::Row step;
        const RowPlan& here = plan.row(row);
        step.fallen = here.fall;
        for (std::size_t set = 0; set < kLineSets; ++set) {
            const double offset = double(set) / kLineSets;
            step.lines[set] = steps.terms.size();
            steps.terms.push_back(plan.row_term(row, here.shift + offset, here));
            if (row > plan.begin()) plan.add_column_terms(row, offset, here, steps.terms);
            // In the order in which rays meet them: columns, and the row itself.
            std::sort(steps.terms.begin() + static_cast<std::ptrdiff_t>(step.lines[set]),
                      steps.terms.end(),
                      [&](const Term& a, const Term& b) { return a.slope.fall > b.slope.fall; });
            for (std::size_t k = step.lines[set]; k < steps.terms.size(); ++k)
                steps.terms[k].slope.fall += static_cast<float>(offset) * steps.terms[k].slope.ramp;
        }
        if (row > plan.begin()) {
            step.slope = {static_cast<float>(here.fall - plan.row(row - 1).fall),
                          static_cast<float>(here.ramp - plan.row(row - 1).ramp)};
        }
        step.posts() = steps.terms.size();
        step.column = static_cast<int>(std::ceil(here.shift - kOnLine));
        const double between = std::max(0.0, step.column - here.shift);
        step.between = static_cast<float>(between < kOnLine ? 0 : between);
        for (int at = row - 1; row >= first_row && at >= std::max(row - kNearRows, plan.begin());
             --at) {
            steps.terms.push_back(plan.row_term(at, plan.row(at).shift + between, here));
            plan.add_column_terms(at + 1, between, here, steps.terms);
        }
        step.end = steps.terms.size();
        for (std::size_t k = step.posts(); k < step.end; ++k)  // by the line that a post is on
            steps.terms[k].slope.fall += step.between * steps.terms[k].slope.ramp;
        if (const int at = row - kNearRows - 1; at >= plan.begin()) {
            const float ramp = static_cast<float>(here.ramp - plan.row(at).ramp);
            step.far_slope = {
                static_cast<float>(here.fall - plan.row(at).fall) + step.between * ramp, ramp};
        }
        steps.rows.push_back(step);
    }
    set_lines(plan, window, steps);
    return steps;
}

/// Lines next to each other, from the sun to the end of the window.
class Strip {
  public:
    static constexpr int kWidth = kStripLines;

    /// @param line  the first one
    Strip(const Sheet& sheet, const Steps& steps, Kernel kernel, int line, float floor_m)
        : sheet_(sheet), steps_(steps), kernel_(kernel), line_(line), floor_m_(floor_m) {
        for (Lines& lines : height_m_)
            lines.fill(kNothing_m);
    }

    /// Where its ground is, from now on.
    Sheet& sheet() { return sheet_; }

    /// To the next row, and the ground there.
    void advance(int row) {
        const Steps::Row& step = steps_.row(row);
        const int from = std::max(line_, step.first_line),
                  to = std::min(line_ + kLines, step.end_line);
        if (from >= to) return;
        for (std::size_t set = 0; set < kLineSets; ++set) {
            float* const lines = height_m_[set].data() + (from - line_);
            const float offset = static_cast<float>(set) / kLineSets;
            raise({.e = lines,
                   .before = lines,
                   .line = from,
                   .lines = to - from,
                   .slope = {step.slope.fall + offset * step.slope.ramp, step.slope.ramp}},
                  nullptr, step.lines[set], step.lines[set + 1]);
        }
    }

    /// The edge at the posts of a row, the lines having been left kNearRows + 1 rows before.
    /// @param first, end  of the columns that are wanted
    /// @param use         takes the first column, how many there are, and their edges
    template <typename Use>
    void edge(int row, int first, int end, const Use& use) {
        const Steps::Row& step = steps_.row(row);
        const int from = std::max(line_, first - step.column);
        const int to = std::min(line_ + kStripLines, end - step.column);
        if (from >= to) return;
        Ground far;
        if (row - kNearRows - 1 >= steps_.begin) {
            // The lines before and behind a post; the next one of the first set is one on.
            const float at = step.between * kLineSets;
            const auto set = static_cast<std::size_t>(at);
            far.part = at - static_cast<float>(set);
            far.p = height_m_[set].data() + (from - line_);
            far.q = set + 1 < kLineSets ? height_m_[set + 1].data() + (from - line_)
                                        : height_m_[0].data() + (from - line_) + 1;
            if (far.part == 0) far.q = far.p;
            far.slope = step.far_slope;
        }
        float* const e = edge_m_.data();
        raise({.e = e, .before = nullptr, .least = floor_m_, .line = from, .lines = to - from},
              far.p ? &far : nullptr, step.posts(), step.end);
        use(step.column + from, to - from, e);
    }

  private:
    static constexpr int kLines = kStripLines + 1;  // the posts of the last one lie before the next

    /// Lines fall, and rise to terms [begin, end).
    void raise(Lift lift, const Ground* far, std::size_t begin, std::size_t end) const {
        const int first = lift.line, last = lift.line + lift.lines;
        std::array<Ground, 16> ground;  // of which the first `count` are set
        std::size_t count = 0;
        if (far) ground[count++] = *far;
        lift.ground = ground.data();
        const auto settle = [&] {
            lift.grounds = static_cast<int>(std::exchange(count, 0));
            kernel_.raise(lift);
            lift.before = lift.e;
            lift.slope = {};
        };
        for (std::size_t k = begin; k < end; ++k) {
            const Term& term = steps_.terms[k];
            const int from = std::max(first, term.begin), to = std::min(last, term.end);
            if (from >= to) continue;
            const bool whole = from == first && to == last;
            if (!whole || count == ground.size()) settle();
            ground[count] = {sheet_.first + term.p + from, sheet_.first + term.q + from, term.part,
                             term.slope};
            if (whole) {
                ++count;
                continue;
            }
            float* const e = lift.e + (from - first);
            kernel_.raise({e, e, kNothing_m, from, to - from, {}, ground.data(), 1});
        }
        settle();
    }

    Sheet sheet_;
    const Steps& steps_;
    Kernel kernel_;
    int line_;
    float floor_m_;
    using Lines = std::array<float, kLines>;
    std::array<Lines, kLineSets> height_m_;
    std::array<float, kStripLines> edge_m_;
};

/// The upper convex hull of the ground under a line, from the sun on. Heights are less what the
/// ground has sunk by below the tangent plane of the reference.
class Hull {
  public:
    struct Point {
        float distance_m, height_m;  // away from the sun, over the plane
    };

    /// @param first  where its points are put, with room for as many as there will be
    explicit Hull(Point* first = nullptr) : first_(first) {}

    void add(const Point& point) {
        // The last one but for this goes where it lies under the line to the one before.
        while (count_ >= 2 && !is_over(first_[count_ - 1], first_[count_ - 2], point))
            --count_;
        first_[count_++] = point;
    }

    /// The tangent at which the hull is seen, for an eye that is farther from the sun than it.
    float tangent(const Point& eye) const {
        float best = kNothing_m;
        for (int k = count_ - 1; k >= 0; --k) {
            const float seen =
                (first_[k].height_m - eye.height_m) / (eye.distance_m - first_[k].distance_m);
            if (!(seen > best)) break;
            best = seen;
        }
        return best;
    }

  private:
    static bool is_over(const Point& middle, const Point& before, const Point& after) {
        return (middle.height_m - before.height_m) * (after.distance_m - before.distance_m) >
               (after.height_m - before.height_m) * (middle.distance_m - before.distance_m);
    }

    Point* first_;
    int count_ = 0;
};

/// Lines next to each other, with the hulls of the ground under them.
class HullStrip {
  public:
    static constexpr int kLines = 128, kWidth = kLines;

    /// @param steps      for a tangent of 1 everywhere: what lines fall by is how far they go
    /// @param line       the first one
    /// @param curvature  [1/m]
    HullStrip(const Sheet& sheet, const Steps& steps, const Kernel& kernel, double curvature,
              int line)
        : sheet_(sheet), steps_(steps), kernel_(kernel), curvature_(curvature), line_(line) {
        std::size_t most = 0;  // no line meets more, and no memory is touched before it does
        for (const Steps::Row& row : steps.rows)
            most += row.posts() - row.lines[0];
        points_ = std::make_unique_for_overwrite<Hull::Point[]>(kLineSets * (kLines + 1) * most);
        for (std::size_t i = 0; i < kLineSets * (kLines + 1); ++i)
            hulls_[i / (kLines + 1)][i % (kLines + 1)] = Hull(points_.get() + i * most);
    }

    Sheet& sheet() { return sheet_; }

    /// The ground of the next row, and of the columns before it.
    void advance(int row) {
        const Steps::Row& step = steps_.row(row);
        for (std::size_t set = 0; set < kLineSets; ++set)
            for (std::size_t k = step.lines[set]; k < step.lines[set + 1]; ++k)
                add(set, steps_.terms[k], step);
    }

    template <typename Use>
    void look(int row, int first, int end, const Use& use) {
        const Steps::Row& step = steps_.row(row);
        const int from = std::max(line_, first - step.column);
        const int to = std::min(line_ + kLines, end - step.column);
        if (from >= to) return;
        const float* const height = sheet_.first + row * sheet_.stride + step.column + from;
        std::array<float, kLines> tangent;
        const double s = steps_.distance_m(row);
        const float sunk_m = static_cast<float>(curvature_ * s * s / 2),
                    tilt = static_cast<float>(curvature_ * s);
        // The line nearest to a post.
        const int half = static_cast<int>(step.between * 2 * kLineSets + 1) / 2;
        const auto& hulls = hulls_[static_cast<std::size_t>(half) % kLineSets];
        const int on = half / static_cast<int>(kLineSets) - line_;
        for (int i = from; i < to; ++i)
            tangent[static_cast<std::size_t>(i - from)] =
                hulls[static_cast<std::size_t>(i + on)].tangent(
                    {static_cast<float>(s), height[i - from] - sunk_m}) -
                tilt;
        look_near(step, from, to, height, tangent.data());
        use(step.column + from, to - from, tangent.data());
    }

  private:
    void add(std::size_t set, const Term& term, const Steps::Row& step) {
        const double s = step.fallen - term.slope.fall;
        const float distance_m = static_cast<float>(s),
                    sunk_m = static_cast<float>(curvature_ * s * s / 2);
        const int from = std::max({line_, term.begin, step.first_line}),
                  to = std::min({line_ + kLines + 1, term.end, step.end_line});
        const float *const p = sheet_.first + term.p, *const q = sheet_.first + term.q;
        for (int i = from; i < to; ++i) {
            const float height_m = p[i] + term.part * (q[i] - p[i]);
            if (!std::isnan(height_m))
                hulls_[set][static_cast<std::size_t>(i - line_)].add(
                    {distance_m, height_m - sunk_m});
        }
    }

    void look_near(const Steps::Row& step, int from, int to, const float* height_m,
                   float* tangent) const {
        for (std::size_t k = step.posts(); k < step.end; ++k) {
            const Term& term = steps_.terms[k];
            const int first = std::max(from, term.begin), last = std::min(to, term.end);
            if (first >= last) continue;
            const double d = term.slope.fall;
            const Ground ground{
                sheet_.first + term.p + first,
                sheet_.first + term.q + first,
                term.part,
                {static_cast<float>(1 / d), static_cast<float>(curvature_ * d / 2)}};
            kernel_.look(
                {tangent + (first - from), height_m + (first - from), last - first, &ground, 1});
        }
    }

    Sheet sheet_;
    const Steps& steps_;
    const Kernel& kernel_;
    double curvature_;
    int line_;
    std::unique_ptr<Hull::Point[]> points_;
    std::array<std::array<Hull, kLines + 1>, kLineSets> hulls_;
};

/// What lies where on a sheet for a sweep.
struct Extent {
    int first_line = std::numeric_limits<int>::max(), end_line = std::numeric_limits<int>::min();

    Extent(const Steps& steps, const SweepWindow& window) {
        for (int row = window.row; row < window.row + window.rows; ++row) {
            first_line = std::min(first_line, window.column - steps.row(row).column);
            end_line = std::max(end_line, window.column + window.columns - steps.row(row).column);
        }
    }
};

/// Rows that ground is read for together, and those before them that it takes besides: posts look
/// back over kNearRows of them, and lines that are left behind those cross the columns before.
constexpr int kReadRows = 256, kRowsBefore = kNearRows + 2;

constexpr int kTransposeBlock = 4;  // posts a side

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
        s -= (way(s).row - posts) / slope;
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
    struct Range {
        float lowest = kInfinity, highest = -kInfinity;
    };
    std::vector<Range> of_rows(static_cast<std::size_t>(rows));
    parallel_for(0, rows, 64, [&](int first, int last) {
        for (int row = first; row < last; ++row) {
            Range range;
            for (int column = 0; column < columns; ++column) {
                const float h = height_m[row * stride + column];
                range.lowest = h < range.lowest ? h : range.lowest;
                range.highest = h > range.highest ? h : range.highest;
            }
            of_rows[static_cast<std::size_t>(row)] = range;
        }
    });
    lowest_m_ = kInfinity, highest_m_ = -kInfinity;
    for (const Range& range : of_rows) {
        lowest_m_ = std::min(lowest_m_, range.lowest);
        highest_m_ = std::max(highest_m_, range.highest);
    }
}

const float* Sweep::transposed() const {
    std::call_once(once_, [&] {
        transposed_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
        transpose(height_m_, stride_, rows_, columns_, transposed_.data(), rows_);
    });
    return transposed_.data();
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

/// Has strips of lines over a window go from the first row that matters to its last.
/// @param make  a strip from the steps and its first line
/// @param look  at a row of the window with a strip
template <typename OneStrip, typename Make, typename Look>
void Sweep::sweep_strips(View& view, double drop_m, const Make& make, const Look& look) const {
    const SweepWindow& w = view.window;
    Sheet& sheet = view.sheet;
    const Plan plan(sheet, view.sun, w, drop_m);
    constexpr int kLines = OneStrip::kWidth;
    // Ground that is read has room for a strip, and how far that goes aside over the rows.
    const auto rows_before = [&](int row) { return std::max(plan.begin(), row - kRowsBefore); };
    if (read_) {
        double aside = 0;
        for (int row = plan.begin(); row < plan.end(); row += kReadRows) {
            const auto [least, most] =
                plan.columns(rows_before(row), std::min(row + kReadRows, plan.end()));
            aside = std::max(aside, most - least);
        }
        sheet.stride = kLines + static_cast<int>(std::ceil(aside)) + 8;
    }
    const Steps steps = steps_of(plan, w);
    const Extent extent(steps, w);
    const int strips = (extent.end_line - extent.first_line + kLines - 1) / kLines;
    parallel_for(0, strips, 1, [&](int begin, int end) {
        std::vector<float> buffer;
        for (int k = begin; k < end; ++k) {
            const int line = extent.first_line + k * kLines;
            auto strip = make(steps, line);
            for (int row = steps.begin; row < plan.end(); ++row) {
                if (read_ && (row - steps.begin) % kReadRows == 0) {
                    const int first = rows_before(row),
                              last = std::min(row + kReadRows, plan.end());
                    const auto [least, most] = plan.columns(first, last);
                    const int column = std::max(0, static_cast<int>(std::floor(least)) + line - 2);
                    const int end_column = std::min(
                        sheet.columns, static_cast<int>(std::ceil(most)) + line + kLines + 4);
                    if (column < end_column)
                        view.read(read_, strip->sheet(), first, last, column, end_column, buffer);
                }
                if (const int at = row - kNearRows - 1; at >= steps.begin) strip->advance(at);
                if (row >= w.row) look(*strip, row);
            }
        }
    });
}

void Sweep::each_edge(const SweepSun& given, const SweepWindow& window, const Use& use, int lanes,
                      float floor_m) const {
    View view = this->view(given, window);
    SweepSun& sun = view.sun;
    if (!(std::abs(sun.tangent) < kSteepest)) {
        sun.tangent = std::copysign(kSteepest, sun.tangent);
        sun.tangent_a_post = {};
    }
    const SweepWindow& w = view.window;
    const double drop_m =
        std::max(0.0, double{highest_m_} - (floor_m > kNoFloor_m ? floor_m : lowest_m_));
    const Kernel kernel = widest_kernel(lanes);
    sweep_strips<Strip>(
        view, drop_m,
        [&](const Steps& steps, int line) {
            return std::make_unique<Strip>(view.sheet, steps, kernel, line, floor_m);
        },
        [&](Strip& strip, int row) {
            strip.edge(row, w.column, w.column + w.columns,
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
    const Kernel kernel = widest_kernel(lanes);
    sweep_strips<HullStrip>(
        view, reach_m,
        [&](const Steps& steps, int line) {
            return std::make_unique<HullStrip>(view.sheet, steps, kernel, curvature, line);
        },
        [&](HullStrip& strip, int row) {
            strip.look(row, w.column, w.column + w.columns,
                       [&](int column, int count, const float* tangent) {
                           use(view.run(strip.sheet(), row, column, count, tangent));
                       });
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
