#pragma once

/// Numbers that figures are asked for with, for every front end.
namespace relevo::figure {

struct Range {
    double value, min, max;  ///< default, both ends
};
struct Option : Range {
    const char* key;   ///< of the library; of the command line with hyphens
    const char* help;  ///< of the command line
};

inline constexpr Option kTerrestrialRefraction{
    {0.13, -1, 0.9},
    "terrestrial_refraction",
    "Terrestrial refraction: curvature of a line of sight in units of the Earth's (0.13)"};
/// Without it: the DEM's highest post.
inline constexpr Option kHighest_m{
    {8850, -500, 8850},
    "highest",
    "Upper bound of the terrain outside the DEM, m (the DEM's highest post)"};
inline constexpr Option kHighestAtPoint_m{{8850, -12000, 9000}, "highest", kHighest_m.help};
inline constexpr Option kStep_s{{180, 1, 3600}, "step", ""};
inline constexpr Option kLinke{
    {3, 1, 10}, "linke", "Linke turbidity for irradiation: 2 clean, 3 country, 5 city (3)"};
inline constexpr Option kAlbedo{
    {0.2, 0, 1}, "albedo", "Albedo of the ground for irradiation: 0.2 grass, 0.8 snow (0.2)"};
inline constexpr Option kTilt_deg{{0, 0, 90}, "tilt", ""};
inline constexpr Option kAzimuth_deg{{0, 0, 360}, "azimuth", ""};  ///< needed for a tilt above 0
inline constexpr Option kSkyDirections{
    {36, 4, 3600}, "directions", "Number of azimuths around each post (36)"};
/// Without it: all posts, and no means.
inline constexpr Option kHalo_km{{0, 0.1, 1000},
                                 "halo",
                                 "Posts only so many km around a tile, ground beyond as means, "
                                 "exact to 0.1 degrees (all posts)"};
inline constexpr Option kHorizonDirections{{36, 1, 720}, "directions", kSkyDirections.help};

}  // namespace relevo::figure
