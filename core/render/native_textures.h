#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

#include <relevo/plugin.h>

#include "gl/context.h"
#include "gl/texture.h"

namespace relevo::render {

/// The textures that a native module has made: "relevo.texture" of relevo/plugin.h.
class NativeTextures {
  public:
    NativeTextures(std::string plugin, const gl::DeviceInfo& device);

    /// @throws Error (Failed) for what the device does not take
    relevo_texture create(const relevo_texture_info& info);
    /// @throws Error (Failed) if there is no such texture; so below
    void destroy(relevo_texture name);
    const gl::Texture& get(relevo_texture name) const { return at(name).texture; }
    gl::Texture& get(relevo_texture name);
    /// @throws Error (Failed) also for what is no rectangle of the texture, or has other bytes
    void write(const relevo_texels& texels);
    /// Level 0 of a layer.
    /// @throws Error (Failed) for too little room, and for textures that are not of floats
    void read(relevo_texture name, int layer, std::span<float> out) const;

    /// The one of that name, "vsm.moments"; or null.
    const gl::Texture* find(std::string_view resource) const;

  private:
    struct Made {
        gl::Texture texture;
        std::string resource;
    };
    const Made& at(relevo_texture name) const;

    std::string plugin_;
    gl::DeviceInfo device_;
    std::map<relevo_texture, Made> textures_;
    relevo_texture last_ = 0;
};

}  // namespace relevo::render
