#pragma once

#include <string>

#include "base/array2d.h"

namespace relevo::dem {

/// Some heights of a raster, for a look at it without its place.
struct QuickLook {
    Array2d<float> heights_m;  ///< north up if the file says so; NaN for voids
    double column_m = 1;       ///< ground between neighbours [m]
    double row_m = 1;
};

/// Reads a raster reduced to at most `longest` columns or rows, from its overviews where it has
/// any. Needs neither a CRS nor, of SRTM's .hgt files, a name that says their place. Numbers are
/// heights in metres, sides of cells metres, or degrees if they cannot be anything else.
/// @throws Error (BadInput) `PATH: what, expected E but got G; remedy`
QuickLook quick_look(const std::string& path, int longest);

}  // namespace relevo::dem
