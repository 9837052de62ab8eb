#include "patches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <glm/gtc/packing.hpp>

#include "field.h"
#include "material.h"
#include "noise.h"

namespace relevo::ground {
namespace {

constexpr std::uint32_t kPatchesSeed = 0x7A7C;
constexpr double kDeviation = 0.16;

/// Fractal noise read at places that are displaced by another, which frays its outlines.
float warped(std::uint32_t seed, int cells, int octaves, float gain, float by, float s, float t) {
    const float ds = fractal_noise(seed + 11, s, t, cells, 4, 0.6f);
    const float dt = fractal_noise(seed + 23, s, t, cells, 4, 0.6f);
    return fractal_noise(seed, s + by * ds, t + by * dt, cells, octaves, gain);
}

/// Mean 0.5 and the standard deviation that is wanted.
void normalise(Field& field) {
    const double middle = mean(field);
    double square = 0;
    for (const float v : field)
        square += (v - middle) * (v - middle);
    const double scale = kDeviation / std::sqrt(square / static_cast<double>(field.size()));
    for (float& v : field)
        v = static_cast<float>(0.5 + scale * (v - middle));
}

using Channels = std::array<Field, 4>;

Channels make_channels(int n) {
    Channels channels{
        make_field(n,
                   [](float s, float t) { return warped(kPatchesSeed, 6, 7, 0.66f, 0.02f, s, t); }),
        make_field(
            n, [](float s, float t) { return warped(kPatchesSeed + 1, 6, 6, 0.58f, 0.03f, s, t); }),
        make_field(n,
                   [](float s, float t) {
                       const float group = warped(kPatchesSeed + 2, 7, 4, 0.6f, 0.02f, s, t);
                       const float shrub = fractal_noise(kPatchesSeed + 3, s, t, 44, 3, 0.62f);
                       return smoothstep(0.06f, 0.36f, shrub + 0.9f * group);
                   }),
        make_field(
            n, [](float s, float t) { return fractal_noise(kPatchesSeed + 4, s, t, 30, 4, 0.7f); }),
    };
    for (const std::size_t c : {0, 1, 3})
        normalise(channels[c]);
    return channels;
}

/// The next mip level: means of four.
void halve(Channels& channels) {
    for (Field& channel : channels) {
        const int side = channel.width() / 2;
        Field coarse(side, side);
        for (int r = 0; r < side; ++r)
            for (int c = 0; c < side; ++c)
                coarse.at(c, r) =
                    0.25f * (channel.at(2 * c, 2 * r) + channel.at(2 * c + 1, 2 * r) +
                             channel.at(2 * c, 2 * r + 1) + channel.at(2 * c + 1, 2 * r + 1));
        channel = std::move(coarse);
    }
}

}  // namespace

image::TextureData patches_texture(int n) {
    Channels channels = make_channels(n);
    image::TextureData texture(PixelFormat::RGBA8, n, n, 1, 1, image::full_chain_levels(n, n));
    texture.metadata["relevo.channels"] = "r tone, g hue, b shrubs, a fine tone";
    texture.metadata["relevo.description"] = "How ground varies from place to place";
    for (int level = 0; level < texture.levels(); ++level) {
        if (level > 0) halve(channels);
        const auto bytes = texture.writable_level(level);
        for (std::size_t i = 0; i < bytes.size(); ++i) {
            const float value = *(channels[i % 4].data() + i / 4);
            // Dithered, as the mean of every level has to stay.
            const float chance = hash_unit(kPatchesSeed + 9, static_cast<int>(i), level);
            bytes[i] = static_cast<std::byte>(
                std::clamp(static_cast<int>(std::floor(value * 255.0f + chance)), 0, 255));
        }
    }
    return texture;
}

image::TextureData regions_texture(int n) {
    Channels channels = make_channels(n);
    image::TextureData texture(PixelFormat::RGBA16F, n, n, 1, 1, image::full_chain_levels(n, n));
    texture.metadata["relevo.channels"] = "as of the patches, less 0.5";
    texture.metadata["relevo.description"] = "How ground varies from region to region";
    for (int level = 0; level < texture.levels(); ++level) {
        if (level > 0) halve(channels);
        const auto bytes = texture.writable_level(level);
        for (std::size_t i = 0; i < bytes.size() / 2; ++i) {
            const std::uint16_t half = glm::packHalf1x16(*(channels[i % 4].data() + i / 4) - 0.5f);
            bytes[2 * i] = static_cast<std::byte>(half & 0xff);
            bytes[2 * i + 1] = static_cast<std::byte>(half >> 8);
        }
    }
    return texture;
}

}  // namespace relevo::ground
