#pragma once

#include <vector>

#include "sun/events.h"
#include "sun/moon.h"

namespace relevo::sun {

/// What the moon does on a local day.
struct MoonDay {
    Date date;
    TimeSpan span;  ///< the local day
    /// Moonrise, Transit, Moonset and LowerTransit in order of time. On a day each comes once, not
    /// at all, or, where the day is long or the place near a pole, twice.
    std::vector<Event> events;
    Crossing moon = Crossing::Crosses;
    std::vector<TimeSpan> moon_up;    ///< within the local day
    double moon_up_s = 0;             ///< of moon_up, together
    std::vector<PhaseTime> phases;    ///< within the local day
    double illuminated_fraction = 0;  ///< at the place, in the middle of the local day
    double phase_longitude_rad = 0;   ///< then
};

/// The days from `first` to `last`, without those that the zone skipped.
/// @param rule  of the moon
/// @throws Error (BadInput) outside 1900-2100 and for an impossible place
/// Accuracy: that of moon_position, 0.03 s of time; tests/sun/test_moon_events.cpp compares with
/// minutes of the U.S. Naval Observatory
std::vector<MoonDay> moon_days(Date first, Date last, const Zone& zone, const geo::Geodetic& place,
                               const RiseRule& rule = RiseRule::almanac(Body::Moon),
                               const EarthRotation& rotation = EarthRotation::built_in());

}  // namespace relevo::sun
