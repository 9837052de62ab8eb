#pragma once

/// What loops over all posts of a DEM can do for several of them at once.
namespace relevo::light {

constexpr float kHalfPi = 1.57079632679489662F;

/// Arc tangent of a number that is not negative.
/// Accuracy: 2e-7 (tests/light/test_horizons.cpp).
/// Source: Abramowitz and Stegun, Handbook of Mathematical Functions (1964), 4.4.49.
inline float quick_atan(float t) {
    const bool steep = t > 1;
    const float x = steep ? 1 / t : t;
    const float y = x * x;
    float sum = 0.0028662257F;
    sum = sum * y - 0.0161657367F;
    sum = sum * y + 0.0429096138F;
    sum = sum * y - 0.0752896400F;
    sum = sum * y + 0.1065626393F;
    sum = sum * y - 0.1420889944F;
    sum = sum * y + 0.1999355085F;
    sum = sum * y - 0.3333314528F;
    sum = (sum * y + 1) * x;
    return steep ? kHalfPi - sum : sum;
}

}  // namespace relevo::light
