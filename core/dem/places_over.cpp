#include "dem/places_over.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "base/parallel_for.h"
#include "base/units.h"

namespace relevo::dem {
namespace {

constexpr double kMostOff = 0.05;  // cells of the raster, or points where they are wider

}  // namespace

PlacesOver::PlacesOver(const Grid& dem, const Grid& raster, const PointsOver& points)
    : dem_(dem),
      raster_(raster),
      points_(points),
      same_crs_(dem.crs().text() == raster.crs().text()),
      linear_(is_linear()) {
    if (linear_) return;
    net_ = Array2d<glm::dvec2>((points.count.x - 1) / kNet + 2, (points.count.y - 1) / kNet + 2);
    parallel_for(0, net_.height(), 1, [&](int first, int last) {
        for (int row = first; row < last; ++row)
            for (int column = 0; column < net_.width(); ++column)
                net_.at(column, row) = exact({column * kNet, row * kNet});
    });
    uneven_ = Array2d<std::uint8_t>(net_.width() - 1, net_.height() - 1);
    parallel_for(0, uneven_.height(), 1, [&](int first, int last) {
        for (int row = first; row < last; ++row)
            for (int column = 0; column < uneven_.width(); ++column)
                uneven_.at(column, row) = is_uneven(column, row);
    });
}

glm::dvec2 PlacesOver::operator()(int column, int row) const {
    if (linear_) return linear(points_.first_post + glm::dvec2(column, row) * points_.step);
    if (uneven_.at(column / kNet, row / kNet)) return exact({column, row});
    return interpolated(glm::dvec2(column, row) / double{kNet});
}

glm::dvec2 PlacesOver::linear(const glm::dvec2& post) const {
    return raster_.affine().inverse(dem_.affine()(post.x, post.y));
}

glm::dvec2 PlacesOver::exact(const glm::dvec2& point) const {
    const glm::dvec2 post = points_.first_post + point * points_.step;
    if (same_crs_) {
        // Coordinates beyond 180 degrees east are counted on in one of them alone.
        const glm::dvec2 at = linear(post);
        if (at.x >= -0.5 && at.y >= -0.5 && at.x <= raster_.columns() - 0.5 &&
            at.y <= raster_.rows() - 0.5)
            return at;
    }
    return raster_.post(dem_.place(post.x, post.y));
}

/// Whether both have one CRS and count its longitudes alike: 190 degrees may be -170 there.
bool PlacesOver::is_linear() const {
    constexpr int kSamples = 32;
    if (!same_crs_) return false;
    const glm::dvec2 extent = glm::dvec2(points_.count - 1) * points_.step;
    for (int j = 0; j <= kSamples; ++j)
        for (int i = 0; i <= kSamples; ++i) {
            const glm::dvec2 post =
                points_.first_post + extent * glm::dvec2(i, j) / double{kSamples};
            if (distance(raster_.post(dem_.place(post.x, post.y)), linear(post)) > 0.5)
                return false;
        }
    return true;
}

/// @param at  in steps of the net
glm::dvec2 PlacesOver::interpolated(const glm::dvec2& at) const {
    const int left = std::min(static_cast<int>(at.x), net_.width() - 2),
              above = std::min(static_cast<int>(at.y), net_.height() - 2);
    const double u = at.x - left, v = at.y - above;
    const auto node = [&](int i, int j) { return net_.at(left + i, above + j); };
    return (1 - v) * ((1 - u) * node(0, 0) + u * node(1, 0)) +
           v * ((1 - u) * node(0, 1) + u * node(1, 1));
}

/// Whether places in a part of the net cannot be interpolated: near a pole, where longitudes
/// begin anew, and where the net is too wide for how the two CRSs differ.
bool PlacesOver::is_uneven(int column, int row) const {
    const glm::dvec2 corner = net_.at(column, row), across = net_.at(column + 1, row),
                     down = net_.at(column, row + 1);
    const double point_cells = std::min(distance(corner, across), distance(corner, down)) / kNet;
    const double most_off = kMostOff * std::max(1.0, point_cells);
    for (const glm::dvec2& in : {glm::dvec2(0.5, 0.5), glm::dvec2(0.5, 0), glm::dvec2(0.5, 1),
                                 glm::dvec2(0, 0.5), glm::dvec2(1, 0.5)}) {
        const glm::dvec2 at = glm::dvec2(column, row) + in;
        if (!(distance(interpolated(at), exact(at * double{kNet})) <= most_off)) return true;
    }
    return false;
}

std::string extent_text(const Grid& grid) {
    constexpr int kSamples = 16;
    const double centre_rad = grid.center().lon_rad;
    glm::dvec2 low(std::numeric_limits<double>::infinity()), high = -low;
    const glm::dvec2 last(grid.columns() - 0.5, grid.rows() - 0.5);
    for (int i = 0; i <= kSamples; ++i)
        for (int j = 0; j <= kSamples; ++j) {
            const glm::dvec2 post =
                glm::mix(glm::dvec2(-0.5), last, glm::dvec2(i, j) / double{kSamples});
            const geo::Geodetic at = grid.place(post.x, post.y);
            const double lon_rad = centre_rad + std::remainder(at.lon_rad - centre_rad, 2 * kPi);
            if (!std::isfinite(at.lat_rad) || !std::isfinite(lon_rad)) continue;
            low = glm::min(low, glm::dvec2(degrees(at.lat_rad), degrees(lon_rad)));
            high = glm::max(high, glm::dvec2(degrees(at.lat_rad), degrees(lon_rad)));
        }
    constexpr double kAllRound_deg = 350;  // about a pole
    const auto from_west = [](double lon_deg) { return std::remainder(lon_deg, 360.0); };
    return fmt::format(
        "latitude {:.3f} to {:.3f}, {}", low.x, high.x,
        high.y - low.y > kAllRound_deg
            ? "all longitudes"
            : fmt::format("longitude {:.3f} to {:.3f}", from_west(low.y), from_west(high.y)));
}

}  // namespace relevo::dem
