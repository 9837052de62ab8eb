#pragma once

#include <glm/vec3.hpp>

#include "render/frame_block.gen.h"
#include "sun/celestial.h"
#include "sun/moon.h"

namespace relevo::render {

class HeightLight;
struct FrameInputs;
struct SunLight;

/// The moon over a DEM, for the shaders. Directions are of the local frame, unit, geometric.
struct Moon {
    glm::dvec3 direction{0, 0, -1};
    glm::dvec3 to_sun{0, 0, -1};  ///< from the moon
    glm::dvec3 axis{0, 0, 1};     ///< of the moon, northwards, without libration
    double semidiameter_rad = 0;
    glm::dvec3 light{0};     ///< irradiance outside the atmosphere, linear sRGB
    glm::dvec3 radiance{0};  ///< sun::moon_radiance()
    double earthshine = 0;   ///< light of the Earth on the dark side, relative to the sun's there
};

/// @param sun, stars  at the same place and time
Moon make_moon(const sun::MoonPosition& moon, const sun::Position& sun,
               const sun::CelestialFrame& stars);

/// Sets the direct light to the moon's if no part of the sun is above the horizon of the
/// highest ground and the moon is.
/// @param moonlight  the moon as make_sun_light() has it
void choose_direct_light(FrameInputs& inputs, SunLight moonlight);

/// Light on level ground from the moon and the sky that it lights, where the moon is the direct
/// light [lux]; else 0.
double moonlight_lux(const FrameInputs& inputs);

/// Writes the moon's part of the frame block.
/// @param at_eye  light at the eye's height
/// @param eye_up  vertical at the eye
/// @param bent    refraction at the eye, as a fraction of that in inputs.sun
/// @param horizon_sine  of the horizon's elevation at the eye
void write_moon(const FrameInputs& inputs, const HeightLight& at_eye, const glm::dvec3& eye_up,
                double bent, double horizon_sine, SkyBlock& block);

}  // namespace relevo::render
