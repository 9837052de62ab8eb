#include "sky/night.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include "sky/path.h"

namespace relevo::sky {
namespace {

constexpr double kLayer_m = 100e3;
/// Radiance of the airglow in the zenith and of starlight, over night_irradiance(): together they
/// shed that on level ground.
constexpr double kAirglow = 0.543, kStarlight = 0.190;

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

glm::dvec3 night_radiance(double height_m, double sine, const glm::dvec3& through) {
    const double h = std::max(height_m, 0.0);
    const glm::dvec3 share = glm::clamp(through, 0.0, 1.0);
    // Most of what air takes of the light of a whole sky it scatters on. Near the horizon the
    // colour of the light that passes is outside of sRGB: red and blue follow from green.
    const double depth = -0.2 * std::log(std::max(share.g, 1e-4));
    const glm::dvec3 far = glm::exp(-depth * glm::dvec3(0.69, 1, 1.63));
    const double glow = kAirglow * slant(h, sine);
    const bool above = h > kLayer_m, ground = sine < 0 && path_of(h, sine).ground;
    glm::dvec3 light(above && sine < 0 ? glow : 0);
    if (ground)
        light += 0.5 * (1.0 - share);  // air that is lit from above
    else
        light += (above && sine >= 0 ? 0.0 : glow) * far + kStarlight;
    return night_irradiance() * light;
}

}  // namespace relevo::sky
