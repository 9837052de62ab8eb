#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "effect/texture_files.h"
#include "gl/texture.h"

namespace relevo::render {

/// Caches effects' textures on the device by the files that they were read from. Unused ones are
/// deleted.
class EffectTextureCache {
  public:
    /// The texture. Creates mipmaps if the manifest requests them and the files have none.
    /// @pre  effect::check_limits() of this device
    /// @throws Error (Failed) if the device is out of memory
    std::shared_ptr<const gl::Texture> find_or_make(const effect::LoadedTexture& from,
                                                    double anisotropy);

  private:
    struct Known {
        effect::TextureSpec spec;
        FileStamps files;
        std::weak_ptr<const gl::Texture> texture;
    };
    std::vector<Known> known_;
};

/// The textures of the enabled effects on the device.
class EffectTextures {
  public:
    EffectTextures() = default;
    /// @throws Error as EffectTextureCache
    EffectTextures(const std::vector<const effect::LoadedTexture*>& textures, double anisotropy,
                   EffectTextureCache& cache);

    /// Null if no effect declares it.
    const gl::Texture* find(const std::string& resource) const;

  private:
    std::map<std::string, std::shared_ptr<const gl::Texture>> textures_;
};

}  // namespace relevo::render
