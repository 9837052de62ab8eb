#include "sky/sun_rays.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <mutex>
#include <utility>

#include "base/units.h"
#include "sky/path.h"

namespace relevo::sky {
namespace {

constexpr int kRays = 48;
/// Refractivity of air at sea level and 15 degrees C, for green light. Source: P. E. Ciddor,
/// Refractive Index of Air, Applied Optics 35 (1996), 1566.
constexpr double kRefractivity = 2.779e-4;

double refractive_index(double height_m) {
    return 1 + kRefractivity * rayleigh_density(height_m);
}

/// Step along a ray [m]: 250 m of height near the ground, more where the air is thin.
double step_m(double height_m, double sine) {
    return 250 * (1 + height_m / 10000) / (std::abs(sine) + 0.02);
}

/// A point of a ray.
struct Point {
    double height_m, elevation_rad;
};

/// Curvature of a ray, downwards [rad/m].
double bend(const Point& at) {
    return -std::cos(at.elevation_rad) * kRefractivity * rayleigh_density_slope(at.height_m);
}

Point moved(const Point& from, const Point& slope_at, double step, bool bent) {
    const double r = kEarthRadius_m + std::max(slope_at.height_m, 0.0);
    const double turn = std::cos(slope_at.elevation_rad) / r - (bent ? bend(slope_at) : 0.0);
    return {std::max(from.height_m + step * std::sin(slope_at.elevation_rad), 0.0),
            from.elevation_rad + step * turn};
}

}  // namespace

SunRays::SunRays(double height_m, bool bent) : height_m_(std::max(height_m, 0.0)) {
    const double n = bent ? refractive_index(0) / refractive_index(height_m_) : 1;
    const double dip = std::acos(std::min(n * kEarthRadius_m / (kEarthRadius_m + height_m_), 1.0));
    for (int i = 0; i < kRays; ++i) {
        const double t = i / (kRays - 1.0);
        rays_.push_back(trace(-dip + (0.5 * kPi + dip) * t * t * t, bent));
    }
}

SunRays::Ray SunRays::trace(double apparent_rad, bool bent) const {
    Ray ray{apparent_rad, apparent_rad, {}};
    Point at{height_m_, apparent_rad};
    if (at.height_m > kTopOfAir_m) {
        // Straight to the air, or past it.
        const Path path = path_of(at.height_m, std::sin(apparent_rad));
        if (path.end_m <= path.begin_m) return ray;
        const double r = kEarthRadius_m + at.height_m;
        at = {kTopOfAir_m, -std::acos(std::min(
                               r * std::cos(apparent_rad) / (kEarthRadius_m + kTopOfAir_m), 1.0))};
    }
    double rayleigh = 0, aerosol = 0, ozone = 0;
    do {
        const double step = step_m(at.height_m, std::sin(at.elevation_rad));
        const Point middle = moved(at, at, 0.5 * step, bent);
        if (bent) ray.elevation_rad -= step * bend(middle);
        rayleigh += step * rayleigh_density(middle.height_m);
        aerosol += step * aerosol_density(middle.height_m);
        ozone += step * ozone_density(middle.height_m);
        at = moved(at, middle, step, bent);
    } while (at.height_m < kTopOfAir_m);
    ray.column = {static_cast<float>(rayleigh), static_cast<float>(aerosol),
                  static_cast<float>(ozone)};
    return ray;
}

SunRays::Place SunRays::place(double elevation_rad) const {
    const auto after = std::upper_bound(
        rays_.begin() + 1, rays_.end() - 1, elevation_rad,
        [](double elevation, const Ray& ray) { return elevation < ray.elevation_rad; });
    const Ray &a = *(after - 1), &b = *after;
    return {static_cast<std::size_t>(after - 1 - rays_.begin()),
            std::clamp((elevation_rad - a.elevation_rad) / (b.elevation_rad - a.elevation_rad), 0.0,
                       1.0)};
}

std::optional<Column> SunRays::towards(double elevation_rad) const {
    if (elevation_rad < horizon_rad()) return std::nullopt;
    const auto [first, share] = place(elevation_rad);
    const Column &a = rays_[first].column, &b = rays_[first + 1].column;
    const auto mix = [t = static_cast<float>(share)](float x, float y) { return x + t * (y - x); };
    return Column{mix(a.rayleigh_m, b.rayleigh_m), mix(a.aerosol_m, b.aerosol_m),
                  mix(a.ozone_m, b.ozone_m)};
}

double SunRays::refraction_rad(double elevation_rad) const {
    const auto [first, share] = place(elevation_rad);
    const auto of = [](const Ray& ray) { return ray.apparent_rad - ray.elevation_rad; };
    return (1 - share) * of(rays_[first]) + share * of(rays_[first + 1]);
}

std::shared_ptr<const SunRays> sun_rays(double height_m, bool bent) {
    constexpr std::size_t kKept = 64;
    using Key = std::pair<long, bool>;
    static std::mutex mutex;
    static std::deque<std::pair<Key, std::shared_ptr<const SunRays>>> kept;
    const Key key{std::lround(std::max(height_m, 0.0)), bent};
    {
        const std::lock_guard lock(mutex);
        for (const auto& [of, rays] : kept)
            if (of == key) return rays;
    }
    auto rays = std::make_shared<const SunRays>(static_cast<double>(key.first), bent);
    const std::lock_guard lock(mutex);
    if (kept.size() >= kKept) kept.pop_front();
    kept.emplace_back(key, rays);
    return rays;
}

}  // namespace relevo::sky
