#pragma once

#include <string>

// What to say of names and files that are no DEM. Inside of the layer only.

namespace relevo::dem {

/// Of a name under which there is no file: what was probably meant.
std::string no_file_text(const std::string& path);

/// Of a file that GDAL takes for no raster: what it is instead, where its first bytes say so.
std::string no_raster_text(const std::string& path);

}  // namespace relevo::dem
