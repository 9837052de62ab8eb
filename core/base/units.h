#pragma once

#include <limits>
#include <numbers>

namespace relevo {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kDegree_rad = kPi / 180.0;            ///< one degree [rad]
inline constexpr double kArcsecond_rad = kDegree_rad / 3600;  ///< one second of arc [rad]
inline constexpr double kFoot_m = 0.3048;                     ///< international foot (exact, 1959)
inline constexpr double kUsSurveyFoot_m = 1200.0 / 3937.0;    ///< US survey foot (exact, 1893)
inline constexpr double kDegree_m = 111'195;                  ///< one degree of a great circle [m]
inline constexpr double kHour_s = 3600;
inline constexpr double kDay_s = 86400;
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

constexpr double radians(double degrees) {
    return degrees * kDegree_rad;
}

constexpr double degrees(double radians) {
    return radians / kDegree_rad;
}

}  // namespace relevo
