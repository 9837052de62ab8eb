#pragma once

#include <optional>
#include <string>
#include <vector>

#include "light/point/horizon.h"
#include "sun/body.h"
#include "sun/refraction.h"
#include "sun/zone.h"

namespace relevo::light {

struct AlignmentOptions {
    sun::Body body = sun::Body::Sun;  ///< of the moon read "moon" for "sun" below
    /// How near the sun's centre must come to the target [rad].
    double tolerance_rad = 0.5 * 3.14159265358979323846 / 180;
    /// Of the sun; none: integrated through the standard atmosphere over the place.
    std::optional<sun::Refraction> refraction = {};
};

/// A passage of the sun by a point of the landscape, at its closest.
struct Alignment {
    sun::Instant utc;
    sun::Date date;             ///< local
    double separation_rad = 0;  ///< of the sun's centre from the target, on the sky
    double right_rad = 0;       ///< of it, along the horizon; negative: the sun stands to the left
    double above_rad = 0;       ///< of it, in elevation; negative: the sun stands lower
    double azimuth_rad = 0;     ///< of the sun's centre
    double elevation_rad = 0;   ///< of it, apparent
    bool sun_visible = false;   ///< the centre stands over the terrain horizon
    bool hole = false;          ///< visible, but through a void of the DEM (HorizonPoint::hole)
};

/// Dates and times at which the sun stands at a point of the landscape, as seen from a viewpoint.
struct Alignments {
    geo::Geodetic target;             ///< with its height above the DEM's zero
    Sight sight;                      ///< where it stands, and whether it is seen
    std::vector<Alignment> passages;  ///< in order of time
    std::string definition;
};

/// All passages within the tolerance on the local days from `first` to `last`, each at the moment
/// when the sun's centre is closest to the target.
/// @param target  with its height; see summit_near()
/// @throws Error (BadInput) for dates backwards or outside 1900-2100, a tolerance that is none
/// Accuracy: 1 s in still standard air (tests/light/test_alignment.cpp); the horizon's remarks on
/// refraction apply.
Alignments alignments(const TerrainHorizon& from, const geo::Geodetic& target, sun::Date first,
                      sun::Date last, const sun::Zone& zone, const AlignmentOptions& options = {});

}  // namespace relevo::light
