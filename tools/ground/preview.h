#pragma once

#include <filesystem>

#include "image/ktx.h"

/// Pictures for people: what the textures look like by themselves, repeated, and under a sun.
namespace relevo::ground {

/// Writes PNG pictures of one ground into `dir`, all with t (north) up:
///
///     NAME_albedo, _gloss, _normal, _height   the maps
///     NAME_high, NAME_low                     lit by a sun at 60 and 12 degrees, from north-west
///     NAME_repeat                             8 x 8 tiles, lit at 40 degrees
///     NAME_view                               level ground seen by a person who stands on it
/// @throws Error (Failed) if a file cannot be written
void write_previews(const std::filesystem::path& dir, const std::string& name,
                    const image::TextureData& albedo, const image::TextureData& normal);

/// A lit picture, `size` pixels a side, of side_m metres of ground; several go side by side.
struct Ground {
    const image::TextureData* albedo;
    const image::TextureData* normal;
};
void write_composite(const std::filesystem::path& path, const std::vector<Ground>& grounds,
                     double side_m, double sun_elevation_deg);

/// Three slices of a volume, each repeated twice across and down.
void write_volume_preview(const std::filesystem::path& path, const image::TextureData& volume);

}  // namespace relevo::ground
