#pragma once

#include <cstdint>
#include <vector>

#include "dem/pyramid.h"
#include "render/patch_net.h"

/// The elevation cut into square pages as the device gets it. shaders/lib/pages.glsl is the mirror
/// of the sizes.
namespace relevo::render {

inline constexpr int kTileQuads = dem::Pyramid::kTileQuads;  ///< quads along a side of a tile
inline constexpr int kHeightPage_px = kTileQuads + 3;        ///< 65 nodes and a border of one
inline constexpr int kNormalNodes = 256;  ///< nodes that a normal page covers along a side
inline constexpr int kNormalPage_px = kNormalNodes + 2;  ///< they and a border of one
/// A normal page covers what a tile covers that is this many levels coarser.
inline constexpr int kNormalPageLevels = 2;
static_assert(kNormalNodes == kTileQuads << kNormalPageLevels);

/// Four floats a node, kHeightPage_px a side, the first one a border: height [m] and coverage (of
/// dem::Pyramid, blurred where some is a hole; holes are cut out at one half), and both of the next
/// coarser level's triangles at the same place, towards which the vertex program morphs. Nodes
/// beyond the DEM repeat its rim.
std::vector<float> height_page(const dem::Pyramid& pyramid, int level, glm::ivec2 tile);

/// East (in the lower half of each) and north part of the unit normals of the nodes of a page and
/// its border, as 16-bit signed fractions, kNormalPage_px a side.
///
/// A normal is the cross product of differences of 3-D positions, the net's curvature included,
/// turned outwards; differences are central, one-sided at the rim and beside holes.
/// @param net    of the page's part of the DEM, as normal_page_net() says
/// @param axis   unit vector along the Earth's axis in the local frame: it tells where east is
std::vector<std::uint32_t> normal_page(const dem::Pyramid& pyramid, int level, glm::ivec2 page,
                                       const PatchNet& net, const glm::dvec3& axis);

/// Heights of the nodes of a normal page and its border [m], kNormalPage_px a side.
std::vector<float> surface_page(const dem::Pyramid& pyramid, int level, glm::ivec2 page);

/// The posts between the first and the last of a square of posts that lie on the DEM.
/// @param first  column and row
/// @param side   posts along the whole square
glm::ivec2 span_on_dem(const dem::Pyramid& pyramid, glm::ivec2 first, int side);

}  // namespace relevo::render
