#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/array2d.h"
#include "dem/posts.h"
#include "light/plane/transposition.h"
#include "light/raster/sun_plan.h"

namespace relevo::light {

/// The horizon of all posts of a DEM in some directions.
struct Horizons {
    std::vector<double> azimuth_rad;            ///< clockwise from true north at each post
    std::vector<Array2d<float>> elevation_rad;  ///< for each of these, of every post; NaN in holes
    std::int64_t holes = 0;
    std::string definition;  ///< a sentence, to be printed with results
};

/// Eyes are on the ground. What lies farther off than the nearest eight rows is met within half a
/// post of the direction. Beyond the DEM lies a smooth Earth as high as its edge there, as in
/// TerrainHorizon. Accuracy: tests/light/test_horizons.cpp.
/// @param azimuth_rad  directions, from true north at each post
/// @param refraction   terrestrial, as in HorizonOptions
/// @throws Error (BadInput) as shadows()
/// @param part  as in ShadowOptions
Horizons horizons(const dem::Posts& posts, std::vector<double> azimuth_rad,
                  double refraction = 0.13, const Window& part = {});

/// The same for parts of a DEM one after the other, and for one direction.
/// @param plan  with add_horizon_directions()
/// @param part  as in ShadowOptions
Array2d<float> horizon_elevations(const SunPlan& plan, const PlannedSun& direction,
                                  const Window& part);
void add_horizon_directions(SunPlan& plan, const std::vector<double>& azimuth_rad);
std::string horizons_definition(const dem::Posts& posts, double refraction);

struct SkyViewOptions {
    int directions = 36;
    double refraction = 0.13;
    /// Of a level plane at each post instead of the ground as it is inclined.
    bool level = false;
    std::optional<Plane> plane{};  ///< likewise, a plane in this position
    /// As a share of what an endless plane as inclined as the ground sees: 1 where nothing rises
    /// over the ground's own slope. Not with `level`.
    bool of_open_slope = false;
    Window part{};                     ///< as in ShadowOptions
    std::function<void(double)> done;  ///< likewise
};

/// How much of the sky each post of a DEM sees.
struct SkyView {
    /// The share of a uniform sky's light that falls on the ground, 0 to 1: the sky-view factor.
    /// NaN in holes.
    Array2d<float> share;
    double mean = 0;
    std::int64_t holes = 0;
    std::string definition;
};

/// @throws Error (BadInput) as shadows(), and for fewer than 4 directions or more than 3600
/// Source: Dozier and Frew, IEEE Trans. Geosci. Remote Sensing 28 (1990) 963, equation 7b; slopes
/// of the ground after Horn, Proc. IEEE 69 (1981) 14.
/// Accuracy: tests/light/test_horizons.cpp, against topocalc.
SkyView sky_view(const dem::Posts& posts, const SkyViewOptions& options = {});

/// The same for parts of a DEM one after the other.
/// @param plan  with add_sky_view_directions()
SkyView sky_view(const SunPlan& plan, const SkyViewOptions& options);
/// @throws Error (BadInput) as sky_view()
void add_sky_view_directions(SunPlan& plan, int directions);

}  // namespace relevo::light
