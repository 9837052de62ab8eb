#pragma once

#include <cstdint>
#include <vector>

#include "render/pages.h"

/// The grid of vertices of every terrain tile.
namespace relevo::render {

/// Vertices along a side, including the skirt.
inline constexpr int kGridSide = kTileQuads + 3;
inline constexpr int kGridVertices = kGridSide * kGridSide;
inline constexpr int kQuadrantQuads = (kGridSide - 1) / 2;
inline constexpr int kQuadrantIndices = kQuadrantQuads * kQuadrantQuads * 6;

/// Positions of vertices [quads of the tile], x and y, row by row.
std::vector<float> tile_grid_vertices();

/// One quadrant after another, so that each can be drawn separately.
std::vector<std::uint16_t> tile_grid_indices();

}  // namespace relevo::render
