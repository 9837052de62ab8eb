#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "sky/spectrum.h"

/// Arithmetic on all wavelengths at once, in single precision and in loops that compilers turn into
/// vector instructions.
namespace relevo::sky {

using Values = std::array<float, kWavelengths>;

inline Values filled(float value) {
    Values result;
    result.fill(value);
    return result;
}

/// exp(-depth) for depths of 0 and more; relative error 2e-6, 0 beyond 87.
inline float passed(float depth) {
    const float t = depth < 86.0f ? depth * -1.44269504f : -124.0f;
    const int whole = static_cast<int>(t);
    const float x = (t - static_cast<float>(whole)) * 0.693147181f;  // -0.69..0
    const float series =
        1 + x * (1 + x * (1.f / 2 + x * (1.f / 6 + x * (1.f / 24 + x * (1.f / 120 + x / 720)))));
    return series * std::bit_cast<float>((whole + 127) << 23);
}

/// (1 - exp(-depth)) / depth, which is 1 at depth 0.
inline float mean_passed(float depth, float passed_all) {
    const float safe = depth > 1e-3f ? depth : 1.0f;
    return depth > 1e-3f ? (1 - passed_all) / safe : 1 - 0.5f * depth;
}

}  // namespace relevo::sky
