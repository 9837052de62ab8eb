#pragma once

#include <string>
#include <vector>

#include "light/point/horizon.h"
#include "names/summit_top.h"

namespace relevo::chart {

/// A summit that stands against the sky.
struct SkylineName {
    double azimuth_rad = 0;
    double elevation_rad = 0;  ///< apparent
    double ground_m = 0;       ///< height of the DEM there
    std::string text;          ///< "Serles 2717 m"
};

/// Summits of a DEM that are visible from a point and not in front of higher ground, the highest
/// first. Farther than 200 km and nearer than 500 m there are none.
/// @throws Error (BadInput) as names::Gazetteer::summits(), and if the DEM cannot be read
std::vector<SkylineName> names_on_skyline(
    const light::TerrainHorizon& horizon,
    const names::Gazetteer& gazetteer = names::Gazetteer::summits());

}  // namespace relevo::chart
