#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "output/tile_plan.h"

namespace relevo::output {

/// A STAC 1.1 ItemCollection as JSON, an Item for each tile: its outline in WGS 84, the time of
/// what it shows, its grid by the projection extension (proj:code, and proj:epsg for older readers,
/// GDAL's STACIT among them), and its file with the role data, as a URI relative to the collection.
/// A figure without a time, such as the sky view, has the time of its file.
/// An outline across 180 degrees is its bounding box in two parts.
/// @param path    of the collection, which nobody writes here
/// @param folder  of the tiles, which are there
/// @param base    of their names in the collection; empty: the collection's folder
/// @throws Error (Failed) where a tile cannot be read
/// Source: github.com/radiantearth/stac-spec, v1.1.0; stac-extensions/projection, v1.2.0,
/// whose schema allows proj:code and proj:epsg; that of v2.0.0 allows no proj:epsg.
std::string stac_text(const std::filesystem::path& path, const std::filesystem::path& folder,
                      const std::string& base, const TilePlan& plan,
                      const std::vector<PlannedTile>& tiles);

}  // namespace relevo::output
