#pragma once

#include <string>

#include "dem/grid.h"
#include "sun/refraction.h"
#include "sun/zone.h"

/// What a page knows of a DEM's place: JSON objects, docs/web.md.
namespace relevo::web {

/// Sides of the net of places, posts from corner to corner.
inline constexpr int kNodes = 9;

/// Places of a net of kNodes x kNodes posts, row by row: `lat`, `lon` and `convergence` [deg], and
/// `scale_x`, `scale_y`: ground metres of a step along rows and columns, as shares of those in the
/// middle.
/// @param grid  north-up
/// @throws Error (BadInput) where the CRS has no place for a post
std::string grid_json(const dem::Grid& grid);

/// `name` and `transitions`: pairs of Unix time and seconds ahead of UTC, from 1970 to 2100.
std::string zone_json(const sun::Zone& zone);

/// By how much the air lifts the sun: `elevation` without air, rising, and `lift` there [deg].
/// Linear between these within 0.002 degrees.
std::string refraction_json(const sun::Refraction& refraction);

}  // namespace relevo::web
