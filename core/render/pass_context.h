#pragma once

#include <string>
#include <string_view>

#include "render/frame_block.h"
#include "render/graph/plan.h"
#include "render/graph_targets.h"
#include "render/terrain.h"

namespace relevo::render {

/// What a renderer has beside the terrain and does for the bodies of core's passes.
class FrameServices {
  public:
    virtual ~FrameServices() = default;
    /// Uploads and binds the blocks of the frame and of the parameters.
    virtual void upload_blocks(const FrameBlock& block) = 0;
    /// Computes the texture `floor_ground`.
    virtual void make_footprint(const Footprint& footprint) = 0;
    /// Lets a native effect prepare the frame.
    virtual void prepare_native(const std::string& id, PassContext& frame) = 0;
};

/// What the body of a pass is given. The program, the targets and their state are bound already.
struct PassContext {
    Terrain& terrain;
    const Ground& ground;
    const FrameInputs& inputs;
    FrameBlock& block;     ///< uploaded by the pass "frame"
    TileSelection& tiles;  ///< chosen by the pass "select"
    int width_px, height_px;
    const Plan& plan;
    GraphTargets& targets;
    FrameServices& services;
    const Pass* pass = nullptr;  ///< the one that is executed; set by the runner

    /// Whether any pass of this frame reads a resource.
    bool is_read(std::string_view resource) const { return plan.reads(resource); }
    /// Memory that the graph has allocated. @throws Error (Failed) for a resource that the pass
    /// does not declare, or of another kind
    gl::Texture& texture(std::string_view resource) const;
    const gl::Buffer& buffer(std::string_view resource) const;
};

}  // namespace relevo::render
