#include "session/srgb16.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/srgb.h"

namespace relevo::session {
namespace {

std::array<float, 65536> make_table() {
    std::array<float, 65536> values{};
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = static_cast<float>(linear_of_srgb(static_cast<double>(i) / kMost16));
    return values;
}

}  // namespace

float decoded(std::uint16_t srgb) {
    static const std::array<float, 65536> table = make_table();
    return table[srgb];
}

std::uint16_t encoded(float linear) {
    const float v = std::clamp(linear, 0.0F, 1.0F);
    // srgb_of_linear() in single precision, for every pixel.
    const float srgb = v <= 0.0031308F ? 12.92F * v : 1.055F * std::pow(v, 1 / 2.4F) - 0.055F;
    return static_cast<std::uint16_t>(std::lround(kMost16 * srgb));
}

}  // namespace relevo::session
