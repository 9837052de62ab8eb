#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "sky/air.h"

/// Straight rays through the round atmosphere.
namespace relevo::sky {

/// Sine of the elevation of the horizon from a height, 0 or below.
inline double horizon_sine(double height_m) {
    const double h = std::max(height_m, 0.0), r = kEarthRadius_m + h;
    return -std::sqrt(h * (2 * kEarthRadius_m + h)) / r;
}

/// The part of a ray that lies in the air.
struct Path {
    double begin_m = 0, end_m = 0;  ///< distances from the eye; equal: no air
    double lowest_m = 0;            ///< distance of its lowest point
    bool ground = false;            ///< it ends on the ground
};

/// @param height_m  of the eye above sea level, also above the air; below 0 counts as 0
/// @param sine      of the ray's elevation at the eye
inline Path path_of(double height_m, double sine) {
    const double h = std::max(height_m, 0.0), r = kEarthRadius_m + h;
    const double b = r * sine;
    const double above_top = (h - kTopOfAir_m) * (2 * kEarthRadius_m + h + kTopOfAir_m);
    const double top2 = b * b - above_top;
    Path path;
    if (top2 <= 0 || (h >= kTopOfAir_m && sine >= 0)) return path;
    const double half = std::sqrt(top2);
    path.begin_m = h > kTopOfAir_m ? std::max(0.0, -b - half) : 0.0;
    path.end_m = -b + half;
    const double above_ground = h * (2 * kEarthRadius_m + h), ground2 = b * b - above_ground;
    path.ground = sine < 0 && ground2 > 0;
    if (path.ground) path.end_m = above_ground / (-b + std::sqrt(ground2));
    path.lowest_m = std::clamp(-b, path.begin_m, path.end_m);
    return path;
}

/// Height at a distance along a ray, not below 0.
inline double height_at(double height_m, double sine, double distance_m) {
    const double r = kEarthRadius_m + height_m;
    const double rise2 = distance_m * (distance_m + 2 * r * sine);
    return std::max(0.0, height_m + rise2 / (r + std::sqrt(std::max(r * r + rise2, 0.0))));
}

/// Ends of the steps in which a path is integrated, dense at its lowest point. Their number
/// changes nowhere by directions, so that no edge is seen in the sky.
/// @param steps  from the lowest point on; up to it there are half as many, or all if it is the end
inline std::vector<double> step_ends(const Path& path, int steps) {
    std::vector<double> ends;
    const double before = path.lowest_m - path.begin_m, after = path.end_m - path.lowest_m;
    const int first = before <= 0 ? 0 : path.ground ? steps : steps / 2;
    for (int i = 0; i < first; ++i) {
        const double left = 1 - static_cast<double>(i) / first;
        ends.push_back(path.lowest_m - before * left * left);
    }
    ends.push_back(path.lowest_m);
    if (after > 0)
        for (int i = 1; i <= steps; ++i)
            ends.push_back(path.lowest_m + after * i * i / (static_cast<double>(steps) * steps));
    return ends;
}

}  // namespace relevo::sky
