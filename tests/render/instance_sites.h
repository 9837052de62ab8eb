#pragma once

#include <array>
#include <cstdint>

#include <glm/vec2.hpp>

namespace relevo::test {

/// @source  M. Jarzynski, M. Olano, JCGT 9(3), 2020: pcg4d, as lib/instances.glsl
inline std::array<double, 4> random_of(int x, int y, std::uint32_t stream) {
    std::array<std::uint32_t, 4> v{static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                                   stream, 0x9e3779b9U};
    for (std::uint32_t& each : v)
        each = each * 1664525U + 1013904223U;
    const auto mix = [&] {
        v[0] += v[1] * v[3];
        v[1] += v[2] * v[0];
        v[2] += v[0] * v[1];
        v[3] += v[1] * v[2];
    };
    mix();
    for (std::uint32_t& each : v)
        each ^= each >> 16U;
    mix();
    std::array<double, 4> result{};
    for (std::size_t i = 0; i < 4; ++i)
        result[i] = (v[i] >> 8U) / 16777216.0;
    return result;
}

/// The post of a cell's site. @param posts  to a cell
inline glm::dvec2 site_post(int x, int y, double posts) {
    const auto chance = random_of(x, y, 0);
    return (glm::dvec2(x, y) + 0.1 + 0.8 * glm::dvec2(chance[0], chance[1])) * posts;
}

}  // namespace relevo::test
