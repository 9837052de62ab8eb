#pragma once

#include "climate/cover.h"
#include "climate/land_map.h"

namespace relevo::climate {

/// How the ground's colour at a place differs from what its covers usually have there, as factors
/// of 0.4 to 2.5: with them the mixture of covers has the ground's colour, wholly where it is bare,
/// by 65 % where plants cover it, whose colours are those of May to October in that map.
/// @param ground  colour without snow
Colour tint_of(const CoverColumn& column, const LandShares& shares, const Colour& ground);

}  // namespace relevo::climate
