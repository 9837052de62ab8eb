#include "light/edge_ground.h"

#include <cassert>
#include <utility>

namespace relevo::light {
namespace {

bool is_on(const dem::Grid& grid, const glm::dvec2& post) {
    return post.x > -0.5 && post.y > -0.5 && post.x < grid.columns() - 0.5 &&
           post.y < grid.rows() - 0.5;
}

double height_near(const dem::Posts& posts, const glm::dvec2& post) {
    return posts.thinned_m(static_cast<int>(std::lround(post.x)),
                           static_cast<int>(std::lround(post.y)));
}

/// Calls `use` with distances and posts along a line of sight, as far apart as thinned posts are,
/// until the line leaves the grid or `use` returns false.
template <typename Use>
void each_near(const dem::Posts& posts, std::span<const TracePoint> line, const Use& use) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const TracePoint &from = line[i], &to = line[i + 1];
        const glm::dvec2 way = to.post - from.post;
        const double posts_on = std::max(std::abs(way.x), std::abs(way.y));
        const int steps = std::max(1, static_cast<int>(std::ceil(posts_on / posts.thinning())));
        for (int k = i == 0 ? 0 : 1; k <= steps; ++k) {
            const double share = double(k) / steps;
            const glm::dvec2 post = from.post + share * way;
            if (!is_on(posts.grid(), post)) return;
            if (!use(from.distance_m + share * (to.distance_m - from.distance_m),
                     static_cast<int>(std::lround(post.x)), static_cast<int>(std::lround(post.y))))
                return;
        }
    }
}

}  // namespace

std::optional<Edge> edge_along(const dem::Posts& posts, std::span<const TracePoint> line) {
    EdgeFinder finder;
    each_near(posts, line, [&](double distance_m, int column, int row) {
        finder.add(distance_m, posts.thinned_m(column, row));
        return true;
    });
    return finder.edge();
}

double outside_from_m(const dem::Posts& posts, std::span<const TracePoint> line) {
    double from_m = std::numeric_limits<double>::infinity();
    each_near(posts, line, [&](double distance_m, int column, int row) {
        if (!std::isnan(posts.thinned_m(column, row)) || !posts.is_outside(column, row))
            return true;
        from_m = distance_m;
        return false;
    });
    return from_m;
}

constexpr double kNowhere = -std::numeric_limits<double>::infinity();

RayEdges::RayEdges(const dem::Posts& posts, const SweepSun& path, const SweepWindow& window,
                   const std::vector<GridPair>& marks, double reach_m)
    : path_(path.along_columns() ? path.transposed() : path), along_columns_(path.along_columns()) {
    std::vector<GridPair> corners = marks;
    if (marks.empty())
        for (const int column : {window.column, window.column + window.columns - 1})
            for (const int row : {window.row, window.row + window.rows - 1})
                corners.push_back({double(column), double(row)});
    double begin_m = std::numeric_limits<double>::infinity(), end_m = -begin_m;
    double first = begin_m, last = -begin_m;
    for (GridPair at : corners) {
        if (along_columns_) std::swap(at.column, at.row);
        const double s = path_.distance_m(at.row);
        if (std::isnan(s)) continue;
        const double line = at.column - path_.reference.column - path_.way(s).column;
        begin_m = std::min(begin_m, s), end_m = std::max(end_m, s);
        first = std::min(first, line), last = std::max(last, line);
    }
    if (!(first <= last)) return;
    // Rays are bent between the corners.
    const int beside = 8 + static_cast<int>((last - first) / 32);
    const int step = posts.thinning();
    const double step_m =
        step / std::max(std::abs(path.towards.column), std::abs(path.towards.row));
    first_line_ = static_cast<int>(std::floor(first)) - beside;
    const int lines = static_cast<int>(std::ceil(last)) + beside + 1 - first_line_;
    height_m_.resize(static_cast<std::size_t>(lines));
    distance_m_.resize(height_m_.size());
    for (int line = 0; line < lines; line += step) {
        const int middle = std::min(line + step / 2, lines - 1);
        const Edge edge =
            find(posts, first_line_ + middle, begin_m - step_m, end_m + reach_m, step_m);
        const auto begin = static_cast<std::size_t>(line),
                   end = static_cast<std::size_t>(std::min(line + step, lines));
        std::fill(height_m_.begin() + begin, height_m_.begin() + end,
                  static_cast<float>(edge.height_m));
        std::fill(distance_m_.begin() + begin, distance_m_.begin() + end,
                  static_cast<float>(edge.distance_m));
    }
}

Edge RayEdges::find(const dem::Posts& posts, double line, double begin_m, double end_m,
                    double step_m) const {
    EdgeFinder finder;
    bool inside = false;
    for (double s = begin_m; s <= end_m; s += step_m) {
        const GridPair way = path_.way(s);
        glm::dvec2 post(path_.reference.column + line + way.column, path_.reference.row + way.row);
        if (along_columns_) std::swap(post.x, post.y);
        const bool on = is_on(posts.grid(), post);
        if (inside && !on) break;
        inside = on;
        if (on) finder.add(s, height_near(posts, post));
    }
    return finder.edge().value_or(Edge{0, kNowhere});
}

RayEdges::OfRun RayEdges::of(const SweepRun& run) const {
    static const std::vector<float> kNone(kLongestRun, -std::numeric_limits<float>::infinity());
    assert(run.count <= kLongestRun);
    const double from_m = path_.distance_m(run.line);
    if (std::isnan(from_m)) return {kNone.data(), kNone.data(), 0};
    const double line = run.first - path_.reference.column - path_.way(from_m).column - first_line_;
    const auto first = static_cast<std::ptrdiff_t>(std::lround(line));
    if (first < 0 || first + run.count > std::ssize(height_m_))
        return {kNone.data(), kNone.data(), 0};
    return {height_m_.data() + first, distance_m_.data() + first, from_m};
}

}  // namespace relevo::light
