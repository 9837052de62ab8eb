#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include <glm/glm.hpp>

#include "mesh/refine.h"

namespace relevo::mesh {

/// A triangle mesh of any size, on its way to a file.
struct Surface {
    std::vector<glm::vec3> position_m;  ///< x east, y north, z up
    std::vector<glm::vec3> normal;      ///< unit, one a position; or none
    std::vector<glm::vec2> texture;  ///< 0..1 from the upper left corner, one a position; or none
    std::vector<std::uint32_t> corners;  ///< three a triangle, counter-clockwise from outside

    std::size_t triangles() const { return corners.size() / 3; }
};

/// A solid under a mesh: walls from its border down to a flat bottom. Closed: each edge belongs to
/// two triangles, which pass it in opposite directions; normals point outwards.
/// @param top      without corner contacts (cut_corner_contacts())
/// @param bottom   of the same ground, with the border of `top` and perhaps no other points
/// @param place_m  where a post of the top is
/// @param base_m   height of the bottom, below all of the top
Surface solid(const GridMesh& top, const GridMesh& bottom,
              const std::function<glm::dvec3(const LatticePoint&)>& place_m, double base_m);

/// Volume within a closed surface [m^3], negative where it is inside out.
double volume_m3(const Surface& surface);

}  // namespace relevo::mesh
