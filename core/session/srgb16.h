#pragma once

#include <cstdint>

/// sRGB with 16 bits, and linear light. Source: IEC 61966-2-1.
namespace relevo::session {

inline constexpr float kMost16 = 65535;

/// Linear light, 0 to 1.
float decoded(std::uint16_t srgb);
/// The nearest value of a light, which is clamped to 0 to 1.
std::uint16_t encoded(float linear);

}  // namespace relevo::session
