#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "base/array2d.h"
#include "dem/pyramid.h"
#include "render/lod.h"

namespace relevo::render {

/// A wall below an edge of the ground, in vertex units of a tile (side.vert.glsl). Seen from above
/// it runs round the ground against the order of the ground's triangles.
struct SideEdge {
    glm::vec2 a, b;
    glm::vec2 third;   ///< x < 0: on the DEM's edge; otherwise a, b, third is a clipped triangle
    int quadrant = 0;  ///< of the tile: bit x + 2 y, as in TileDraw
};

/// Edges of the ground that have walls: the DEM's edge and the voids that reach it. Voids that
/// ground encloses have none, nor has a piece of ground that is narrower than an eighth of the DEM:
/// it would be a tower.
class Sides {
  public:
    explicit Sides(const dem::Pyramid& pyramid) : pyramid_(&pyramid) {}

    /// The edges of a tile, including those at the level it may morph to. Cached.
    const std::vector<SideEdge>& edges(const TileKey& key);

    static constexpr int kVectors = 2;  ///< per vertex: inputs ends and third of side.vert.glsl

    /// Appends the walls below some quadrants of a tile: vertices, and triangles whose indices are
    /// relative to the first appended vertex.
    void add(const TileKey& key, std::uint8_t quadrants, std::vector<glm::vec4>& vertices,
             std::vector<std::uint16_t>& indices);

  private:
    std::vector<SideEdge> find(const TileKey& key);
    void find_parts();
    /// Bits of what is at a node or near it: kOpen, kWide.
    int parts_at(int level, glm::ivec2 node) const;

    const dem::Pyramid* pyramid_;
    std::unordered_map<std::uint64_t, std::vector<SideEdge>> edges_;
    int first_parts_ = 0;                       // level of the first of parts_
    std::vector<Array2d<std::uint8_t>> parts_;  // of levels from there; empty: not yet found
};

}  // namespace relevo::render
