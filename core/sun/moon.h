#pragma once

#include <string_view>
#include <vector>

#include "geo/geodetic.h"
#include "sun/position.h"
#include "sun/time.h"

namespace relevo::sun {

/// The moon as seen from a place, without an atmosphere. Libration, which turns the disc's markings
/// by up to 8 degrees, is not modelled.
struct MoonPosition : SkyPosition {
    double phase_angle_rad = 0;  ///< at the moon, between the sun and the place; 0: full [0, pi]
    double illuminated_fraction = 0;  ///< of the disc's area [0, 1]
    double elongation_rad = 0;        ///< from the sun's centre, at the place [0, pi]
    /// Direction of the bright limb's middle at the disc's centre: from celestial north through
    /// east, and from the zenith through the left [0, 2 pi).
    double bright_limb_rad = 0, bright_limb_from_zenith_rad = 0;
    /// Geocentric apparent ecliptic longitude of the moon minus that of the sun: 0 new moon, a
    /// quarter turn the first quarter [0, 2 pi).
    double phase_longitude_rad = 0;
};

/// @param place  geodetic, WGS 84 [rad, rad, m above the ellipsoid]
/// @throws Error (BadInput) outside 1900-2100 and for an impossible place
/// Accuracy: 0.1 arcsec mean and 0.3 worst against JPL's DE431, 1900-2100, with UT1 known;
/// against JPL Horizons as tests/sun/test_moon.cpp prints. The deflection of the vertical is not
/// modelled.
/// Source: moon_ephemeris.h; ERFA for the axes, the Earth's rotation and the sun.
MoonPosition moon_position(const Epoch& epoch, const geo::Geodetic& place);
MoonPosition moon_position(Instant utc, const geo::Geodetic& place);

enum class Phase { NewMoon, FirstQuarter, FullMoon, LastQuarter };

/// "new moon", "first quarter", ...
std::string_view name_of(Phase phase);

/// Name of the phase at a phase longitude: one of the four of Phase within 6 degrees (half a day)
/// of it, otherwise "waxing crescent", "waxing gibbous", "waning gibbous" or "waning crescent".
std::string_view phase_name(double phase_longitude_rad);

struct PhaseTime {
    Phase phase;
    Instant utc;
};

/// The phases within a span, in order: the times at which the phase longitude is 0, 90, 180 and 270
/// degrees.
/// @throws Error (BadInput) outside 1900-2100
/// Accuracy: 2 s, by that of the positions; against the minutes of the U.S. Naval Observatory as
/// tests/sun/test_moon.cpp prints
std::vector<PhaseTime> moon_phases(Instant from, Instant to);

/// Days since the last new moon.
/// @throws Error (BadInput) outside 1900-2100
double moon_age_d(Instant utc);

}  // namespace relevo::sun
