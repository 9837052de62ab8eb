#pragma once

#include <functional>
#include <span>

#include "light/raster/sun_plan.h"

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

}  // namespace relevo::light
