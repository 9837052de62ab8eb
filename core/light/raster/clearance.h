#pragma once

#include <functional>
#include <vector>

#include "light/raster/shadow_heights.h"
#include "light/raster/shadows.h"
#include "light/raster/sun_plan.h"

namespace relevo::light {

/// By how much the ground is above the shadows that the limbs of the sun and its centre make [m]:
/// below 0 a limb is hidden. The upper limb's is the greatest one.
struct DiscClearance {
    float upper_m, middle_m, lower_m;
};

/// Posts next to each other in a row, and their clearances: between the limbs lies the penumbra.
/// NaN in holes.
struct ClearanceRun {
    int row, column, count;
    const float* upper_m;
    const float* lower_m;
};

/// What of a DEM is the same for all suns, for clearances.
class Clearances {
  public:
    /// @param posts    outlives this
    /// @param options  its `soft`, `part` and `done` mean nothing
    /// @throws Error (BadInput) as shadows()
    Clearances(const dem::Posts& posts, const ShadowOptions& options);

    using Use = std::function<void(const ClearanceRun&)>;
    struct Found {
        bool night = false;  ///< the sun is under the horizon of every post
        /// By how much the sun that is taken for a post may be off; 0 for kSunTolerance or less. It
        /// is more on grids over which one sun holds for few posts: whole planets.
        double error_rad = 0;
    };
    /// Calls `use` once for each post, on several threads; not at all at night. The lower limbs'
    /// clearances are such that the line between them and the upper limb's passes 0 where the
    /// horizon cuts the disc.
    /// @param place  where `sun` stands so
    Found each(const geo::Geodetic& place, const SunOverDem& sun, const Use& use) const;

    /// Shadows that a device finds: of one part of the disc, in one air, over some tiles.
    struct DeviceSweep {
        enum Part { kUpper, kMiddle, kLower } part;
        /// This sweep is in the air of the highest post. An earlier sweep over the same tiles was
        /// in the air of the lowest one, and mix_by_height() mixes the shadows of both.
        bool mixes = false;
        std::vector<TileSweep> tiles{};
    };
    using UseSweep = std::function<void(const DeviceSweep&)>;
    /// Calls `use` with the sweeps that find the shadows of all posts but those at which it is
    /// night: of the upper limb alone for a sun without a disc. Not at all at night.
    Found each_sweep(const geo::Geodetic& place, const SunOverDem& sun, const UseSweep& use) const;
    const SunTerrain& terrain() const { return terrain_; }

  private:
    SunTerrain terrain_;
};

/// How much of the sun's diameter is over the horizon, where the upper limb is over it and the
/// lower one is not; 0.0001 to 1. Ridges one behind the other make clearances bend from limb to
/// limb: of two limbs alone a sun 2 degrees high would seem smaller by an eighth of its disc, by
/// straight lines to its centre by a twelfth. As a shadow is the highest of many lines, clearances
/// are nowhere below such a straight line, nor above the other one's continuation: they are 0
/// between where these are.
inline float height_of_disc(const DiscClearance& clearance) {
    // How far on from the line's to the other's: what makes the mean share right at 2 and 5 degrees
    // on three DEMs (docs/accuracy-shadows.md).
    constexpr float kAhead = 0.35F;
    const auto [upper_m, middle_m, lower_m] = clearance;
    // From the centre to where the horizon is, in radii.
    const float up = std::max(upper_m - middle_m, 1e-6F);
    const float down = std::max(middle_m - lower_m, 1e-6F);
    const float line = -middle_m / (middle_m > 0 ? down : up);
    const float other = std::max(-middle_m / (middle_m > 0 ? up : down), -1.0F);
    const float at = line + kAhead * (std::min(other, line) - line);
    return std::min(std::max(0.5F - 0.5F * at, 1e-4F), 1.0F);
}

/// The visible fraction of a disc; within 0.002 of share_of_disc(), for many at once.
/// @param height  of its diameter, 0 to 1
inline float quick_share_of_disc(float height) {
    const float x = height < 0.5F ? height : 1 - height;
    const float part = x * std::sqrt(x) * (1.6977F - 0.567F * x);
    return height < 0.5F ? part : 1 - part;
}

}  // namespace relevo::light
