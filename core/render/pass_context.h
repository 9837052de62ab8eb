#pragma once

#include <string>
#include <string_view>

#include "render/frame_block.h"
#include "render/graph/plan.h"
#include "render/graph_targets.h"
#include "render/terrain.h"

namespace relevo::render {

class Instances;

/// Services of a renderer for the bodies of core's passes.
class FrameServices {
  public:
    virtual ~FrameServices() = default;
    /// Uploads and binds the frame's and the parameters' uniform blocks.
    virtual void upload_blocks(const FrameBlock& block) = 0;
    /// Creates the texture `floor_ground`.
    virtual void make_footprint(const Footprint& footprint) = 0;
    /// Draws the instances of plugins.
    virtual Instances& instances() = 0;
    /// Calls a native effect's prepare().
    virtual void prepare_native(const std::string& id, PassContext& frame) = 0;
};

/// Arguments of a pass's body. Program, targets and state are already bound.
struct PassContext {
    Terrain& terrain;
    const Ground& ground;
    const FrameInputs& inputs;
    FrameBlock& block;     ///< uploaded in the pass "frame"
    TileSelection& tiles;  ///< selected in the pass "select"
    int width_px, height_px;
    const Plan& plan;
    GraphTargets& targets;
    FrameServices& services;
    const Pass* pass = nullptr;  ///< the current pass; set by the runner

    /// True if a pass of this frame reads a resource.
    bool is_read(std::string_view resource) const { return plan.reads(resource); }
    /// A target of the graph. @throws Error (Failed) if the pass does not declare it, or it is of
    /// another kind
    gl::Texture& texture(std::string_view resource) const;
    const gl::Buffer& buffer(std::string_view resource) const;
};

}  // namespace relevo::render
