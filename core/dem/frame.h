#pragma once

#include <optional>
#include <vector>

#include "base/array2d.h"

namespace relevo::dem {

/// One height all around the edge of a DEM that does not go with the ground inside.
struct Frame {
    float height_m = 0;
    double step_m = 0;  ///< median, from the frame to the ground beside it
};

/// Finds what is left around a raster that was turned or cut without a nodata value: the edge is of
/// one height at 19 of 20 posts and in all corners, and where that height ends, half of the steps
/// to the next post are higher than 20 m. An island in its sea has a beach.
std::optional<Frame> find_frame(const Array2d<float>& height_m);

/// The same in parts, for a DEM that memory does not hold. First its edge:
class FrameEdge {
  public:
    /// @param height_m  of a corner
    explicit FrameEdge(float height_m) : height_m_(height_m) {}
    /// The first and the last row, the first and the last column, one after the other.
    void add(const Array2d<float>& line_m);
    bool may_be_frame() const;
    float height_m() const { return height_m_; }

  private:
    float height_m_;
    bool corners_ = true;
    double posts_ = 0, like_corner_ = 0;
};

/// Then, where that may be a frame, what is inside.
class FrameSteps {
  public:
    explicit FrameSteps(float height_m) : height_m_(height_m) {}
    /// Parts that share their last column and row with the next ones.
    void add(const Array2d<float>& part_m);
    std::optional<Frame> frame();

  private:
    float height_m_;
    std::vector<float> steps_m_;
};

}  // namespace relevo::dem
