#include "render/pages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace relevo::render {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// A block of a level with its coverage blurred, which smooths the clipped edge of voids. Nodes
/// stay on their side of 0.5.
dem::Pyramid::Block smoothly_cut(const dem::Pyramid& pyramid, int level, glm::ivec2 first,
                                 int columns, int rows) {
    if (!pyramid.has_voids()) return pyramid.block(level, first, columns, rows);
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
    // The part of the coarser level under the page.
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

namespace {

/// Posts of a page's row, and the constants of their normals.
struct NormalRow {
    // Heights of each post and its neighbours, NaN without one.
    const float *here, *west, *east, *north, *south;
    const float* u;                  // of each post on the proxy grid
    const float *to_west, *to_east;  // distances to neighbours in posts, 0 without one
    float to_north, to_south;
    float step_x, step_y;
    glm::vec3 up0, up_u, up_v;            // vertical: up0 + u * up_u + up_v
    glm::vec3 base_u0, base_u1;           // derivative of position by u: base_u0 + u * base_u1
    glm::vec3 base_v0, base_v1, base_v2;  // by v: base_v0 + u * (base_v1 + u * base_v2)
    glm::vec3 rise_u, rise_v;             // change of these derivatives per metre of height
    glm::vec3 pole, east_middle;
};

/// Slope in metres per post: a central difference, or one-sided next to a missing neighbour.
inline float slope_of(float before, float here, float after, float to_before, float to_after) {
    const bool has_before = before == before, has_after = after == after;
    const float low = has_before ? before : here, high = has_after ? after : here;
    const float posts = (has_before ? to_before : 0.0f) + (has_after ? to_after : 0.0f);
    return (high - low) / (posts > 0 ? posts : 1.0f);
}

/// Rounds half to even.
inline int nearest(float value) {
    constexpr float kWhole = 12582912.0f;  // floats of this magnitude have no fraction
    return static_cast<int>((value + kWhole) - kWhole);
}

inline std::uint32_t snorm16(float value) {
    const float known = value == value ? value : 0.0f;
    const float least = known > -1.0f ? known : -1.0f;
    return static_cast<std::uint32_t>(nearest((least < 1.0f ? least : 1.0f) * 32767.0f)) & 0xffffU;
}

/// @param to  east in the low half, north in the high half
void encode_normals(const NormalRow& given, std::uint32_t* to) {
    using vec3 = glm::vec3;
    const NormalRow row = given;  // a copy, so that compilers need not assume aliasing with `to`
    for (int i = 0; i < kNormalPage_px; ++i) {
        const float h = row.here[i], u = row.u[i], to_west = row.to_west[i],
                    to_east = row.to_east[i], west = row.west[i], east = row.east[i];
        const float dh_column =
            slope_of(to_west > 0 ? west : kNone, h, to_east > 0 ? east : kNone, to_west, to_east);
        const float dh_row = slope_of(row.north[i], h, row.south[i], row.to_north, row.to_south);
        const vec3 up = row.up0 + u * row.up_u + row.up_v;
        const vec3 base_u = row.base_u0 + u * row.base_u1;
        const vec3 base_v = row.base_v0 + u * (row.base_v1 + u * row.base_v2);
        const vec3 along_column = row.step_x * (base_u + h * row.rise_u) + dh_column * up;
        const vec3 along_row = row.step_y * (base_v + h * row.rise_v) + dh_row * up;
        const vec3 across = cross(along_column, along_row);
        const vec3 normal = across * ((dot(across, up) < 0 ? -1.0f : 1.0f) / length(across));
        const vec3 aside = cross(row.pole, up);
        const float reach = dot(aside, aside);
        const bool has_east = reach > 1e-12f;  // false at a pole
        const vec3 unit = aside / std::sqrt(has_east ? reach : 1.0f);
        const vec3 eastwards(has_east ? unit.x : row.east_middle.x,
                             has_east ? unit.y : row.east_middle.y,
                             has_east ? unit.z : row.east_middle.z);
        to[i] = snorm16(dot(normal, eastwards)) | snorm16(dot(normal, cross(up, eastwards))) << 16;
    }
}

/// Values that depend only on the column.
struct NormalColumns {
    using Figures = std::array<float, kNormalPage_px>;
    Figures u, to_west, to_east;
    // Indices into the page's block, which has one more node on each side.
    std::array<int, kNormalPage_px> at;

    NormalColumns(const dem::Pyramid& pyramid, int level, int first_node, int first, float step) {
        const int last = pyramid.size(level).x - 1;
        const auto post = [&](int column) { return pyramid.post(level, {column, 0}).x; };
        for (std::size_t x = 0; x < kNormalPage_px; ++x) {
            const int column = std::clamp(first_node + static_cast<int>(x) - 1, 0, last);
            at[x] = column - first_node + 2;
            to_west[x] = static_cast<float>(post(column) - post(std::max(column - 1, 0)));
            to_east[x] = static_cast<float>(post(std::min(column + 1, last)) - post(column));
            u[x] = static_cast<float>(post(column) - first) * step;
        }
    }

    /// A row's values at the columns, shifted by `aside`.
    /// @param moved  buffer, used if columns are not contiguous, as at the DEM's edge
    const float* of(std::span<const float> row, int aside, Figures& moved) const {
        const float* const from = row.data() + aside;
        if (at.front() == 1 && at.back() == kNormalPage_px) return from + 1;
        for (std::size_t x = 0; x < kNormalPage_px; ++x)
            moved[x] = from[at[x]];
        return moved.data();
    }
};

/// Constants of a row. @param v  of the row on the proxy grid
NormalRow normal_row(const PatchNet& net, const glm::dvec3& axis, float v) {
    using vec3 = glm::vec3;
    std::array<vec3, 9> p;
    for (std::size_t i = 0; i < 9; ++i)
        p[i] = vec3(net.position_m[i]);
    const vec3 n0 = vec3(net.vertical[0]), nu = vec3(net.vertical[1]), nv = vec3(net.vertical[2]);
    NormalRow row{};
    row.up0 = n0, row.up_u = nu, row.up_v = v * nv;
    row.base_u0 = p[1] + v * (p[4] + v * p[7]);
    row.base_u1 = 2.0f * (p[2] + v * (p[5] + v * p[8]));
    row.base_v0 = p[3] + 2.0f * v * p[6];
    row.base_v1 = p[4] + 2.0f * v * p[7];
    row.base_v2 = p[5] + 2.0f * v * p[8];
    row.rise_u = nu, row.rise_v = nv;
    row.pole = vec3(axis);
    row.east_middle = normalize(cross(row.pole, n0));
    return row;
}

}  // namespace

std::vector<std::uint32_t> normal_page(const dem::Pyramid& pyramid, int level, glm::ivec2 page,
                                       const PatchNet& net, const glm::dvec3& axis) {
    // Relative to the page's centre, single precision is accurate to micrometres.
    const glm::ivec2 first_node = page * kNormalNodes;
    const glm::ivec2 first = first_node << level;
    const glm::vec2 step = 1.0f / glm::vec2(span_on_dem(pyramid, first, kNormalNodes << level));
    const int last = pyramid.size(level).y - 1;
    // With one more node on each side than the page.
    auto block = pyramid.block(level, first_node - 2, kNormalPage_px + 2, kNormalPage_px + 2);
    Array2d<float>& known_m = block.coverage;
    for (std::size_t i = 0; i < known_m.size(); ++i)
        known_m.data()[i] = known_m.data()[i] > 0 ? block.height_m.data()[i] : kNone;
    const NormalColumns columns(pyramid, level, first_node.x, first.x, step.x);
    std::array<NormalColumns::Figures, 5> moved;
    NormalColumns::Figures none;
    none.fill(kNone);
    std::vector<std::uint32_t> texels(std::size_t{kNormalPage_px} * kNormalPage_px);
    for (int y = 0; y < kNormalPage_px; ++y) {
        const int row = std::clamp(first_node.y + y - 1, 0, last);
        const int post = pyramid.post(level, {0, row}).y;
        const int to_north = post - pyramid.post(level, {0, std::max(row - 1, 0)}).y;
        const int to_south = pyramid.post(level, {0, std::min(row + 1, last)}).y - post;
        const int at = row - first_node.y + 2;  // index into the block
        NormalRow posts = normal_row(net, axis, static_cast<float>(post - first.y) * step.y);
        posts.here = columns.of(block.height_m.row(at), 0, moved[0]);
        posts.west = columns.of(known_m.row(at), -1, moved[1]);
        posts.east = columns.of(known_m.row(at), 1, moved[2]);
        posts.north = to_north > 0 ? columns.of(known_m.row(at - 1), 0, moved[3]) : none.data();
        posts.south = to_south > 0 ? columns.of(known_m.row(at + 1), 0, moved[4]) : none.data();
        posts.u = columns.u.data();
        posts.to_west = columns.to_west.data(), posts.to_east = columns.to_east.data();
        posts.to_north = static_cast<float>(to_north),
        posts.to_south = static_cast<float>(to_south);
        posts.step_x = step.x, posts.step_y = step.y;
        encode_normals(posts, texels.data() + std::ptrdiff_t{y} * kNormalPage_px);
    }
    return texels;
}

}  // namespace relevo::render
