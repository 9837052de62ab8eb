#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dem/heightfield.h"
#include "web/container.h"
#include "web/far_horizons.h"

namespace relevo::web {

/// Pages are flat, and have one sun for each corner.
inline constexpr double kLongest_m = 300e3;

/// @throws Error (BadInput) for a DEM of longer sides, and for one whose rows do not run along x or
///     y of its CRS
void check_grid(const dem::Grid& grid);

/// Heights of a page, and what is computed of them.
struct PageGround {
    dem::Grid grid;             ///< of its posts
    double height_error_m = 0;  ///< of the stored heights, at most
    std::string about;          ///< a JSON object
    std::vector<Block> blocks;  ///< heights, sky_view, and far where ground is around

    double bytes() const;  ///< of the blocks
};

/// Bytes that a ground takes in a page, about: quicker than page_ground(), and without ground
/// around.
double bytes_of(const dem::Heightfield& ground);

/// @param ground  north-up, NaN in voids
/// @param far     of ground around, by the same posts or others; null: none
/// @throws Error (BadInput) where the CRS has no place for a post
PageGround page_ground(const dem::Heightfield& ground, const FarHorizons* far);

}  // namespace relevo::web
