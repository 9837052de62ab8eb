#pragma once

#include <bit>
#include <cstdint>

#include "light/raster/clearance.h"

/// Texels of the shadow textures, encoded by the widest vectors that the processor has, as
/// light/sweep/kernels.h.
namespace relevo::render {

constexpr float kMostMargin = 60000;  ///< [m], in halves, less than GroundLight::kHole

/// A float as a half. What is smaller than a half's least normal number is 0.
inline std::uint32_t half_of(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    const std::uint32_t sign = bits >> 16 & 0x8000U, size = bits & 0x7fffffffU;
    const std::uint32_t half = (size - (112U << 23) + 0x1000U) >> 13;
    return sign | (size < (113U << 23) ? 0 : half);
}

/// Margins as two halves, the upper limb's in the low one, and the share of the disc that is seen.
void encode_shadows(const light::ClearanceRun& run, std::uint32_t* halves, std::uint16_t* shares);

}  // namespace relevo::render
