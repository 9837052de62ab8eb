#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "geo/geodetic.h"
#include "sun/position.h"

namespace relevo::sun {

/// How the sky of the stars stands over a place. `axes * d - velocity`, normalised, is where a star
/// is catalogued that is seen in the direction d (unit, local ENU, without air).
struct CelestialFrame {
    glm::dmat3 axes{1};      ///< local ENU to ICRS: precession, nutation, the Earth's turning, pole
    glm::dvec3 velocity{0};  ///< of the place, over that of light, ICRS: aberration
};

/// @param place  geodetic, WGS 84 [rad, rad, m above the ellipsoid]
/// @throws Error (BadInput) for a latitude beyond 90 degrees or a height that is no place on Earth
/// Accuracy: 0.01 arcsec against ERFA's eraAtco13 for stars more than 90 degrees from the sun,
/// without parallax; the sun bends the light of nearer ones by up to 0.01 at 45 degrees
/// (tests/sun/test_celestial.cpp).
/// Source: IAU SOFA in its BSD-licensed form ERFA: eraPnm00b, eraEra00, eraPom00, eraPvtob,
/// eraEpv00.
CelestialFrame celestial_frame(const Epoch& epoch, const geo::Geodetic& place);

}  // namespace relevo::sun
