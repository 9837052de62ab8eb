#pragma once

#include <vector>

#include "base/file_stamps.h"
#include "effect/manifest.h"
#include "image/ktx.h"

namespace relevo::effect {

/// A texture of a plugin, loaded and checked. Only a device may still refuse it.
struct LoadedTexture {
    TextureSpec spec;
    /// One; of an array, its layers in order. All have the same format, sides and levels.
    std::vector<image::TextureData> layers;
    FileStamps stamps;  ///< of its files, as they were read

    /// Whether the files have the mipmaps that the manifest requests.
    bool has_mipmaps() const { return spec.mipmaps && layers.front().levels() > 1; }
};

/// Loads a texture's files. KTX 2 files are mapped; image files are decoded; tables are read. A
/// table that is to be chosen has no file until it is.
/// @throws Error (BadInput) `plugin: FILE: ...` for a file that is missing or broken, is of
///         another kind than the manifest says, or does not fit the other layers
LoadedTexture load_texture(const TextureSpec& spec);

/// The largest textures that a device supports [px].
struct TextureLimits {
    int side_px = 0;         ///< of a 2-D texture
    int volume_side_px = 0;  ///< of a volume
    int layers = 0;          ///< of an array
};

/// @throws Error (BadInput) `plugin: FILE: ...` for a larger texture
void check_limits(const LoadedTexture& texture, const TextureLimits& limits);

}  // namespace relevo::effect
