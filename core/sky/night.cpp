#include "sky/night.h"

#include <algorithm>
#include <cmath>

#include "sky/path.h"

namespace relevo::sky {
namespace {

constexpr double kLayer_m = 100e3;
/// Radiance of the airglow in the zenith and of starlight, over night_irradiance(): together they
/// shed that on level ground.
constexpr double kAirglow = 0.652, kStarlight = 0.228;

/// Length of a ray in the layer of airglow over the layer's thickness, of one of its crossings;
/// 0 for rays that pass outside of it.
double slant(double height_m, double sine) {
    constexpr double kGrazing = 1.0 / 36;  // the layer is 10 km thick
    const double ratio = (kEarthRadius_m + height_m) / (kEarthRadius_m + kLayer_m);
    const double sine2 = 1 - ratio * ratio * (1 - sine * sine);
    return sine2 < 0 ? 0 : 1 / std::sqrt(sine2 + kGrazing * kGrazing);
}

}  // namespace

glm::dvec3 night_irradiance() {
    constexpr double kNight = 0.002 / 127500;
    return kNight * glm::dvec3(0.66, 0.98, 1.95);
}

double night_scattered(double sine) {
    // Half of what lights air from all sides, for the sky lights it from above alone; near the
    // level, where the airglow is brightest, more of what is scattered forward.
    const double level = sine / 0.15;
    return 0.5 + 0.35 * std::exp(-level * level);
}

glm::dvec3 night_radiance(double height_m, double sine, double through) {
    const double h = std::max(height_m, 0.0);
    const double passes = std::clamp(through, 0.0, 1.0);
    const double glow = kAirglow * slant(h, sine);
    const bool above = h > kLayer_m, ground = sine < 0 && path_of(h, sine).ground;
    double light = night_scattered(sine) * (1.0 - passes);
    if (above && sine < 0) light += glow;
    if (!ground) light += ((above ? 0.0 : glow) + kStarlight) * passes;
    return night_irradiance() * light;
}

}  // namespace relevo::sky
