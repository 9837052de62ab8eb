#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "effect/native_module.h"
#include "gl/context.h"
#include "gl/texture.h"
#include "render/frame_block.h"
#include "render/terrain.h"
#include "shader/param_store.h"

namespace relevo::render {

/// The GLSL of a program with a module's own fragment shader.
struct NativeProgramText {
    std::string vertex, fragment;
};
NativeProgramText native_program_text(std::string_view own);

/// The services of relevo/plugin.h for one renderer, and the module's instance.
class NativeHost {
  public:
    /// Calls `draw` with the program current that draws the terrain orthographically.
    using DrawDepth =
        std::function<void(const Terrain& terrain, const std::function<void()>& draw)>;

    /// Creates the instance. The module, the context and the values must outlive this.
    /// @param values  the renderer's own, whose host parameters the module writes
    /// @throws Error (Failed) `render: LIBRARY: reason` if the module cannot
    NativeHost(const effect::NativeModule& module, gl::Context& context, DrawDepth draw_depth,
               shader::ParamStore& values, int width_px, int height_px);
    NativeHost(NativeHost&&) noexcept;
    NativeHost& operator=(NativeHost&&) noexcept;
    ~NativeHost();

    /// Calls the module's prepare(). The image's tiles stay drawable.
    /// @throws Error (Failed) as above
    void prepare(Terrain& terrain, const Ground& ground, const FrameInputs& inputs,
                 const FrameBlock& block, const TileSelection& picture);

    /// Frames have this size from the next one on.
    void resize(int width_px, int height_px);

    /// A texture that the module has created with that name, "vsm.moments"; or null.
    const gl::Texture* find(std::string_view resource) const;

    const std::string& id() const;
    /// Whether a host parameter was written since the last call.
    bool take_changes();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace relevo::render
