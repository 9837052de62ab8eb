#include "volume.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "base/parallel_for.h"
#include "noise.h"

namespace relevo::ground {
namespace {

constexpr std::uint32_t kVolumeSeed = 0x9E71;

std::size_t index(int n, int c, int r, int s) {
    return static_cast<std::size_t>((s * n + r) * n + c);
}

}  // namespace

image::TextureData perlin_texture(int n) {
    std::vector<float> noise(index(n, 0, 0, n));
    parallel_for(0, n, 1, [&](int first, int last) {
        for (int s = first; s < last; ++s)
            for (int r = 0; r < n; ++r)
                for (int c = 0; c < n; ++c) {
                    float sum = 0, strength = 1;
                    for (int o = 0; o < kVolumeOctaves; ++o) {
                        const int cells = kVolumeCells << o;
                        const double scale = static_cast<double>(cells) / n;
                        // Shifted, so that no plane of the volume is a lattice plane of all
                        // octaves, where gradient noise is weak.
                        sum += strength * perlin_noise(kVolumeSeed + static_cast<std::uint32_t>(o),
                                                       (c + 0.5) * scale + 0.31 * o,
                                                       (r + 0.5) * scale + 0.57 * o,
                                                       (s + 0.5) * scale + 0.43 * o, cells);
                        strength *= 0.5f;
                    }
                    noise[index(n, c, r, s)] = sum;
                }
    });
    double mean = 0;
    for (const float v : noise)
        mean += v;
    mean /= static_cast<double>(noise.size());
    float peak = 0;
    for (float& v : noise) {
        v -= static_cast<float>(mean);
        peak = std::max(peak, std::abs(v));
    }

    image::TextureData texture(PixelFormat::R8, n, n, n, 1, image::full_chain_levels(n, n, n));
    texture.metadata["relevo.channels"] = "r noise, mean 0.5";
    texture.metadata["relevo.description"] =
        fmt::format("Perlin noise, {} octaves of {} cells and finer", kVolumeOctaves, kVolumeCells);
    for (int l = 0, side = n;; ++l) {
        const auto bytes = texture.writable_level(l);
        for (std::size_t i = 0; i < bytes.size(); ++i) {
            const float value = 0.5f + 0.5f * noise[i] / peak;
            // Dithered, as the mean of every level has to be 127.5, which no byte can say.
            const float chance = hash_unit(kVolumeSeed + 9, static_cast<int>(i), l);
            bytes[i] = static_cast<std::byte>(
                std::clamp(static_cast<int>(std::floor(value * 255.0f + chance)), 0, 255));
        }
        if (l + 1 == texture.levels()) return texture;
        side /= 2;
        std::vector<float> coarse(index(side, 0, 0, side));
        for (int s = 0; s < side; ++s)
            for (int r = 0; r < side; ++r)
                for (int c = 0; c < side; ++c) {
                    float sum = 0;
                    for (int corner = 0; corner < 8; ++corner)
                        sum += noise[index(2 * side, 2 * c + (corner & 1),
                                           2 * r + (corner >> 1 & 1), 2 * s + (corner >> 2))];
                    coarse[index(side, c, r, s)] = sum / 8;
                }
        noise = std::move(coarse);
    }
}

}  // namespace relevo::ground
