#pragma once

#include <glm/vec3.hpp>

#include "sun/apparent.h"

namespace relevo::sun {

/// From the Earth's centre to the moon's, geometric, at a Julian date of TT [m], ICRS.
/// Accuracy: 0.09 arcsec mean, 0.25 worst against JPL's DE431 at 2000 dates of 1900-2100; distance
/// 0.2 km (docs/accuracy.md).
/// Source: ELP 2000-82B (M. Chapront-Touze, J. Chapront, Astron. Astrophys. 124 (1983) 50) in
/// libnova, with the mean longitude of ELP/MPP02 fitted to lunar laser ranging (J. Chapront,
/// G. Francou, Astron. Astrophys. 404 (2003) 735).
glm::dvec3 moon_icrs_m(double tt_jd1, double tt_jd2);

/// From the Earth's centre to the moon as it is seen from there: when the light left [m], CIRS.
///
/// Neither aberration nor the Earth's way while the light travels is applied: both shift the moon
/// by the Earth's velocity over that of light, in opposite directions. What remains is a square of
/// that (0.002 arcsec). So subtracting a place on the Earth is exact.
glm::dvec3 apparent_moon_m(double tt_jd1, double tt_jd2, const SolarEphemeris& axes);

}  // namespace relevo::sun
