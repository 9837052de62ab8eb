#include "render/height_light.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/common.hpp>

#include "sky/atmosphere.h"
#include "sky/night.h"
#include "sun/daylight.h"
#include "sun/moonlight.h"

namespace relevo::render {
namespace {

/// Linear sRGB; colours outside of it lose their negative part.
glm::dvec3 colour(const sky::Spectrum& light) {
    return glm::max(sky::colour_of(light), glm::dvec3(0));
}

bool bends(const SunLight& light) {
    return light.lift_rad(0) != 0;
}

}  // namespace

HeightLight::HeightLight(const FrameInputs& inputs, double height_m)
    : inputs_(inputs), height_m_(height_m) {
    if (inputs.atmosphere) rays_ = sky::sun_rays(height_m, bends(inputs.sun));
}

glm::dvec3 HeightLight::passed(const SunLight& light, double sine, double bent) const {
    const double elevation = elevation_of(sine);
    if (rays_) return colour(inputs_.atmosphere->sunlight(*rays_, elevation));
    return sun::direct_transmittance(elevation + bent * light.lift_rad(elevation), height_m_);
}

glm::dvec3 HeightLight::direct(const SunLight& light, double sine, double bent) const {
    return light.strength * passed(light, sine, bent);
}

glm::dvec3 HeightLight::sky(double sine) const {
    const double share = sun::eclipsed_sky(inputs_.sun_visible);
    const double over_middle = inputs_.sun.direction.z;
    const std::optional<SunLight>& moon = inputs_.moonlight;
    if (!rays_) {
        glm::dvec3 light = share * sun::sky_irradiance(elevation_of(over_middle));
        if (moon)
            light += sun::moonlit_sky_irradiance(elevation_of(moon->direction.z), moon->strength);
        return light;
    }
    const auto by = [&](double light_sine) {
        return colour(inputs_.atmosphere->sky_irradiance(height_m_, light_sine));
    };
    const glm::dvec3 night = sky::night_irradiance();
    // The moon is the direct light in nights alone: then the sun's twilight is taken as even.
    return moon ? night + share * by(over_middle) + moon->strength * by(sine)
                : night + share * by(sine);
}

}  // namespace relevo::render
