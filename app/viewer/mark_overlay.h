#pragma once

#include <memory>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "chart/drawing.h"
#include "gl/texture.h"
#include "image/image.h"
#include "viewer/picture.h"

namespace relevo::viewer {

/// Draws a picture's marks on an image of it, as session::Session::picture() does.
/// @param taken  where none may stand, in pixels
void add_marks(const Picture& picture, std::span<const chart::Rect> taken, image::Image8& image);

/// The marks of a picture over the window, in the layout that a capture of the window's size has.
class MarkOverlay {
  public:
    /// @param picture  not null
    /// @param size_px  of the window
    /// @param from, to  where marks may stand, in fractions of the window's width
    /// @param size      of the window, in units of panels
    /// @param taken     where none may stand, in units of panels
    void draw(const std::shared_ptr<const Picture>& picture, glm::ivec2 size_px, float from,
              float to, glm::vec2 size, std::span<const chart::Rect> taken);

  private:
    std::weak_ptr<const Picture> of_;
    glm::ivec2 size_px_{0};
    glm::vec2 sides_{0};
    std::vector<chart::Rect> taken_;
    gl::Texture texture_;
};

}  // namespace relevo::viewer
