#pragma once

#include <map>
#include <string>
#include <vector>

#include "effect/texture_files.h"
#include "gl/texture.h"

namespace relevo::render {

/// The textures of all enabled effects, on the device. They get mipmaps where the manifest says so
/// and the files have none.
class EffectTextures {
  public:
    EffectTextures() = default;
    /// @pre  effect::check_limits() of this device
    /// @throws Error (Failed) where the device has no memory for them
    EffectTextures(const std::vector<const effect::LoadedTexture*>& textures, double anisotropy);

    /// Null if no effect asked for it.
    const gl::Texture* find(const std::string& resource) const;

  private:
    std::map<std::string, gl::Texture> textures_;
};

}  // namespace relevo::render
