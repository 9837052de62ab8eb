#pragma once

#include "base/array2d.h"
#include "light/raster/sun_terrain.h"

namespace relevo::light {

/// How the ground rises towards the east and the north [m/m] at the posts of a window. Next to
/// holes and the DEM's edge the ground goes on as it comes. Source: Horn, Proc. IEEE 69 (1981) 14.
struct GroundSlope {
    Array2d<float> east, north;

    /// Level ground.
    explicit GroundSlope(const Window& window)
        : east(window.columns, window.rows, 0), north(window.columns, window.rows, 0) {}
    GroundSlope(const dem::Grid& grid, const WindowHeights& heights, const Window& window);
};

}  // namespace relevo::light
