#pragma once

#include <string>

#include "dem/heightfield.h"
#include "dem/spikes.h"

// Heights that no ground of the Earth has. Inside of the layer only; load.h refuses them.

namespace relevo::dem {

/// Whether spikes say something about the unit: where nothing says which it is, and posts are a
/// kilometre apart at most. Single posts of coarser grids are seamounts.
bool spikes_matter(const Description& about, const Grid& grid);

/// Why the heights cannot be those of the Earth's ground, and which options settle it; empty where
/// they can: heights outside of -11500 to 9000 m, or one in 200 that stands out of all its
/// neighbours as no ground does, which it would not in another unit.
/// @param about   with its statistics
/// @param spikes  none where they do not matter
std::string unearthly(const Description& about, const Spikes& spikes);

}  // namespace relevo::dem
