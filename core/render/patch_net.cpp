#include "render/patch_net.h"

#include <algorithm>
#include <cmath>

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

/// Least-squares fit of a biquadratic; yields its values at the nodes.
class NodeFit {
  public:
    NodeFit() {
        // Keeps the system regular if few posts are on the Earth.
        constexpr double kStiff = 1e-6;
        for (std::size_t i = 0; i < 9; ++i)
            matrix_[i][i] = kStiff;
    }

    void add(double u, double v, const glm::dvec3& position, const glm::dvec3& vertical,
             double weight = 1) {
        const std::array<double, 3> a = {1, u, u * u}, b = {1, v, v * v};
        std::array<double, 9> row{};
        for (std::size_t i = 0; i < 9; ++i)
            row[i] = a[i % 3] * b[i / 3];
        for (std::size_t i = 0; i < 9; ++i) {
            for (std::size_t k = 0; k < 9; ++k)
                matrix_[i][k] += weight * row[i] * row[k];
            positions_[i] += weight * row[i] * position;
            verticals_[i] += weight * row[i] * vertical;
        }
    }

    void solve(std::array<glm::dvec3, 9>& positions, std::array<glm::dvec3, 9>& verticals) {
        // Symmetric and positive definite: no pivoting is needed.
        for (std::size_t i = 0; i < 9; ++i) {
            for (std::size_t k = i + 1; k < 9; ++k) {
                const double factor = matrix_[k][i] / matrix_[i][i];
                for (std::size_t c = i; c < 9; ++c)
                    matrix_[k][c] -= factor * matrix_[i][c];
                positions_[k] -= factor * positions_[i];
                verticals_[k] -= factor * verticals_[i];
            }
        }
        for (std::size_t i = 9; i-- > 0;) {
            for (std::size_t k = i + 1; k < 9; ++k) {
                positions_[i] -= matrix_[i][k] * positions_[k];
                verticals_[i] -= matrix_[i][k] * verticals_[k];
            }
            positions_[i] /= matrix_[i][i];
            verticals_[i] /= matrix_[i][i];
        }
        for (std::size_t node = 0; node < 9; ++node) {
            const double u = 0.5 * static_cast<double>(node % 3);
            const double v = 0.5 * static_cast<double>(node / 3);
            const std::array<double, 3> a = {1, u, u * u}, b = {1, v, v * v};
            positions[node] = verticals[node] = glm::dvec3(0);
            for (std::size_t i = 0; i < 9; ++i) {
                positions[node] += a[i % 3] * b[i / 3] * positions_[i];
                verticals[node] += a[i % 3] * b[i / 3] * verticals_[i];
            }
        }
    }

  private:
    std::array<std::array<double, 9>, 9> matrix_{};
    std::array<glm::dvec3, 9> positions_{}, verticals_{};  // sums, then coefficients
};

/// For parts that are partly off the Earth: extrapolates nodes without a position. Other nodes are
/// kept, so that neighbours agree.
void fit_what_is_on_earth(const PostPlace& place, const geo::LocalFrame& frame, glm::dvec2 first,
                          glm::dvec2 sides, std::array<glm::dvec3, 9>& positions,
                          std::array<glm::dvec3, 9>& verticals) {
    constexpr int kSamples = 16;
    constexpr double kNodeWeight = 1e4;
    NodeFit fit;
    std::array<bool, 9> known{};
    for (std::size_t node = 0; node < 9; ++node) {
        known[node] = std::isfinite(positions[node].x);
        if (known[node])
            fit.add(0.5 * static_cast<double>(node % 3), 0.5 * static_cast<double>(node / 3),
                    positions[node], verticals[node], kNodeWeight);
    }
    for (int j = 0; j <= kSamples; ++j) {
        for (int i = 0; i <= kSamples; ++i) {
            const glm::dvec2 at = glm::dvec2(i, j) / double{kSamples};
            const geo::Geodetic on_earth =
                place(first.x + sides.x * at.x, first.y + sides.y * at.y);
            if (std::isfinite(on_earth.lat_rad))
                fit.add(at.x, at.y, frame.to_local({on_earth.lat_rad, on_earth.lon_rad, 0}),
                        frame.up(on_earth.lat_rad, on_earth.lon_rad));
        }
    }
    std::array<glm::dvec3, 9> fitted_positions, fitted_verticals;
    fit.solve(fitted_positions, fitted_verticals);
    for (std::size_t node = 0; node < 9; ++node) {
        if (known[node]) continue;
        positions[node] = fitted_positions[node];
        verticals[node] = fitted_verticals[node];
    }
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
    if (!std::ranges::all_of(positions,
                             [](const glm::dvec3& position) { return std::isfinite(position.x); }))
        fit_what_is_on_earth(place, frame, first, sides, positions, verticals);
    PatchNet net;
    net.centre_m = positions[4];
    for (glm::dvec3& position : positions)
        position -= net.centre_m;
    net.position_m = biquadratic(positions);
    const std::array<glm::dvec3, 9> vertical = biquadratic(verticals);
    // Only the linear part of the vertical is kept: its curvature over a part moves a summit by
    // micrometres. Taken at the centre, where the neglected terms are smallest.
    const auto& c = vertical;
    const glm::dvec3 du = c[1] + c[2] + 0.5 * c[4] + 0.5 * c[5] + 0.25 * c[7] + 0.25 * c[8];
    const glm::dvec3 dv = c[3] + c[6] + 0.5 * c[4] + 0.5 * c[7] + 0.25 * c[5] + 0.25 * c[8];
    net.vertical = {verticals[4] - 0.5 * du - 0.5 * dv, du, dv};
    return net;
}

}  // namespace relevo::render
