#pragma once

#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "dem/heightfield.h"
#include "geo/local_frame.h"
#include "render/frame_block.h"
#include "scene/framing.h"
#include "sun/position.h"
#include "sun/refraction.h"

namespace relevo::render {

/// The ground of a DEM: its local frame about the DEM's centre at height 0, its range and its
/// extent.
/// @param whole  the grid of all its posts, where `dem` has means of them; else the same. Frame and
///               extent are of these, whatever they were averaged to.
Ground make_ground(const dem::Heightfield& dem, const dem::Grid& whole);
Ground make_ground(const dem::Heightfield& dem);

/// What a camera has to see to see the DEM, in the local frame [m].
struct GroundToShow {
    /// Its valid posts, thinned out to some thousands, with the highest and the lowest of each
    /// piece and the ends of rows and columns kept: their outline in a picture is that of the posts
    /// within half a percent of the picture (tests/render/test_ground.cpp).
    std::vector<glm::dvec3> points;
    std::vector<glm::dvec3> rim;  ///< of them, ends of rows and columns
    scene::GroundNet net;         ///< a post of each piece that has one
};
GroundToShow ground_to_show(const dem::Heightfield& dem, const Ground& ground, double exaggeration);

/// The points alone.
std::vector<glm::dvec3> points_to_show(const dem::Heightfield& dem, const Ground& ground,
                                       double exaggeration);

/// The lower rim of the block below ground that is seen from outside; none where there is no block.
std::vector<glm::dvec3> block_below(std::span<const glm::dvec3> rim, const Ground& ground,
                                    double exaggeration);

/// Points to show where effects move the ground beyond these at most.
std::vector<glm::dvec3> points_moved_to(std::span<const glm::dvec3> points, const Ground& ground,
                                        double exaggeration, const Displacement& displacement);

/// The light of a sun over the DEM.
/// @param refraction  the air's; also for other elevations than the present one
SunLight make_sun_light(const sun::Position& position, const sun::Refraction& refraction,
                        const Ground& ground, const dem::Grid& grid);

}  // namespace relevo::render
