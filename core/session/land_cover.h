#pragma once

#include <memory>

#include "overlay/photo.h"
#include "scene/scene.h"

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

}  // namespace relevo::session
