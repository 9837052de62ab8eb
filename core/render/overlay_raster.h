#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <glm/vec2.hpp>

#include "base/array2d.h"
#include "dem/pyramid.h"
#include "overlay/photo.h"

namespace relevo::render {

/// Colours or values over the ground of a DEM: an overlay, or a raster of an effect. It has a
/// photo, or colours, or values.
struct OverlayRaster {
    /// 0xAABBGGRR: sRGB, premultiplied by alpha. Rows from the north. The outer rows and columns
    /// coincide with the DEM's; their number may differ.
    Array2d<std::uint32_t> rgba{};
    Array2d<float> values{};                        ///< as rgba; NaN: none
    std::shared_ptr<const overlay::Photo> photo{};  ///< drawn in its own resolution
    double opacity = 1;                             ///< of the photo, 0 to 1
    bool lit = false;  ///< the colours are the ground's reflectance; else they are displayed as is
};

/// Where the texels of a raster's finest level lie on the DEM. A photo of more than 262144 pixels
/// along an axis has fewer texels than pixels, each a mean; one of fewer than 64 has more.
struct OverlayTexels {
    glm::dvec2 first_post{0};  ///< of texel (0, 0), which is a point
    glm::dvec2 per_post{1};    ///< texels per post
    glm::ivec2 count{1};
    int levels = 1;  ///< each has half as many as the one before, the first ones of both coincide
};
OverlayTexels overlay_texels(const OverlayRaster& raster, const dem::Pyramid& pyramid);

/// A texel of an OverlayRaster from sRGB and alpha, each 0 to 1.
std::uint32_t overlay_texel(double red, double green, double blue, double alpha);

/// Colours of a photo at the nodes of a page of `texels` with its border, kNormalPage_px a side.
std::vector<std::uint32_t> photo_page(const overlay::Photo& photo, const OverlayTexels& texels,
                                      int level, glm::ivec2 page);

/// Colours at the nodes of a raster's page with its border, kNormalPage_px a side. Each is the mean
/// of the texels nearest to its node. A photo's nodes are those of overlay_texels(), others the
/// DEM's posts.
std::vector<std::uint32_t> overlay_page(const OverlayRaster& raster, const dem::Pyramid& pyramid,
                                        int level, glm::ivec2 page);

/// As overlay_page(), of a raster of values: x the sum of a node's values over the number of its
/// texels, y the part of these that have one. The mean value is x / y.
std::vector<glm::vec2> value_page(const OverlayRaster& raster, const dem::Pyramid& pyramid,
                                  int level, glm::ivec2 page);

}  // namespace relevo::render
