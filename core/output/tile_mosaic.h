#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "output/tile_plan.h"

namespace relevo::output {

/// A virtual raster of GDAL's over tiles that are there: its grid is that of the raster without
/// tiles, names of tiles count from its folder, and a tile that is not there is void.
/// @param path    of the VRT, which nobody writes here
/// @param folder  of the tiles
/// @param tiles   at least one
/// @throws Error (Failed) where GDAL refuses
std::string mosaic_text(const std::filesystem::path& path, const std::filesystem::path& folder,
                        const TilePlan& plan, const std::vector<PlannedTile>& tiles);

/// The window around the tiles of a plan.
dem::Window window_of(const TilePlan& plan);

/// The name of a tile as a file in another folder has it: relative where both have a root in
/// common, with slashes.
std::string name_from(const std::filesystem::path& file, const std::filesystem::path& tile);

}  // namespace relevo::output
