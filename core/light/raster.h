#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/array2d.h"
#include "base/output_file.h"
#include "dem/grid.h"

namespace relevo::light {

/// What the figures of a raster are.
struct RasterText {
    std::string name;                                           ///< of the band: "shadow"
    std::string unit;                                           ///< "1" for shares
    std::vector<std::pair<std::string, std::string>> metadata;  ///< of the file
};

/// Writes a raster of figures on a grid as a cloud-optimised GeoTIFF, in the grid's CRS, and gives
/// it its name. Until it is whole it is in memory: nothing is left beside it, however the program
/// ends.
/// @param values  as many as the grid has posts; 255 is a hole
/// @throws Error (Failed) where GDAL or the disk refuses
void write_raster(OutputFile& file, const dem::Grid& grid, const Array2d<std::uint8_t>& values,
                  const RasterText& text);
/// The same; NaN is a hole.
void write_raster(OutputFile& file, const dem::Grid& grid, const Array2d<float>& values,
                  const RasterText& text);

}  // namespace relevo::light
