#pragma once

#include <functional>
#include <optional>

#include "gl/framebuffer.h"
#include "gl/texture.h"
#include "render/frame_block.h"

namespace relevo::render {

/// Measures the height of the drawn ground on the vertical through an eye. The ground is drawn
/// there, one pixel wide and from above, with the program of the picture: so all that places a
/// vertex counts, such as the level of detail and effects that displace.
class GroundProbe {
  public:
    /// Looks straight down from an eye through one pixel: the view that selects the tiles.
    /// @param tolerance    of the picture's view, LodView::tolerance
    /// @param pixel_error  of the terrain; 0 draws every post
    static scene::Camera camera_below(const scene::Camera& picture, const geo::LocalFrame& frame,
                                      double tolerance, double pixel_error);

    /// Has a frame's block show the vertical through its eye, and heights as depths.
    void aim(const FrameInputs& inputs, const Ground& ground, FrameBlock& block);

    /// Draws into the pixel. @returns the height of the highest ground drawn [m]: ellipsoidal,
    /// exaggerated; accurate to 1 cm of a range of heights of 20 km
    /// (tests/session/test_standing.cpp). None where none is drawn.
    /// @param has_voids  the ground is clipped at them
    std::optional<double> height_m(bool has_voids, const std::function<void()>& draw);

  private:
    gl::Texture depth_;
    gl::Framebuffer target_;
    double lowest_m_ = 0, range_m_ = 1;  // heights of depths 0 and 1
};

}  // namespace relevo::render
