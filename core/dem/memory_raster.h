#pragma once

#include <string>

#include "dem/grid.h"

namespace relevo::dem {

/// What a file says of the numbers that it stores.
struct Stored {
    double scale = 1, offset = 0;  ///< height: offset + scale * number, in the unit
    std::string unit;              ///< of the height; empty: none is named
    bool voids_declared = false;   ///< NaN alone marks voids; else they may be undeclared
};

/// Heights of another program's memory as a file that GDAL holds in memory, with a name that Source
/// opens. The file ends with this object.
class MemoryRaster {
  public:
    /// The file has no CRS: LoadOptions::crs is to be that of `post_to_crs`.
    /// @param numbers  row by row, NaN for voids; copied
    /// @throws Error (Failed) where GDAL refuses, (BadInput) for a transform without an area
    MemoryRaster(const float* numbers, int columns, int rows, const Affine& post_to_crs,
                 const Stored& stored = {});
    MemoryRaster(MemoryRaster&& other) noexcept;
    MemoryRaster& operator=(MemoryRaster&&) = delete;
    ~MemoryRaster();

    const std::string& name() const { return name_; }  ///< "/vsimem/relevo/1/heights.tif"

  private:
    std::string name_;
};

}  // namespace relevo::dem
