#pragma once

#include <cstddef>
#include <span>

#include <glm/vec4.hpp>

#include "atmosphere.h"
#include "image/ktx.h"

namespace relevo::skymaker {

/// How the sky's colours lie in their textures. A shader finds them with the same formulas
/// (plugins/sky/sky.glsl).
///
/// All hold light relative to the luminance of what the sky, with its aureole, sheds on level
/// ground: the mean luminance over the hemisphere, weighted with the sine of the elevation, is 1.
/// The aureole itself is left out of the radiance, which the paper's skies alone have.
struct Layout {
    static constexpr int kAround = 48;   ///< s = 0.5 + 0.5 cos(azimuth from the sun), 0..1
    static constexpr int kUp = 64;       ///< t, by sine_of; 0 and 1 included
    static constexpr int kSuns = 40;     ///< slices: sines of the sun's elevation, by slice_of
    static constexpr int kNormals = 12;  ///< of the light on slopes: the same s; t = normal's z
    static constexpr double kFold = 0.14;
    static constexpr double kLowestSun_deg = -18;

    /// Sine of the elevation at t: its square, bent to end 1.8 degrees above the horizon, so that
    /// what lies below takes the colour over the horizon's haze and not of the dark line in it.
    static double sine_of(double t);
    /// Place among the slices, 0..1, of a sun's sine.
    static double slice_of(double sun_sine);
    /// Its inverse.
    static double sun_sine_of(double slice);
};

/// Irradiance of slopes by the sky alone, for every height of the sun, a volume of half floats: s
/// from the azimuth of a normal against the sun's, t the normal's z, 0..1. The ground sends
/// nothing.
image::TextureData light_texture(const Atmosphere& air);

/// Radiance at one height of the sun: the paper's day, sunset and night.
image::TextureData single_texture(const Atmosphere& air, double sun_sine);

/// Light of the whole sky on level ground, without the sun, as a share of the sun's outside the
/// atmosphere; linear sRGB. Below the horizon a moonless night's is part of it.
glm::dvec3 level_irradiance(const Atmosphere& air, double sun_sine);

double luminance(const glm::dvec3& linear_srgb);

/// Half floats, little-endian, into texel `index` of an Rgba16F texture.
void write_texel(std::span<std::byte> texels, std::size_t index, const glm::dvec4& value);

}  // namespace relevo::skymaker
