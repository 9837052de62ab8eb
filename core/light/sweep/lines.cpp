#include "light/sweep/lines.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace relevo::light {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMargin = 1.05;  // of a reach

}  // namespace

double reach_m(const SweepSun& sun, const Window& window, double most_fall_m) {
    const glm::dvec2& more = sun.tangent_per_post;
    const double lowest = sun.tangent_at(more.x > 0 ? window.column : window.end_column() - 1,
                                         more.y > 0 ? window.row : window.end_row() - 1);
    // Towards the sun it stands higher still, by so much with each metre.
    const double a_metre = more.x * sun.ray.first.x + more.y * sun.ray.first.y;
    const double sum = lowest + std::sqrt(lowest * lowest + 2 * a_metre * most_fall_m);
    return a_metre >= 0 && sum > 0 ? kMargin * 2 * most_fall_m / sum : kInfinity;
}

SweepLines::SweepLines(const Sheet& sheet, const SweepSun& sun, const SheetPosts& posts,
                       const Sampling& sampling, double most_fall_m)
    : sampling_(sampling), first_wanted_(posts.window.row) {
    add_rows(sun, posts, most_fall_m);
    find_line_ranges(sheet, posts, reach_m(sun, posts.window, most_fall_m));
    find_ground_columns();
}

void SweepLines::add_rows(const SweepSun& sun, const SheetPosts& posts, double most_fall_m) {
    const Window& window = posts.window;
    const double far_m = sun.ray.distance_m(window.row) + reach_m(sun, window, most_fall_m);
    const auto row_at = [&](double s) {
        Row at;
        at.distance_m = s;
        at.shift = sun.ray.reference.x + sun.ray.way(s).x;
        const glm::dvec2 ways = sun.ray.way_integral(s);
        at.fall_m =
            -(sun.tangent * s + sun.tangent_per_post.x * ways.x + sun.tangent_per_post.y * ways.y);
        at.fall_per_line_m = -s * sun.tangent_per_post.x;
        at.column = ceil_of(at.shift - kOnPost);
        const double offset = std::max(0.0, at.column - at.shift);
        at.post_offset = static_cast<float>(offset < kOnPost ? 0 : offset);
        return at;
    };
    // Towards the sun, some rows at once.
    constexpr int kRows = 64;
    int begin = window.row;
    std::vector<double> distances_m = sun.ray.distances_m(begin, window.end_row());
    const auto is_enough = [&] { return !(distances_m.front() <= far_m); };
    while (begin > 0 && !is_enough()) {
        const int next = std::max(0, begin - kRows);
        const std::vector<double> before = sun.ray.distances_m(next, begin);
        distances_m.insert(distances_m.begin(), before.begin(), before.end());
        begin = next;
    }
    for (int row = window.end_row() - 1; row >= begin; --row) {
        const double distance_m = distances_m[static_cast<std::size_t>(row - begin)];
        if (std::isnan(distance_m)) break;  // turned back: it comes over no further ground
        const Row at = row_at(distance_m);
        rows_.push_back(at);
        if (row <= window.row && at.distance_m > far_m) break;
    }
    std::reverse(rows_.begin(), rows_.end());
    begin_ = window.end_row() - static_cast<int>(rows_.size());
}

ColumnRange SweepLines::columns(int first, int end_row) const {
    double least = row(first).shift, most = least;
    for (int at = first + 1; at < end_row; ++at)
        least = std::min(least, row(at).shift), most = std::max(most, row(at).shift);
    return {floor_of(least), ceil_of(most) + 1};
}

void SweepLines::find_line_ranges(const Sheet& sheet, const SheetPosts& posts, double reach_m) {
    const int first = std::max(begin_, posts.window.row);
    const auto over = [&](int row) {
        const ColumnRange columns = posts.at(row);
        const int column = this->row(row).column;
        return ColumnRange{columns.begin - column, columns.end - column};
    };
    lines_ = {std::numeric_limits<int>::max(), std::numeric_limits<int>::min()};
    bool falls = true, rises = true;
    for (int row = begin_; row < end(); ++row) {
        if (row > begin_) {
            falls &= this->row(row).shift <= this->row(row - 1).shift;
            rises &= this->row(row).shift >= this->row(row - 1).shift;
        }
        if (row < first || posts.at(row).is_empty()) continue;
        lines_ = {std::min(lines_.begin, over(row).begin), std::max(lines_.end, over(row).end)};
    }
    if (lines_.begin > lines_.end) lines_ = {};  // no posts are wanted
    // A line matters from where it has ground to where shade of that ground reaches. All lines are
    // kept where they turn back aside, or where the window's border is bent.
    const bool is_simple = (falls || rises) && posts.ranges.empty();
    int reached = first;
    for (int at = begin_; at < end(); ++at) {
        Row& row = rows_[static_cast<std::size_t>(at - begin_)];
        row.lines = {lines_.begin, lines_.end + 1};
        if (!is_simple) continue;
        reached = std::max(reached, at);
        while (reached + 1 < end() && row.distance_m - this->row(reached).distance_m <= reach_m)
            ++reached;
        const ColumnRange near = over(std::max(at, first)), far = over(reached);
        const ColumnRange ground = columns(std::max(at - 1, begin_), at + 1);
        row.lines = {std::max(std::min(near.begin, far.begin), -ground.end - 1),
                     std::min(std::max(near.end, far.end) + 1, sheet.columns - ground.begin)};
    }
}

void SweepLines::find_ground_columns() {
    for (int at = begin_; at < end(); ++at) {
        const ColumnRange columns =
            this->columns(std::max(begin_, at - 1), std::min(end(), at + 2));
        Row& row = rows_[static_cast<std::size_t>(at - begin_)];
        row.ground_column = columns.begin - 1;
        ground_columns_ = std::max(ground_columns_, columns.end + 2 - row.ground_column);
    }
}

void SweepLines::add_crossing(const Crossing& crossing, double distance_m) {
    crossings_.push_back(crossing);
    if (sampling_.distances) distances_m_.push_back(distance_m);
}

/// The ground on a row, of rays that are at `shift` there.
/// @param from_m  where distances are counted from
void SweepLines::add_row_crossing(int row, double shift, double from_m) {
    int column = floor_of(shift);
    double part = shift - column;
    if (part > 1 - kOnPost) {
        ++column;
        part = 0;
    } else if (part < kOnPost) {
        part = 0;
    }
    const int at = origin(row) + column;  // at a post, what is beside it plays no part
    add_crossing({at, at + (part > 0), static_cast<float>(part)},
                 this->row(row).distance_m - from_m);
}

/// The ground on all columns that rays cross between row `row - 1` and row `row`.
/// @param offset  of the rays from the lines, columns
void SweepLines::add_column_crossings(int row, double offset, double from_m) {
    const Row &a = this->row(row - 1), &b = this->row(row);
    const double from = a.shift + offset, until = b.shift + offset;
    const double low = std::min(from, until) + kOnPost, high = std::max(from, until) - kOnPost;
    const int before = origin(row - 1), here = origin(row);
    for (int column = ceil_of(low); column <= high; ++column) {
        const double part = (column - from) / (until - from);
        add_crossing({before + column, here + column, static_cast<float>(part)},
                     a.distance_m + part * (b.distance_m - a.distance_m) - from_m);
    }
}

void SweepLines::find_crossings(int pitch, int kept) {
    pitch_ = pitch, kept_ = kept;
    // Rays pass no more columns than rows, but where they are bent.
    crossings_.reserve(rows_.size() * 2 *
                       static_cast<std::size_t>(sampling_.line_sets + sampling_.near_rows + 1));
    const auto next = [&] { begins_.push_back(static_cast<std::uint32_t>(crossings_.size())); };
    for (int at = begin_; at < end(); ++at) {
        const Row& here = row(at);
        for (int set = 0; set < sampling_.line_sets; ++set) {
            next();
            const double offset = double(set) / sampling_.line_sets;
            add_row_crossing(at, here.shift + offset, here.distance_m);
            if (at > begin_) add_column_crossings(at, offset, here.distance_m);
        }
        next();
        if (at < first_wanted_) continue;
        const double offset = std::max(0.0, here.column - here.shift);
        for (int near = at - 1; near >= std::max(at - sampling_.near_rows, begin_); --near) {
            add_row_crossing(near, row(near).shift + offset, here.distance_m);
            add_column_crossings(near + 1, offset, here.distance_m);
        }
        // Lines have been raised to the row before those, not on their way from there.
        if (const int far = at - sampling_.near_rows - 1; far >= begin_)
            add_column_crossings(far + 1, offset, here.distance_m);
    }
    next();
}

std::span<const Crossing> SweepLines::crossings_of(int k, int row) const {
    const auto i = static_cast<std::size_t>((row - begin_) * (sampling_.line_sets + 1) + k);
    return std::span(crossings_).subspan(begins_[i], begins_[i + 1] - begins_[i]);
}

}  // namespace relevo::light
