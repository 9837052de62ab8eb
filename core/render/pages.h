#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/array2d.h"
#include "render/patch_net.h"

/// The elevation cut into square pages as the device gets it. shaders/lib/pages.glsl is the mirror
/// of the sizes.
namespace relevo::render {

inline constexpr int kPatchQuads = 64;                  ///< quads along a side of a patch
inline constexpr int kHeightPage_px = kPatchQuads + 3;  ///< 65 posts and a border of one
inline constexpr int kNormalPosts = 256;    ///< posts that a normal page covers along a side
inline constexpr int kNormalBorder_px = 8;  ///< a border that lasts for four levels of mipmaps
inline constexpr int kNormalPage_px = kNormalPosts + 2 * kNormalBorder_px;
inline constexpr int kNormalPageLevels = 4;

/// Height [m] and coverage (1 on posts, 0 on holes) of the posts of a patch, kHeightPage_px a side,
/// the first one a border. Holes carry the mean of their neighbours that are none, so that the
/// surface meets the cut half way without a jump.
/// @param first   column and row of the patch's first post
/// @param stride  posts from vertex to vertex; posts beyond the DEM repeat its rim
std::vector<float> height_page(const Array2d<float>& height_m, glm::ivec2 first, int stride);

/// East and north part of the unit normals of the posts of a page and its border, as 16-bit signed
/// fractions, kNormalPage_px a side, all kNormalPageLevels of mipmaps one after the other.
///
/// A normal is the cross product of differences of 3-D positions, the net's curvature included,
/// turned outwards; differences are central, one-sided at the rim and beside holes.
/// @param net     of the page's kNormalPosts x kNormalPosts posts
/// @param axis    unit vector along the Earth's axis in the local frame: it tells where east is
/// @param first   column and row of the page's first post
std::vector<std::int16_t> normal_page(const Array2d<float>& height_m, const PatchNet& net,
                                      const glm::dvec3& axis, glm::ivec2 first);

}  // namespace relevo::render
