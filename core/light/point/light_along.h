#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dem/posts.h"
#include "light/point/doubt.h"
#include "light/point/horizon.h"
#include "light/point/walk.h"
#include "sun/refraction.h"

/// Where a walk over a DEM is in the sun.
namespace relevo::light {

enum class WalkLight {
    Sun,       ///< the sun's centre stands over the terrain
    Terrain,   ///< it stands over the level horizon, behind terrain
    Night,     ///< it is under the level horizon
    NotKnown,  ///< the ground there is a void of the DEM, or the sun is seen through one
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
    double spacing_m = 0, step_s = 0;  ///< from sample to sample, at most
    Doubt doubt;                       ///< of terrain beyond the DEM
    std::string definition;
};

/// The light on every part of a walk, by the exact horizon of each point that is sampled, in the
/// one direction in which the sun stands: as far apart as the DEM's posts and ten seconds at most,
/// and between two of different light to 0.1 s and 0.1 m. Light that is shorter than both steps may
/// be missed. The sun is refracted by the air over the ground there, between levels 100 m apart.
///
/// Accuracy: for one who stands, the edges of DirectLight to 0.2 s (tests/light/test_walk.cpp).
/// Speed: 34 us a sample, one thread (tests/light/bench_light.cpp, horizon_of_one_direction).
/// @throws Error (BadInput) where a part of the walk is outside of the DEM, with which and how far,
///     for a walk of more than a million samples, a year that is not computed, and as
///     TerrainHorizon
LightAlong light_along(const dem::Posts& posts, const Walk& walk, const WalkOptions& options);

}  // namespace relevo::light
