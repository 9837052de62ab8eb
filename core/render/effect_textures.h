#pragma once

#include <map>
#include <string>
#include <vector>

#include "effect/manifest.h"
#include "gl/texture.h"

namespace relevo::render {

/// The textures of all enabled effects, on the device. KTX 2 files go there as they are; pictures
/// are decoded, and get mipmaps where the manifest says so.
class EffectTextures {
  public:
    EffectTextures() = default;
    /// @throws Error (BadInput) for a file that is missing or broken, and layers of different sizes
    EffectTextures(const std::vector<effect::TextureSpec>& specs, double anisotropy);

    /// Null if no effect asked for it.
    const gl::Texture* find(const std::string& resource) const;

  private:
    std::map<std::string, gl::Texture> textures_;
};

}  // namespace relevo::render
