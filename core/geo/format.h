#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "geo/geodetic.h"

namespace relevo::geo {

/// UTM: `32N 683473 E 5255234 N`. The zone, then N or S for the hemisphere (not the latitude band
/// of MGRS), then easting and northing rounded to whole metres; in the southern hemisphere the
/// northing has its false 10 000 000 m. Zones follow the exceptions of Norway and Svalbard. North
/// of 84 degrees and south of -80, UPS: `UPS N 2000000 E 2000000 N`, where N or S is the pole.
/// @throws nothing for latitudes within [-pi/2, pi/2]
/// Source: GeographicLib::UTMUPS (accuracy 5 nm); tests/geo/test_format.cpp.
std::string utm_text(const Geodetic& place);

/// MGRS: `32TPT8347355234`, the square that holds the place.
/// @param digits  of easting and of northing, 0 (100 km) to 5 (1 m); squares are named by their
///                south-west corner, so nothing is rounded
/// Source: GeographicLib::MGRS; tests/geo/test_format.cpp.
std::string mgrs_text(const Geodetic& place, int digits = 5);

/// Decimal degrees as people write them: `47.41700 N 11.43708 E`, rounded to 1e-5 (1 m).
std::string degrees_text(const Geodetic& place);

/// The nearest of 16 compass points: `SSW` for 200.
/// @param azimuth_deg  0 or more, clockwise from north
const char* compass_point(double azimuth_deg);

/// A place in any of the forms that maps and GPS receivers have: degrees ("47.4395, 11.8935",
/// "47 26 22 N 11 53 37 E"), UTM or UPS ("32N 683473 E 5255234 N", "32T 683473 5255234") or MGRS
/// ("32TPT8347355234"); height 0.
/// Of two plain numbers the first is the latitude; N and S behind a zone are hemispheres.
/// @returns none: it is no such text
/// Source: GeographicLib::GeoCoords.
std::optional<Geodetic> find_coordinates(std::string_view text);

}  // namespace relevo::geo
