#pragma once

#include "dem/heightfield.h"

namespace relevo::dem {

/// How a grid is read so that columns run most nearly along x of its CRS (east) and rows most
/// nearly against y (south): grids may be mirrored, or turned by a quarter.
struct NorthUp {
    bool swap = false;          ///< rows are read as columns
    bool flip_columns = false;  ///< then, from the last column to the first
    bool flip_rows = false;

    bool any() const { return swap || flip_columns || flip_rows; }
};

NorthUp north_up_of(const Affine& post_to_crs);

/// The same posts in that order, on the grid that they then have.
Heightfield turned(Heightfield field, const NorthUp& turn);

}  // namespace relevo::dem
