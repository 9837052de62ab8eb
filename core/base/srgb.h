#pragma once

#include <cmath>

namespace relevo {

/// Linear light of an sRGB-encoded value, both from 0 to 1. Source: IEC 61966-2-1.
inline double linear_of_srgb(double value) {
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

/// The sRGB encoding of linear light, both from 0 to 1. Source: as linear_of_srgb().
inline double srgb_of_linear(double value) {
    return value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1 / 2.4) - 0.055;
}

}  // namespace relevo
