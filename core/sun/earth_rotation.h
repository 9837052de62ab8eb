#pragma once

#include <optional>
#include <vector>

#include "sun/time.h"

namespace relevo::sun {

/// How the Earth is turned at a moment, as seen from a clock that shows UTC.
struct EarthOrientation {
    double tt_minus_utc_s = 0;   ///< terrestrial time, which the planets follow
    double ut1_minus_utc_s = 0;  ///< UT1, the angle of the Earth's rotation
    double pole_x_rad = 0;       ///< of the pole on the Earth's surface, towards Greenwich
    double pole_y_rad = 0;       ///< towards 90 degrees west
};

/// UT1 and the motion of the pole, as the International Earth Rotation Service measured them.
///
/// Built in: 30-day nodes from 1962 to August 2027 (measured to August 2026, then predicted), with
/// cubic interpolation. After that UT1-UTC is held at its last value, and the pole goes to its mean
/// place within a year. Before 1962 an Instant is UT1 itself, TT-UT1 is the U.S. Naval
/// Observatory's half-yearly table, and the pole is at its mean place.
///
/// Accuracy of the built-in table against the daily values it was made from: UT1 0.0009 s median,
/// 0.0060 s worst (0.09 arcsec of the sun's azimuth); pole 0.001 and 0.014 arcsec
/// (tools/make_earth_rotation_table.py prints them; tests/sun/test_earth_rotation.cpp).
/// Source: IERS EOP 14 C04, IERS Bulletin A, USNO historic_deltat.data; mean pole: IERS Conventions
/// (2010) version 1.3.0, 7.1.4.
class EarthRotation {
  public:
    static const EarthRotation& built_in();

    /// For experts and tests: the same at all times, whatever the instants then mean.
    static EarthRotation fixed(const EarthOrientation& orientation);

    EarthOrientation at(Instant utc) const;

  private:
    struct Node {
        double ut1_minus_tai_s, pole_x_rad, pole_y_rad;
    };

    std::optional<EarthOrientation> fixed_;
    std::vector<Node> nodes_;
};

/// UTC to TAI: whole leap seconds since 1972; before, from 1962, the drifting seconds of old UTC.
double tai_minus_utc_s(Instant utc);

}  // namespace relevo::sun
