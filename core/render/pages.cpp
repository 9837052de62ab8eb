#include "render/pages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace relevo::render {
namespace {

/// Rise a post between neighbours, from both sides where both are there, else from the one that is.
float slope_of(float before, float here, float after, int posts_before, int posts_after) {
    const bool has_before = !std::isnan(before), has_after = !std::isnan(after);
    if (has_before && has_after)
        return (after - before) / static_cast<float>(posts_before + posts_after);
    if (has_after) return (after - here) / static_cast<float>(posts_after);
    if (has_before) return (here - before) / static_cast<float>(posts_before);
    return 0.0f;
}

std::int16_t snorm16(float value) {
    return static_cast<std::int16_t>(std::lrint(std::clamp(value, -1.0f, 1.0f) * 32767.0f));
}

/// A block of a level with its coverage blurred, so that the cut beside holes, at one half, is
/// smooth where posts would make steps. Nodes stay on the side of the cut that they are on.
dem::Pyramid::Block smoothly_cut(const dem::Pyramid& pyramid, int level, glm::ivec2 first,
                                 int columns, int rows) {
    if (!pyramid.has_holes()) return pyramid.block(level, first, columns, rows);
    constexpr float kLeastAside = 0.05f;
    const auto wide = pyramid.block(level, first - 1, columns + 2, rows + 2);
    dem::Pyramid::Block block{Array2d<float>(columns, rows), Array2d<float>(columns, rows)};
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
            float sum = 0;
            for (int dy = 0; dy <= 2; ++dy)
                for (int dx = 0; dx <= 2; ++dx)
                    sum += static_cast<float>((1 + dx % 2) * (1 + dy % 2)) *
                           wide.coverage.at(x + dx, y + dy);
            const float blurred = sum / 16, own = wide.coverage.at(x + 1, y + 1);
            block.coverage.at(x, y) = own >= 0.5f ? std::max(blurred, 0.5f + kLeastAside)
                                                  : std::min(blurred, 0.5f - kLeastAside);
            block.height_m.at(x, y) = wide.height_m.at(x + 1, y + 1);
        }
    }
    return block;
}

}  // namespace

glm::ivec2 span_on_dem(const dem::Pyramid& pyramid, glm::ivec2 first, int side) {
    const glm::ivec2 last(pyramid.columns() - 1, pyramid.rows() - 1);
    return glm::max(glm::min(glm::ivec2(side), last - first), glm::ivec2(1));
}

std::vector<float> height_page(const dem::Pyramid& pyramid, int level, glm::ivec2 tile) {
    const glm::ivec2 first = tile * kTileQuads - 1;
    const auto fine = smoothly_cut(pyramid, level, first, kHeightPage_px, kHeightPage_px);
    const bool top = level + 1 == pyramid.levels();
    std::vector<float> page;
    page.reserve(std::size_t{4} * kHeightPage_px * kHeightPage_px);
    if (top) {
        for (int y = 0; y < kHeightPage_px; ++y)
            for (int x = 0; x < kHeightPage_px; ++x)
                for (int twice = 0; twice < 2; ++twice)
                    page.insert(page.end(), {fine.height_m.at(x, y), fine.coverage.at(x, y)});
        return page;
    }
    const glm::ivec2 last = pyramid.size(level) - 1;
    const auto on_level = [&](int i, int n) { return std::clamp(i, 0, n); };
    // The part of the coarser level that the page lies on.
    const int left = pyramid.column_in_coarser(level, on_level(first.x, last.x)).from;
    const int above = pyramid.row_in_coarser(level, on_level(first.y, last.y)).from;
    constexpr int kCoarse = kHeightPage_px / 2 + 3;
    const auto coarse = smoothly_cut(pyramid, level + 1, {left, above}, kCoarse, kCoarse);
    for (int y = 0; y < kHeightPage_px; ++y) {
        const auto row = pyramid.row_in_coarser(level, on_level(first.y + y, last.y));
        for (int x = 0; x < kHeightPage_px; ++x) {
            const auto column = pyramid.column_in_coarser(level, on_level(first.x + x, last.x));
            const auto parent = [&](const Array2d<float>& values) {
                const int c = column.from - left, r = row.from - above;
                return dem::on_triangles(values.at(c, r), values.at(c + 1, r), values.at(c, r + 1),
                                         values.at(c + 1, r + 1), column.share, row.share);
            };
            page.insert(page.end(), {fine.height_m.at(x, y), fine.coverage.at(x, y),
                                     parent(coarse.height_m), parent(coarse.coverage)});
        }
    }
    return page;
}

std::vector<float> surface_page(const dem::Pyramid& pyramid, int level, glm::ivec2 page) {
    const auto block =
        pyramid.block(level, page * kNormalNodes - 1, kNormalPage_px, kNormalPage_px);
    std::vector<float> texels;
    texels.reserve(std::size_t{kNormalPage_px} * kNormalPage_px);
    for (int y = 0; y < kNormalPage_px; ++y)
        for (int x = 0; x < kNormalPage_px; ++x)
            texels.push_back(block.height_m.at(x, y));
    return texels;
}

// In one piece: two loops, the inner of which reads what the outer knows of its row.
std::vector<std::int16_t> normal_page(const dem::Pyramid& pyramid, int level, glm::ivec2 page,
                                      const PatchNet& net, const glm::dvec3& axis) {
    // Everything from here on is relative to the page's middle: floats hold it to micrometres.
    using vec3 = glm::vec3;
    const glm::ivec2 first_node = page * kNormalNodes;
    const glm::ivec2 first = first_node << level;
    const glm::vec2 step = 1.0f / glm::vec2(span_on_dem(pyramid, first, kNormalNodes << level));
    const glm::ivec2 last = pyramid.size(level) - 1;
    std::array<vec3, 9> p;
    for (std::size_t i = 0; i < 9; ++i)
        p[i] = vec3(net.position_m[i]);
    const vec3 n0 = vec3(net.vertical[0]), nu = vec3(net.vertical[1]), nv = vec3(net.vertical[2]);
    const vec3 pole = vec3(axis);
    const vec3 east_middle = normalize(cross(pole, n0));

    // One more node on each side than the page has.
    const auto block = pyramid.block(level, first_node - 2, kNormalPage_px + 2, kNormalPage_px + 2);
    const auto height = [&](int column, int row) {
        const glm::ivec2 at = glm::ivec2(column, row) - first_node + 2;
        return block.coverage.at(at.x, at.y) > 0 ? block.height_m.at(at.x, at.y)
                                                 : std::numeric_limits<float>::quiet_NaN();
    };
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

    struct Column {
        int at, to_west, to_east;
        float u;
    };
    std::array<Column, kNormalPage_px> columns;
    for (int x = 0; x < kNormalPage_px; ++x) {
        const int at = std::clamp(first_node.x + x - 1, 0, last.x);
        const auto post = [&](int column) { return pyramid.post(level, {column, 0}).x; };
        columns[static_cast<std::size_t>(x)] = {at, post(at) - post(std::max(at - 1, 0)),
                                                post(std::min(at + 1, last.x)) - post(at),
                                                static_cast<float>(post(at) - first.x) * step.x};
    }

    std::vector<std::int16_t> texels;
    texels.reserve(std::size_t{2} * kNormalPage_px * kNormalPage_px);
    for (int y = 0; y < kNormalPage_px; ++y) {
        const int row = std::clamp(first_node.y + y - 1, 0, last.y);
        const int row_post = pyramid.post(level, {0, row}).y;
        const int to_north = row_post - pyramid.post(level, {0, std::max(row - 1, 0)}).y;
        const int to_south = pyramid.post(level, {0, std::min(row + 1, last.y)}).y - row_post;
        const float v = static_cast<float>(row_post - first.y) * step.y;
        // Derivatives of the net along this row: of u at v, and of v as a parabola of u.
        const vec3 row_u = p[1] + v * (p[4] + v * p[7]);
        const vec3 row_uu = p[2] + v * (p[5] + v * p[8]);
        const vec3 slope_v0 = p[3] + 2.0f * v * p[6];
        const vec3 slope_v1 = p[4] + 2.0f * v * p[7];
        const vec3 slope_v2 = p[5] + 2.0f * v * p[8];
        for (const auto& [column, to_west, to_east, u] : columns) {
            const glm::ivec2 at = glm::ivec2(column, row) - first_node + 2;
            const float h = block.height_m.at(at.x, at.y);
            const float west = to_west > 0 ? height(column - 1, row) : kNone;
            const float east = to_east > 0 ? height(column + 1, row) : kNone;
            const float north = to_north > 0 ? height(column, row - 1) : kNone;
            const float south = to_south > 0 ? height(column, row + 1) : kNone;
            const float dh_column = slope_of(west, h, east, to_west, to_east);
            const float dh_row = slope_of(north, h, south, to_north, to_south);

            const vec3 up = n0 + u * nu + v * nv;
            const vec3 base_u = row_u + 2.0f * u * row_uu;
            const vec3 base_v = slope_v0 + u * (slope_v1 + u * slope_v2);
            const vec3 along_column = step.x * (base_u + h * nu) + dh_column * up;
            const vec3 along_row = step.y * (base_v + h * nv) + dh_row * up;
            vec3 normal = cross(along_column, along_row);
            normal *= (dot(normal, up) < 0 ? -1.0f : 1.0f) / length(normal);
            vec3 eastwards = cross(pole, up);
            const float reach = dot(eastwards, eastwards);
            eastwards = reach > 1e-12f ? eastwards / std::sqrt(reach) : east_middle;
            texels.push_back(snorm16(dot(normal, eastwards)));
            texels.push_back(snorm16(dot(normal, cross(up, eastwards))));
        }
    }
    return texels;
}

}  // namespace relevo::render
