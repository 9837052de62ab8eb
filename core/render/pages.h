#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dem/pyramid.h"
#include "render/patch_net.h"

/// Tile pages of elevation data as uploaded to the device. Sizes are repeated in
/// shaders/lib/pages.glsl.
namespace relevo::render {

inline constexpr int kTileQuads = dem::Pyramid::kTileQuads;  ///< quads along a side of a tile
inline constexpr int kHeightPage_px = kTileQuads + 3;        ///< 65 nodes and a border of one
inline constexpr int kNormalNodes = 256;                 ///< nodes of a normal page along a side
inline constexpr int kNormalPage_px = kNormalNodes + 2;  ///< with a border of one
/// A normal page covers a tile this many levels coarser.
inline constexpr int kNormalPageLevels = 2;
static_assert(kNormalNodes == kTileQuads << kNormalPageLevels);

/// The texels of a page, as PageCache takes them.
template <typename Texel>
std::vector<std::byte> bytes_of(const std::vector<Texel>& texels) {
    const auto bytes = std::as_bytes(std::span(texels));
    return {bytes.begin(), bytes.end()};
}

/// Four floats a node, kHeightPage_px a side with a border of one: height [m] and coverage, then
/// both interpolated on the next coarser level's triangles, towards which vertices morph. Coverage
/// is that of dem::Pyramid, blurred next to voids; ground is clipped at 0.5. Nodes outside the DEM
/// repeat its edge.
std::vector<float> height_page(const dem::Pyramid& pyramid, int level, glm::ivec2 tile);

/// Unit normals of the nodes of a page with its border, kNormalPage_px a side: the east (low half)
/// and north (high half) components as 16-bit signed normalised fractions.
///
/// A normal is the outward cross product of differences of 3-D positions, including the Earth's
/// curvature. Differences are central, or one-sided at the DEM's edge and next to voids.
/// @param net    proxy grid of the page's part of the DEM
/// @param axis   unit vector along the Earth's axis in the local frame
std::vector<std::uint32_t> normal_page(const dem::Pyramid& pyramid, int level, glm::ivec2 page,
                                       const PatchNet& net, const glm::dvec3& axis);

/// Heights of the nodes of a normal page with its border [m], kNormalPage_px a side.
std::vector<float> surface_page(const dem::Pyramid& pyramid, int level, glm::ivec2 page);

/// Extent of a square of posts within the DEM, in posts from first to last.
/// @param first  column and row
/// @param side   posts along the square's sides
glm::ivec2 span_on_dem(const dem::Pyramid& pyramid, glm::ivec2 first, int side);

}  // namespace relevo::render
