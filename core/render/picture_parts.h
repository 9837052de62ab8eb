#pragma once

#include <vector>

#include <glm/vec2.hpp>

namespace relevo::render {

/// A rectangle of pixels. Row 0 is the lowest one.
struct PixelRectangle {
    int left = 0, bottom = 0, width = 0, height = 0;
    bool operator==(const PixelRectangle&) const = default;
};

/// Which parts of a picture a pass has to draw with its whole program. The parts are squares; all
/// others are drawn with its plain one.
class PictureParts {
  public:
    static constexpr int kSide_px = 32;

    PictureParts(int width_px, int height_px);  ///< all are plain

    /// Makes parts whole that a rectangle touches. It may lie beside the picture.
    void mark(const glm::dvec2& low_px, const glm::dvec2& high_px);
    void mark_all();
    bool is_whole(int column, int row) const;

    /// The whole or the plain parts as few rectangles. Together both are the picture, each pixel
    /// once.
    std::vector<PixelRectangle> rectangles(bool whole) const;

  private:
    int width_px_, height_px_, columns_, rows_;
    std::vector<bool> whole_;  // by row
};

}  // namespace relevo::render
