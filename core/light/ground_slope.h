#pragma once

#include "dem/posts.h"
#include "light/sky.h"

namespace relevo::light {

/// How the ground rises towards the east and the north [m/m] at the posts of a part of a DEM. Next
/// to holes and the DEM's edge the ground goes on as it comes.
/// @param heights      of the part and the posts around it
/// @param east, north  of the part, along rows
/// Source: Horn, Proc. IEEE 69 (1981) 14.
void ground_slope(const dem::Grid& grid, const dem::Posts::View& heights, const SweepWindow& part,
                  TileValues& east, TileValues& north);

}  // namespace relevo::light
