#pragma once

#include <limits>
#include <span>

#include <glm/vec2.hpp>

#include "dem/posts.h"
#include "light/point/apparent_elevation.h"
#include "light/point/fan.h"

namespace relevo::light {

/// How close to a post, in posts, a place on the grid is that post: coordinates of seven decimals,
/// and the way to the grid's CRS and back, are good to a centimetre.
inline constexpr double kSnap_cells = 1e-3;

/// The highest ground on a line of sight, and the voids on it.
struct HighestCrossing {
    double tangent = -std::numeric_limits<double>::infinity();  ///< of its apparent elevation
    double distance_m = std::numeric_limits<double>::quiet_NaN();
    glm::dvec2 post{std::numeric_limits<double>::quiet_NaN()};
    double height_m = std::numeric_limits<double>::quiet_NaN();
    double reach_m = 0;  ///< how far the line was followed over the DEM
    double first_void_m = std::numeric_limits<double>::infinity();
    double last_void_m = -std::numeric_limits<double>::infinity();
};

/// Follows a line of sight over a grid and finds the highest of its crossings with rows and
/// columns, where heights are linear from post to post. Blocks of posts that cannot stand over what
/// was found so far are skipped. Voids within the DEM are passed over.
/// @param line     from the viewpoint outwards
/// @param until_m  follows it no farther
HighestCrossing highest_crossing(const dem::Posts& posts, const ApparentElevation& elevation,
                                 std::span<const TracePoint> line, double until_m);

}  // namespace relevo::light
