#pragma once

#include <optional>

#include "base/array2d.h"

namespace relevo::dem {

/// One height all around the edge of a DEM that does not go with the ground inside.
struct Frame {
    float height_m = 0;
    double step_m = 0;  ///< median, from the frame to the ground beside it
};

/// Finds what is left around a raster that was turned or cut without a nodata value: the edge is of
/// one height at 19 of 20 posts and in all corners, and where that height ends, half of the steps
/// to the next post are higher than 20 m. An island in its sea has a beach.
std::optional<Frame> find_frame(const Array2d<float>& height_m);

}  // namespace relevo::dem
