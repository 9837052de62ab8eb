#pragma once

#include <string>

#include <glm/vec2.hpp>

#include "dem/posts.h"
#include "geo/geodetic.h"

namespace relevo::light {

/// "47.1,11.2", as messages name a place.
std::string place_text(const geo::Geodetic& place);

/// Whether a place on the grid lies on or between its posts, to kSnap_cells; NaN does not.
bool is_within(const dem::Grid& grid, const glm::dvec2& post);

/// Ground of a DEM.
struct Ground {
    glm::dvec2 post{0};  ///< column and row; whole ones within kSnap_cells of a post
    double height_m = 0;
};

/// @throws Error (BadInput) `horizon: LAT,LON: what` where the place is outside of the DEM or in a
///     void of it
Ground ground_at(const dem::Posts& posts, const geo::Geodetic& place);

/// The highest post within a radius of a place, with its height: the summit that was meant. The
/// place itself, with its interpolated height, where no post is near enough or the radius is 0. Off
/// the DEM that of its surroundings.
/// @throws Error (BadInput) as ground_at()
geo::Geodetic summit_near(const dem::Posts& posts, const geo::Geodetic& place, double radius_m);

}  // namespace relevo::light
