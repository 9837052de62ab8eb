#pragma once

#include "base/array2d.h"
#include "dem/grid.h"
#include "dem/heightfield.h"

// Posts that the CRS has no place for: corners of a map of the world. Inside of the layer only.

namespace relevo::dem {

/// Whether some posts have no place, which is said; where none has one, it is an error.
void settle_earth(const Grid& grid, Description& about, bool& leaves_earth);

/// Makes holes of posts that are not on the Earth.
void cut_to_earth(const Grid& grid, Array2d<float>& height_m);

}  // namespace relevo::dem
