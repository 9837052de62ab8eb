#include "render/patch_net.h"

#include <cmath>
#include <utility>

namespace relevo::render {
namespace {

using Row = std::array<double, 6>;

Row monomials(double u, double v) {
    return {1, u, v, u * u, u * v, v * v};
}

/// The 6 x 9 matrix that turns values at the 3 x 3 nodes into coefficients: (A^T A)^-1 A^T.
std::array<std::array<double, 9>, 6> fit_matrix() {
    std::array<Row, 9> a{};
    for (std::size_t node = 0; node < 9; ++node)
        a[node] = monomials(static_cast<double>(node % 3) / 2, static_cast<double>(node / 3) / 2);
    // Gauss-Jordan on [A^T A | A^T]; the matrix is fixed and well conditioned.
    std::array<std::array<double, 15>, 6> m{};
    for (std::size_t i = 0; i < 6; ++i) {
        for (std::size_t j = 0; j < 6; ++j)
            for (std::size_t node = 0; node < 9; ++node)
                m[i][j] += a[node][i] * a[node][j];
        for (std::size_t node = 0; node < 9; ++node)
            m[i][6 + node] = a[node][i];
    }
    for (std::size_t i = 0; i < 6; ++i) {
        std::size_t pivot = i;
        for (std::size_t r = i + 1; r < 6; ++r)
            if (std::abs(m[r][i]) > std::abs(m[pivot][i])) pivot = r;
        std::swap(m[i], m[pivot]);
        const double scale = 1 / m[i][i];
        for (double& value : m[i])
            value *= scale;
        for (std::size_t r = 0; r < 6; ++r) {
            if (r == i) continue;
            const double factor = m[r][i];
            for (std::size_t c = 0; c < 15; ++c)
                m[r][c] -= factor * m[i][c];
        }
    }
    std::array<std::array<double, 9>, 6> inverse{};
    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t node = 0; node < 9; ++node)
            inverse[i][node] = m[i][6 + node];
    return inverse;
}

}  // namespace

glm::dvec3 PatchNet::place(double u, double v, double height_m) const {
    const Row m = monomials(u, v);
    glm::dvec3 result = centre_m;
    for (std::size_t i = 0; i < 6; ++i)
        result += m[i] * position_m[i];
    return result + height_m * (vertical[0] + u * vertical[1] + v * vertical[2]);
}

PatchNet fit_patch_net(const PostPlace& place, const geo::LocalFrame& frame, glm::dvec2 first,
                       double side) {
    static const auto kFit = fit_matrix();
    std::array<glm::dvec3, 9> positions;
    std::array<glm::dvec3, 9> verticals;
    for (std::size_t node = 0; node < 9; ++node) {
        const geo::Geodetic at = place(first.x + side * static_cast<double>(node % 3) / 2,
                                       first.y + side * static_cast<double>(node / 3) / 2);
        positions[node] = frame.to_local({at.lat_rad, at.lon_rad, 0});
        verticals[node] = frame.up(at.lat_rad, at.lon_rad);
    }
    PatchNet net;
    net.centre_m = positions[4];
    net.position_m.fill(glm::dvec3(0));
    std::array<glm::dvec3, 6> vertical{};
    vertical.fill(glm::dvec3(0));
    for (std::size_t i = 0; i < 6; ++i) {
        for (std::size_t node = 0; node < 9; ++node) {
            net.position_m[i] += kFit[i][node] * (positions[node] - net.centre_m);
            vertical[i] += kFit[i][node] * verticals[node];
        }
    }
    // The vertical keeps its linear part: its curvature over a piece moves a summit by micrometres.
    // The plane is taken at the middle, where the quadratic terms leave the smallest error.
    const glm::dvec3 du = vertical[1] + vertical[3] + 0.5 * vertical[4];
    const glm::dvec3 dv = vertical[2] + vertical[5] + 0.5 * vertical[4];
    net.vertical = {verticals[4] - 0.5 * du - 0.5 * dv, du, dv};
    return net;
}

}  // namespace relevo::render
