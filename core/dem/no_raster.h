#pragma once

#include <string>

// Messages for names and files that are not DEMs. Inside of the layer only.

namespace relevo::dem {

/// A message for a name without a file, with the name that was probably meant.
std::string no_file_text(const std::string& path);

/// A message for a file that GDAL does not read: what it is, if its first bytes show that.
std::string no_raster_text(const std::string& path);

}  // namespace relevo::dem
