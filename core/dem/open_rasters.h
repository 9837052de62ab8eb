#pragma once

#include <span>
#include <string>
#include <vector>

#include "dem/mosaic.h"

// Opens what the command line names as a DEM. Inside of the layer only.

namespace relevo::dem {

/// A raster of a DEM: a file that is open, or a tile of an index.
struct RasterEntry {
    int piece = -1;  ///< its number among the pieces; -1: a tile that is not open yet
    int index = -1;  ///< its index's number; -1: a file of its own
    std::size_t tile = 0;
};

struct OpenRasters {
    std::vector<RasterEntry> entries;  ///< in the order of the names
    std::vector<Piece> pieces;
    std::vector<Dataset> handles;  ///< of the pieces; null where it was closed again
    std::vector<OpenIndex> indexes;
};

/// Opens files, the rasters of folders, and of each index one tile. Files are opened on several
/// threads; of several errors that of the first file is thrown.
/// @throws Error (BadInput) as rasters_of(), open_piece() and open_index()
OpenRasters open_rasters(std::span<const std::string> names, const LoadOptions& options);

}  // namespace relevo::dem
