#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "effect/module_marks.h"
#include "effect/native_module.h"
#include "gl/context.h"
#include "gl/texture.h"
#include "render/frame_block.h"
#include "render/terrain.h"
#include "shader/param_store.h"

namespace relevo::render {

/// Shader sources of a module's full-screen program. @param own  its fragment shader
struct NativeProgramText {
    std::string vertex, fragment;
};
NativeProgramText native_program_text(std::string_view own);

/// A module's instance, and the services of relevo/plugin.h for one renderer.
class NativeHost {
  public:
    /// Draws terrain orthographically: binds the program, then calls `draw`.
    using DrawDepth =
        std::function<void(const Terrain& terrain, const std::function<void()>& draw)>;

    /// Creates the instance. Module, context and values must outlive this.
    /// @param values  the renderer's; the module writes its host parameters
    /// @throws Error (Failed) `render: LIBRARY: reason` if the module fails
    NativeHost(const effect::NativeModule& module, gl::Context& context, DrawDepth draw_depth,
               shader::ParamStore& values, int width_px, int height_px);
    NativeHost(NativeHost&&) noexcept;
    NativeHost& operator=(NativeHost&&) noexcept;
    ~NativeHost();

    /// Calls the module's prepare(). Does not evict tile pages of `tiles`, the frame's selection.
    /// @throws Error (Failed) as the constructor
    void prepare(Terrain& terrain, const Ground& ground, const FrameInputs& inputs,
                 const FrameBlock& block, const TileSelection& tiles);

    /// Sets the size of subsequent frames.
    void resize(int width_px, int height_px);

    /// The module's texture with a name such as "vsm.moments", or null.
    const gl::Texture* find(std::string_view resource) const;

    /// The marks that the module has set for a list of its plugin.json; null before it has.
    std::shared_ptr<const effect::ModuleMarks> marks(const std::string& list) const;

    const std::string& id() const;
    /// True if a host parameter was written since the last call.
    bool take_changes();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace relevo::render
