#include "render/overlay_raster.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>

#include "render/pages.h"

namespace relevo::render {
namespace {

/// Along an axis: a page table of 1024 entries.
constexpr double kMaxTexels = 1024 * kNormalNodes;
/// Over a texel the edge of an image fades, so that few texels would not show it.
constexpr double kLeastTexels = 64;

/// Texels along an axis that are nearest to a node, [first, end).
struct Span {
    int first, end;
};

/// @param post, level  of the node
/// @param posts        of the DEM along the axis
Span span_of(int post, int level, int posts, int texels) {
    const double scale = posts > 1 ? (texels - 1.0) / (posts - 1.0) : 0;
    const double middle = post * scale, half = scale * (1 << level) / 2;
    const int nearest = std::clamp(static_cast<int>(std::lround(middle)), 0, texels - 1);
    const int first = std::clamp(static_cast<int>(std::ceil(middle - half)), 0, nearest);
    const int end = std::clamp(static_cast<int>(std::ceil(middle + half)), nearest + 1, texels);
    return {first, end};
}

std::uint32_t mean_of(const Array2d<std::uint32_t>& rgba, const Span& columns, const Span& rows) {
    if (columns.end - columns.first == 1 && rows.end - rows.first == 1)
        return rgba.at(columns.first, rows.first);
    std::array<std::uint64_t, 4> sums{};
    for (int row = rows.first; row < rows.end; ++row)
        for (int column = columns.first; column < columns.end; ++column)
            for (unsigned k = 0; k < 4; ++k)
                sums[k] += rgba.at(column, row) >> 8 * k & 255;
    const auto count = static_cast<std::uint64_t>(columns.end - columns.first) *
                       static_cast<std::uint64_t>(rows.end - rows.first);
    std::uint32_t texel = 0;
    for (unsigned k = 0; k < 4; ++k)
        texel |= static_cast<std::uint32_t>((sums[k] + count / 2) / count) << 8 * k;
    return texel;
}

glm::vec2 mean_of(const Array2d<float>& values, const Span& columns, const Span& rows) {
    double sum = 0;
    int known = 0;
    for (int row = rows.first; row < rows.end; ++row)
        for (int column = columns.first; column < columns.end; ++column)
            if (const float value = values.at(column, row); std::isfinite(value)) {
                sum += double{value};
                ++known;
            }
    const int count = (columns.end - columns.first) * (rows.end - rows.first);
    return glm::vec2(glm::dvec2(sum, known) / double(count));
}

/// The means of a page's nodes, which are the DEM's posts.
template <typename Texel>
auto page_of(const Array2d<Texel>& texels, const dem::Pyramid& pyramid, int level,
             glm::ivec2 page) {
    const glm::ivec2 first = page * kNormalNodes - 1, last = pyramid.size(level) - 1;
    std::vector<Span> columns, rows;
    for (int i = 0; i < kNormalPage_px; ++i) {
        const glm::ivec2 post = pyramid.post(level, glm::clamp(first + i, glm::ivec2(0), last));
        columns.push_back(span_of(post.x, level, pyramid.columns(), texels.width()));
        rows.push_back(span_of(post.y, level, pyramid.rows(), texels.height()));
    }
    std::vector<decltype(mean_of(texels, columns[0], rows[0]))> means;
    means.reserve(std::size_t{kNormalPage_px} * kNormalPage_px);
    for (const Span& row : rows)
        for (const Span& column : columns)
            means.push_back(mean_of(texels, column, row));
    return means;
}

std::uint32_t times_opacity(std::uint32_t texel, double opacity) {
    std::uint32_t result = 0;
    for (unsigned k = 0; k < 4; ++k)
        result |= static_cast<std::uint32_t>(std::lround(opacity * (texel >> 8 * k & 255)))
                  << 8 * k;
    return result;
}

}  // namespace

std::uint32_t overlay_texel(double red, double green, double blue, double alpha) {
    const auto byte = [](double value) {
        return static_cast<std::uint32_t>(std::lround(255 * std::clamp(value, 0.0, 1.0)));
    };
    return byte(red * alpha) | byte(green * alpha) << 8 | byte(blue * alpha) << 16 |
           byte(alpha) << 24;
}

OverlayTexels overlay_texels(const OverlayRaster& raster, const dem::Pyramid& pyramid) {
    OverlayTexels texels;
    texels.count = pyramid.size(0);
    if (raster.photo) {
        texels.first_post = raster.photo->first_post();
        const glm::dvec2 side = raster.photo->last_post() - texels.first_post;
        texels.per_post =
            glm::clamp(raster.photo->pixels_per_post(), kLeastTexels / side, kMaxTexels / side);
        texels.count = glm::ivec2(glm::ceil(side * texels.per_post)) + 1;
    }
    const int side = std::max(texels.count.x, texels.count.y) - 1;
    while (kNormalNodes << (texels.levels - 1) < side)
        ++texels.levels;
    return texels;
}

std::vector<std::uint32_t> photo_page(const overlay::Photo& photo, const OverlayTexels& texels,
                                      int level, glm::ivec2 page) {
    const glm::dvec2 step = double(1 << level) / texels.per_post;
    const Array2d<std::uint32_t> rgba =
        photo.read({.first_post = texels.first_post + glm::dvec2(page * kNormalNodes - 1) * step,
                    .step = step,
                    .count = glm::ivec2(kNormalPage_px)});
    return {rgba.begin(), rgba.end()};
}

std::vector<std::uint32_t> overlay_page(const OverlayRaster& raster, const dem::Pyramid& pyramid,
                                        int level, glm::ivec2 page) {
    if (!raster.photo) return page_of(raster.rgba, pyramid, level, page);
    std::vector<std::uint32_t> texels =
        photo_page(*raster.photo, overlay_texels(raster, pyramid), level, page);
    if (raster.opacity < 1)
        for (std::uint32_t& texel : texels)
            texel = times_opacity(texel, raster.opacity);
    return texels;
}

std::vector<glm::vec2> value_page(const OverlayRaster& raster, const dem::Pyramid& pyramid,
                                  int level, glm::ivec2 page) {
    return page_of(raster.values, pyramid, level, page);
}

}  // namespace relevo::render
