#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

// Heights of contour lines, as contours.glsl has them.

namespace contours {

inline constexpr double kLines = 25;  // over the DEM's relief, about

/// 1, 2 or 5 times a power of ten.
inline double rounded(double wanted_m) {
    const double power = std::pow(10.0, std::floor(std::log10(wanted_m)));
    const double first = wanted_m / power;
    return power * (first < 1.414 ? 1 : first < 3.162 ? 2 : first < 7.071 ? 5 : 10);
}

/// Height from line to line [m].
/// @param asked_m   the parameter; 0: by the relief
/// @param relief_m  of the DEM
inline double interval(double asked_m, double relief_m) {
    return asked_m > 0 ? asked_m : rounded(std::max(relief_m / kLines, 0.1));
}

/// "1200 m"; with the decimals that multiples of `step_m` need, three at most.
inline std::string text_of(double level_m, double step_m) {
    int decimals = 0;
    for (double rest = step_m; decimals < 3 && std::abs(rest - std::round(rest)) > 1e-6; rest *= 10)
        ++decimals;
    char text[48];
    std::snprintf(text, sizeof text, "%.*f m", decimals, level_m);
    return text;
}

}  // namespace contours
