#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/array2d.h"
#include "dem/grid.h"

namespace relevo::dem {

/// A band of a raster as it lies over a DEM.
struct BandOver {
    /// NaN where the raster has no value, or does not reach. The first and the last columns and
    /// rows lie on the DEM's.
    Array2d<float> values;
    std::string name;    ///< the band's description; empty where it has none
    std::string unit;    ///< likewise
    bool whole = false;  ///< stored as whole numbers of 8 bits: classes, a mask
    /// RGBA of the values 0, 1, ...; empty where the band has no colour table.
    std::vector<std::array<std::uint8_t, 4>> colors;
};

/// Values of more posts than these are means or picks of fewer [posts].
inline constexpr std::int64_t kMostOver = std::int64_t{1} << 24;

/// Reads a band of any raster that GDAL opens, in any CRS, for the posts of a DEM: of 8-bit bands
/// the nearest cell, of others what is linear between cells.
///
/// Accuracy: places between those of every 16th post are interpolated where the two have different
/// CRSs (tests/dem/test_band_over.cpp).
/// @param band  from 1
/// @throws Error (BadInput) as Source::open(), for a band that is not there, and where the raster
///     has no cell over the DEM
BandOver read_band_over(const Grid& grid, const std::string& path, int band);

}  // namespace relevo::dem
