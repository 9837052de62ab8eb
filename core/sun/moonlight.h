#pragma once

#include <glm/vec3.hpp>

#include "sun/moon.h"

/// Light of the moon. Units as in daylight.h: a white
/// diffuse surface that faces the sun outside the atmosphere reflects a radiance of 1.
namespace relevo::sun {

/// Irradiance of the moon on a surface that faces it, outside the atmosphere; linear sRGB.
/// Source: V = -12.73 + 0.026 a + 4e-9 a^4 with the phase angle a in degrees, at the mean distance
/// (C. W. Allen, Astrophysical Quantities, 1976, 143, as used by K. Krisciunas and B. E. Schaefer,
/// Publ. Astron. Soc. Pacific 103 (1991) 1033); B-V 0.91 against the sun's 0.65 (Allen). Within 7
/// degrees of full moon the real one is up to a third brighter.
glm::dvec3 moonlight(const MoonPosition& moon);

/// Radiance of the lit disc where the law of Lommel and Seeliger is 1: mu0 / (mu0 + mu) = 1/2, as
/// all over the full moon. The disc as a whole then sheds moonlight(). Linear sRGB.
glm::dvec3 moon_radiance(const MoonPosition& moon);

/// Irradiance on level ground from a clear sky that the moon lights, as the sun would from there.
/// @param elevation_rad  of the moon, geometric; below the horizon: 0
glm::dvec3 moonlit_sky_irradiance(double elevation_rad, const glm::dvec3& moonlight);

}  // namespace relevo::sun
