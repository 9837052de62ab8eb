#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "gl/texture.h"

namespace relevo::render {

/// A texture that an effect reads, as its manifest describes it.
struct TextureRequest {
    std::string resource;  ///< "layering.albedo": what the stitcher calls it
    gl::TextureKind kind = gl::TextureKind::D2;
    std::vector<std::filesystem::path> files;  ///< one; of an array, its layers
    int slices = 1;                            ///< of a volume whose slices lie below each other
    bool srgb = false;
    bool mipmaps = true;
    gl::Wrap wrap = gl::Wrap::Repeat;
};

/// The textures of all enabled effects, on the device. KTX 2 files go there as they are; pictures
/// are decoded, and get mipmaps where the request says so.
class EffectTextures {
  public:
    EffectTextures() = default;
    /// @throws Error (BadInput) for a file that is missing or broken, and layers of different sizes
    EffectTextures(const std::vector<TextureRequest>& requests, double anisotropy);

    /// Null if no effect asked for it.
    const gl::Texture* find(const std::string& resource) const;

  private:
    std::map<std::string, gl::Texture> textures_;
};

}  // namespace relevo::render
