#include "render/patch_net.h"

#include <cmath>
#include <utility>

namespace relevo::render {
namespace {

/// Coefficients of 1, t, t^2 of the parabola through values at t = 0, 1/2 and 1.
std::array<glm::dvec3, 3> parabola(const glm::dvec3& f0, const glm::dvec3& f1,
                                   const glm::dvec3& f2) {
    return {f0, -3.0 * f0 + 4.0 * f1 - f2, 2.0 * f0 - 4.0 * f1 + 2.0 * f2};
}

/// Coefficients of u^i v^j at 3 j + i, from values at node 3 row + column.
std::array<glm::dvec3, 9> biquadratic(const std::array<glm::dvec3, 9>& nodes) {
    std::array<glm::dvec3, 9> along_u, result;
    for (std::size_t row = 0; row < 3; ++row) {
        const auto c = parabola(nodes[3 * row], nodes[3 * row + 1], nodes[3 * row + 2]);
        for (std::size_t i = 0; i < 3; ++i)
            along_u[3 * row + i] = c[i];
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const auto c = parabola(along_u[i], along_u[3 + i], along_u[6 + i]);
        for (std::size_t j = 0; j < 3; ++j)
            result[3 * j + i] = c[j];
    }
    return result;
}

}  // namespace

glm::dvec3 PatchNet::place(double u, double v, double height_m) const {
    glm::dvec3 result = centre_m;
    for (std::size_t j = 3; j-- > 0;) {
        const glm::dvec3* const row = &position_m[3 * j];
        const glm::dvec3 along_u = row[0] + u * (row[1] + u * row[2]);
        result += (j == 0 ? 1 : j == 1 ? v : v * v) * along_u;
    }
    return result + height_m * (vertical[0] + u * vertical[1] + v * vertical[2]);
}

PatchNet fit_patch_net(const PostPlace& place, const geo::LocalFrame& frame, glm::dvec2 first,
                       glm::dvec2 sides) {
    std::array<glm::dvec3, 9> positions;
    std::array<glm::dvec3, 9> verticals;
    for (std::size_t node = 0; node < 9; ++node) {
        const geo::Geodetic at = place(first.x + sides.x * static_cast<double>(node % 3) / 2,
                                       first.y + sides.y * static_cast<double>(node / 3) / 2);
        positions[node] = frame.to_local({at.lat_rad, at.lon_rad, 0});
        verticals[node] = frame.up(at.lat_rad, at.lon_rad);
    }
    PatchNet net;
    net.centre_m = positions[4];
    for (glm::dvec3& position : positions)
        position -= net.centre_m;
    net.position_m = biquadratic(positions);
    const std::array<glm::dvec3, 9> vertical = biquadratic(verticals);
    // The vertical keeps its linear part: its curvature over a piece moves a summit by micrometres.
    // The plane is taken at the middle, where the quadratic terms leave the smallest error.
    const auto& c = vertical;
    const glm::dvec3 du = c[1] + c[2] + 0.5 * c[4] + 0.5 * c[5] + 0.25 * c[7] + 0.25 * c[8];
    const glm::dvec3 dv = c[3] + c[6] + 0.5 * c[4] + 0.5 * c[7] + 0.25 * c[5] + 0.25 * c[8];
    net.vertical = {verticals[4] - 0.5 * du - 0.5 * dv, du, dv};
    return net;
}

}  // namespace relevo::render
