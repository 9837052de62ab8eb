#pragma once

#include <algorithm>
#include <cmath>
#include <functional>

#include "light/sky.h"
#include "light/sweep.h"

namespace relevo::light {

/// Posts next to each other, as SweepRun, and by how much the ground there is above the edge of the
/// shadow that each limb of the sun makes [m]: below 0 the limb is hidden. The upper limb's margin
/// is the greater one, and between the two lies the penumbra. Infinite where nothing is in the way,
/// NaN in holes.
struct MarginRun {
    bool along_column;
    int line, first, count;
    const float* upper_m;
    const float* lower_m;
};

/// By how much the ground is above the edges of the shadow over it [m]; NaN in holes.
void find_margins(const SweepRun& run, float* margin_m);

/// What of a DEM is the same for all suns, for margins.
class Margins {
  public:
    /// @param posts    in memory; outlives this
    /// @param options  its `soft` means nothing
    /// @throws Error (BadInput) as shadows()
    Margins(const dem::Posts& posts, const ShadowOptions& options);

    using Use = std::function<void(const MarginRun&)>;
    struct Found {
        bool night = false;  ///< the sun is under the horizon of every post
        /// By how much the sun that is taken for a post may be off; 0 for kSunTolerance or less. It
        /// is more on grids over which one sun holds for few posts: whole planets.
        double error_rad = 0;
    };
    /// Calls `use` once for each post, on several threads; not at all at night.
    /// @param place  where `sun` stands so
    /// @param turn   called first, with whether all runs go along columns
    Found each(const geo::Geodetic& place, const SunOverDem& sun,
               const std::function<void(bool along_columns)>& turn, const Use& use) const;

  private:
    DemSky dem_;
    Sweep sweep_;
};

/// How much of the sun's diameter is over the horizon, where the upper limb is over it and the
/// lower one is not; 0.0001 to 1. Ridges one behind the other make margins bend from limb to limb:
/// of two limbs alone a sun 2 degrees high would seem smaller by an eighth of its disc, by straight
/// lines to its centre by a twelfth. As an edge of shadow is the highest of many lines, margins are
/// nowhere below such a straight line, nor above the other one's continuation: they are 0 between
/// where these are.
/// @param upper_m, middle_m, lower_m  margins of the disc's limbs and of its centre
inline float height_of_disc(float upper_m, float middle_m, float lower_m) {
    // How far on from the line's to the other's: what makes the mean share right at 2 and 5 degrees
    // on three DEMs (docs/accuracy-shadows.md).
    constexpr float kAhead = 0.35F;
    // From the centre to where the horizon is, in radii.
    const float up = std::max(upper_m - middle_m, 1e-6F);
    const float down = std::max(middle_m - lower_m, 1e-6F);
    const float line = -middle_m / (middle_m > 0 ? down : up);
    const float other = std::max(-middle_m / (middle_m > 0 ? up : down), -1.0F);
    const float at = line + kAhead * (std::min(other, line) - line);
    return std::min(std::max(0.5F - 0.5F * at, 1e-4F), 1.0F);
}

/// How much of a disc is over a level line; within 0.002 of share_of_disc(), for many at once.
/// @param height  of its diameter, 0 to 1
inline float quick_share_of_disc(float height) {
    const float x = height < 0.5F ? height : 1 - height;
    const float part = x * std::sqrt(x) * (1.6977F - 0.567F * x);
    return height < 0.5F ? part : 1 - part;
}

}  // namespace relevo::light
