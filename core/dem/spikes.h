#pragma once

#include <cstdint>

#include <glm/vec2.hpp>

#include "base/array2d.h"
#include "dem/grid.h"

namespace relevo::dem {

/// Posts that stick out of their surroundings as no ground does.
struct Spikes {
    std::int64_t count = 0;
    double limit_m = 0;  ///< more than this above, or below, each neighbour
    int worst_column = 0;
    int worst_row = 0;
    double worst_m = 0;  ///< how far the worst one is from its nearest neighbour in height

    /// Adds those of another window of the same DEM. The place of the worst stays that of this
    /// window.
    Spikes& operator+=(const Spikes& other);
};

/// Looks for single posts that are higher than all of their eight neighbours, or lower, by more
/// than six post spacings (a slope of 80 degrees on all sides), at least 100 m so that trees, masts
/// and chimneys stay, and at most 1500 m, which no kilometre of the Earth rises on all sides.
/// Posts with fewer than three valid neighbours are left out.
Spikes find_spikes(const Array2d<float>& height_m, const glm::dvec2& post_spacing_m);

/// Among the posts of a window; those around it are neighbours all the same.
Spikes find_spikes(const Array2d<float>& height_m, const glm::dvec2& post_spacing_m,
                   const Window& window);

}  // namespace relevo::dem
