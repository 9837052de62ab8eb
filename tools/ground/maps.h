#pragma once

#include "image/ktx.h"
#include "material.h"

/// From fields to textures with their mip chains.
namespace relevo::ground {

/// Slopes of a relief: dz/ds and dz/dt in metres per metre, central differences on the torus.
struct Slopes {
    Field ds;
    Field dt;
};
Slopes slopes(const Field& height_m, double tile_m);

/// The tangent-space normal of a slope: (-dz/ds, -dz/dt, 1) made one long.
/// x goes with s (columns, east on the ground), y with t (rows upwards, north), z out of the
/// ground.
glm::vec3 normal_of_slope(float ds, float dt);

/// What is left of a specular highlight's peak where a texel stands for normals that vary:
/// 1 / (1 + 4 n v), with Phong exponent n and variance v of the slope along an axis.
/// A lobe cos^n of the angle from the mirrored direction has variance 1/n along an axis; a normal
/// tilted by d turns the mirrored direction by 2d, so variances 1/n and 4v add up, and the peak of
/// a lobe that keeps its energy falls as its width over both axes grows. Source: M. Toksvig,
/// Mipmapping Normal Maps, Journal of Graphics Tools 10(3), 2005,
/// doi:10.1080/2151237X.2005.10129203; moments of slopes: M. Olano and D. Baker, LEAN Mapping,
/// I3D 2010, doi:10.1145/1730804.1730834
float gloss_left(double shininess, double slope_variance);

/// RGB: albedo in sRGB encoding; A: gloss. Full mip chain.
/// Every level's albedo is the mean over its texels in linear light. Its gloss is the mean over its
/// texels times gloss_left() for the slopes that lie inside one texel.
image::TextureData albedo_texture(const Material& material);

/// RGB: the normal, 0.5 + 0.5 n; A: the height, 0..1 between the metadata's relevo.height_min_m and
/// relevo.height_max_m. Full mip chain.
/// Every level's normal is that of the mean slope over its texels, so it is one long, the mean
/// slope stays zero, and ground seen from far is lit as flat ground is. Rounding is dithered by a
/// hash, so that gentle slopes keep their means over 8 bits.
image::TextureData normal_texture(const Material& material);

}  // namespace relevo::ground
