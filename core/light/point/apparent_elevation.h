#pragma once

#include <algorithm>
#include <cmath>

#include "geo/ellipsoid.h"

namespace relevo::light {

/// Apparent elevations in one direction from an eye: `rise` over `run` is the tangent of that of a
/// point of height h at the distance s, both in metres. rise falls with s, run grows.
///
/// The Earth is a sphere of the ellipsoid's radius of curvature that way; the next term, the change
/// of the radius along the way, is 0.04 m at 100 km, 0.00003 degrees
/// (tests/light/test_horizon.cpp). Lines of sight are arcs of a radius of radius_m / refraction.
struct ApparentElevation {
    double radius_m, eye_m, refraction;

    double curvature() const { return (1 - refraction) / radius_m; }  ///< of the ground [1/m]

    double rise(double h, double s) const {
        const double u = s * s / (radius_m * radius_m);
        const double fallen = u * (0.5 - u / 24);  // 1 - cos
        return (h - eye_m) - (radius_m + h) * fallen + 0.5 * refraction * radius_m * u;
    }
    double run(double h, double s) const {
        const double u = s * s / (radius_m * radius_m);
        return (1 + h / radius_m) * s * (1 - u * (1.0 / 6 - u / 120));
    }
    double tangent(double h, double s) const { return rise(h, s) / run(h, s); }

    /// The height at the distance s that has a tangent; rise and run are linear in it.
    double height_m(double tangent, double s) const {
        const double rise_0 = rise(0, s), rise_a_m = rise(1, s) - rise_0;
        const double run_0 = run(0, s), run_a_m = run(1, s) - run_0;
        return (tangent * run_0 - rise_0) / (rise_a_m - tangent * run_a_m);
    }

    /// Where a smooth Earth of height h has its horizon, from a distance on.
    double farthest_rise_m(double h, double from_m) const {
        const double above_m = eye_m - h;
        if (above_m <= 0) return from_m;
        return std::max(from_m, std::sqrt(2 * radius_m * above_m / (1 - refraction)));
    }
};

/// Radius of the ellipsoid's curvature in a direction: Euler's formula.
inline double radius_of_curvature_m(double lat_rad, double azimuth_rad) {
    const double e2 = geo::kFlattening * (2 - geo::kFlattening);
    const double w2 = 1 - e2 * std::sin(lat_rad) * std::sin(lat_rad);
    const double n = geo::kEquatorialRadius_m / std::sqrt(w2);
    const double m = n * (1 - e2) / w2;
    const double c = std::cos(azimuth_rad), s = std::sin(azimuth_rad);
    return 1 / (c * c / m + s * s / n);
}

}  // namespace relevo::light
