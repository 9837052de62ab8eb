#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "effect/abi/relevo_plugin.h"
#include "gl/context.h"
#include "gl/texture.h"

namespace relevo::render {

/// The textures that a native module has made: "relevo.texture" of relevo_plugin.h.
class NativeTextures {
  public:
    NativeTextures(std::string plugin, const gl::DeviceInfo& device);

    /// @throws Error (Failed) for what the device does not take
    relevo_texture create(const relevo_texture_info& info);
    void destroy(relevo_texture name) { textures_.erase(name); }
    /// @throws Error (Failed) if there is no such texture
    const gl::Texture& get(relevo_texture name) const { return at(name).texture; }
    gl::Texture& get(relevo_texture name);
    /// Level 0 of a layer.
    /// @param count  of floats that `out` has room for
    /// @throws Error (Failed) for too little room, and for textures that are not of floats
    void read(relevo_texture name, int layer, float* out, std::uint64_t count) const;

    /// The one of that name, "vsm.moments"; or null.
    const gl::Texture* find(std::string_view resource) const;

  private:
    struct Made {
        gl::Texture texture;
        std::string resource;
        int floats = 0;
    };
    const Made& at(relevo_texture name) const;

    std::string plugin_;
    gl::DeviceInfo device_;
    std::map<relevo_texture, Made> textures_;
    relevo_texture last_ = 0;
};

}  // namespace relevo::render
