#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

#include "base/array2d.h"
#include "dem/pyramid.h"

namespace relevo::render {

/// Colours that lie on the ground of a DEM, whatever light falls on it.
struct Drape {
    /// 0xAABBGGRR: sRGB, premultiplied by alpha. Its first and its last columns and rows lie on the
    /// DEM's; it may have more or fewer of them.
    Array2d<std::uint32_t> rgba;
};

/// sRGB and alpha, 0 to 1, as a texel of a Drape.
std::uint32_t drape_texel(double red, double green, double blue, double alpha);

/// Colours at the nodes of a normal page and its border, kNormalPage_px a side: means over what is
/// nearest to each node.
std::vector<std::uint32_t> drape_page(const Drape& drape, const dem::Pyramid& pyramid, int level,
                                      glm::ivec2 page);

}  // namespace relevo::render
