#include "output/ground_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"

namespace relevo::output {
namespace {

/// Ground metres in a unit of x and of y, at a point.
glm::dvec2 ground_metres(const dem::Grid& grid, const glm::dvec2& at) {
    const dem::Affine& affine = grid.affine();
    const double step = std::min(std::hypot(affine.x_column, affine.y_column),
                                 std::hypot(affine.x_row, affine.y_row));
    const auto along = [&](const glm::dvec2& way) {
        const glm::dvec2 half = 0.5 * step * way;
        const geo::Geodetic from = grid.crs().to_geodetic(at.x - half.x, at.y - half.y);
        const geo::Geodetic to = grid.crs().to_geodetic(at.x + half.x, at.y + half.y);
        return geo::geodesic(from, to).distance_m / step;
    };
    return {along({1, 0}), along({0, 1})};
}

}  // namespace

GroundFrame::GroundFrame(const dem::Grid& grid, bool flat)
    : grid_(grid), is_flat_(flat), frame_(grid.center()) {
    if (!flat) return;
    origin_crs_ = grid.affine()(0.5 * (grid.columns() - 1), 0.5 * (grid.rows() - 1));
    metres_a_unit_ = ground_metres(grid, origin_crs_);
    constexpr double kLeast = 1e-3;  // of a degree of longitude, against one of latitude
    if (!(metres_a_unit_.x > kLeast * metres_a_unit_.y))
        bad_input(
            fmt::format("--flat: {} has no plane at the DEM's centre, a pole; leave --flat and "
                        "--base out, or bring it to a polar CRS with gdalwarp",
                        grid.crs().name()));
}

void GroundFrame::place(std::span<const glm::dvec2> posts, std::span<const double> height_m,
                        std::span<Point> points) const {
    if (is_flat_) {
        for (std::size_t i = 0; i < posts.size(); ++i) {
            const glm::dvec2 at =
                (grid_.affine()(posts[i].x, posts[i].y) - origin_crs_) * metres_a_unit_;
            points[i] = {{at, height_m[i]}, {0, 0, 1}};
        }
        return;
    }
    std::vector<geo::Geodetic> places(posts.size());
    grid_.place(posts, places);
    for (std::size_t i = 0; i < posts.size(); ++i) {
        places[i].height_m = height_m[i];
        points[i] = {frame_.to_local(places[i]), frame_.up(places[i].lat_rad, places[i].lon_rad)};
    }
}

double GroundFrame::bend_m() const {
    if (is_flat_) return 0;
    constexpr int kSamples = 7;
    constexpr std::array<glm::dvec2, 4> kWays{{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};
    const glm::dvec2 last(grid_.columns() - 1, grid_.rows() - 1);
    const double step = std::min(1.0, 0.5 * std::min(last.x, last.y));
    // Differences over many posts: those of a few metres would be lost in rounding.
    const double reach = std::max(step, std::floor(0.02 * std::min(last.x, last.y)));
    const std::array<double, 3> heights{};
    double most_m = 0;
    for (int k = 0; k < kSamples * kSamples; ++k) {
        const glm::dvec2 share = glm::dvec2(k % kSamples, k / kSamples) / (kSamples - 1.0);
        const glm::dvec2 at = reach + share * (last - 2 * reach);
        for (const glm::dvec2& way : kWays) {
            const std::array<glm::dvec2, 3> posts{at - reach * way, at, at + reach * way};
            std::array<Point, 3> points{};
            place(posts, heights, points);
            const glm::dvec3 second = points[0].at_m + points[2].at_m - 2.0 * points[1].at_m;
            const double bend_m = glm::length(second) / (reach * reach * glm::dot(way, way));
            if (std::isfinite(bend_m)) most_m = std::max(most_m, bend_m);
        }
    }
    return most_m;
}

}  // namespace relevo::output
