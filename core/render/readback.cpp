#include "render/readback.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <glm/vec4.hpp>

#include "render/frame_block.h"

namespace relevo::render {
namespace {

std::size_t texels_of(const gl::Texture& texture) {
    const gl::Extent extent = texture.extent();
    return static_cast<std::size_t>(extent.width) * static_cast<std::size_t>(extent.height);
}

template <typename Texel>
std::vector<Texel> read_all(const gl::Texture& texture) {
    std::vector<Texel> texels(texels_of(texture));
    texture.read(0, std::as_writable_bytes(std::span(texels)));
    return texels;
}

}  // namespace

int count_non_finite(std::span<const std::uint8_t> rgba) {
    int count = 0;
    for (std::size_t alpha = 3; alpha < rgba.size(); alpha += 4)
        count += rgba[alpha] != 255;
    return count;
}

NonFinite find_non_finite(const gl::Texture& output) {
    std::vector<std::uint8_t> texels(4 * texels_of(output));
    output.read(0, std::as_writable_bytes(std::span(texels)));
    NonFinite found{count_non_finite(texels), {}};
    const int width = output.extent().width, height = output.extent().height;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            if (texels[4 * static_cast<std::size_t>((height - 1 - y) * width + x) + 3] != 255) {
                found.first = {x, y};
                return found;
            }
    return found;
}

image::Image8 read_output(const gl::Texture& output, int* non_finite) {
    std::vector<std::uint8_t> texels(4 * texels_of(output));
    output.read(0, std::as_writable_bytes(std::span(texels)));
    if (non_finite) *non_finite = count_non_finite(texels);
    return image::from_device(output.extent().width, output.extent().height, texels);
}

image::Image16 read_output16(const gl::Texture& output, int* non_finite) {
    const auto texels = read_all<std::array<std::uint16_t, 4>>(output);
    const auto is_marked = [](const auto& texel) { return texel[3] != 65535; };
    if (non_finite) *non_finite = static_cast<int>(std::ranges::count_if(texels, is_marked));
    const auto [width, height, layers] = output.extent();
    image::Image16 picture(width, height, 3);
    for (int y = 0; y < height; ++y) {
        const auto* from = texels.data() + std::ptrdiff_t{height - 1 - y} * width;
        std::uint16_t* to = picture.row(y);
        for (int x = 0; x < width; ++x, ++from, to += 3)
            std::copy_n(from->begin(), 3, to);
    }
    return picture;
}

PixelData read_data(const gl::Texture& surface, const gl::Texture& depth,
                    const gl::Texture* albedo) {
    const auto [width, height, layers] = surface.extent();
    std::vector<float> seen(4 * texels_of(surface));
    surface.read_floats(seen);
    std::vector<float> colours(albedo ? 4 * texels_of(*albedo) : 0);
    if (albedo) albedo->read_floats(colours);
    const std::vector<float> depths_m = read_depths(depth);
    PixelData data;
    for (int y = height - 1; y >= 0; --y)
        for (int x = 0; x < width; ++x) {
            const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                  static_cast<std::size_t>(x);
            const glm::vec3 normal(seen[4 * i], seen[4 * i + 1], seen[4 * i + 2]);
            // side.frag.glsl leaves it 0.
            const bool wall = std::isfinite(depths_m[i]) && normal == glm::vec3(0);
            data.depths_m.push_back(depths_m[i]);
            data.normals.push_back(normal);
            data.sun.push_back(seen[4 * i + 3]);
            data.walls.push_back(wall ? 1 : 0);
            if (albedo)
                data.albedo.emplace_back(colours[4 * i], colours[4 * i + 1], colours[4 * i + 2]);
        }
    return data;
}

image::ImageF read_radiance(const gl::Texture& radiance, double exposure, int* non_finite) {
    const int width = radiance.extent().width, height = radiance.extent().height;
    std::vector<float> texels(4 * texels_of(radiance));
    radiance.read_floats(texels);
    if (non_finite) {
        *non_finite = 0;
        for (std::size_t alpha = 3; alpha < texels.size(); alpha += 4)
            *non_finite += texels[alpha] != 1;
    }
    const auto scale = static_cast<float>(1 / exposure);
    image::ImageF result(width, height, 3);
    for (int y = 0; y < height; ++y) {
        const float* from = texels.data() + static_cast<std::size_t>(height - 1 - y) *
                                                static_cast<std::size_t>(width) * 4;
        float* to = result.row(y);
        for (int x = 0; x < width; ++x, from += 4, to += 3)
            std::transform(from, from + 3, to, [&](float value) { return value * scale; });
    }
    return result;
}

float distance_m(float depth) {
    return static_cast<float>(kNear_m) / depth;
}

std::vector<float> read_depths(const gl::Texture& depth) {
    std::vector<float> depths_m = read_all<float>(depth);
    std::ranges::transform(depths_m, depths_m.begin(), distance_m);
    return depths_m;
}

std::vector<SunSeen> read_sun_seen(const gl::Texture& sun_seen, const gl::Texture& gbuffer,
                                   const gl::Texture& depth) {
    const auto seen = read_all<glm::vec4>(sun_seen);
    const auto what = read_all<glm::uvec4>(gbuffer);
    const std::vector<float> depths_m = read_depths(depth);
    std::vector<SunSeen> result;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const glm::vec4& v = seen[i];
        // Walls of a block may hide the ground.
        const float ground_m = std::bit_cast<float>(what[i].w);
        if (v.w == 0 || depths_m[i] < 0.999F * ground_m) continue;
        result.push_back({.post = {v.x, v.y},
                          .share = v.z,
                          .pixel_posts = std::abs(double{v.w}),
                          .faces = v.w > 0,
                          .moved = v.z == -1,
                          .shaded_by_instance = v.z == -2});
    }
    return result;
}

}  // namespace relevo::render
