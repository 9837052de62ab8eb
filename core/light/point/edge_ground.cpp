#include "light/point/edge_ground.h"

#include <cassert>
#include <utility>

namespace relevo::light {

bool is_on(const dem::Grid& grid, const glm::dvec2& post) {
    return post.x > -0.5 && post.y > -0.5 && post.x < grid.columns() - 0.5 &&
           post.y < grid.rows() - 0.5;
}

double height_near(const dem::Posts& posts, const glm::dvec2& post) {
    return posts.thinned_m(static_cast<int>(std::lround(post.x)),
                           static_cast<int>(std::lround(post.y)));
}

namespace {

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

}  // namespace relevo::light
