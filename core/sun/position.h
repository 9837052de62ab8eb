#pragma once

#include <glm/vec3.hpp>

#include "geo/geodetic.h"
#include "sun/body.h"
#include "sun/earth_rotation.h"
#include "sun/time.h"

namespace relevo::sun {

/// The two clocks that the sun's place depends on, and the pole. The ephemeris follows TT, the
/// turning of the Earth UT1; each is a Julian date in two parts that are to be added.
struct Epoch {
    double tt_jd[2] = {0, 0};
    double ut1_jd[2] = {0, 0};
    double pole_x_rad = 0;
    double pole_y_rad = 0;

    /// What the tables know of this moment.
    /// @throws Error (BadInput) outside 1900-2100
    static Epoch at(Instant utc, const EarthRotation& rotation = EarthRotation::built_in());

    /// For experts and tests: UTC with a given UT1-UTC, and the pole at its conventional place.
    /// @throws Error (BadInput) outside 1900-2100
    static Epoch from_utc(Instant utc, double ut1_minus_utc_s);

    /// For experts and tests: the instant read as UT1, with a given TT-UT1; the pole likewise.
    /// @throws Error (BadInput) outside 1900-2100
    static Epoch from_ut1(Instant ut1, double delta_t_s);
};

/// The sun as seen from the centre of the Earth.
struct Geocentric {
    double right_ascension_rad = 0;  ///< apparent, true equator and equinox of date [0, 2 pi)
    double declination_rad = 0;      ///< likewise
    double distance_au = 0;          ///< when the light left
    double longitude_rad = 0;        ///< apparent, ecliptic and equinox of date [0, 2 pi)
    /// Apparent solar time minus mean solar time: Greenwich hour angle of the apparent sun minus
    /// (UT1 - 12 h). Meeus' definition by the mean longitude differs from it by some 0.24 s.
    double equation_of_time_s = 0;
};

/// The sun or the moon seen from a place, without an atmosphere.
struct SkyPosition {
    double azimuth_rad = 0;    ///< of the disc's centre, clockwise from true north [0, 2 pi)
    double elevation_rad = 0;  ///< of the centre above the ellipsoid's tangent plane; no refraction
    double distance_au = 0;    ///< from the place, when the light left
    double right_ascension_rad = 0;  ///< topocentric, true equator and equinox of date [0, 2 pi)
    double declination_rad = 0;      ///< likewise
    double hour_angle_rad = 0;       ///< local, topocentric, west positive [-pi, pi]
    double semidiameter_rad = 0;     ///< half the disc's width
    glm::dvec3 direction{0};         ///< unit vector to the centre: x east, y north, z up
};

/// The sun as seen from a place, without an atmosphere.
struct Position : SkyPosition {
    double equation_of_time_s = 0;  ///< as in Geocentric
};

/// Whether the instant lies in 1900-2100, give or take two days so that local days at both ends are
/// whole.
bool is_in_years(Instant instant);
/// Throws the layer's own error unless it does.
void check_year(Instant instant);

/// @throws Error (BadInput) outside 1900-2100
Geocentric geocentric(const Epoch& epoch);

/// Where the sun stands.
/// @param place  geodetic, WGS 84 [rad, rad, m above the ellipsoid]
/// @throws Error (BadInput) outside 1900-2100, for a latitude beyond 90 degrees, for a height that
///     is no place on Earth
/// Accuracy, arcsec on the sky: with UT1 known 0.02 against JPL's DE431, 1900-2100; with the
/// built-in table 0.1 from 1962 to 2026; for civil times to come 15 for every second that
/// UT1 differs from its last known value (tests/sun/test_position.cpp). The deflection of the
/// vertical (up to 60 in mountains) is not modelled.
/// Source: IAU SOFA in its BSD-licensed form ERFA: eraEpv00, eraPnm00b, eraEra00, eraPvtob, eraAb.
Position position(const Epoch& epoch, const geo::Geodetic& place);
Position position(Instant utc, const geo::Geodetic& place);

/// Clockwise from north [0, 2 pi) and above the horizon [rad] of a vector in local ENU.
double azimuth_of(const glm::dvec3& direction);
double elevation_of(const glm::dvec3& direction);

inline constexpr double kSunRadius_m = 695'700'000;  ///< IAU 2015 resolution B3, nominal
inline constexpr double kMoonRadius_m = 1'737'400;   ///< mean; IAU working group 2015

/// Half the width of a body's disc at a distance.
double semidiameter_rad(double distance_au, Body body = Body::Sun);

}  // namespace relevo::sun
