#pragma once

#include <vector>

#include "geo/geodetic.h"
#include "sun/time.h"

namespace relevo::light {

/// A way over the ground in time: from place to place along geodesics, at an even speed on each.
/// Distances are those on the map: over the ellipsoid, not along the slope.
class Walk {
  public:
    /// At one speed. @param speed_m_s  above 0
    /// @throws Error (BadInput) for less than two places, a way without a length, a speed that is
    ///     none, and a walk of more than kLongest_s
    static Walk at_speed(std::vector<geo::Geodetic> places, sun::Instant start, double speed_m_s);

    /// At times of its own, which may be equal (a rest, a gap) but not go backwards.
    /// @throws Error (BadInput) for less than two places, times that go backwards, with the number
    ///     of the point from 1, and a walk of no or of more time than kLongest_s
    static Walk timed(std::vector<geo::Geodetic> places, std::vector<sun::Instant> times);

    static constexpr double kLongest_s = 31 * 86400.0;

    const std::vector<geo::Geodetic>& places() const { return places_; }
    const std::vector<double>& distances_m() const { return distance_m_; }  ///< from the start
    const std::vector<sun::Instant>& times() const { return utc_; }
    double length_m() const { return distance_m_.back(); }
    double duration_s() const { return utc_.back() - utc_.front(); }

    /// The same walk at another time.
    Walk starting_at(sun::Instant start) const;

  private:
    explicit Walk(std::vector<geo::Geodetic> places);
    void check_duration() const;

    std::vector<geo::Geodetic> places_;
    std::vector<double> distance_m_;
    std::vector<sun::Instant> utc_;
};

}  // namespace relevo::light
