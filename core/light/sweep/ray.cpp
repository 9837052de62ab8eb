#include "light/sweep/ray.h"

#include <limits>

namespace relevo::light {

double Ray::distance_m(double row) const {
    const double posts = row - reference.y;
    double s = posts / first.y;
    if (second.y == 0 && third.y == 0) return s;
    // Newton's method; two or three steps do.
    for (int step = 0; step < 8; ++step) {
        const double slope = (third.y / 2 * s + second.y) * s + first.y;
        if (!(slope * first.y > 0)) return std::numeric_limits<double>::quiet_NaN();
        const double off_m = (((third.y / 6 * s + second.y / 2) * s + first.y) * s - posts) / slope;
        s -= off_m;
        if (std::abs(off_m) <= 1e-11 * std::abs(s)) return s;
    }
    return std::numeric_limits<double>::quiet_NaN();
}

SweepSun sun_over_map(const glm::dvec2& spacing_m, const glm::dvec2& direction,
                      double elevation_rad, const glm::dvec2& reference, double curvature) {
    SweepSun sun;
    sun.ray.reference = reference;
    sun.ray.first = direction / spacing_m;
    sun.tangent = std::tan(elevation_rad);
    sun.tangent_per_post = curvature * (1 + sun.tangent * sun.tangent) * direction * spacing_m;
    return sun;
}

}  // namespace relevo::light
