#pragma once

#include "sun/time.h"

namespace relevo::sun {

/// The four turning points of a year: the sun's apparent geocentric longitude is 0, 90, 180, 270
/// degrees.
struct Seasons {
    Instant march_equinox;
    Instant june_solstice;
    Instant september_equinox;
    Instant december_solstice;
};

/// @throws Error (BadInput) outside 1900-2100
/// Accuracy: 0.5 s (0.02 arcsec of longitude); Meeus' seconds for 2000, and the U.S. Naval
/// Observatory's minutes 1900-2015 within 34 s, rounding included (tests/sun/test_events.cpp). In
/// UTC, later ones hang on leap seconds to come.
Seasons seasons(int year);

}  // namespace relevo::sun
