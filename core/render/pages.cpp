#include "render/pages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace relevo::render {
namespace {

float clamped(const Array2d<float>& height_m, int column, int row) {
    return height_m.at(std::clamp(column, 0, height_m.width() - 1),
                       std::clamp(row, 0, height_m.height() - 1));
}

float mean_of_neighbours(const Array2d<float>& height_m, int column, int row, int stride) {
    float sum = 0;
    int count = 0;
    for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
            const float h = clamped(height_m, column + dx * stride, row + dy * stride);
            if (std::isnan(h)) continue;
            sum += h;
            ++count;
        }
    }
    return count ? sum / static_cast<float>(count) : 0.0f;
}

/// Rise between neighbours, both sides where both are there, else the one that is.
float slope_of(float before, float here, float after) {
    const bool has_before = !std::isnan(before), has_after = !std::isnan(after);
    if (has_before && has_after) return 0.5f * (after - before);
    if (has_after) return after - here;
    if (has_before) return here - before;
    return 0.0f;
}

std::int16_t snorm16(float value) {
    return static_cast<std::int16_t>(std::lrint(std::clamp(value, -1.0f, 1.0f) * 32767.0f));
}

}  // namespace

std::vector<float> height_page(const Array2d<float>& height_m, glm::ivec2 first, int stride) {
    std::vector<float> page;
    page.reserve(std::size_t{2} * kHeightPage_px * kHeightPage_px);
    for (int y = -1; y < kHeightPage_px - 1; ++y) {
        const int row = std::clamp(first.y + y * stride, 0, height_m.height() - 1);
        for (int x = -1; x < kHeightPage_px - 1; ++x) {
            const int column = std::clamp(first.x + x * stride, 0, height_m.width() - 1);
            const float h = height_m.at(column, row);
            const bool hole = std::isnan(h);
            page.push_back(hole ? mean_of_neighbours(height_m, column, row, stride) : h);
            page.push_back(hole ? 0.0f : 1.0f);
        }
    }
    return page;
}

std::vector<std::int16_t> normal_page(const Array2d<float>& height_m, const PatchNet& net,
                                      const glm::dvec3& axis, glm::ivec2 first) {
    // Everything from here on is relative to the page's middle: floats hold it to micrometres.
    using vec3 = glm::vec3;
    const float step = 1.0f / kNormalPosts;
    std::array<vec3, 9> p;
    for (std::size_t i = 0; i < 9; ++i)
        p[i] = vec3(net.position_m[i]);
    const vec3 n0 = vec3(net.vertical[0]), nu = vec3(net.vertical[1]), nv = vec3(net.vertical[2]);
    const vec3 pole = vec3(axis);
    const vec3 east_middle = normalize(cross(pole, n0));

    std::vector<std::int16_t> page;
    page.reserve(std::size_t{2} * kNormalPage_px * kNormalPage_px * 4 / 3 + 64);
    std::vector<float> finest(std::size_t{2} * kNormalPage_px * kNormalPage_px);
    float* out = finest.data();
    for (int y = 0; y < kNormalPage_px; ++y) {
        const int row = std::clamp(first.y + y - kNormalBorder_px, 0, height_m.height() - 1);
        const int above = std::max(row - 1, 0), below = std::min(row + 1, height_m.height() - 1);
        const float v = static_cast<float>(row - first.y) * step;
        // Derivatives of the net along this row: of u at v, and of v as a parabola of u.
        const vec3 row_u = p[1] + v * (p[4] + v * p[7]);
        const vec3 row_uu = p[2] + v * (p[5] + v * p[8]);
        const vec3 slope_v0 = p[3] + 2.0f * v * p[6];
        const vec3 slope_v1 = p[4] + 2.0f * v * p[7];
        const vec3 slope_v2 = p[5] + 2.0f * v * p[8];
        for (int x = 0; x < kNormalPage_px; ++x) {
            const int column = std::clamp(first.x + x - kNormalBorder_px, 0, height_m.width() - 1);
            const int left = std::max(column - 1, 0),
                      right = std::min(column + 1, height_m.width() - 1);
            const float u = static_cast<float>(column - first.x) * step;
            float h = height_m.at(column, row);
            float west = height_m.at(left, row), east = height_m.at(right, row);
            float north = height_m.at(column, above), south = height_m.at(column, below);
            if (std::isnan(h)) h = mean_of_neighbours(height_m, column, row, 1);
            if (left == column) west = std::numeric_limits<float>::quiet_NaN();
            if (right == column) east = std::numeric_limits<float>::quiet_NaN();
            if (above == row) north = std::numeric_limits<float>::quiet_NaN();
            if (below == row) south = std::numeric_limits<float>::quiet_NaN();
            const float dh_column = slope_of(west, h, east);
            const float dh_row = slope_of(north, h, south);

            const vec3 up = n0 + u * nu + v * nv;
            const vec3 base_u = row_u + 2.0f * u * row_uu;
            const vec3 base_v = slope_v0 + u * (slope_v1 + u * slope_v2);
            const vec3 along_column = step * (base_u + h * nu) + dh_column * up;
            const vec3 along_row = step * (base_v + h * nv) + dh_row * up;
            vec3 normal = cross(along_column, along_row);
            normal *= (dot(normal, up) < 0 ? -1.0f : 1.0f) / length(normal);
            vec3 to_east = cross(pole, up);
            const float reach = dot(to_east, to_east);
            to_east = reach > 1e-12f ? to_east / std::sqrt(reach) : east_middle;
            *out++ = dot(normal, to_east);
            *out++ = dot(normal, cross(up, to_east));
        }
    }
    int size = kNormalPage_px;
    std::vector<float> level = std::move(finest);
    for (int mip = 0; mip < kNormalPageLevels; ++mip) {
        for (const float value : level)
            page.push_back(snorm16(value));
        const int half = size / 2;
        std::vector<float> next(std::size_t{2} * static_cast<std::size_t>(half * half));
        for (int y = 0; y < half; ++y)
            for (int x = 0; x < half; ++x)
                for (int c = 0; c < 2; ++c) {
                    const auto at = [&](int i, int j) {
                        return level[static_cast<std::size_t>(2 * ((2 * y + j) * size + 2 * x + i) +
                                                              c)];
                    };
                    next[static_cast<std::size_t>(2 * (y * half + x) + c)] =
                        0.25f * (at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1));
                }
        level = std::move(next);
        size = half;
    }
    return page;
}

}  // namespace relevo::render
