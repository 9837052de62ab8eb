#pragma once

#include <array>
#include <cstdint>

#include "base/array2d.h"
#include "dem/heightfield.h"

namespace relevo::dem {

/// What a post of a surface model stands on.
enum class SurfaceKind : std::uint8_t {
    Ground,  ///< open: meadows, rock, water
    Street,  ///< ground between houses
    Wall,    ///< between a roof and the ground, or two roofs
    Roof,
    Canopy,  ///< trees and shrubs
};

/// What stands on the ground, in a DEM that has houses and trees in its heights.
struct Surface {
    Array2d<SurfaceKind> kind;    ///< of the posts; Ground in voids
    Array2d<std::uint8_t> house;  ///< a random number for each house, on its roof and walls; else 0
    std::array<double, 5> share{};  ///< of the posts that have a height, by kind
};

/// Posts farther apart show neither houses nor trees [m].
inline constexpr double kSurfacePosts_m = 4;

/// Tells houses, streets and trees from the ground by heights alone.
///
/// What is narrower than 80 m, above the ground around it and steep along half of its rim at least
/// stands on the ground (morphological opening, K. Zhang et al. 2003): crests and cliffs go over
/// into it on some side. Of that roofs are where the highest heights near each post are even, since
/// ridges are level and crowns are not, or where heights are smooth; small ones that stand alone
/// are crowns. Streets are ground with houses around.
/// @param heights_m  NaN for holes
/// @param grid       of as many posts, at most kSurfacePosts_m apart
Surface find_surface(const Array2d<float>& heights_m, const Grid& grid);

/// Whether a DEM looks as if it had houses in its heights: some of its ground is roofs that stand
/// in walls. Of large ones a window in the middle is asked.
bool looks_like_surface(const Array2d<float>& heights_m, const Grid& grid);

}  // namespace relevo::dem
