#include "render/terrain.h"

#include <array>
#include <cmath>
#include <cstdint>

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <glm/vec4.hpp>

#include "base/error.h"
#include "base/parallel_for.h"
#include "base/units.h"
#include "render/pages.h"

namespace relevo::render {
namespace {

constexpr int kGridVertices = (kPatchQuads + 1) * (kPatchQuads + 1);
constexpr int kGridIndices = kPatchQuads * kPatchQuads * 6;
constexpr int kInstanceVectors = 12;  // inputs net_0 ... up_v of terrain.vert.glsl

/// Rounding leaves the rims of two patches up to a step of the rasteriser apart, so each reaches
/// this far [quads] over its neighbour.
constexpr float kOverlap = 1.0f / 128.0f;

std::vector<float> grid_vertices() {
    std::vector<float> vertices;
    const auto coordinate = [](int i) {
        if (i == 0) return -kOverlap;
        return static_cast<float>(i) + (i == kPatchQuads ? kOverlap : 0.0f);
    };
    for (int y = 0; y <= kPatchQuads; ++y)
        for (int x = 0; x <= kPatchQuads; ++x) {
            vertices.push_back(coordinate(x));
            vertices.push_back(coordinate(y));
        }
    return vertices;
}

std::vector<std::uint16_t> grid_indices() {
    std::vector<std::uint16_t> indices;
    for (int y = 0; y < kPatchQuads; ++y)
        for (int x = 0; x < kPatchQuads; ++x) {
            const int a = y * (kPatchQuads + 1) + x, b = a + 1, c = a + kPatchQuads + 1, d = c + 1;
            for (const int i : {a, c, b, b, c, d})
                indices.push_back(static_cast<std::uint16_t>(i));
        }
    return indices;
}

int pieces(int posts, int posts_per_piece) {
    return std::max(1, (posts - 1 + posts_per_piece - 1) / posts_per_piece);
}

}  // namespace

Terrain::Terrain(const dem::Heightfield& heightfield, const geo::LocalFrame& frame,
                 const TerrainOptions& options, int max_array_layers)
    : grid_(gl::Buffer::of<float>(grid_vertices(), "terrain grid")),
      grid_indices_(gl::Buffer::of<std::uint16_t>(grid_indices(), "terrain grid indices")) {
    const Array2d<float>& height_m = heightfield.height_m;
    const int columns = height_m.width(), rows = height_m.height();
    const auto patches_at = [&](int stride) {
        return static_cast<long>(pieces(columns, kPatchQuads * stride)) *
               pieces(rows, kPatchQuads * stride);
    };
    // A patch reads its normals from one page, so at most four posts lie between its vertices.
    while (patches_at(stride_) * kGridVertices > options.vertex_budget &&
           stride_ * 2 * kPatchQuads <= kNormalPosts)
        stride_ *= 2;

    const glm::ivec2 normal_pages{pieces(columns, kNormalPosts), pieces(rows, kNormalPosts)};
    const int normal_count = normal_pages.x * normal_pages.y;
    const int span = kPatchQuads * stride_;
    const glm::ivec2 patch_counts{pieces(columns, span), pieces(rows, span)};
    const int patch_count = patch_counts.x * patch_counts.y;
    if (std::max(normal_count, patch_count) > max_array_layers)
        bad_input(
            fmt::format("render: a DEM of {} x {} posts needs {} pages, expected at most {} on "
                        "this device; use a "
                        "part of it or fewer posts",
                        columns, rows, std::max(normal_count, patch_count), max_array_layers));

    const PostPlace place = [&](double column, double row) {
        return heightfield.grid.place(column, row);
    };
    const glm::dvec3 axis = frame.up(kPi / 2, 0);

    normal_pages_ = gl::Texture(gl::TextureKind::D2Array, gl::Format::RG16Snorm,
                                {kNormalPage_px, kNormalPage_px, normal_count}, kNormalPageLevels,
                                "normal pages");
    std::vector<std::vector<std::int16_t>> normals(static_cast<std::size_t>(normal_count));
    parallel_for(0, normal_count, 1, [&](int begin, int end) {
        for (int i = begin; i < end; ++i) {
            const glm::ivec2 first =
                kNormalPosts * glm::ivec2(i % normal_pages.x, i / normal_pages.x);
            const PatchNet net = fit_patch_net(place, frame, glm::dvec2(first), kNormalPosts);
            normals[static_cast<std::size_t>(i)] = normal_page(height_m, net, axis, first);
        }
    });
    for (int i = 0; i < normal_count; ++i) {
        std::span<const std::int16_t> texels = normals[static_cast<std::size_t>(i)];
        int size = kNormalPage_px;
        for (int level = 0; level < kNormalPageLevels; ++level, size /= 2) {
            const auto count = static_cast<std::size_t>(2 * size * size);
            normal_pages_.write(level, {0, 0, i}, {size, size, 1},
                                std::as_bytes(texels.first(count)));
            texels = texels.subspan(count);
        }
    }
    normal_pages_.set_sampling(gl::Filter::Mipmap, gl::Wrap::Clamp);

    height_pages_ = gl::Texture(gl::TextureKind::D2Array, gl::Format::RG32F,
                                {kHeightPage_px, kHeightPage_px, patch_count}, 1, "height pages");
    std::vector<std::vector<float>> heights(static_cast<std::size_t>(patch_count));
    patches_.resize(static_cast<std::size_t>(patch_count));
    parallel_for(0, patch_count, 4, [&](int begin, int end) {
        for (int i = begin; i < end; ++i) {
            const glm::ivec2 first = span * glm::ivec2(i % patch_counts.x, i / patch_counts.x);
            heights[static_cast<std::size_t>(i)] = height_page(height_m, first, stride_);
            Patch& patch = patches_[static_cast<std::size_t>(i)];
            patch.net = fit_patch_net(place, frame, glm::dvec2(first), span);
            patch.quads = glm::min(
                glm::vec2(kPatchQuads),
                glm::vec2(columns - 1 - first.x, rows - 1 - first.y) / static_cast<float>(stride_));
            patch.height_layer = static_cast<float>(i);
            const glm::ivec2 page = first / kNormalPosts;
            patch.normal_layer = static_cast<float>(page.y * normal_pages.x + page.x);
            patch.first_texel = glm::vec2(first - page * kNormalPosts) +
                                static_cast<float>(kNormalBorder_px) + 0.5f;
            patch.texels_per_quad = static_cast<float>(stride_);
        }
    });
    for (int i = 0; i < patch_count; ++i)
        height_pages_.write(0, {0, 0, i}, {kHeightPage_px, kHeightPage_px, 1},
                            std::as_bytes(std::span(heights[static_cast<std::size_t>(i)])));
    height_pages_.set_sampling(gl::Filter::Nearest, gl::Wrap::Clamp);

    for (const float h : height_m)
        has_holes_ |= std::isnan(h);

    instances_ =
        gl::Buffer(patches_.size() * kInstanceVectors * sizeof(glm::vec4), "terrain patches");
    vertex_array_.emplace();
    vertex_array_->attributes(0, grid_, 0, 1, 2, false);
    vertex_array_->attributes(1, instances_, 1, kInstanceVectors, 4, true);
    vertex_array_->indices(grid_indices_);
}

int Terrain::triangles() const {
    return static_cast<int>(patches_.size()) * kGridIndices / 3;
}

void Terrain::draw(const glm::dvec3& eye_m) {
    std::vector<std::array<glm::vec4, kInstanceVectors>> instances;
    instances.reserve(patches_.size());
    for (const Patch& patch : patches_) {
        const PatchNet& net = patch.net;
        const auto& p = net.position_m;
        const auto with = [](const glm::dvec3& v, float w) { return glm::vec4(glm::vec3(v), w); };
        instances.push_back({with(net.centre_m - eye_m + p[0], patch.quads.x),
                             with(p[1], patch.quads.y), with(p[2], patch.height_layer),
                             with(p[3], patch.normal_layer), with(p[4], patch.first_texel.x),
                             with(p[5], patch.first_texel.y), with(p[6], patch.texels_per_quad),
                             with(p[7], 0), with(p[8], 0), with(net.vertical[0], 0),
                             with(net.vertical[1], 0), with(net.vertical[2], 0)});
    }
    instances_.write(std::as_bytes(std::span(instances)));
    vertex_array_->bind();
    glDrawElementsInstanced(GL_TRIANGLES, kGridIndices, GL_UNSIGNED_SHORT, nullptr,
                            static_cast<GLsizei>(patches_.size()));
}

}  // namespace relevo::render
