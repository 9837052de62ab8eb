#pragma once

#include <memory>
#include <string>

#include <gdal_priv.h>

/// Rasters that the program wrote.
namespace relevo::test {

struct CloseDataset {
    void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, CloseDataset>;

inline Dataset opened(const std::string& path) {
    GDALAllRegister();
    return Dataset(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_VERBOSE_ERROR));
}

}  // namespace relevo::test
