#pragma once

/// Numbers that figures are asked for with, for every front end: default, least and most.
namespace relevo::figure {

struct Option {
    double value, min, max;
};

inline constexpr Option kTerrestrialRefraction{0.13, -1, 0.9};
inline constexpr Option kHighest_m{8850, -500, 8850};  ///< without it: the DEM's highest post
inline constexpr Option kStep_s{180, 1, 3600};
inline constexpr Option kLinke{3, 1, 10};
inline constexpr Option kAlbedo{0.2, 0, 1};
inline constexpr Option kTilt_deg{0, 0, 90};
inline constexpr Option kAzimuth_deg{0, 0, 360};  ///< without a default for a tilt above 0
inline constexpr Option kSkyDirections{36, 4, 3600};
inline constexpr Option kHorizonDirections{36, 1, 720};

}  // namespace relevo::figure
