#pragma once

#include <string>

#include "dem/grid.h"

namespace relevo::dem {

/// Heights of another program's memory as a file that GDAL holds in memory, with a name that Source
/// opens. The file ends with this object.
class MemoryRaster {
  public:
    /// The file has no CRS: LoadOptions::crs is to be that of `post_to_crs`.
    /// @param heights_m  row by row, NaN for holes; copied
    /// @throws Error (Failed) where GDAL refuses, (BadInput) for a transform without an area
    MemoryRaster(const float* heights_m, int columns, int rows, const Affine& post_to_crs);
    MemoryRaster(MemoryRaster&& other) noexcept;
    MemoryRaster& operator=(MemoryRaster&&) = delete;
    ~MemoryRaster();

    const std::string& name() const { return name_; }  ///< "/vsimem/relevo/1/heights.tif"

  private:
    std::string name_;
};

}  // namespace relevo::dem
