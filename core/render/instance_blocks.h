#pragma once

#include <algorithm>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "render/lod.h"
#include "render/terrain.h"
#include "render/tile_mesh.h"
#include "shader/instance_set.h"

namespace relevo::render {

// shaders/lib/instances.glsl has these too.
inline constexpr double kLowest_px = 4;    ///< lowest instances that are drawn as meshes
inline constexpr double kMostCells = 350;  ///< from the eye; bounds how many are drawn

/// A rectangle of sites of instances, within one quadrant of a tile of the ground.
struct InstanceBlock {
    TileMesh::Instance tile{};             ///< with the rectangle, as instance.vert.glsl reads it
    glm::vec4 cells{0};                    ///< first column and row; w: range [m]
    glm::ivec2 count{0};                   ///< of columns and rows
    double nearest_m = 0, farthest_m = 0;  ///< from the eye
    Box box{};                             ///< of all that may stand in it
};

/// Distance up to which instances are drawn [m]: instances_range_m() of
/// shaders/lib/instances.glsl. @param pixel_rad  a pixel at the frame's centre
double instance_range_m(const shader::InstanceSet& set, double pixel_rad);

/// Where the instances of a set may stand in a view.
struct InstanceView {
    LodView view;
    double pixel_rad = 0;  ///< a pixel at the frame's centre
    double range_m = 0;    ///< instances_range_m() of shaders/lib/instances.glsl
    glm::dvec2 cells_per_post{1};

    InstanceView(const shader::InstanceSet& set, const Terrain& terrain, LodView of,
                 double pixel_rad);

    /// Distance at which the highest instance has a height on the screen [m].
    double distance_m(const shader::InstanceSet& set, double height_px) const {
        return std::min(range_m, set.height_m / (height_px * pixel_rad));
    }
};

/// Rectangles of sites that may be in a view, within the range. Their number and that of their
/// cells are bounded by kMostCells, whatever the spacing.
std::vector<InstanceBlock> instance_blocks(const shader::InstanceSet& set, Terrain& terrain,
                                           const TileSelection& selection,
                                           const InstanceView& view);

}  // namespace relevo::render
