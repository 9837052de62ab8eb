#pragma once

#include <bit>
#include <cstdint>

#include "light/raster/clearance.h"

/// Encodes texels of the shadow textures with the widest vectors of the processor, as
/// light/sweep/kernels.h.
namespace relevo::render {

constexpr float kMaxClearance_m =
    60000;  ///< limit of stored clearances, below GroundLight::kVoidClearance

/// The bits of a half float. Subnormal halves become 0.
inline std::uint32_t to_half(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    const std::uint32_t sign = bits >> 16 & 0x8000U, size = bits & 0x7fffffffU;
    const std::uint32_t half = (size - (112U << 23) + 0x1000U) >> 13;
    return sign | (size < (113U << 23) ? 0 : half);
}

/// @param clearances  two half floats a post: the upper limb in the low half
/// @param fractions   visible fraction of the disc (low byte) and coverage, 0 to 255
void encode_shadows(const light::ClearanceRun& run, std::uint32_t* clearances,
                    std::uint16_t* fractions);

}  // namespace relevo::render
