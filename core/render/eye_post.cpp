#include "render/eye_post.h"

#include <cmath>

#include <glm/common.hpp>
#include <glm/matrix.hpp>

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

void write_eye_post(const dem::Grid& grid, const geo::Geodetic& eye, EyeBlock& block) {
    block.eye_post = block.eye_axes = glm::vec4(0);
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
}

}  // namespace relevo::render
