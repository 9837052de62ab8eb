#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/array2d.h"
#include "dem/heightfield.h"

namespace relevo::dem {

enum class WaterKind : std::uint8_t {
    None,
    Sea,       ///< the heights are its surface, or as good as that
    SeaFloor,  ///< the heights are of its floor; the surface is at 0 m
    Lake,      ///< the heights are its surface
};

/// Where water stands in a DEM that says so by its heights alone.
struct Water {
    Array2d<WaterKind> kind;  ///< of the posts; empty where there is none
    std::int64_t sea_posts = 0, lake_posts = 0;
    int lakes = 0;
    double lowest_sea_m = 0;
    bool has_sea_floor = false;  ///< some of it is WaterKind::SeaFloor
    /// Whole sentences: what the heights leave open.
    std::vector<std::string> assumptions;

    bool any() const { return !kind.empty(); }
    /// Fraction of all posts that are WaterKind::SeaFloor.
    double sea_floor_share() const;
    /// Fraction of the posts along the DEM's edge that are sea.
    double sea_rim_share() const;
};

/// Tells water from land by the heights of a DEM and by its place.
///
/// Sea are connected posts at or below 0 m that reach the edge of the DEM or a hole in it, at
/// least 64 and one in 2000 of all; others where they are exactly 0 on a square kilometre or more,
/// or lower than any land (-450 m). Land below 0 that is known is dry: DryLand; zeros around a
/// raster that was turned are no sea: find_collar(). Lakes are connected posts of one height,
/// within a millimetre, at least 64 on 0.01 km2, with higher ground on 95 % of their rim. Heights
/// in steps, such as whole metres, make terraces of plains that rise by one step: there the rim
/// must rise by two and more on a quarter of it, or the flat be large and compact (water.cpp has
/// the limits). A large one may have a lower rim, from resampling, if the land behind it is higher.
/// @param heights_m  NaN for holes
/// @param grid       of as many posts
/// Takes about 10 ms a million posts (tests/dem/bench_dem.cpp).
Water find_water(const Array2d<float>& heights_m, const Grid& grid);

}  // namespace relevo::dem
