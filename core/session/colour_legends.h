#pragma once

#include <vector>

#include "chart/legend.h"
#include "session/active_effects.h"

namespace relevo::session {

/// What ramps may say of a DEM.
struct DemRange {
    double lowest_m = 0, highest_m = 0;
    bool has_sea_floor = false;  ///< dem::Water::has_sea_floor
};

/// What the colours of the effects that are on mean, by the ramps that their plugins declare.
/// Ramps of one name and unit are one legend, such as those of seas and of lands.
std::vector<chart::Legend> colour_legends(const ActiveEffects& effects, const DemRange& ground);

}  // namespace relevo::session
