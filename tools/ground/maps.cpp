#include "maps.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "noise.h"

namespace relevo::ground {
namespace {

/// Moments of what lies inside a texel of one level.
struct Level {
    ColourField albedo;
    Field gloss, height_m;
    Field ds, dt;                ///< mean slope
    Field ds_square, dt_square;  ///< mean square of it
};

template <typename T>
Array2d<T> halved(const Array2d<T>& fine) {
    const int n = fine.width() / 2;
    Array2d<T> coarse(n, n);
    for_each_texel(n, [&](int c, int r) {
        coarse.at(c, r) = 0.25f * (fine.at(2 * c, 2 * r) + fine.at(2 * c + 1, 2 * r) +
                                   fine.at(2 * c, 2 * r + 1) + fine.at(2 * c + 1, 2 * r + 1));
    });
    return coarse;
}

// A box of 2 x 2 keeps every mean exactly and rings nowhere; the sharper kernels in use do neither.
Level halved(const Level& fine) {
    return {halved(fine.albedo), halved(fine.gloss),     halved(fine.height_m), halved(fine.ds),
            halved(fine.dt),     halved(fine.ds_square), halved(fine.dt_square)};
}

Level finest(const Material& material) {
    Level level{material.albedo, material.gloss, material.height_m, {}, {}, {}, {}};
    const int n = material.height_m.width();
    Slopes slope = slopes(material.height_m, material.tile_m);
    level.ds_square = Field(n, n);
    level.dt_square = Field(n, n);
    for_each_texel(n, [&](int c, int r) {
        level.ds_square.at(c, r) = slope.ds.at(c, r) * slope.ds.at(c, r);
        level.dt_square.at(c, r) = slope.dt.at(c, r) * slope.dt.at(c, r);
    });
    level.ds = std::move(slope.ds);
    level.dt = std::move(slope.dt);
    return level;
}

std::byte rounded(float value) {
    return static_cast<std::byte>(std::clamp(std::lround(value * 255.0f), 0L, 255L));
}

/// Rounded up or down by chance, so that the mean of many is the value itself.
std::byte dithered(float value, float chance) {
    return static_cast<std::byte>(
        std::clamp(static_cast<int>(std::floor(value * 255.0f + chance)), 0, 255));
}

void describe(image::TextureData& texture, const Material& material) {
    texture.metadata["KTXorientation"] = "ru";
    texture.metadata["relevo.material"] = material.name;
    texture.metadata["relevo.description"] = material.description;
    texture.metadata["relevo.tile_m"] = fmt::format("{:g}", material.tile_m);
}

template <typename Fill>
image::TextureData with_chain(PixelFormat format, const Material& material, Fill fill) {
    const int n = material.height_m.width();
    image::TextureData texture(format, n, n, 1, 1, image::full_chain_levels(n, n));
    describe(texture, material);
    Level level = finest(material);
    for (int l = 0;; ++l) {
        const auto bytes = texture.writable_level(l);
        const int side = texture.level_width(l);
        for_each_texel(side, [&](int c, int r) {
            fill(level, l, c, r, &bytes[static_cast<std::size_t>(4 * (r * side + c))]);
        });
        if (l + 1 == texture.levels()) return texture;
        level = halved(level);
    }
}

}  // namespace

Slopes slopes(const Field& height_m, double tile_m) {
    const int n = height_m.width();
    Slopes result{Field(n, n), Field(n, n)};
    const auto scale = static_cast<float>(n / (2 * tile_m));
    for_each_texel(n, [&](int c, int r) {
        const int west = (c + n - 1) % n, east = (c + 1) % n;
        const int south = (r + n - 1) % n, north = (r + 1) % n;
        result.ds.at(c, r) = (height_m.at(east, r) - height_m.at(west, r)) * scale;
        result.dt.at(c, r) = (height_m.at(c, north) - height_m.at(c, south)) * scale;
    });
    return result;
}

glm::vec3 normal_of_slope(float ds, float dt) {
    const float length = std::sqrt(ds * ds + dt * dt + 1);
    return {-ds / length, -dt / length, 1 / length};
}

float gloss_left(double shininess, double slope_variance) {
    return static_cast<float>(1 / (1 + 4 * shininess * slope_variance));
}

image::TextureData albedo_texture(const Material& material) {
    image::TextureData texture = with_chain(
        PixelFormat::Srgb8A8, material,
        [&](const Level& level, int, int c, int r, std::byte* texel) {
            for (int channel = 0; channel < 3; ++channel)
                texel[channel] = rounded(srgb_encoded(level.albedo.at(c, r)[channel]));
            const float ds = level.ds.at(c, r), dt = level.dt.at(c, r);
            const float variance = 0.5f * std::max(0.0f, level.ds_square.at(c, r) - ds * ds +
                                                             level.dt_square.at(c, r) - dt * dt);
            texel[3] = rounded(level.gloss.at(c, r) * gloss_left(material.shininess, variance));
        });
    texture.metadata["relevo.channels"] = "rgb albedo, a gloss";
    texture.metadata["relevo.shininess"] = fmt::format("{:g}", material.shininess);
    return texture;
}

image::TextureData normal_texture(const Material& material) {
    const auto [low, high] =
        std::minmax_element(material.height_m.begin(), material.height_m.end());
    const float min_m = *low, range_m = std::max(*high - *low, 1e-6f);
    image::TextureData texture = with_chain(
        PixelFormat::RGBA8, material,
        [&](const Level& level, int l, int c, int r, std::byte* texel) {
            const glm::vec3 normal = normal_of_slope(level.ds.at(c, r), level.dt.at(c, r));
            const auto seed = static_cast<std::uint32_t>(l);
            for (int axis = 0; axis < 3; ++axis)
                texel[axis] = dithered(0.5f + 0.5f * normal[axis], hash_unit(seed, c, r, axis));
            texel[3] = rounded((level.height_m.at(c, r) - min_m) / range_m);
        });
    texture.metadata["relevo.channels"] = "rgb normal (x to s, y to t, z out), a height";
    texture.metadata["relevo.height_min_m"] = fmt::format("{:.6f}", min_m);
    texture.metadata["relevo.height_max_m"] = fmt::format("{:.6f}", min_m + range_m);
    return texture;
}

}  // namespace relevo::ground
