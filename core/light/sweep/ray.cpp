#include "light/sweep/ray.h"

#include <algorithm>
#include <limits>

namespace relevo::light {
namespace {

/// Rows that a ray passes in s metres, and its rows for each metre there.
double rows_at(const Ray& ray, double s) {
    return ((ray.third.y / 6 * s + ray.second.y / 2) * s + ray.first.y) * s;
}
double slope_at(const Ray& ray, double s) {
    return (ray.third.y / 2 * s + ray.second.y) * s + ray.first.y;
}

}  // namespace

double Ray::distance_m(double row) const {
    const double posts = row - reference.y;
    double s = posts / first.y;
    if (second.y == 0 && third.y == 0) return s;
    // Newton's method; two or three steps do.
    for (int step = 0; step < 8; ++step) {
        const double slope = slope_at(*this, s);
        if (!(slope * first.y > 0)) return std::numeric_limits<double>::quiet_NaN();
        const double off_m = (rows_at(*this, s) - posts) / slope;
        s -= off_m;
        if (std::abs(off_m) <= 1e-11 * std::abs(s)) return s;
    }
    return std::numeric_limits<double>::quiet_NaN();
}

std::vector<double> Ray::distances_m(int begin, int end) const {
    // Each row's from the one before it; from whole numbers of rows on, so that bits do not hang on
    // which rows are asked for.
    constexpr int kRows = 64;
    std::vector<double> distances(static_cast<std::size_t>(std::max(0, end - begin)));
    const auto slope = [&](double s) { return slope_at(*this, s); };
    const auto off = [&](double s, double posts) { return rows_at(*this, s) - posts; };
    for (int from = begin - ((begin % kRows) + kRows) % kRows; from < end; from += kRows) {
        double s = distance_m(from);
        const bool turns = std::isnan(s);
        for (int row = from; row < std::min(from + kRows, end); ++row) {
            const double posts = row - reference.y;
            if (turns) {
                s = distance_m(row);
            } else if (row > from) {
                s += 1 / slope(s);
                s -= off(s, posts) / slope(s);
                s -= off(s, posts) / slope(s);
                // Near to where it turns back a step leads too far.
                if (!(std::abs(off(s, posts)) < 1e-9 && slope(s) * first.y > 0))
                    s = distance_m(row);
            }
            if (row >= begin) distances[static_cast<std::size_t>(row - begin)] = s;
        }
    }
    return distances;
}

SweepSun sun_over_map(const glm::dvec2& spacing_m, const glm::dvec2& direction,
                      double elevation_rad, const glm::dvec2& reference, double curvature) {
    SweepSun sun;
    sun.ray.reference = reference;
    sun.ray.first = direction / spacing_m;
    sun.ray.along_columns = std::abs(sun.ray.first.y) < std::abs(sun.ray.first.x);
    sun.tangent = std::tan(elevation_rad);
    sun.tangent_per_post = curvature * (1 + sun.tangent * sun.tangent) * direction * spacing_m;
    return sun;
}

}  // namespace relevo::light
