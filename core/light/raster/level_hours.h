#pragma once

#include "light/raster/sun_terrain.h"
#include "sun/time.h"

namespace relevo::light {

/// Hours that the sun's centre is over a level horizon.
struct LevelHours {
    double middle = 0;  ///< in the middle of a DEM
    double most = 0;    ///< the most at its corners, sides and middle
};
LevelHours level_hours(const SunTerrain& terrain, sun::Instant begin, double length_s);

}  // namespace relevo::light
