#include "sun/moonlight.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "sun/daylight.h"

namespace relevo::sun {
namespace {

constexpr double kSunMagnitude = -26.76;  // Willmer, Astrophys. J. Suppl. 236 (2018) 47
constexpr double kMeanDistance_au = 384'400'000 / 149'597'870'700.0;

/// Colour of B-V 0.91 where that of the sun, 0.65, is white: linear sRGB of unit luminance, by the
/// black bodies of plugins/sky's stars (F. J. Ballesteros, EPL 97 (2012) 34008).
constexpr glm::dvec3 kColour{1.094, 0.989, 0.829};

/// Light of the moon over that of the sun.
double moon_over_sun(const MoonPosition& moon) {
    const double a_deg = degrees(moon.phase_angle_rad);
    const double magnitude = -12.73 + 0.026 * a_deg + 4e-9 * std::pow(a_deg, 4);
    const double nearer = kMeanDistance_au / moon.distance_au;
    return nearer * nearer * std::pow(10, 0.4 * (kSunMagnitude - magnitude));
}

/// What a sphere that reflects by the law of Lommel and Seeliger sheds at a phase angle, over that
/// at full phase. Source: B. Hapke, Theory of Reflectance and Emittance Spectroscopy, 1993, 10.38
double sphere_phase(double phase_angle_rad) {
    const double half = phase_angle_rad / 2;
    if (half < 1e-4) return 1;
    return 1 - std::sin(half) * std::tan(half) * std::log(1 / std::tan(half / 2));
}

}  // namespace

glm::dvec3 moonlight(const MoonPosition& moon) {
    return moon_over_sun(moon) * kColour;
}

glm::dvec3 moon_radiance(const MoonPosition& moon) {
    // Radiance 1 over a solid angle is an irradiance of that angle over pi.
    const double disc = std::pow(std::sin(moon.semidiameter_rad), 2);
    // The law fails for the thinnest crescents, which no one sees.
    const double phase = std::max(sphere_phase(moon.phase_angle_rad), 0.002);
    return moonlight(moon) / (disc * phase);
}

glm::dvec3 moonlit_sky_irradiance(double elevation_rad, const glm::dvec3& moonlight) {
    if (elevation_rad <= 0) return glm::dvec3(0);
    return sky_irradiance(elevation_rad) * moonlight;
}

}  // namespace relevo::sun
