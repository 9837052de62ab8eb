#pragma once

#include <optional>

#include "gl/framebuffer.h"
#include "render/graph/graph.h"

namespace relevo::render {

/// State of draws, except program and textures. Depth, stencil, colour mask, clip distances and
/// framebuffers of terrain draws are set only here.
struct DrawState {
    std::optional<Depth> depth{};
    std::optional<Stencil> stencil{};
    bool clips_voids = false;   ///< GL_CLIP_DISTANCE0
    bool clamps_depth = false;  ///< GL_DEPTH_CLAMP
    /// Culls triangles seen from below; nullopt: draws both sides.
    std::optional<bool> winds_counterclockwise{};
};

/// Binds a framebuffer and sets a state. The destructor disables all capabilities.
class DrawScope {
  public:
    /// Clears depth and stencil if the state says so.
    DrawScope(const gl::Framebuffer& target, const DrawState& state);
    ~DrawScope();
    DrawScope(const DrawScope&) = delete;
    DrawScope& operator=(const DrawScope&) = delete;
};

}  // namespace relevo::render
