#pragma once

#include <memory>

#include <glm/glm.hpp>

#include "geo/geodetic.h"

namespace relevo::geo {

/// East, north and up at some place: unit vectors, orthogonal, right-handed.
struct Axes {
    glm::dvec3 east;
    glm::dvec3 north;
    glm::dvec3 up;  ///< normal of the ellipsoid, away from the Earth
};

/// Local Cartesian coordinates about an origin: x east, y north, z up there, in metres. The Earth
/// stays round: a place far from the origin has a lower z at the same height, and its own up.
/// Accuracy: 1 mm within 1000 km against a written-out geocentric computation, to_geodetic undoes
/// to_local to 1 um (tests/geo/test_local_frame.cpp). Source: GeographicLib::LocalCartesian; EPSG
/// method 9837.
class LocalFrame {
  public:
    /// @param origin  latitude within [-pi/2, pi/2]; at a pole its longitude says where north is
    explicit LocalFrame(const Geodetic& origin);
    LocalFrame(const LocalFrame& other);
    LocalFrame(LocalFrame&&) noexcept;
    LocalFrame& operator=(const LocalFrame& other);
    LocalFrame& operator=(LocalFrame&&) noexcept;
    ~LocalFrame();

    const Geodetic& origin() const { return origin_; }

    /// Metres east, north and up of the origin. Safe on several threads at once.
    glm::dvec3 to_local(const Geodetic& place) const;

    /// The place of a point given in this frame [m]; the centre of the Earth has none of its own
    /// and gives latitude pi/2. Safe on several threads at once.
    Geodetic to_geodetic(const glm::dvec3& local_m) const;

    /// The normal of the ellipsoid at a place, as a unit vector of this frame.
    glm::dvec3 up(double lat_rad, double lon_rad) const;

    /// East, north and up at a place, as unit vectors of this frame.
    Axes axes(double lat_rad, double lon_rad) const;

  private:
    struct Impl;
    Geodetic origin_;
    std::unique_ptr<Impl> impl_;
};

}  // namespace relevo::geo
