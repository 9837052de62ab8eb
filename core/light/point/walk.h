#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dem/posts.h"
#include "geo/geodetic.h"
#include "light/point/doubt.h"
#include "light/point/horizon.h"
#include "sun/refraction.h"
#include "sun/time.h"

/// Where a walk over a DEM is in the sun.
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

enum class WalkLight {
    Sun,       ///< the sun's centre stands over the terrain
    Terrain,   ///< it stands over the level horizon, behind terrain
    Night,     ///< it is under the level horizon
    NotKnown,  ///< the ground there is a hole of the DEM, or the sun is seen through one
};
inline constexpr std::size_t kWalkLights = 4;

/// "sun", "terrain", "night", "not_known".
std::string_view name_of(WalkLight light);

struct WalkMoment {
    double distance_m = 0;  ///< from the start
    sun::Instant utc;
    geo::Geodetic place;  ///< height 0
};

/// A part of a walk in one light.
struct WalkStretch {
    WalkLight light = WalkLight::Night;
    WalkMoment from, to;
};

struct WalkSum {
    double time_s = 0, length_m = 0;
};

struct WalkOptions {
    HorizonOptions horizon;  ///< of the eye, above the ground
    /// The air over a place at its height; none: no refraction.
    std::function<sun::Refraction(const geo::Geodetic&)> air;
    std::optional<double> highest_m;  ///< of terrain beyond the DEM, as for doubt_of()
};

struct LightAlong {
    std::vector<WalkStretch> stretches;     ///< in order, each begins where the last ends
    std::array<WalkSum, kWalkLights> sums;  ///< by WalkLight
    double length_m = 0, duration_s = 0;
    double spacing_m = 0, step_s = 0;  ///< that the light was looked at by, at most
    Doubt doubt;                       ///< of terrain beyond the DEM
    std::string definition;
};

/// The light on every part of a walk, by the exact horizon of each point that is looked at, in the
/// one direction in which the sun stands: as far apart as the DEM's posts and ten seconds at most,
/// and between two of different light to 0.1 s and 0.1 m. Light that is shorter than both steps may
/// be missed. The sun is refracted by the air over the ground there, between levels 100 m apart.
///
/// Accuracy: for one who stands, the edges of DirectLight to 0.2 s (tests/light/test_walk.cpp).
/// Speed: 34 us a look, one thread (tests/light/bench_light.cpp, horizon_of_one_direction).
/// @throws Error (BadInput) where a part of the walk is outside of the DEM, with which and how far,
///     for a walk of more than a million points to look at, a year that is not computed, and as
///     TerrainHorizon
LightAlong light_along(const dem::Posts& posts, const Walk& walk, const WalkOptions& options);

}  // namespace relevo::light
