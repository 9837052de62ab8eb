#pragma once

#include <string>
#include <vector>

#include "geo/geodetic.h"
#include "scene/camera.h"
#include "sun/time.h"

namespace relevo::scene {

/// Limits of light that shows relief: elevation of the sun, and its azimuth relative to that of the
/// camera as seen from the ground.
inline constexpr double kLowestSun_deg = 20, kHighestSun_deg = 35;
inline constexpr double kLeastAside_deg = 50, kMostAside_deg = 100;

/// The time of pictures for which none is given.
struct DefaultTime {
    sun::Instant utc;
    double elevation_deg = 0;  ///< of the sun's centre, geometric
    double aside_deg = 0;  ///< azimuth relative to the camera, -180 to 180; positive to the left
    bool within_bounds = false;
    bool globe = false;  ///< the DEM goes round the Earth; there are no limits

    /// "time: 2026-06-21T22:50:00Z, chosen for relief: sun 31 degrees high, ...".
    std::string reason() const;
};

/// The longest day of a place's hemisphere in 2026, in mean solar time: the date of pictures for
/// which no time is given.
class DefaultDay {
  public:
    /// @param globe  the DEM goes round the Earth; the hour then lights most of the visible side
    explicit DefaultDay(const geo::Geodetic& place, bool globe = false);

    bool is_globe() const { return globe_; }

    /// The hour that shows relief best to a camera: with the sun 20 to 35 degrees high and 50 to
    /// 100 degrees from the camera's azimuth, preferably to the left, as maps are shaded. If the
    /// place has no such hour, the closest one.
    /// @param camera_deg  azimuth of the camera as seen from the ground
    DefaultTime time(double camera_deg) const;
    /// As time(), within half a degree, in a hundredth of the time.
    DefaultTime estimate(double camera_deg) const;

  private:
    struct Hour {
        double hours;  // since midnight, mean solar time
        double azimuth_deg, elevation_deg;
    };
    DefaultTime made(const Hour& hour, double camera_deg) const;

    geo::Geodetic place_;
    bool globe_;
    sun::Date date_;
    std::vector<Hour> hours_;
};

/// Azimuth of a camera as seen from its target [deg], towards the lower edge of the picture. Also
/// defined for cameras that look straight down.
double side_of_deg(const Camera& camera);

}  // namespace relevo::scene
