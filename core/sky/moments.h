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

/// The real, orthonormal harmonics of a direction.
/// @param sine    of its elevation
/// @param across  length of its horizontal part times the cosine of its azimuth from the sun's
inline std::array<float, kHarmonics> harmonics(double sine, double across) {
    const double sine2 = sine * sine, across2 = across * across, level2 = 1 - sine2;
    return {0.282095f,
            static_cast<float>(0.488603 * sine),
            static_cast<float>(0.488603 * across),
            static_cast<float>(0.315392 * (3 * sine2 - 1)),
            static_cast<float>(1.092548 * sine * across),
            static_cast<float>(0.546274 * (2 * across2 - level2)),
            static_cast<float>(0.373176 * sine * (5 * sine2 - 3)),
            static_cast<float>(0.457046 * across * (5 * sine2 - 1)),
            static_cast<float>(1.445306 * sine * (2 * across2 - level2)),
            static_cast<float>(0.590044 * across * (4 * across2 - 3 * level2)),
            static_cast<float>(0.105786 * (sine2 * (35 * sine2 - 30) + 3)),
            static_cast<float>(0.669047 * sine * across * (7 * sine2 - 3)),
            static_cast<float>(0.473087 * (2 * across2 - level2) * (7 * sine2 - 1)),
            static_cast<float>(1.770131 * sine * across * (4 * across2 - 3 * level2)),
            static_cast<float>(0.625836 * (8 * across2 * (across2 - level2) + level2 * level2))};
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
