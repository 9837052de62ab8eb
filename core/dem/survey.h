#pragma once

#include <cstdint>
#include <optional>

#include "dem/collar.h"
#include "dem/heightfield.h"
#include "dem/source.h"
#include "dem/spikes.h"

namespace relevo::dem {

/// What all posts of a DEM say together, however many there are.
struct Survey {
    Statistics statistics;
    Spikes spikes;
    std::optional<Collar> collar;
};

/// Goes through all posts once, in pieces; tells of its progress where that takes long.
/// @param max_posts  that memory has room for, at least some 10^5
/// @throws Error (BadInput) where the file is damaged
Survey survey(const Source& source, std::int64_t max_posts);

/// What looks for a collar inside of a DEM, where its edge may be one. The edge is read in pieces;
/// columns only where the rows may be a collar's: of some files they are all of it.
std::optional<CollarSteps> collar_steps_of(const Source& source);

}  // namespace relevo::dem
