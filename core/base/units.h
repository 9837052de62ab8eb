#pragma once

#include <numbers>

namespace relevo {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kDegree_rad = kPi / 180.0;            ///< one degree [rad]
inline constexpr double kArcsecond_rad = kDegree_rad / 3600;  ///< one second of arc [rad]
inline constexpr double kFoot_m = 0.3048;                     ///< international foot (exact, 1959)
inline constexpr double kUsSurveyFoot_m = 1200.0 / 3937.0;    ///< US survey foot (exact, 1893)

constexpr double radians(double degrees) {
    return degrees * kDegree_rad;
}

constexpr double degrees(double radians) {
    return radians / kDegree_rad;
}

}  // namespace relevo
