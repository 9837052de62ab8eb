#pragma once

#include <cstddef>
#include <span>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "image/ktx.h"
#include "sky/atmosphere.h"

namespace relevo::skymaker {

/// Coordinates of the textures of the sky at sea level. plugins/sky/sky.glsl has the same formulas.
struct Layout {
    static constexpr int kAround = 48;   ///< s = 0.5 + 0.5 cos(azimuth from the sun), 0..1
    static constexpr int kUp = 64;       ///< t, by sine_of; 0 and 1 included
    static constexpr int kSuns = 40;     ///< slices: sines of the sun's elevation, by slice_of
    static constexpr int kNormals = 12;  ///< of the light on slopes: the same s; t = normal's z
    static constexpr double kFold = 0.14;
    static constexpr double kLowestSun_deg = -18;

    /// Sine of the elevation at t: t^2, but not below that of 1.8 degrees. What lies below has the
    /// colour above the horizon's haze, not that of the dark line in it.
    static double sine_of(double t);
    /// Place among the slices, 0..1, of a sun's sine.
    static double slice_of(double sun_sine);
    /// Its inverse.
    static double sun_sine_of(double slice);
};

/// Irradiance of slopes by the sky alone over that of level ground, each colour by itself, for each
/// elevation of the sun: a volume of half floats by azimuth of the normal, z of the normal (0..1),
/// and slice. The ground and the sun's disc send nothing.
image::TextureData light_texture(const sky::Atmosphere& air);

/// Radiance at one elevation of the sun, without the aureole, over the luminance of
/// level_irradiance: the paper's day, sunset and night.
image::TextureData single_texture(const sky::Atmosphere& air, double sun_sine);

/// Light of the whole sky on level ground at sea level, without the sun's disc, by summing up its
/// directions; linear sRGB, units of sky::Atmosphere. Has the light of a moonless night.
glm::dvec3 level_irradiance(const sky::Atmosphere& air, double sun_sine);

double luminance(const glm::dvec3& linear_srgb);

/// Half floats, little-endian, into texel `index` of an Rgba16F texture.
void write_texel(std::span<std::byte> texels, std::size_t index, const glm::dvec4& value);

}  // namespace relevo::skymaker
