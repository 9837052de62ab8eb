#pragma once

#include <string>

#include "base/error.h"
#include "dem/mosaic.h"

// Opens the tiles of an index. Inside of the layer only.

namespace relevo::dem {

/// Whether there is a file of a name, also on the net.
/// @throws Error (BadInput) where the net does not answer
bool is_there(const AllowedName& name);

/// Whether an error is due to what the machine lacks, or to the net: trying again may help, and a
/// void in place of the heights would be wrong.
bool is_no_fault_of_a_file(const Error& error);

/// Whether a name on the command line is that of an index, on the net too.
bool is_named_index(const std::string& name);

/// By which a tile is opened: one of the net only where its index is.
/// @throws Error (Usage) as AllowedName
AllowedName name_of(const TileIndex& index, const IndexedTile& tile);

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
