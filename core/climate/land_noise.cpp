#include "climate/land_noise.h"

#include <cmath>

namespace relevo::climate {
namespace {

float random_at(std::int64_t i, std::int64_t j, std::int64_t k, std::uint32_t seed) {
    std::uint32_t h = (static_cast<std::uint32_t>(i) * 0x8da6b343U) ^
                      (static_cast<std::uint32_t>(j) * 0xd8163841U) ^
                      (static_cast<std::uint32_t>(k) * 0xcb1ab31fU) ^ (seed * 0x9e3779b1U);
    h ^= h >> 15;
    h *= 0x2c1b3c6dU;
    h ^= h >> 12;
    h *= 0x297a2d39U;
    h ^= h >> 15;
    return static_cast<float>(h) * 0x1p-32F;
}

}  // namespace

LandNoise::LandNoise(double largest_m, double least_m, std::uint32_t seed) {
    constexpr float kWeaker = 0.78F;  // each octave than the one before
    float weight = 1, square = 0;
    for (double cell_m = largest_m; cell_m > least_m && count_ < std::ssize(octaves_);
         cell_m /= 2) {
        octaves_[static_cast<std::size_t>(count_)] = {
            .per_m = 1 / cell_m,
            .weight = weight,
            .seed = seed * 16 + static_cast<std::uint32_t>(count_)};
        ++count_;
        square += weight * weight;
        weight *= kWeaker;
    }
    if (count_ > 0) scale_ = 5.6F / std::sqrt(square);
}

float LandNoise::at(const glm::dvec3& place_m) {
    float sum = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count_); ++i)
        sum += octaves_[i].weight * value(octaves_[i], place_m);
    return sum * scale_;
}

float LandNoise::value(Octave& octave, const glm::dvec3& place_m) {
    std::array<std::int64_t, 3> cell{};
    std::array<float, 3> t{};
    for (int axis = 0; axis < 3; ++axis) {
        const double at = place_m[axis] * octave.per_m, from = std::floor(at);
        const auto share = static_cast<float>(at - from);
        cell[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(from);
        t[static_cast<std::size_t>(axis)] = share * share * (3 - 2 * share);
    }
    if (!octave.has_cell || cell != octave.cell) {
        octave.has_cell = true;
        octave.cell = cell;
        for (int corner = 0; corner < 8; ++corner)
            octave.corners[static_cast<std::size_t>(corner)] =
                random_at(cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1),
                          cell[2] + (corner >> 2), octave.seed);
    }
    const auto& c = octave.corners;
    const auto between = [&](std::size_t first) {
        const float low = c[first] + t[0] * (c[first + 1] - c[first]);
        const float high = c[first + 2] + t[0] * (c[first + 3] - c[first + 2]);
        return low + t[1] * (high - low);
    };
    const float near = between(0), far = between(4);
    return near + t[2] * (far - near) - 0.5F;
}

}  // namespace relevo::climate
