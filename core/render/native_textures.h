#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <relevo/plugin.h>

#include "effect/module_services.h"
#include "gl/framebuffer.h"
#include "gl/texture.h"

namespace relevo::render {

/// Textures of a native module. effect::ModuleServices has validated all arguments.
class NativeTextures {
  public:
    explicit NativeTextures(std::string plugin) : plugin_(std::move(plugin)) {}

    /// @throws Error (Failed) if the device cannot create the texture
    void create(relevo_texture name, const effect::ModuleTexture& info);
    void destroy(relevo_texture name) { textures_.erase(name); }
    gl::Texture& get(relevo_texture name) { return textures_.at(name).texture; }
    /// Framebuffer of one layer of one level of a colour texture, kept with the texture.
    const gl::Framebuffer& colour_framebuffer(relevo_texture name, int level, int layer);
    /// Framebuffer of a depth texture alone, kept with the texture.
    const gl::Framebuffer& depth_framebuffer(relevo_texture name);
    void write(const relevo_texels& texels);
    /// Reads level 0 of a layer.
    void read(relevo_texture name, int layer, std::span<float> out) const;

    /// The newest texture of a name such as "vsm.moments", or null.
    const gl::Texture* find(std::string_view resource) const;

  private:
    struct Made {
        gl::Texture texture;
        std::string resource;                                         // empty: no sampler reads it
        std::map<std::pair<int, int>, gl::Framebuffer> framebuffers;  // by level and layer
    };

    std::string plugin_;
    std::map<relevo_texture, Made> textures_;
};

}  // namespace relevo::render
