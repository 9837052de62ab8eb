#pragma once

#include <memory>
#include <string>

#include "dem/heightfield.h"

// What a file means: the questions that Source::open() asks GDAL. Inside of the layer only.

namespace relevo::dem {

/// An open GDALDatasetH, which is a void*; serves one thread at a time.
struct CloseDataset {
    void operator()(void* dataset) const;
};
using Dataset = std::unique_ptr<void, CloseDataset>;

/// @throws Error (BadInput) `dem::load: path: what`
[[noreturn]] void refuse(const std::string& path, const std::string& what);

/// @throws Error (BadInput) where there is no such file or GDAL does not take it for a raster
Dataset open_dataset(const std::string& path);

/// The band that holds the heights: the one asked for (from 1), else (0) the first.
/// Fills in the number of bands. @throws Error (BadInput) for pictures, none, or no such band
int chosen_band(const std::string& path, void* dataset, int wanted, Description& about);

/// Refuses a file that is shorter than what it promises where the driver would fill up in silence.
void refuse_if_short(const std::string& path, void* dataset, const Description& about);

/// @throws Error (BadInput) where the file does not say where its posts are
Affine georeference(const std::string& path, void* dataset);

/// The CRS given, else the file's. @throws Error (BadInput) where there is none, or not of the
/// Earth
geo::Crs crs_of(const std::string& path, void* dataset, const std::string& given,
                Description& about);

/// Unit and where it is from: given, else the band's, else the vertical CRS's, else metres.
/// @throws Error (BadInput) where the band has a unit that is none of heights
void settle_unit(const std::string& path, void* band, const geo::Crs& crs, const std::string& given,
                 Description& about);

/// What the heights are above, as far as the file says.
void settle_vertical_datum(void* dataset, const geo::Crs& crs, Description& about);

}  // namespace relevo::dem
