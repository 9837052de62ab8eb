#pragma once

#include <glm/vec2.hpp>

#include "base/array2d.h"
#include "scene/scene.h"

/// How many times too high a picture from the air draws a DEM whose relief would not be seen at its
/// true scale.
namespace relevo::scene {

/// Whether a picture may choose its vertical scale: a view from the air at the default time,
/// without an overlay and with the effects and values that a scene begins with. In other pictures
/// people look at the sun's shadows, which follow the drawn ground, or compare heights.
bool may_exaggerate(const Scene& scene);

/// The vertical scale of a DEM: 1 to 4, to a fifth; 20 at most where no ground is above the sea, or
/// relief is a few metres. 1 where relief is steep already (above 12 % of the width) or posts are
/// closer than 5 m, as of buildings.
/// @param height_m  of posts; NaN: none
/// @param sides_m   the DEM's extent east and north
double chosen_exaggeration(const Array2d<float>& height_m, const glm::dvec2& sides_m);

}  // namespace relevo::scene
