#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/array2d.h"
#include "base/output_file.h"
#include "dem/grid.h"

namespace relevo::output {

using RasterMetadata = std::vector<std::pair<std::string, std::string>>;

/// What a band of a raster says of itself.
struct RasterBand {
    std::string name;  ///< "shadow"
    std::string unit;  ///< "1" for shares
    RasterMetadata metadata{};
};

/// What the values of a file are stored as. A hole is NaN; among bytes 255.
enum class RasterType { Byte, Float };

/// @throws Error (Usage) for one that GDAL's COG driver does not have
void check_creation_options(const std::vector<std::string>& options);

/// A cloud-optimised GeoTIFF on its way, in the CRS of a grid. Its parts are put where they belong
/// in any order; until it is whole it is in files without a name in the folder of the result, so
/// that it takes no memory, and nothing is left beside it, however the program ends.
class RasterWriter {
  public:
    /// @param grid     of the result
    /// @param options  for GDAL's COG driver besides its own defaults and ours: "COMPRESS=ZSTD"
    /// @throws Error (Usage) for a creation option that the driver does not have, (Failed) where
    ///     GDAL or the disk refuses, here and below
    RasterWriter(OutputFile& file, const dem::Grid& grid, RasterType type,
                 const std::vector<RasterBand>& bands, std::vector<std::string> options = {});
    ~RasterWriter();
    RasterWriter(const RasterWriter&) = delete;
    RasterWriter& operator=(const RasterWriter&) = delete;

    /// Values of a part of a band, whose upper left post is at (column, row) of the result. Bytes
    /// are 1 where they are above 0.
    /// @param band  from 0
    void put(std::size_t band, int column, int row, const Array2d<float>& values);

    /// Gives the file its name, once all has been put.
    void finish(const RasterMetadata& metadata);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace relevo::output
