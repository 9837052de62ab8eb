#pragma once

#include <memory>

#include "overlay/photo.h"
#include "render/overlay_raster.h"
#include "scene/scene.h"
#include "session/session.h"

namespace relevo::session {

/// A scene's map of land cover over a DEM, as an image: red trees, green low plants, blue ice, each
/// a share of the ground, and alpha where the map tells anything. Null without a map.
///
/// Without a word on its classes they are taken to be those of the one table that has them all,
/// which is said; classes that a named table does not have tell nothing, with a warning.
/// @param grid  of the DEM's posts
/// @throws Error (BadInput) as overlay::Photo::open_classes() and climate::LandCoverTable, if none
/// or
///     several of the program's tables have all of its classes, and for classes without a map
std::shared_ptr<const overlay::Photo> open_land_cover(const scene::LandCover& asked,
                                                      const dem::Grid& grid);

/// @throws Error (BadInput) if a DEM's posts in memory are too far apart to show houses
void check_houses(const LoadedDem& dem);
/// What stands on the ground of a DEM's drawn heights, as lib/houses.glsl reads it: red roofs and
/// walls, green streets, blue trees, alpha a random number for each house on its red.
/// @throws Error (BadInput) as check_houses
std::shared_ptr<const render::OverlayRaster> houses_on(const LoadedDem& dem);

}  // namespace relevo::session
