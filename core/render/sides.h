#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "dem/pyramid.h"
#include "render/lod.h"

namespace relevo::render {

/// A wall below an edge of the ground, in vertex units of a tile (side.vert.glsl).
struct SideEdge {
    glm::vec2 a, b;
    glm::vec2 third;   ///< x < 0: on the DEM's edge; otherwise a, b, third is a clipped triangle
    int quadrant = 0;  ///< of the tile: bit x + 2 y, as in TileDraw
};

/// Edges of the ground: the DEM's edge and its voids.
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
    std::vector<SideEdge> find(const TileKey& key) const;

    const dem::Pyramid* pyramid_;
    std::unordered_map<std::uint64_t, std::vector<SideEdge>> edges_;
};

}  // namespace relevo::render
