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

/// The ground of a DEM, in a local frame at the DEM's centre at height 0.
/// @param whole  grid of all posts, if `dem` has means of them; else its own. Determines frame and
///     extent
Ground make_ground(const dem::Heightfield& dem, const dem::Grid& whole);
Ground make_ground(const dem::Heightfield& dem);

/// Points for framing a DEM, in the local frame [m].
struct GroundToShow {
    /// Some thousands of valid posts: the highest and the lowest of each piece, and the ends of
    /// rows and columns. Their outline in a frame is within 0.5 % of that of all posts
    /// (tests/render/test_ground.cpp).
    std::vector<glm::dvec3> points;
    std::vector<glm::dvec3> rim;  ///< the ends of rows and columns among them
    scene::AerialGround aerial;   ///< what aerial views frame
    /// One post of each piece and what aerial views frame, at their true heights: sides are chosen
    /// by these.
    scene::GroundNet net;
    scene::AerialGround true_aerial;
};
GroundToShow ground_to_show(const dem::Heightfield& dem, const Ground& ground, double exaggeration);

/// ground_to_show().points
std::vector<glm::dvec3> points_to_show(const dem::Heightfield& dem, const Ground& ground,
                                       double exaggeration);

/// Lower rim of the block below the ground; empty without a block.
std::vector<glm::dvec3> block_below(std::span<const glm::dvec3> rim, const Ground& ground,
                                    double exaggeration);

/// Extreme positions of points under a displacement; empty without displacement.
std::vector<glm::dvec3> points_moved_to(std::span<const glm::dvec3> points, const Ground& ground,
                                        double exaggeration, const Displacement& displacement);

/// The sun, or the moon, over a DEM.
/// @param refraction  at the DEM's centre, as a function of elevation
SunLight make_sun_light(const sun::SkyPosition& position, const sun::Refraction& refraction,
                        const Ground& ground, const dem::Grid& grid);

}  // namespace relevo::render
