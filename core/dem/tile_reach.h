#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dem/grid.h"
#include "dem/tile_index.h"

// Where rasters lie on the grid of a DEM. Inside of the layer only.

namespace relevo::dem {

/// More columns or rows than a raster of the whole Earth at 1 m has is a mistake.
inline constexpr double kMaxPosts = 5e7;

/// The whole turns of longitude that are nearest to an offset, in units of the CRS; 0 for projected
/// ones.
double whole_turns(const geo::Crs& crs, double offset);

/// Of a post: files whose posts are this near to those of the others are on one grid.
inline constexpr double kSamePlace = 0.02;

/// The place of a raster whose posts are on a grid; nothing where they are not.
/// @param off_posts  how far from the grid's they may be
std::optional<Window> place_on_grid(const Grid& own, const Grid& grid,
                                    double off_posts = kSamePlace);

/// The posts of a grid that a raster covers with its cells.
/// @param name, reference  of both, for messages
/// @throws Error (BadInput) where parts of the raster have no place in the grid's CRS
Window place_resampled(const Grid& own, const Grid& grid, const std::string& name,
                       const std::string& reference);

/// The posts of a grid that each tile of an index may have, by what the index says: its place where
/// its outline runs along cells, else somewhat more.
/// @throws Error (BadInput) as place_resampled()
std::vector<Window> reaches_of(const TileIndex& index, const Grid& grid,
                               const std::string& reference);

}  // namespace relevo::dem
