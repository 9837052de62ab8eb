#pragma once

#include "render/frame_block.h"
#include "render/graph/plan.h"
#include "render/terrain.h"

namespace relevo::render {

/// What the body of a pass is given. The program, the targets and their state are bound already.
struct PassContext {
    Terrain& terrain;
    const Ground& ground;
    const FrameInputs& inputs;
    FrameBlock& block;     ///< uploaded by the pass "frame"
    TileSelection& tiles;  ///< chosen by the pass "select"
    int width_px, height_px;
    const FrameGraph& graph;
    const Plan& plan;

    /// Whether any pass of this frame reads a resource.
    bool is_read(std::string_view resource) const { return plan.reads(graph, resource); }
};

}  // namespace relevo::render
