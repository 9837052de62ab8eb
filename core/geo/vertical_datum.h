#pragma once

#include <optional>

#include "geo/crs.h"
#include "geo/geodetic.h"

namespace relevo::geo {

/// Added to a height in one vertical CRS it gives the height in another, at a place, in metres
/// both, as PROJ finds it from the grids that are installed.
/// @param from, to  with a code, or ellipsoidal ("ellipsoidal height")
/// @returns none where PROJ knows no way between them but a guess, or lacks its grid
std::optional<double> vertical_step_m(const VerticalCrs& from, const VerticalCrs& to,
                                      const Geodetic& place);

}  // namespace relevo::geo
