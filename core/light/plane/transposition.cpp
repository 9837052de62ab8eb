#include "light/plane/transposition.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/units.h"

namespace relevo::light {
namespace {

/// F11, F12, F13, F21, F22, F23 of one bin of clearness.
using PerezRow = std::array<double, 6>;
constexpr std::array<PerezRow, 8> kPerez{{
    {-0.008, 0.588, -0.062, -0.060, 0.072, -0.022},
    {0.130, 0.683, -0.151, -0.019, 0.066, -0.029},
    {0.330, 0.487, -0.221, 0.055, -0.064, -0.026},
    {0.568, 0.187, -0.295, 0.109, -0.152, -0.014},
    {0.873, -0.392, -0.362, 0.226, -0.462, 0.001},
    {1.132, -1.237, -0.412, 0.288, -0.823, 0.056},
    {1.060, -1.600, -0.359, 0.264, -1.127, 0.131},
    {0.678, -0.327, -0.250, 0.156, -1.377, 0.251},
}};
constexpr std::array<double, 7> kPerezEdges{1.065, 1.23, 1.5, 1.95, 2.8, 4.5, 6.2};

/// Relative: 1 at the zenith, at any height.
double air_mass(double zenith_rad) {
    const double zenith_deg = std::min(90.0, degrees(zenith_rad));
    return 1 / (std::cos(radians(zenith_deg)) + 0.50572 * std::pow(96.07995 - zenith_deg, -1.6364));
}

SkyFactors perez(const Plane& plane, const SkySun& sun, double dni, double dhi) {
    if (dhi <= 0) return {0, 0, 0};
    const double z = sun.zenith_rad, z3 = 1.041 * z * z * z;
    const double clearness = ((dhi + dni) / dhi + z3) / (1 + z3);
    const double brightness = dhi * air_mass(z) / sun.outside_w_m2;
    const auto bin = std::upper_bound(kPerezEdges.begin(), kPerezEdges.end(), clearness);
    const PerezRow& f = kPerez[static_cast<std::size_t>(bin - kPerezEdges.begin())];
    const double f1 = std::max(0.0, f[0] + f[1] * brightness + f[2] * z);
    const double f2 = f[3] + f[4] * brightness + f[5] * z;
    const double ratio =
        std::max(0.0, sun.cos_incidence) / std::max(std::cos(radians(85)), sun.cos_zenith);
    return {(1 - f1) * open_sky(plane), f1 * ratio, f2 * std::sin(plane.tilt_rad)};
}

SkyFactors hay_davies(const Plane& plane, const SkySun& sun, double dni) {
    const double anisotropy = dni / sun.outside_w_m2;
    const double ratio = std::max(0.0, sun.cos_incidence) / std::max(0.01745, sun.cos_zenith);
    return {(1 - anisotropy) * open_sky(plane), anisotropy * ratio, 0};
}

}  // namespace

double irradiance_above_air(int day) {
    const double b = 2 * kPi * (day - 1) / 365;
    return kSkySolarConstant * (1.00011 + 0.034221 * std::cos(b) + 0.00128 * std::sin(b) +
                                0.000719 * std::cos(2 * b) + 0.000077 * std::sin(2 * b));
}

glm::dvec3 Plane::normal() const {
    const double out = std::sin(tilt_rad);
    return {out * std::sin(azimuth_rad), out * std::cos(azimuth_rad), std::cos(tilt_rad)};
}

SkyFactors sky_factors(SkyModel model, const Plane& plane, const SkySun& sun, double dni_w_m2,
                       double dhi_w_m2) {
    switch (model) {
        case SkyModel::HayDavies:
            return hay_davies(plane, sun, dni_w_m2);
        case SkyModel::Perez:
            return perez(plane, sun, dni_w_m2, dhi_w_m2);
        default:
            return {open_sky(plane), 0, 0};
    }
}

double open_sky(const Plane& plane) {
    return (1 + std::cos(plane.tilt_rad)) / 2;
}

double open_sky(const Plane& plane, const Skyline& horizon) {
    constexpr int kLeast = 3600;  // directions
    const int parts = (kLeast + horizon.count() - 1) / horizon.count();
    const int count = horizon.count() * parts;
    const double step_rad = 2 * kPi / count, up = std::cos(plane.tilt_rad);
    double sum = 0;
    for (int k = 0; k < count; ++k) {
        const double azimuth_rad = (k + 0.5) * step_rad;
        const double across = std::cos(azimuth_rad - plane.azimuth_rad) * std::sin(plane.tilt_rad);
        const double behind_rad = std::atan2(-across, up);  // the sky below is behind the plane
        const double low_rad =
            std::clamp(std::max(horizon.elevation_rad(azimuth_rad), behind_rad), 0.0, kPi / 2);
        const double cosine = std::cos(low_rad);
        sum += up * cosine * cosine / 2 +
               across * ((kPi / 2 - low_rad) / 2 - std::sin(2 * low_rad) / 4);
    }
    return sum * step_rad / kPi;
}

}  // namespace relevo::light
