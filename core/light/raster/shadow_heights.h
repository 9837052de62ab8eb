#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "light/raster/ground_beyond.h"
#include "light/raster/sun_plan.h"
#include "light/sweep/shadow_tables.h"

namespace relevo::light {

constexpr int kLongestRun = 512;

/// Calls `use` with the posts of a window and the height of the shadow over each: that which the
/// DEM's ground casts through the air as each post's height has it, and that of the Earth around.
///
/// The smooth Earth beyond the DEM, as high as its edge, hides suns that are lower than level. For
/// suns that are a little higher its shadow is given as far below the ground as it was above it
/// before, so that a clearance passes 0 just as the sun rises.
/// @param tiles       of the sun
/// @param offset_rad  of the part of the disc over its centre
/// @param use         as Sweep::Use
void each_shadow(const SunField& sun, std::span<const SunTile> tiles, const Window& window,
                 double offset_rad, const Sweep::Use& use);

/// What a device needs to sweep a tile, besides heights.
struct TileSweep {
    /// The shadow of the Earth around the DEM, as raise_to_earth() finds it.
    struct Earth {
        std::vector<float> edge_height_m, edge_distance_m;  ///< of lines
        std::vector<GroundBeyond::SweepRow> rows;           ///< of the sheet, from the tables' on
        std::vector<float> base;  ///< SunOverRow::base, of rows of the grid from `first_row` on
        int first_row = 0, reference_column = 0;
        float a_post = 0, curvature = 0, lowest_m = 0;
    };
    ShadowTables tables;
    std::optional<Earth> earth;  ///< where it may be higher than the floor
};

/// The same for a device: of each tile that sees the sun. Posts of others are in the shade.
/// @param air  one that the sun has: SunField::first_air() or, of two, kOfHighest
TileSweep tile_sweep(const SunField& sun, const SunTile& tile, const Window& window,
                     double offset_rad, SunTerrain::Air air);

/// The same of a planned sun: where a wider DEM lies around, its ground and its Earth shade, too.
void each_shadow(const PlannedSun& sun, const Window& window, double offset_rad,
                 const Sweep::Use& use);

/// Calls `use` with the posts of a window and the tangent of the elevation of the horizon, from the
/// ground at each post. Where nothing of the DEM is higher, it is that of the ground beyond the
/// DEM.
/// @param direction  its tiles are of a level sun
/// @param use  called with runs of kLongestRun posts at most
void each_horizon(const SunField& direction, std::span<const SunTile> tiles, const Window& window,
                  const std::function<void(const SunTile&, const SweepRun&)>& use);

/// The same of a planned direction: where a wider DEM lies around, its ground stands over horizons,
/// too.
void each_horizon(const PlannedSun& direction, const Window& window,
                  const std::function<void(const SunTile&, const SweepRun&)>& use);

}  // namespace relevo::light
