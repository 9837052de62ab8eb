#pragma once

#include <vector>

#include "chart/legend.h"
#include "session/active_effects.h"

namespace relevo::session {

/// What colour ramps depend on in a DEM.
struct DemRange {
    double lowest_m = 0, highest_m = 0;
    bool has_sea_floor = false;  ///< dem::Water::has_sea_floor
};

/// Legends of the colours that the active effects declare. Ramps with the same title and unit share
/// a legend, such as those of seas and of land, and so do entries with the same title.
std::vector<chart::Legend> colour_legends(const ActiveEffects& effects, const DemRange& ground);

}  // namespace relevo::session
