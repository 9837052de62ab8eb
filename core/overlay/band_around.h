#pragma once

#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "base/array2d.h"
#include "dem/grid.h"

namespace relevo::overlay {

/// Values by place around a DEM: east and north in its local frame, at height 0 of the ellipsoid.
struct ValuesAround {
    Array2d<float> values;    ///< NaN where there is none; row 0 is the southernmost
    glm::dvec2 first_m{0};    ///< place of values.at(0, 0)
    glm::dvec2 step_m{1, 1};  ///< from value to value, both positive

    /// Linear between values; where some are missing, of the others. NaN where all are.
    float at(const glm::dvec2& place_m) const;
};

/// How far beyond the DEM's centre values are read, if the raster reaches so far [m].
inline constexpr double kAround_m = 400'000;

/// Reads a band of any raster that GDAL opens, in any CRS, over and around a DEM: as far as
/// kAround_m, and over all of the DEM. Values are as close as the raster's cells in the middle of
/// the DEM, or closer, but at most 1024 along a side.
///
/// Accuracy: that of read_band_over().
/// @param dem   its centre is the origin of the local frame
/// @param band  from 1
/// @throws Error (BadInput) as read_band_over(), and where the raster has no value over the DEM
ValuesAround read_band_around(const dem::Grid& dem, const std::string& path, int band);

/// Places all over a DEM in its local frame, 33 along rows and columns.
std::vector<glm::dvec2> places_over_dem(const dem::Grid& dem);

}  // namespace relevo::overlay
