#pragma once

#include <optional>

#include "gl/framebuffer.h"
#include "render/graph/graph.h"

namespace relevo::render {

/// The state of draws, other than program and textures. Nothing else sets depth, stencil, colour
/// masks and clip distances, or binds framebuffers for draws of the terrain.
struct DrawState {
    std::optional<Depth> depth{};
    std::optional<Stencil> stencil{};
    bool clips_voids = false;   ///< GL_CLIP_DISTANCE0
    bool clamps_depth = false;  ///< GL_DEPTH_CLAMP
    /// Culls triangles that are seen from below; none: draws both sides.
    std::optional<bool> winds_counterclockwise{};
};

/// While this lives draws go to a framebuffer in a state. At its end every capability is off again.
class DrawScope {
  public:
    /// Clears the depth and the stencil where the state says so.
    DrawScope(const gl::Framebuffer& target, const DrawState& state);
    ~DrawScope();
    DrawScope(const DrawScope&) = delete;
    DrawScope& operator=(const DrawScope&) = delete;
};

}  // namespace relevo::render
