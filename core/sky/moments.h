#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "sky/values.h"

namespace relevo::sky {

/// Light that arrives at a place from all directions, as the first spherical harmonics of its
/// radiance: that is what scattered light depends on, because air scatters smoothly.
/// Directions are given against the local vertical and the sun's azimuth, to which all is
/// symmetric.
inline constexpr int kHarmonics = 15, kDegrees = 5;

/// Degree l of each harmonic; its order m goes from 0 to l.
inline constexpr std::array<int, kHarmonics> kDegree{0, 1, 1, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4, 4};

/// Harmonics of one elevation are polynomials of `across`: coefficients by power, 0 to 4.
inline constexpr int kPowers = 5;
using HarmonicPowers = std::array<std::array<float, kPowers>, kHarmonics>;

/// The real, orthonormal harmonics of an elevation. @param sine  of it
inline HarmonicPowers harmonic_powers(double sine) {
    const double s = sine, s2 = s * s, level2 = 1 - s2;
    const auto powers = [](double c0, double c1, double c2 = 0, double c3 = 0, double c4 = 0) {
        return std::array<float, kPowers>{static_cast<float>(c0), static_cast<float>(c1),
                                          static_cast<float>(c2), static_cast<float>(c3),
                                          static_cast<float>(c4)};
    };
    // Of degree 2 and more: sectoral parts, 2 x^2 - level2 and x (4 x^2 - 3 level2).
    const auto two = [&](double c) { return powers(-c * level2, 0, 2 * c); };
    const auto three = [&](double c) { return powers(0, -3 * c * level2, 0, 4 * c); };
    constexpr double kFour = 0.625836;
    return {powers(0.282095, 0),
            powers(0.488603 * s, 0),
            powers(0, 0.488603),
            powers(0.315392 * (3 * s2 - 1), 0),
            powers(0, 1.092548 * s),
            two(0.546274),
            powers(0.373176 * s * (5 * s2 - 3), 0),
            powers(0, 0.457046 * (5 * s2 - 1)),
            two(1.445306 * s),
            three(0.590044),
            powers(0.105786 * (s2 * (35 * s2 - 30) + 3), 0),
            powers(0, 0.669047 * s * (7 * s2 - 3)),
            two(0.473087 * (7 * s2 - 1)),
            three(1.770131 * s),
            powers(kFour * level2 * level2, 0, -8 * kFour * level2, 0, 8 * kFour)};
}

/// The harmonics of a direction.
/// @param across  length of its horizontal part times the cosine of its azimuth from the sun's
inline std::array<float, kHarmonics> harmonics(const HarmonicPowers& of_elevation, double across) {
    const auto x = static_cast<float>(across);
    std::array<float, kHarmonics> result;
    for (std::size_t c = 0; c < kHarmonics; ++c) {
        const std::array<float, kPowers>& p = of_elevation[c];
        result[c] = p[0] + x * (p[1] + x * (p[2] + x * (p[3] + x * p[4])));
    }
    return result;
}

/// Diffuse light at a height under a sun: radiance moments and irradiance of level ground, for an
/// irradiance of 1 by the sun outside the air at every wavelength.
struct Diffuse {
    std::array<Values, kHarmonics> moments{};
    Values level{};  ///< irradiance from above
};

/// Diffuse light by height and by the sine of the sun's elevation.
class DiffuseTable {
  public:
    static constexpr int kHeights = 32, kSuns = 80;
    static constexpr double kLowestSun_deg = -18;

    DiffuseTable() : nodes_(static_cast<std::size_t>(kHeights * kSuns)) {}

    static double height_of(int row);
    static double sun_of(int column);

    /// Where a height or a sun lies between the nodes: the first of two, and the share of the
    /// other.
    struct Place {
        int first;
        float share;
    };
    static Place row_of(double height_m);
    static Place column_of(double sun_sine);

    Diffuse& at(int row, int column) {
        return nodes_[static_cast<std::size_t>(row * kSuns + column)];
    }
    const Diffuse& at(int row, int column) const {
        return nodes_[static_cast<std::size_t>(row * kSuns + column)];
    }
    std::vector<Diffuse>& nodes() { return nodes_; }
    const std::vector<Diffuse>& nodes() const { return nodes_; }

    /// Irradiance of level ground, interpolated linearly.
    Values level(double height_m, double sun_sine) const;

  private:
    std::vector<Diffuse> nodes_;
};

}  // namespace relevo::sky
