#pragma once

#include "geo/geodetic.h"
#include "sun/time.h"

namespace relevo::scene {

/// The moment a picture shows when none is asked for: nine in the morning by the sun, on the
/// longest day of the place's hemisphere in 2026. The sun then stands 40 to 55 degrees high in the
/// east outside of the polar regions, and relief shows well.
sun::Instant default_moment(const geo::Geodetic& place);

}  // namespace relevo::scene
