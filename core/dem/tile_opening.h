#pragma once

#include <string>

#include "dem/mosaic.h"

// Opens the tiles of an index. Inside of the layer only.

namespace relevo::dem {

/// Whether there is a file of a name; of the net true, as only opening it tells.
bool is_there(const std::string& location);

/// Whether a name on the command line is that of an index, on the net too.
bool is_named_index(const std::string& name);

/// Opens a tile as open_piece() does. @throws Error (BadInput) also for an index
Piece open_tile_piece(const TileIndex& index, const IndexedTile& tile, const LoadOptions& options,
                      std::size_t files, Dataset& opened);

/// Reads an index and opens the first of its tiles that is there.
/// @param piece   becomes that tile
/// @param opened  becomes its handle
/// @throws Error (BadInput) as read_tile_index() and refuse_remote_tiles(), where no tile can be
///     opened, and where that tile is not where the index says
OpenIndex open_index(const std::string& path, const LoadOptions& options,
                     std::optional<Piece>& piece, Dataset& opened);

}  // namespace relevo::dem
