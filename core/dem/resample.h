#pragma once

#include <functional>

#include "dem/piece.h"

// Heights of a raster on another grid than its own. Inside of the layer only.

namespace relevo::dem {

/// Reads posts of a raster's own grid. The window may reach beyond its edges.
/// @param height_m  with room for the window, row after row; becomes NaN where nothing is known
using ReadPosts = std::function<void(const Window& posts, float* height_m)>;

/// The mean of the posts around a place, weighted by a tent. Voids have no part in it. NaN if the
/// nearest post of the raster is a void, and outside of the raster's cells.
/// @param at        column and row of the raster
/// @param reach     half the width of the tent, in posts; 1: bilinear
/// @param posts     what `height_m` has
/// @param raster    columns and rows
float tent_mean(const glm::dvec2& at, const glm::dvec2& reach, const Window& posts,
                const float* height_m, const glm::ivec2& raster);

/// Heights of posts of the DEM, as tent_mean() of the posts of a raster and of those around it:
/// without these, the last half cell would repeat the raster's edge. The result at a post does not
/// depend on the window. Takes memory for a million posts of the raster at most.
/// @param piece     with Piece::resampling
/// @param window    of Piece::place
/// @param height_m  with room for the window, row after row
void resample(const Piece& piece, const Window& window, const ReadPosts& read, float* height_m);

}  // namespace relevo::dem
