#pragma once

#include <string>
#include <vector>

#include "dem/piece.h"
#include "dem/tile_index.h"

// The grid that the rasters of a DEM share. Inside of the layer only.

namespace relevo::dem {

/// The grid of one raster, which the others of the DEM are read on.
struct Frame {
    Grid grid;
    std::string name;         ///< that raster's
    glm::ivec2 origin{0, 0};  ///< the DEM's first post there
};

/// An index that is a DEM or a part of it, with one of its tiles open.
struct OpenIndex {
    TileIndex index;
    std::size_t sample = 0;  ///< the tile that is open: what the others are expected to be like
    std::size_t piece = 0;   ///< its number among the pieces
    std::vector<Window> reaches;  ///< of all its tiles, on the DEM: the posts that each may have
};

/// Gives each piece and each tile of the indexes its place on one grid, and says in `about` what
/// was done. That grid is the finest piece's.
/// @param whole  becomes the grid of the DEM
/// @throws Error (BadInput) where they cannot be joined
Frame join(std::vector<Piece>& pieces, std::vector<OpenIndex>& indexes, Description& about,
           std::optional<Grid>& whole);

/// Gives a piece its place on the DEM: as it is where its posts lie on the grid's, else resampled.
/// @throws Error (BadInput) where it cannot be resampled
void settle_on(const Frame& frame, Piece& piece);

}  // namespace relevo::dem
