#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "geo/geodetic.h"

namespace relevo::sun {

/// Throws the layer's own error unless latitude is within 90 degrees, and the height between 12 km
/// below and 100 km above the ellipsoid.
void check_place(const geo::Geodetic& place);

/// What the sun's place in the sky needs of a place on Earth, computed once.
class Observer {
  public:
    /// @throws Error (BadInput) for a latitude beyond 90 degrees or an impossible height
    explicit Observer(const geo::Geodetic& place);

    const geo::Geodetic& place() const { return place_; }
    /// From the centre of the Earth, in Earth-fixed axes (ITRS) [au].
    const glm::dvec3& position_au() const { return position_au_; }
    /// Earth-fixed to local ENU.
    glm::dvec3 enu(const glm::dvec3& itrs) const { return to_enu_ * itrs; }
    /// Velocity of the place around the axis over that of light, towards the east.
    double eastward_beta() const { return eastward_beta_; }

  private:
    geo::Geodetic place_;
    glm::dvec3 position_au_{0};
    glm::dmat3 to_enu_{1};
    double eastward_beta_ = 0;
};

}  // namespace relevo::sun
