#pragma once

#include <string>

#include "dem/heightfield.h"
#include "dem/spikes.h"

// Heights that no ground of the Earth has. Inside of the layer only; load.h refuses them.

namespace relevo::dem {

/// Whether spikes speak of a wrong unit: no file states the unit, and posts are at most 1 km apart.
/// Single posts of coarser grids are seamounts.
bool spikes_matter(const Description& about, const Grid& grid);

/// Why the heights cannot be those of the Earth's ground, and which options settle it. Empty where
/// they can be. They cannot if one is outside -11500 to 9000 m, or if one post in 200 is a spike
/// and another unit would leave none.
/// @param about   with its statistics
/// @param spikes  none where they do not matter
std::string unearthly(const Description& about, const Spikes& spikes);

}  // namespace relevo::dem
