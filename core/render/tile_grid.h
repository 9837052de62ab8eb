#pragma once

#include <cstdint>
#include <vector>

#include "render/pages.h"

/// The grid of vertices that every tile of the terrain is drawn with.
namespace relevo::render {

/// Vertices along a side: those of the tile and its skirt.
inline constexpr int kGridSide = kTileQuads + 3;
inline constexpr int kGridVertices = kGridSide * kGridSide;
inline constexpr int kQuadrantQuads = (kGridSide - 1) / 2;
inline constexpr int kQuadrantIndices = kQuadrantQuads * kQuadrantQuads * 6;

/// Places of the vertices [quads of the tile], x and y, row after row.
std::vector<float> tile_grid_vertices();

/// Quadrant after quadrant, so that any of them can be drawn alone.
std::vector<std::uint16_t> tile_grid_indices();

}  // namespace relevo::render
