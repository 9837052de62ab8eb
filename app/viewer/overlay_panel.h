#pragma once

#include "gl/texture.h"
#include "viewer/state.h"

namespace relevo::viewer {

/// What the overlay's colours mean, at the right edge, under the north arrow.
class LegendPicture {
  public:
    /// @param size_px    of the window
    /// @param top_px     that is taken by a menu
    /// @param px_a_unit  of the drawing, whose letters are about 12 units high
    void draw(const State& state, glm::vec2 size_px, float top_px, double px_a_unit);

  private:
    std::shared_ptr<const OverlayShown> of_;
    double px_a_unit_ = 0;
    gl::Texture texture_;
};

}  // namespace relevo::viewer
