#pragma once

#include <functional>
#include <optional>

#include "gl/framebuffer.h"
#include "gl/texture.h"
#include "render/frame_block.h"

namespace relevo::render {

/// Measures the height of the drawn ground on the vertical through an eye. Draws the ground from
/// above into one pixel with the frame's own program, so that level of detail and displacement are
/// included.
class GroundProbe {
  public:
    /// Camera straight down from an eye through one pixel; selects the tiles.
    /// @param camera       of the frame
    /// @param tolerance    LodView::tolerance of the frame
    /// @param pixel_error  of the terrain; 0 draws every post
    static scene::Camera camera_below(const scene::Camera& camera, const geo::LocalFrame& frame,
                                      double tolerance, double pixel_error);

    /// Sets an orthographic projection of the vertical through the eye, with heights as depths.
    void aim(const FrameInputs& inputs, const Ground& ground, EyeBlock& block);

    /// Calls `draw` with the pixel as target. @returns height of the highest ground [m],
    /// ellipsoidal and exaggerated; accurate to 1 cm within a height range of 20 km
    /// (tests/session/test_standing.cpp). nullopt without ground.
    /// @param has_voids  clips the ground at voids
    std::optional<double> height_m(bool has_voids, const std::function<void()>& draw);

  private:
    gl::Texture depth_;
    gl::Framebuffer target_;
    double lowest_m_ = 0, range_m_ = 1;  // lowest_m_: height of depth 0; range_m_: of depths 0 to 1
};

}  // namespace relevo::render
