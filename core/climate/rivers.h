#pragma once

#include "base/array2d.h"
#include "climate/land_classes.h"

namespace relevo::climate {

/// The river nearest to a site, as a straight line.
struct RiverSite {
    /// From the columns' direction to the line's normal, on the ground [rad], 0 to pi.
    float normal_rad = 0;
    float off_m = 0;    ///< from the site to the line, along the normal
    float width_m = 0;  ///< of the river; 0: none is near
};

/// Within so many sites of a river its line is known.
inline constexpr double kRiverReach = 2.5;
/// Sites farther apart do not know valleys, and have no rivers [m].
inline constexpr double kRiverSites_m = 1000;

/// Rivers, found by following water downhill: from each site the steepest way, out of hollows over
/// their rims, to the sea (0 m), a void or the raster's edge. What comes from beyond the edge is
/// not known. Where the water falls by 1 to 3 % rivers become narrower, and steeper ones are left
/// out: torrents lie under trees and boulders.
///
/// They carry what the climate leaves of the rain, P exp(-E / P) with E as what the warmth takes
/// (P. Schreiber, Meteorol. Z. 21 (1904), 441), and are 7 m wide times the root of the discharge in
/// m3/s (L. B. Leopold and T. Maddock, USGS Prof. Pap. 252 (1953): the power). Heights know no
/// dams, canals and tunnels.
Array2d<RiverSite> rivers(const LandSites& sites);

}  // namespace relevo::climate
