#include "light/point/ground_at.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/error.h"
#include "base/units.h"
#include "light/point/line_of_sight.h"

namespace relevo::light {
namespace {

double snapped(double index) {
    const double nearest = std::round(index);
    return std::abs(index - nearest) <= kSnap_cells ? nearest : index;
}

/// "latitudes 47 to 48 and longitudes 11 to 12", of the posts.
std::string extent_text(const dem::Grid& grid) {
    double south = kInfinity, north = -kInfinity, west = kInfinity, east = -kInfinity;
    const geo::Geodetic center = grid.center();
    constexpr int kSteps = 16;
    for (int i = 0; i <= kSteps; ++i)
        for (int k = 0; k <= kSteps; ++k) {
            const geo::Geodetic p = grid.place((grid.columns() - 1) * i / double{kSteps},
                                               (grid.rows() - 1) * k / double{kSteps});
            if (!std::isfinite(p.lat_rad)) continue;
            const double lon_deg =
                degrees(center.lon_rad + std::remainder(p.lon_rad - center.lon_rad, 2 * kPi));
            south = std::min(south, degrees(p.lat_rad));
            north = std::max(north, degrees(p.lat_rad));
            west = std::min(west, lon_deg);
            east = std::max(east, lon_deg);
        }
    return fmt::format("latitudes {:.4f} to {:.4f} and longitudes {:.4f} to {:.4f}", south, north,
                       west, east);
}

/// The posts of a DEM within `reach` columns and rows of one.
dem::Window window_around(const dem::Grid& grid, const glm::ivec2& post, const glm::ivec2& reach) {
    const glm::ivec2 first = glm::max(post - reach, 0);
    const glm::ivec2 last = glm::min(post + reach, glm::ivec2(grid.columns(), grid.rows()) - 1);
    return {first.x, first.y, last.x - first.x + 1, last.y - first.y + 1};
}

/// Calls `visit(column, row, height_m)` for the posts of a window, row by row; NaN in voids.
template <typename Visit>
void each_post(const dem::Posts& posts, const dem::Window& window, const Visit& visit) {
    std::vector<float> buffer;
    for (int row = window.row; row < window.row + window.rows; ++row) {
        const dem::Posts::View view = posts.view({window.column, row, window.columns, 1}, buffer);
        for (int column = window.column; column < window.column + window.columns; ++column)
            visit(column, row, double{*view.at(column, row)});
    }
}

/// "; a post with a height is at LAT,LON", as a remedy: the nearest; empty without one near.
std::string nearest_height_text(const dem::Posts& posts, const glm::ivec2& post) {
    constexpr int kFarthest = 2048;
    const dem::Grid& grid = posts.grid();
    for (int reach = 16; reach <= kFarthest; reach *= 2) {
        int least = reach + 1;
        glm::ivec2 nearest(0);
        each_post(posts, window_around(grid, post, glm::ivec2(reach)),
                  [&](int column, int row, double height_m) {
                      const int apart = std::max(std::abs(column - post.x), std::abs(row - post.y));
                      if (std::isnan(height_m) || apart >= least) return;
                      least = apart;
                      nearest = {column, row};
                  });
        if (least <= reach)
            return "; a post with a height is at " + place_text(grid.place(nearest.x, nearest.y));
    }
    return {};
}

}  // namespace

std::string place_text(const geo::Geodetic& place) {
    return fmt::format("{:.7g},{:.7g}", degrees(place.lat_rad), degrees(place.lon_rad));
}

bool is_within(const dem::Grid& grid, const glm::dvec2& post) {
    return post.x >= -kSnap_cells && post.x <= grid.columns() - 1 + kSnap_cells &&
           post.y >= -kSnap_cells && post.y <= grid.rows() - 1 + kSnap_cells;
}

Ground ground_at(const dem::Posts& posts, const geo::Geodetic& place) {
    const dem::Grid& grid = posts.grid();
    glm::dvec2 post = grid.post(place);
    post = {snapped(post.x), snapped(post.y)};
    if (!is_within(grid, post)) {
        const geo::Geodetic swapped{place.lon_rad, place.lat_rad, 0};
        const bool is_swapped =
            std::abs(swapped.lat_rad) <= kPi / 2 && is_within(grid, grid.post(swapped));
        bad_input(fmt::format("horizon: {}: outside of the DEM, expected a point within {}{}",
                              place_text(place), extent_text(grid),
                              is_swapped ? "; latitude comes first" : ""));
    }
    const double height_m = posts.height_at(post.x, post.y);
    if (std::isnan(height_m)) {
        const glm::ivec2 nearest = glm::ivec2(std::lround(post.x), std::lround(post.y));
        bad_input(fmt::format("horizon: {}: the point is {}{}", place_text(place),
                              posts.is_outside(nearest.x, nearest.y)
                                  ? "outside the ground of the DEM"
                                  : "in a void of the DEM",
                              nearest_height_text(posts, nearest)));
    }
    return {post, height_m};
}

geo::Geodetic summit_near(const dem::Posts& given, const geo::Geodetic& place, double radius_m) {
    if (given.surroundings() && !is_within(given.grid(), given.grid().post(place)))
        return summit_near(*given.surroundings(), place, radius_m);
    const std::optional<dem::Posts> unrolled = dem::Posts::around(given, place);
    const dem::Posts& posts = unrolled ? *unrolled : given;
    const dem::Grid& grid = posts.grid();
    const auto [post, ground_m] = ground_at(posts, place);
    const glm::dvec2 spacing_m = grid.post_spacing_m();
    const glm::ivec2 reach(glm::min(radius_m / spacing_m, glm::dvec2(grid.columns(), grid.rows())));
    const glm::ivec2 nearest(std::lround(post.x), std::lround(post.y));
    glm::dvec2 at = post;
    double highest_m = ground_m;
    each_post(posts, window_around(grid, nearest, reach),
              [&](int column, int row, double height_m) {
                  const glm::dvec2 here(column, row);
                  if (height_m > highest_m && glm::length((here - post) * spacing_m) <= radius_m) {
                      highest_m = height_m;
                      at = here;
                  }
              });
    geo::Geodetic summit = grid.place(at.x, at.y);
    summit.height_m = highest_m;
    return summit;
}

}  // namespace relevo::light
