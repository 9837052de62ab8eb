#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include <glm/vec4.hpp>

#include "gl/context.h"
#include "gl/texture.h"
#include "render/frame_block.h"
#include "shader/param_store.h"
#include "support/device.h"

namespace relevo::test {

/// Runs a plugin's functions on the device, once for each pixel of a float target, so that a test
/// can hold them against a reference number by number.
class GpuSnippet {
  public:
    /// @param plugin  the id of a plugin of this project, whose GLSL is read from its folder;
    /// empty:
    ///                core's own functions alone
    /// @param include  a file of core's that the body needs besides, "lib/srgb.glsl"
    explicit GpuSnippet(const std::string& plugin, const std::string& include = "");

    shader::ParamStore& values() { return values_; }
    render::FrameBlock& frame() { return frame_; }
    /// Has the sampler of that name read a texture, which must outlive the runs.
    void bind(const std::string& sampler, const gl::Texture& texture) {
        textures_[sampler] = &texture;
    }

    /// @param body  GLSL that assigns `result`, a vec4; `x` and `y` are the pixel's column and row
    /// @returns the results, row by row
    std::vector<glm::vec4> run(const std::string& body, int columns, int rows);

  private:
    std::string plugin_, include_;
    gl::Context context_{{.device = gl_device(), .debug = true}};
    shader::ParamStore values_;
    render::FrameBlock frame_{};
    std::map<std::string, const gl::Texture*> textures_;
};

}  // namespace relevo::test
