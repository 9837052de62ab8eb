#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

#include "base/array2d.h"
#include "dem/pyramid.h"

namespace relevo::render {

/// Unlit colours over the ground of a DEM.
struct OverlayRaster {
    /// 0xAABBGGRR: sRGB, premultiplied by alpha. Rows from the north. The outer rows and columns
    /// coincide with the DEM's; their number may differ.
    Array2d<std::uint32_t> rgba;
};

/// A texel of an OverlayRaster from sRGB and alpha, each 0 to 1.
std::uint32_t overlay_texel(double red, double green, double blue, double alpha);

/// Colours at the nodes of a normal tile page with its border, kNormalPage_px a side. Each is the
/// mean of the texels nearest to its node.
std::vector<std::uint32_t> overlay_page(const OverlayRaster& raster, const dem::Pyramid& pyramid,
                                        int level, glm::ivec2 page);

}  // namespace relevo::render
