#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/array2d.h"
#include "dem/grid.h"

namespace relevo::dem {

/// One height all around the edge of a DEM that does not go with the ground inside.
struct Collar {
    float height_m = 0;
    double step_m = 0;  ///< median, from the collar to the ground beside it
};

/// Finds what is left around a raster that was turned or cut without a nodata value: the edge is of
/// one height at 19 of 20 posts and in all corners, and where that height ends, half of the steps
/// to the next post are higher than 20 m. An island in its sea has a beach.
std::optional<Collar> find_collar(const Array2d<float>& height_m);

/// The same heights with NaN at the collar: at posts of its height that hang together, by their
/// sides, with the edge.
Array2d<float> without_collar(Array2d<float> height_m, const Collar& collar);

/// The same in parts, for a DEM that memory does not hold. First its edge: the first and the last
/// row, the first and the last column.
class CollarEdge {
  public:
    /// @param height_m  of a corner
    /// @param posts     of all four lines, corners twice
    CollarEdge(float height_m, std::int64_t posts) : height_m_(height_m), posts_(posts) {}
    void add_corner(float height_m) { corners_ = corners_ && height_m == height_m_; }
    void add(std::span<const float> posts_m);
    /// So many posts of one height.
    void add(float height_m, std::int64_t posts);
    /// Whether it is one, as far as it is known; once false it remains so.
    bool may_be_collar() const;
    float height_m() const { return height_m_; }

  private:
    float height_m_;
    std::int64_t posts_;
    bool corners_ = true;
    std::int64_t others_ = 0;  // not like the corner
};

/// Then, where that may be a collar, what is inside.
class CollarSteps {
  public:
    explicit CollarSteps(float height_m) : height_m_(height_m) {}
    /// Parts that share their last column and row with the next ones.
    void add(const Array2d<float>& height_m, const Window& part);
    std::optional<Collar> collar();

  private:
    float height_m_;
    std::vector<float> steps_m_;  // every so manyth of them
    int every_ = 1;
    int left_out_ = 0;
};

}  // namespace relevo::dem
