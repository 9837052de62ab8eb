#pragma once

#include "climate/cover.h"
#include "climate/land_map.h"

namespace relevo::climate {

/// How the ground's colour at a place differs from what its covers usually have there, as factors
/// of 0.3 to 3.4. With them bare ground has the colour of the map; ground with plants goes 65 % of
/// the way there, as the map's plants are those of May to October.
/// @param ground  colour without snow
Colour tint_of(const CoverColumn& column, const LandShares& shares, const Colour& ground);

}  // namespace relevo::climate
