#pragma once

#include <cstdint>

#include "base/array2d.h"
#include "dem/source.h"

namespace relevo::dem {

/// Means of a DEM, `reduction` x `reduction` posts each, from blocks of its file that are spread
/// evenly over it: rows of strips, or tiles. Means between them are interpolated, along rows, then
/// down columns. For a first picture while all posts are read.
/// @param most_cells  posts of the blocks that are read
/// @returns columns and rows of the grid divided by `reduction`; NaN in voids
/// @throws Error (BadInput) as Source::read()
Array2d<float> sample_means(const Source& source, int reduction, std::int64_t most_cells);

}  // namespace relevo::dem
