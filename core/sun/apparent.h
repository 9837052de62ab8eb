#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "geo/geodetic.h"
#include "sun/observer.h"
#include "sun/position.h"

namespace relevo::sun {

/// The moving axes and bodies of a moment of TT, from which the sun's apparent place is taken.
/// Celestial intermediate axes (CIRS): the pole of date and an origin that does not rotate, so that
/// the Earth's rotation angle is a linear function of UT1. Used by position.cpp and
/// position_table.cpp.
class SolarEphemeris {
  public:
    SolarEphemeris(double tt_jd1, double tt_jd2);

    /// From an observer to the sun, as the observer sees it: light time and aberration. [au], CIRS
    /// @param from_geocenter_m, velocity_m_s  of the observer, CIRS
    glm::dvec3 apparent_au(const glm::dvec3& from_geocenter_m = glm::dvec3(0),
                           const glm::dvec3& velocity_m_s = glm::dvec3(0)) const;

    /// Right ascension of the CIRS origin counted from the true equinox, with the sign of the
    /// equation of the origins: equinox right ascension = CIRS right ascension - this.
    double equation_of_origins_rad() const { return equation_of_origins_rad_; }
    /// From the true equinox of date [0, 2 pi), of a vector in CIRS.
    double right_ascension_rad(const glm::dvec3& cirs) const;

    /// CIRS to the axes of star catalogues (GCRS, which for directions is ICRS), of a vector.
    glm::dvec3 icrs(const glm::dvec3& cirs) const;
    glm::dvec3 cirs(const glm::dvec3& icrs) const;  ///< and back
    /// Of the Earth's centre about that of the solar system, ICRS.
    glm::dvec3 earth_velocity_m_s() const;

  private:
    double earth_barycentric_[2][3];  // au, au/d, BCRS
    double earth_heliocentric_[2][3];
    double to_cirs_[3][3];
    double equation_of_origins_rad_;
    double tt_jd_[2];
};

double declination_rad(const glm::dvec3& cirs);

/// The Earth as it is turned at a moment, and where that takes its places.
class TurnedEarth {
  public:
    explicit TurnedEarth(const Epoch& epoch);

    double angle_rad() const { return angle_rad_; }  ///< the Earth's rotation angle

    struct Motion {
        glm::dvec3 position_m{0};    ///< from the Earth's centre, CIRS
        glm::dvec3 velocity_m_s{0};  ///< likewise
    };
    Motion motion(const geo::Geodetic& place) const;

    /// Earth-fixed axes (ITRS) of a vector in CIRS, and back.
    glm::dvec3 itrs(const glm::dvec3& cirs) const;
    glm::dvec3 cirs(const glm::dvec3& itrs) const;

  private:
    double angle_rad_, pole_x_rad_, pole_y_rad_, sp_rad_;
    double to_itrs_[3][3];
};

/// Where a vector from an observer to a body points [au, CIRS] in that observer's sky.
SkyPosition sky_position(const glm::dvec3& cirs_au, Body body, const Observer& observer,
                         const TurnedEarth& earth, const SolarEphemeris& axes);

}  // namespace relevo::sun
