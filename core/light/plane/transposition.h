#pragma once

#include <glm/vec3.hpp>

#include "light/point/skyline.h"

/// Light on a plane in any position: the beam by its angle, the sky by a model, the ground as level
/// and grey. Angles in rad, directions x east, y north, z up.
namespace relevo::light {

struct Plane {
    double tilt_rad = 0;     ///< 0 level, pi/2 a wall
    double azimuth_rad = 0;  ///< where it faces, clockwise from true north

    glm::dvec3 normal() const;
};

/// At 1 au, in the models of the sky [W/m2].
inline constexpr double kSkySolarConstant = 1366.1;

/// Normal irradiance above the air [W/m2], as the models of the sky are used with it and pvlib has
/// it: J. W. Spencer, Search 2 (1971) 172. ClearSky's 1367 at the ephemeris's distance would move
/// months of Hay-Davies by up to 0.08 % on walls that face the pole.
/// @param day  of the year, from 1
double irradiance_above_air(int day);

enum class SkyModel { Isotropic, HayDavies, Perez };

/// The sun as the models of the sky take it.
struct SkySun {
    double zenith_rad = 0;     ///< of the disc's centre, without air
    double cos_zenith = 1;     ///< of the beam
    double cos_incidence = 0;  ///< of the beam on the plane; negative behind it
    double outside_w_m2 = 0;   ///< irradiance_above_air()
};

/// What a plane under an open sky gets of the level diffuse irradiance, as factors of it. Their sum
/// below 0 counts as 0.
struct SkyFactors {
    double isotropic = 1, circumsolar = 0, band = 0;
};

/// Isotropic: (1 + cos tilt) / 2. Hay-Davies: J. E. Hay and J. A. Davies, Proc. First Canadian
/// Solar Radiation Data Workshop (1980) 59, cosine of the zenith angle at least 0.01745. Perez:
/// R. Perez et al., Solar Energy 44 (1990) 271, coefficients of all sites, kappa 1.041, bins not
/// blended, cosine of the zenith angle at least that of 85 degrees; relative air mass of F. Kasten
/// and A. T. Young, Applied Optics 28 (1989) 4735.
/// @param dni_w_m2, dhi_w_m2  direct normal and diffuse level irradiance
/// Accuracy: 0.001 W/m2 against pvlib 0.16.1 with its sun (tests/light/test_transposition.cpp).
SkyFactors sky_factors(SkyModel model, const Plane& plane, const SkySun& sun, double dni_w_m2,
                       double dhi_w_m2);

/// The share of an even sky that a plane sees over a level horizon: 1 for a level plane.
double open_sky(const Plane& plane);

/// The same over a horizon; ground below the level counts as none of the sky. The integral over the
/// elevation is closed: cos2 h for a level plane in a ring of elevation h, 1/2 - h/pi - sin 2h /
/// (2 pi) for a wall in it.
/// Accuracy: 1e-6 (tests/light/test_transposition.cpp).
double open_sky(const Plane& plane, const Skyline& horizon);

}  // namespace relevo::light
