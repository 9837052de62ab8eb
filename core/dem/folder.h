#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

// A folder of rasters. Inside of the layer only.

namespace relevo::dem {

/// What a name of the command line stands for: itself, or the rasters in it where it is a folder
/// that GDAL does not take for one raster. In the order of their names, byte by byte; folders
/// inside count only where they are rasters themselves. Overviews, masks, headers and the files
/// that a virtual raster of the same folder is made of are parts of rasters, not rasters. Others
/// that are left out are named with log::info.
/// @throws Error (BadInput) where a folder has no raster in it or cannot be read
std::vector<std::string> rasters_of(const std::string& path);

/// The same without a word; empty where rasters_of() throws.
std::vector<std::string> rasters_of_quietly(const std::string& path);

/// A file that GDAL takes for a raster.
struct RasterFile {
    std::filesystem::path path;
    std::string driver;  ///< GDAL's short name of who does
    std::uint64_t bytes = 0;
};

/// Leaves out those that are only parts of others: "a.tif.ovr" and "a.ovr" beside "a.tif", and what
/// a header makes cells of besides the cells: "a.prj" beside "a.bil".
void drop_parts(std::vector<RasterFile>& rasters);

}  // namespace relevo::dem
