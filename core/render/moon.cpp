#include "render/moon.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "base/units.h"
#include "render/frame_block.h"
#include "render/height_light.h"
#include "sky/path.h"
#include "sun/daylight.h"
#include "sun/moonlight.h"

namespace relevo::render {
namespace {

/// Whether a part of its disc is above the horizon of the sea from the highest ground.
bool shines(const SunLight& light) {
    constexpr double kSemidiameter_rad = radians(0.2666);
    const double highest_rad = elevation_of(light.highest_sine);
    return highest_rad + light.lift_rad(highest_rad) + kSemidiameter_rad >
           std::asin(sky::horizon_sine(light.highest_m));
}

double luminance(const glm::dvec3& rgb) {
    return dot(rgb, glm::dvec3(0.2126, 0.7152, 0.0722));
}

}  // namespace

Moon make_moon(const sun::MoonPosition& moon, const sun::Position& sun,
               const sun::CelestialFrame& stars) {
    // The axis stands within 1.6 degrees of the pole of the ecliptic.
    constexpr double kObliquity_rad = radians(23.4393);
    const glm::dvec3 ecliptic_pole(0, -std::sin(kObliquity_rad), std::cos(kObliquity_rad));
    // A full Earth is 0.00012 of the sun: -16.9 to -26.7 magnitudes (Allen, Astrophysical
    // Quantities, 1976).
    constexpr double kFullEarth = 1.2e-4;
    Moon result;
    result.direction = moon.direction;
    result.to_sun = normalize(sun.direction * sun.distance_au - moon.direction * moon.distance_au);
    result.axis = normalize(glm::transpose(stars.axes) * ecliptic_pole);
    result.semidiameter_rad = moon.semidiameter_rad;
    result.light = sun::moonlight(moon);
    result.radiance = sun::moon_radiance(moon);
    result.earthshine = kFullEarth * (1 - moon.illuminated_fraction);
    return result;
}

void choose_direct_light(FrameInputs& inputs, SunLight moonlight) {
    inputs.moonlight.reset();
    if (shines(inputs.sun) || !shines(moonlight)) return;
    moonlight.strength = inputs.moon->light;
    moonlight.air = inputs.sun.air;
    inputs.moonlight = std::move(moonlight);
}

double moonlight_lux(const FrameInputs& inputs) {
    if (!inputs.moonlight) return 0;
    const double elevation_rad = elevation_of(inputs.moonlight->direction.z);
    const double apparent_rad = elevation_rad + inputs.moonlight->lift_rad(elevation_rad);
    const glm::dvec3 direct = inputs.moon->light * sun::direct_transmittance(apparent_rad, 0) *
                              std::max(0.0, std::sin(apparent_rad));
    return sun::kSolarIlluminance_lux *
           luminance(direct + sun::moonlit_sky_irradiance(elevation_rad, inputs.moon->light));
}

void write_moon(const FrameInputs& inputs, const HeightLight& at_eye, const glm::dvec3& eye_up,
                double bent, double horizon_sine, SkyBlock& block) {
    if (!inputs.moon) return;
    const Moon& moon = *inputs.moon;
    const glm::dvec4 seen = seen_from(eye_up, moon.direction, inputs.sun, bent);
    if (seen.w + moon.semidiameter_rad < std::asin(horizon_sine)) return;
    const glm::dvec3 air = at_eye.passed(inputs.sun, dot(moon.direction, eye_up), bent);
    block.eye_moon = glm::vec4(glm::dvec3(seen), moon.semidiameter_rad);
    block.eye_moon_light = glm::vec4(moon.light * air, inputs.moonlight ? 1 : 0);
    block.moon_to_sun = glm::vec4(moon.to_sun, 0);
    block.moon_axis = glm::vec4(moon.axis, 0);
    block.moon_radiance = glm::vec4(moon.radiance * air, moon.earthshine);
    // The corona is a millionth of the sun: the sky drowns it in all but the last of an eclipse.
    constexpr double kShowsCorona = 0.002;
    if (inputs.sun_visible < kShowsCorona)
        block.corona =
            glm::vec4(at_eye.passed(inputs.sun, dot(inputs.sun.direction, eye_up), bent), 0);
}

}  // namespace relevo::render
