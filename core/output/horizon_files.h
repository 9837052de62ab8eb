#pragma once

#include <string>
#include <vector>

#include "light/point/horizon.h"

/// A horizon as programs for solar plants read it, each with its own zero of the azimuth.
namespace relevo::output {

/// For pvlib: columns `horizon_azimuth` and `horizon_elevation` in degrees, the azimuth clockwise
/// from north, 0 to 360 without the latter, as pvlib.iotools.get_pvgis_horizon() returns them.
/// Elevations below the level horizon are negative.
/// Source: pvlib 0.13 documentation, get_pvgis_horizon; "from north, clockwise" is all of pvlib's.
/// @param profile  equally spaced from north on, as TerrainHorizon::profile() has it; likewise
/// below
std::string pvlib_text(const std::vector<light::HorizonPoint>& profile);

/// PVGIS's user horizon: heights in degrees, one a line and nothing else, from north on clockwise
/// at equal steps. It has no heights below the level horizon; those are 0.
/// Source: PVGIS (European Commission, JRC), interactive tools and API, `userhorizon`.
std::string pvgis_text(const std::vector<light::HorizonPoint>& profile);

/// For PVsyst: two lines of comment, then azimuth and height in degrees, parted by a blank, from
/// -180 on. West is 90 and east -90; 0 is south on the northern half of the Earth and on the
/// equator, and north on the southern one, where azimuths so run counterclockwise. Heights below
/// the level horizon are 0.
/// Source: PVsyst 7 and 8 help, "Importing a horizon profile" and "Plane azimuth".
/// @param place  of the viewpoint
std::string pvsyst_text(const std::vector<light::HorizonPoint>& profile,
                        const geo::Geodetic& place);

}  // namespace relevo::output
