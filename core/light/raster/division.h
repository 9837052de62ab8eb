#pragma once

#include <vector>

#include "base/window.h"
#include "light/raster/sun_field.h"

namespace relevo::light {

/// How far a tile's sun may be off at its marks; between these it is off by 0.05 degrees at most.
constexpr double kSunTolerance_rad = radians(0.04);

/// Divides a window into tiles over each of which a sun is one.
///
/// A window over which it is not is cut between rays into tiles side by side: what a sun differs by
/// over a grid in degrees, it does across its rays, and so no ground is swept twice. Where such
/// tiles would be too narrow, or rays turn back, the window is halved along its rays first.
/// @param part  only tiles with posts of this window are returned
/// @param most  no more tiles are wanted: the division is given up beyond it
/// @throws Error (BadInput) where a grid is so coarse or so near to a pole that there are none
std::vector<SunTile> divide(const SunField& sun, const Window& window, const Window& part,
                            double tolerance_rad = kSunTolerance_rad,
                            std::size_t most = static_cast<std::size_t>(-1));

}  // namespace relevo::light
