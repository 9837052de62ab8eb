#include "render/eye_post.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include "base/units.h"

namespace relevo::render {

glm::dmat2 metres_per_post(const dem::Grid& grid, const glm::dvec2& post) {
    constexpr double kStep = 0.5;  // posts on either side
    glm::dmat2 metres;
    for (int i = 0; i < 2; ++i) {
        glm::dvec2 step(0);
        step[i] = kStep;
        const glm::dvec2 from = post - step, to = post + step;
        const geo::Geodesic way = geo::geodesic(grid.place(from.x, from.y), grid.place(to.x, to.y));
        // East and north as in the middle: the azimuth turns between the ends.
        const double turned = std::remainder(way.end_azimuth_rad - way.azimuth_rad, 2 * kPi);
        const double azimuth = way.azimuth_rad + 0.5 * turned;
        metres[i] = way.distance_m * glm::dvec2(std::sin(azimuth), std::cos(azimuth));
    }
    return metres;
}

namespace {

/// Half of the second derivatives of a place's column and row, by metres east and north: columns of
/// xx, xy and yy, and of rows. Exact `reach_m` away in eight directions; 0 where the grid ends.
std::array<glm::dvec3, 2> bends_at(const dem::Grid& grid, const geo::Geodetic& place,
                                   const glm::dvec2& post, double reach_m) {
    const auto sum = [&](double azimuth_rad) {  // of a step there and one back, less what is linear
        return grid.post(geo::destination(place, azimuth_rad, reach_m)) +
               grid.post(geo::destination(place, azimuth_rad, -reach_m)) - 2.0 * post;
    };
    const glm::dvec2 east = sum(kPi / 2), north = sum(0);
    const glm::dvec2 across = 0.5 * (sum(kPi / 4) - sum(-kPi / 4));
    std::array<glm::dvec3, 2> bends;
    for (int i = 0; i < 2; ++i) {
        bends[static_cast<std::size_t>(i)] =
            glm::dvec3(east[i], 2 * across[i], north[i]) / (2 * reach_m * reach_m);
        const double most = 0.2 * std::max(grid.columns(), grid.rows());
        const double bent = glm::length(glm::dvec3(east[i], across[i], north[i]));
        // As at the date line, beyond which columns begin again.
        if (!(bent < most)) return {glm::dvec3(0), glm::dvec3(0)};
    }
    return bends;
}

}  // namespace

void write_eye_post(const dem::Grid& grid, const geo::Geodetic& eye, EyeBlock& block) {
    block.eye_post = block.eye_axes = glm::vec4(0);
    block.eye_bends.fill(glm::vec4(0));
    const glm::dvec2 post = grid.post(eye);
    // Elsewhere floats of posts are as good.
    constexpr double kFar = 1e6;
    if (!(std::max(std::abs(post.x), std::abs(post.y)) < kFar)) return;
    const glm::dmat2 metres = metres_per_post(grid, post);
    const double area = determinant(metres);
    if (!std::isfinite(area) || area == 0) return;
    const glm::dvec2 whole = glm::floor(post);
    const glm::dmat2 axes = inverse(metres);
    block.eye_post = glm::vec4(whole, post - whole);
    block.eye_axes = glm::vec4(axes[0], axes[1]);
    const glm::dvec2 spacing_m = grid.post_spacing_m();
    const double side_m = std::max(grid.columns() * spacing_m.x, grid.rows() * spacing_m.y);
    const auto bends = bends_at(grid, eye, post, std::clamp(0.5 * side_m, 1e3, 2e5));
    for (std::size_t i = 0; i < 2; ++i)
        block.eye_bends[i] = glm::vec4(bends[i], 0);
}

}  // namespace relevo::render
