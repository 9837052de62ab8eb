#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/array2d.h"
#include "base/output_file.h"
#include "dem/grid.h"

namespace relevo::light {

using RasterMetadata = std::vector<std::pair<std::string, std::string>>;

/// Figures of all posts of a grid.
struct RasterBand {
    std::string name;  ///< "shadow"
    std::string unit;  ///< "1" for shares
    /// As many as the grid has posts. A hole is NaN; among bytes 255.
    std::variant<Array2d<std::uint8_t>, Array2d<float>> values;
    RasterMetadata metadata{};
};

/// What the bands of a file have in common.
struct RasterFile {
    RasterMetadata metadata;
    /// For GDAL's COG driver besides its own defaults and ours: "COMPRESS=ZSTD".
    std::vector<std::string> creation_options{};
};

/// @throws Error (Usage) for one that GDAL's COG driver does not have
void check_creation_options(const std::vector<std::string>& options);

/// Writes bands of one type on a grid as a cloud-optimised GeoTIFF, in the grid's CRS, and gives it
/// its name. Until it is whole it is in memory: nothing is left beside it, however the program
/// ends.
/// @throws Error (Usage) for a creation option that the driver does not have, (Failed) where GDAL
///     or the disk refuses
void write_raster(OutputFile& file, const dem::Grid& grid, const std::vector<RasterBand>& bands,
                  const RasterFile& about);

}  // namespace relevo::light
