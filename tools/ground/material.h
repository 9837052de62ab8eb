#pragma once

#include <string>
#include <vector>

#include "field.h"

namespace relevo::ground {

/// One tile of ground, before it becomes textures.
struct Material {
    std::string name;
    std::string description;  ///< one line, for the file's metadata
    double tile_m = 1;        ///< side of the tile on the ground
    double shininess = 1;     ///< Phong exponent that the gloss of the mip levels is filtered for
    glm::vec3 mean_albedo{0.5f};  ///< what the albedo's mean is brought to, linear

    Field height_m;      ///< relief, mean 0
    ColourField albedo;  ///< diffuse reflectance, no light in it
    Field gloss;         ///< 0..1, multiplies the specular term
};

/// The four grounds of the layering effect, each n x n texels, n a power of two and at least 64.
/// The result depends on n alone.
Material make_sand(int n);
Material make_grass(int n);
Material make_rock(int n);
Material make_snow(int n);

std::vector<std::string> material_names();  ///< sand, grass, rock, snow: from low ground to high
Material make_material(const std::string& name, int n);

/// What every material goes through last: flatten() on relief, colour and gloss, so that no wave of
/// the tile's own size is left, and the mean of the colour brought to mean_albedo.
void finish(Material& material);

/// sRGB of a linear value, both 0..1. Source: IEC 61966-2-1:1999.
float srgb_encoded(float linear);
float srgb_decoded(float encoded);

/// 0.2126 R + 0.7152 G + 0.0722 B, of linear sRGB (IEC 61966-2-1).
float luminance(const glm::vec3& linear);

/// Smooth passage from 0 at `from` to 1 at `to`; from may be the greater.
float smoothstep(float from, float to, float x);

}  // namespace relevo::ground
