#include "session/srgb16.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace relevo::session {
namespace {

std::array<float, 65536> make_table() {
    std::array<float, 65536> values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double v = static_cast<double>(i) / kMost16;
        values[i] =
            static_cast<float>(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
    }
    return values;
}

}  // namespace

float decoded(std::uint16_t srgb) {
    static const std::array<float, 65536> table = make_table();
    return table[srgb];
}

std::uint16_t encoded(float linear) {
    const float v = std::clamp(linear, 0.0F, 1.0F);
    const float srgb = v <= 0.0031308F ? 12.92F * v : 1.055F * std::pow(v, 1 / 2.4F) - 0.055F;
    return static_cast<std::uint16_t>(std::lround(kMost16 * srgb));
}

}  // namespace relevo::session
