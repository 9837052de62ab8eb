#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "base/array2d.h"
#include "dem/grid.h"
#include "mesh/surface.h"
#include "output/ground_frame.h"

namespace relevo::output {

struct TerrainMeshOptions {
    std::string name{};  ///< of the DEM, for messages
    double error_m = 1;  ///< no post is farther above or below the mesh
    bool flat = false;   ///< GroundFrame
    bool solid = false;  ///< with walls and a flat bottom; needs `flat`
    /// Of the bottom [m]; none: a tenth of the relief below the lowest post, and at least a
    /// fiftieth of the longer side.
    std::optional<double> base_m{};
    std::int64_t max_triangles = std::int64_t{1} << 24;
    /// Is told now and then about how much is done, 0 to 1; may throw.
    std::function<void(double)> on_share{};
};

/// Triangles of a DEM, and how good they are.
struct TerrainMesh {
    mesh::Surface surface;  ///< of a solid positions alone, so that triangles share their vertices
    double worst_m = 0;     ///< farthest post, along its own vertical
    double mean_m = 0;      ///< of all posts
    std::size_t ground_triangles = 0;  ///< without walls and bottom
    std::int64_t posts = 0;            ///< of the ground
    std::int64_t lone_posts = 0;  ///< with a height, but in no cell of four posts that have one
    std::int64_t cut_posts = 0;   ///< made void because cells of the solid touched at a corner
    std::optional<double> base_m;
};

/// Refines until all posts are within the error, as the file's own numbers (32-bit floats in the
/// frame) place them.
/// @param height_m  NaN for voids; columns eastwards, rows southwards (dem::north_up_of)
/// @param grid      of these posts
/// @param frame     of this grid
/// @throws Error (BadInput) for fewer than 2 x 2 posts, more than mesh::Delaunay::kMaxSide a side,
///     no cell of ground, an error below what 32-bit floats hold, too many triangles, and a base
///     that is not below the ground
TerrainMesh terrain_mesh(Array2d<float> height_m, const dem::Grid& grid, const GroundFrame& frame,
                         const TerrainMeshOptions& options);

}  // namespace relevo::output
