#pragma once

#include <string>

namespace relevo::dem {

/// Of the libraries that read rasters and place them: "3.6.2", "9.1.1".
std::string gdal_version();
std::string proj_version();

}  // namespace relevo::dem
