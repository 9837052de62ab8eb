#pragma once

#include <string>
#include <vector>

#include "geo/geodetic.h"
#include "scene/camera.h"
#include "sun/time.h"

namespace relevo::scene {

/// Bounds of the light that shows relief: how high the sun stands, and how far from the camera's
/// side it does, along the horizon.
inline constexpr double kLowestSun_deg = 20, kHighestSun_deg = 35;
inline constexpr double kLeastAside_deg = 50, kMostAside_deg = 100;

/// The moment a picture shows when none is asked for.
struct DefaultMoment {
    sun::Instant utc;
    double elevation_deg = 0;  ///< of the sun's centre, geometric
    double aside_deg = 0;      ///< from the camera's side, -180 to 180; left of it is positive
    bool within_bounds = false;
    bool globe = false;  ///< whose far side is dark at any hour: there are no bounds

    /// "time: 2026-06-21T22:50:00Z, chosen for relief: sun 31 degrees high, ...".
    std::string reason() const;
};

/// The longest day of a place's hemisphere in 2026, by the sun's own time: the date of pictures for
/// which no time is given.
class DefaultDay {
  public:
    /// @param globe  whether the DEM goes round the Earth: then the hour that lights most of the
    /// side
    ///               that is seen, save for some of its shade
    explicit DefaultDay(const geo::Geodetic& place, bool globe = false);

    bool is_globe() const { return globe_; }

    /// The hour when relief shows best to a camera: with the sun 20 to 35 degrees high and 50 to
    /// 100 degrees from the camera's side, rather left of it, as maps are shaded. Where the place
    /// has no such hour, the one that comes nearest to it.
    /// @param camera_deg  azimuth of the camera as seen from the ground
    DefaultMoment moment(double camera_deg) const;
    /// The same to half a degree, in a hundredth of the time.
    DefaultMoment estimate(double camera_deg) const;

  private:
    struct Hour {
        double hours;  // since midnight, mean solar time
        double azimuth_deg, elevation_deg;
    };
    DefaultMoment made(const Hour& hour, double camera_deg) const;

    geo::Geodetic place_;
    bool globe_;
    sun::Date date_;
    std::vector<Hour> hours_;
};

/// Azimuth of a camera as seen from what it looks at [deg]: where the lower edge of the picture
/// lies, so that one that looks straight down has a side too.
double side_of_deg(const Camera& camera);

}  // namespace relevo::scene
