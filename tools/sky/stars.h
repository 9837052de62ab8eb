#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "image/ktx.h"

namespace relevo::skymaker {

/// A row of stars.csv.
struct Star {
    int hr = 0;                 ///< number in the Bright Star Catalogue
    glm::dvec3 direction{0};    ///< unit, ICRS (J2000), with its proper motion up to kStarEpoch
    double magnitude = 0;       ///< visual
    std::optional<double> b_v;  ///< colour index, where it was measured
};

/// Julian year of the places. 61 Cygni moves by 5.2 arcsec a year, half of the stars by less than
/// 0.05.
inline constexpr double kStarEpoch = 2030;

/// @throws Error (BadInput) for a file that is not such a table
std::vector<Star> read_stars(const std::filesystem::path& path);

/// How stars lie in their texture. A shader finds them with the same formulas
/// (plugins/sky/sky.glsl).
///
/// The sphere is unfolded onto the square as an octahedron. Each of kAcross x kAcross cells has a
/// column of texels with the stars that it may show, brightest first, then zeros. A texel is the
/// star's direction minus that of the cell's centre, and its code.
struct StarLayout {
    static constexpr int kAcross = 96;
    /// How far beyond a cell a star is still in its column: it may reach across the border.
    static constexpr double kReach_deg = 1.0;
    static constexpr double kBrightestMag = -1.5, kMagStep = 0.0625;
    static constexpr double kBluest = -0.35, kBvStep = 0.15;

    /// 1 + 16 * steps of magnitude + steps of colour: 1 to 2048, exact in a half float.
    static int code_of(double magnitude, double b_v);
    static double magnitude_of(int code);
    static double b_v_of(int code);

    /// Direction of the middle of a cell, unit.
    static glm::dvec3 centre_of(int x, int y);
    /// The cell that a direction falls into.
    static void cell_of(const glm::dvec3& direction, int& x, int& y);
};

/// A volume of half floats, as deep as its fullest cell needs.
image::TextureData star_texture(const std::vector<Star>& stars);

/// Linear sRGB of luminance 1 of a star's light, the sun's being white: a black body.
/// Source: F. J. Ballesteros, New insights into black bodies, EPL 97 (2012) 34008, eq. 14, for the
/// temperature by B-V.
glm::dvec3 star_colour(double b_v);

}  // namespace relevo::skymaker
