#pragma once

#include <vector>

#include "chart/drawing.h"
#include "chart/legend.h"
#include "gl/texture.h"
#include "viewer/state.h"

namespace relevo::viewer {

/// Draws the legends at the right edge, under the north arrow.
class LegendPicture {
  public:
    /// Sets what draw() draws.
    /// @param picture    without what panels cover
    /// @param px_a_unit  pixels per unit of the legends, whose text is about 12 units high
    void update(const std::vector<chart::Legend>& legends, const Area& picture, double px_a_unit);
    void draw() const;
    /// Where they are in the window.
    const std::vector<chart::Rect>& places() const { return places_; }

  private:
    std::vector<chart::Legend> of_;
    double px_a_unit_ = 0;
    std::vector<gl::Texture> textures_;  // one for each
    std::vector<chart::Rect> places_;    // the same
};

}  // namespace relevo::viewer
