#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "dem/pyramid.h"
#include "render/lod.h"

namespace relevo::render {

/// A wall below an edge of the ground, in vertices of a tile (side.vert.glsl).
struct SideEdge {
    glm::vec2 a, b;
    glm::vec2 third;   ///< x below 0: on the DEM's rim; else a to third is a triangle that is cut
    int quadrant = 0;  ///< of the tile, bit x + 2 y as TileDraw has it
};

/// Where the ground of tiles ends: at the DEM's rim and at holes.
class Sides {
  public:
    explicit Sides(const dem::Pyramid& pyramid) : pyramid_(&pyramid) {}

    /// The edges of a tile, of any level that it may be morphing to. Kept once asked for.
    const std::vector<SideEdge>& edges(const TileKey& key);

    static constexpr int kVectors = 2;  ///< of a vertex: inputs ends and third of side.vert.glsl

    /// Adds the walls below the edges of some quadrants of a tile: vertices, and triangles of them
    /// that count from the first vertex added.
    void add(const TileKey& key, std::uint8_t quadrants, std::vector<glm::vec4>& vertices,
             std::vector<std::uint16_t>& indices);

  private:
    std::vector<SideEdge> find(const TileKey& key) const;

    const dem::Pyramid* pyramid_;
    std::unordered_map<std::uint64_t, std::vector<SideEdge>> edges_;
};

}  // namespace relevo::render
