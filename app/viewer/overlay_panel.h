#pragma once

#include "gl/texture.h"
#include "viewer/state.h"

namespace relevo::viewer {

/// What colours on the ground mean, at the right edge, under the north arrow.
class LegendPicture {
  public:
    /// @param size_px    of the window
    /// @param top_px     that is taken by a menu
    /// @param px_a_unit  of the drawing, whose letters are about 12 units high
    void draw(const std::vector<chart::Legend>& legends, glm::vec2 size_px, float top_px,
              double px_a_unit);

  private:
    std::vector<chart::Legend> of_;
    double px_a_unit_ = 0;
    std::vector<gl::Texture> textures_;  // one for each
};

}  // namespace relevo::viewer
