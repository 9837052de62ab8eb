#pragma once

#include <vector>

#include "chart/legend.h"
#include "session/active_effects.h"

namespace relevo::session {

/// What the colours of the effects that are on mean, by the ramps that their plugins declare.
/// Ramps of one name and unit are one legend, such as those of seas and of lands.
/// @param lowest_m, highest_m  the DEM's heights
std::vector<chart::Legend> colour_legends(const ActiveEffects& effects, double lowest_m,
                                          double highest_m);

}  // namespace relevo::session
