#pragma once

#include <string>

#include "dem/gdal_support.h"

// Inside of the layer only.

namespace relevo::zones {

/// Opens a file of polygons. @throws Error (BadInput) where GDAL does not read it
dem::Dataset open_vectors(const std::string& path);

/// The only layer that has polygons, an OGRLayerH. @throws Error (BadInput) where there is not one
void* layer_of_zones(const std::string& path, void* dataset);

}  // namespace relevo::zones
