#pragma once

#include <cmath>
#include <utility>

#include "base/units.h"

namespace relevo::test {

/// The camera of tests that look for a light in the sky.
constexpr int kWidth = 640, kHeight = 512;
constexpr double kFov_deg = 12;

struct Direction {
    double azimuth_deg, elevation_deg;
};

/// Where the camera's pinhole puts a direction, in pixels from the upper left corner.
inline std::pair<double, double> project(const Direction& to, double heading_deg,
                                         double pitch_deg) {
    const double azimuth = radians(to.azimuth_deg - heading_deg);
    const double elevation = radians(to.elevation_deg), pitch = radians(pitch_deg);
    // Ahead, to the right and up in the level frame that looks along the heading.
    const double ahead = std::cos(elevation) * std::cos(azimuth),
                 right = std::cos(elevation) * std::sin(azimuth), up = std::sin(elevation);
    const double depth = ahead * std::cos(pitch) + up * std::sin(pitch);
    const double rise = up * std::cos(pitch) - ahead * std::sin(pitch);
    const double scale = kHeight / 2.0 / std::tan(radians(kFov_deg / 2));
    return {kWidth / 2.0 + scale * right / depth, kHeight / 2.0 - scale * rise / depth};
}

}  // namespace relevo::test
