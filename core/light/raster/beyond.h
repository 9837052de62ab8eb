#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dem/posts.h"
#include "light/raster/shadows.h"
#include "sun/time.h"

namespace relevo::light {

/// What terrain beyond a DEM could do to a raster of light if none is higher than a bound.
struct BeyondBound {
    double highest_m = 0;  ///< the bound
    double share = 0;      ///< of the posts at which such terrain could change a figure
    double least_m = 0;    ///< the height from which on it could, at the edge of the DEM
    double needed_m = 0;   ///< how far beyond the edge it could stand and matter
};

/// The same as far as some of the DEM's posts show it: for the bound given, else for the DEM's
/// highest post.
struct Beyond : BeyondBound {
    std::optional<BeyondBound> earths{};  ///< for the Earth's highest terrain, if no bound is given

    /// A sentence without its full stop.
    /// @param would  what such terrain would do: kHides or kStandsOver
    std::string text(const std::string& would) const;
    /// The warning: how many values such terrain could change, and what to do.
    std::string advice() const;
};
inline constexpr const char *kHides = "hide the sun", *kStandsOver = "raise horizons";

/// Terrain that would hide a sun which the DEM's own ground leaves to shine.
///
/// Some hundreds of posts, evenly over the part, look towards every sun over the posts nearest to
/// their ray, to where the DEM ends or has only holes left; beyond 32 posts over those that
/// dem::Posts::thinned_m() has.
/// @param part       as ShadowOptions::part
/// @param highest_m  of the terrain beyond; none: the DEM's highest post, the Earth's at most
/// @return none where no terrain of that height could matter
std::optional<Beyond> terrain_beyond(const dem::Posts& posts, const Window& part,
                                     const std::vector<SunOverDem>& suns,
                                     const ShadowOptions& options,
                                     const std::optional<double>& highest_m = {});

/// Likewise terrain that would stand over the horizon in a direction.
/// @param azimuth_rad  from true north
std::optional<Beyond> terrain_beyond(const dem::Posts& posts, const Window& part,
                                     const std::vector<double>& azimuth_rad, double refraction,
                                     const std::optional<double>& highest_m = {});

/// Suns that stand for a time: twenty minutes apart on its first day and its last one, and on a day
/// of each month between.
std::vector<SunOverDem> suns_of(const dem::Grid& grid, sun::Instant begin, sun::Instant end);

}  // namespace relevo::light
