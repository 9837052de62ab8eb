#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "base/array2d.h"
#include "dem/grid.h"

namespace relevo::overlay {

/// A band of a raster as it lies over a DEM.
struct BandOver {
    /// NaN where the raster has no value, or does not reach. The first and the last columns and
    /// rows lie on the DEM's.
    Array2d<float> values;
    std::string name;                          ///< the band's description; empty where it has none
    std::string unit;                          ///< of the values; empty if unknown
    std::map<std::string, std::string> about;  ///< metadata of the raster, and over them the band's
    bool whole = false;  ///< stored as whole numbers of 8 bits: classes, a mask
    /// RGBA of the values 0, 1, ...; empty where the band has no colour table.
    std::vector<std::array<std::uint8_t, 4>> colors;
};

/// What a band says of itself: BandOver::about. @throws Error (BadInput) as read_band_over()
std::map<std::string, std::string> band_metadata(const std::string& path, int band);

/// A band of a file, or of a part of it (NetCDF, HDF).
struct BandInFile {
    std::string path;                          ///< opens the part
    int band = 1;                              ///< of the part
    std::string unit;                          ///< as BandOver::unit
    std::map<std::string, std::string> about;  ///< as BandOver::about
};

/// All bands of a file; of one without bands those of all its parts.
/// @throws Error (BadInput) as Source::open()
std::vector<BandInFile> bands_of(const std::string& path);

/// The cells of any raster that GDAL opens.
/// @throws Error (BadInput) as Source::open(), and if its place on the ground is unknown
dem::Grid grid_of_raster(const std::string& path);
/// The same of an open one. @param opened  the name that opened it
dem::Grid grid_of_raster(const std::string& path, const std::string& opened, void* dataset);

/// Values of more posts than these are means or picks of fewer [posts].
inline constexpr std::int64_t kMostOver = std::int64_t{1} << 24;

/// Reads a band of any raster that GDAL opens, in any CRS, for the posts of a DEM: of 8-bit bands
/// the nearest cell, of others what is linear between cells.
///
/// Accuracy: within 0.05 cells of the raster, or 0.05 values where those are wider apart, also
/// around a pole and across 180 degrees (tests/dem/test_band_over.cpp): between every 16th value
/// places are interpolated only where that is so.
/// @param band  from 1
/// @throws Error (BadInput) as Source::open(), for a band that is not there, and where the raster
///     has no cell over the DEM
BandOver read_band_over(const dem::Grid& grid, const std::string& path, int band);

}  // namespace relevo::overlay
