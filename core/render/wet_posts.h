#pragma once

#include <cstdint>

#include <glm/vec2.hpp>

#include "base/array2d.h"
#include "dem/water.h"

namespace relevo::render {

/// Where a DEM has water, for any rectangle of posts in constant time: sums over squares of posts.
class WetPosts {
  public:
    static constexpr int kSide = 8;  ///< posts of a square

    explicit WetPosts(const Array2d<dem::WaterKind>& kind);

    /// True if squares that a rectangle touches have water.
    /// @param first, last  posts, also beyond the DEM's edge
    bool any(const glm::ivec2& first, const glm::ivec2& last) const;

  private:
    glm::ivec2 squares_;
    Array2d<std::int32_t> below_;  // wet squares left of a column and above a row
};

}  // namespace relevo::render
