#pragma once

#include "base/array2d.h"

namespace relevo::render {

/// Means of squares of side x side posts, excluding voids, as dem::Source::read() computes them.
/// Posts beyond the last whole square are not part of any.
/// @param height_m  NaN in voids
/// @param factor    of the heights
/// @returns NaN where all posts are voids
Array2d<float> block_means(const Array2d<float>& height_m, int side, float factor = 1);

}  // namespace relevo::render
