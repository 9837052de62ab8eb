#pragma once

#include <functional>

#include <glm/vec2.hpp>

#include "base/array2d.h"
#include "climate/land_map.h"
#include "geo/geodetic.h"

namespace relevo::climate {

/// What plants live by.
struct Growing {
    float dryness = 0, growth = 0, temperature_c = 0;  ///< CoverColumn's
    float ice_m = 0;  ///< balance of ice, with what mapped ice has over it [m of water a year]
};

/// Sites of a raster on the ground.
struct LandSites {
    const Array2d<float>& height_m;                               ///< NaN in voids
    glm::dvec2 apart_m;                                           ///< of columns and rows
    std::function<geo::Geodetic(double, double)> place;           ///< of a column and a row
    std::function<Growing(const geo::Geodetic&, float)> growing;  ///< at a place and height
};

/// What covers each site: the map's shares, shared out by relief, climate and chance.
///
/// A cover is likelier where the shape of the ground suits it: woods on slopes, fields and towns on
/// valley floors, bare ground on cliffs and above the plants. Noise decides the rest, so that a
/// site has one cover; it depends on the place alone. In each cell of 0.1 degrees covers have the
/// shares that the map has there. Where sites are 150 m apart and more, they have some of each.
///
/// Shares are what the map knows; where a wood stands is not known. Of the posts of Sao
/// Tome's land 90 % have the cover of a finer map (tests/climate/test_land_map.cpp).
Array2d<LandShares> land_classes(const LandMap& map, const LandSites& sites);

}  // namespace relevo::climate
