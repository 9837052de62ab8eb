#pragma once

#include "base/array2d.h"
#include "mesh/refine.h"
#include "mesh/surface.h"
#include "output/ground_frame.h"

// Inside of the layer only.

namespace relevo::output {

struct MeshError {
    double worst_m = 0, mean_m = 0;
};

/// Distances of all posts of the ground from the triangle that they are over, along their
/// verticals.
/// @param position_m  of the mesh's points, as the file has them
/// @param roles       as mesh::refine() has them
MeshError mesh_error(const mesh::GridMesh& mesh, const std::vector<glm::vec3>& position_m,
                     const Array2d<float>& height_m, const Array2d<std::uint8_t>& roles,
                     const GroundFrame& frame);

}  // namespace relevo::output
