#pragma once

#include "base/array2d.h"

namespace relevo {

/// The lowest and the highest value of the square around each cell, in the same time for any size.
/// source: M. van Herk, A fast algorithm for local minimum and maximum filters on rectangular and
/// octagonal kernels, Pattern Recognition Letters 13 (1992), 517
/// @param cells  without NaN
/// @param reach  cells from a square's middle to its sides; beyond the rim there are none
Array2d<float> lowest_around(Array2d<float> cells, int reach);
Array2d<float> highest_around(Array2d<float> cells, int reach);

/// The mean of the square around each cell.
Array2d<float> mean_around(Array2d<float> cells, int reach);

}  // namespace relevo
