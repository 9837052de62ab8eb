#pragma once

#include <memory>
#include <string>

#include "base/allowed_name.h"
#include "dem/gdal_support.h"
#include "dem/heightfield.h"
#include "dem/source.h"

// What a file means: the questions that Source::open() asks GDAL. Inside of the layer only.

namespace relevo::dem {

/// Notes a choice that the file did not make itself, and that is a guess.
void guess(Description& about, const std::string& sentence);

/// @throws Error (BadInput) `path: what`
[[noreturn]] void refuse(const std::string& path, const std::string& what);

/// What to do about a reason that GDAL or the system gives, as the end of a message: "; the file is
/// damaged or incomplete" where neither access, the machine's means nor the net are at fault.
std::string remedy_for(const std::string& path, const std::string& reason);

/// What GDAL opens as a raster, without a word where it opens nothing.
Dataset gdal_open(const AllowedName& name);

/// Opens a file, or the one raster of an archive.
/// @param name  becomes that by which GDAL opens it again
/// @throws Error (BadInput) where there is no such file or GDAL does not take it for a raster
Dataset open_dataset(AllowedName& name);

/// The band that holds the heights: the one asked for (from 1), else (0) the first; the first of
/// three where colours encode heights. Fills in the number of bands.
/// @throws Error (BadInput) for pictures, none, or no such band
int chosen_band(const std::string& path, void* dataset, const LoadOptions& options,
                Description& about);

/// Refuses a file that is shorter than what it promises where the driver would fill up in silence.
void refuse_if_short(const std::string& path, void* dataset, const Description& about);

/// Where the posts are, and in which CRS.
struct Georeference {
    Affine affine;
    geo::Crs crs;
};

/// What the options say, else the file, else (for a picture of encoded heights) its path as a tile
/// of a web map; degrees without a CRS are those of WGS 84.
/// @throws Error (BadInput) where nothing says it, or the CRS is not of the Earth
Georeference georeference(const std::string& path, void* dataset, const LoadOptions& options,
                          Description& about);

/// Unit and where it is from: given, else the encoding's, else the band's, else the vertical CRS's,
/// else metres.
/// @throws Error (BadInput) where the band has a unit that is none of heights
void settle_unit(const std::string& path, void* band, const geo::Crs& crs,
                 const LoadOptions& options, Description& about);

/// What the heights are above, as far as the file says.
void settle_vertical_datum(void* dataset, const geo::Crs& crs, Description& about);

}  // namespace relevo::dem
