#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "base/array2d.h"
#include "dem/posts.h"
#include "light/raster/sun_plan.h"

namespace relevo::light {

/// The azimuth from true north, at the middle of a grid, of a direction that its map has at
/// `azimuth_rad` from the map's north.
double true_azimuth_rad(const dem::Grid& grid, double azimuth_rad);

struct ShadowOptions {
    /// Terrestrial refraction, as in HorizonOptions.
    double refraction = 0.13;
    /// The air over a place at its height; none: the sun is where it is seen.
    std::function<sun::Refraction(const geo::Geodetic&)> air;
    /// How much of the disc is seen, instead of whether its centre is.
    bool soft = false;
    /// Whose posts are wanted; without columns: all. Ground around it shades all the same, and the
    /// figures are those, to the bit, that they have among all.
    Window part{};
    /// Told now and then which share of the work has been done since it was told last, by one
    /// thread at a time; 0 where the work proper begins. What it throws ends the work.
    std::function<void(double)> done;
};

/// Light and shade of a moment.
struct Shadows {
    /// Of every post of the part: 0 in the shade, 1 lit, and with ShadowOptions::soft the visible
    /// fraction of the sun's disc, in between; NaN in holes.
    Array2d<float> lit;
    std::int64_t lit_posts = 0;     ///< that see any of what is asked for
    std::int64_t shaded_posts = 0;  ///< that see nothing of it
    std::int64_t holes = 0;
    int tiles = 0;           ///< into which the DEM was divided, each with a sun of its own
    std::string definition;  ///< a sentence, to be printed with results
};

/// What the ground of a DEM shades, its own posts alone: each at the height of the ground.
///
/// The sun is one direction in space. Over a round Earth it stands otherwise at every place; where
/// one plane sun would be off by more than 0.05 degrees anywhere, be it for the curvature, the
/// convergence of meridians, terrestrial refraction, or lines of sight that the map shows as bent,
/// the DEM is divided into tiles with a sun each, which the ground outside of a tile shades all the
/// same. Tiles of short shadows ignore how terrestrial refraction bends rays, an error of up to
/// 0.02 degrees. Refraction of the sun is that of the air at a post's own height: where it
/// differs over the DEM, there are two sweeps, for the lowest and the highest post, and the shadow
/// over a post lies between them by its height. Beyond the DEM lies a smooth Earth as high as its
/// edge there, as in TerrainHorizon. Holes neither shade nor are lit.
///
/// The disc is cut by a level line, wherever the ridge before it runs.
///
/// Accuracy: tests/light/test_shadows.cpp, against TerrainHorizon at every post.
/// @throws Error (BadInput) for a refraction that no air has, a grid so coarse or so near to a pole
///     that no tile has one sun
Shadows shadows(const dem::Posts& posts, const SunOverDem& sun, const ShadowOptions& options = {});

/// The same for parts of a DEM one after the other.
/// @param sun  of the plan
Shadows shadows(const SunPlan& plan, const PlannedSun& sun, const ShadowOptions& options);

/// The visible fraction of a disc.
/// @param height  of its diameter that is over a level line, 0 to 1
double share_of_disc(double height);

}  // namespace relevo::light
