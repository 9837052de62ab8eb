#pragma once

#include "dem/pyramid.h"
#include "render/lod.h"

namespace relevo::render {

/// True if some of a tile's triangles may be in a perspective view. Unlike its box, triangles
/// around an eye near the ground are below all that is seen upwards.
/// @param net            the tile's proxy grid
/// @param morph_start_m  distance from the eye from which vertices morph
bool is_ground_in_view(const dem::Pyramid& pyramid, const TileDraw& tile, const PatchNet& net,
                       double morph_start_m, const Displacement& displacement, const LodView& view);

}  // namespace relevo::render
