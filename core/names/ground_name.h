#pragma once

#include <string>

#include "dem/grid.h"
#include "names/gazetteer.h"

namespace relevo::names {

/// What a map of a DEM is called: its largest place and its highest summit, "Innsbruck –
/// Schrankogel", or the one of both that there is; without any "Near Amboy", by the nearest place
/// within 50 km of its middle.
/// @returns an empty string if no place is that near
std::string ground_name(const Gazetteer& gazetteer, const dem::Grid& grid);

}  // namespace relevo::names
