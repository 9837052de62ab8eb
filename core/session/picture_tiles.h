#pragma once

#include <vector>

#include <glm/vec2.hpp>

/// The frames that a picture is drawn in: tiles of one that is larger than a frame, and samples
/// within its pixels.
namespace relevo::session {

/// A rectangle of a picture [px], from its lower left corner.
struct PictureRect {
    glm::ivec2 corner{0}, size{0};
    bool operator==(const PictureRect&) const = default;
};

/// A tile and the frame that it is cut out of, which is wider by a margin, except at the edges of
/// the picture: full-screen effects read the pixels around a pixel.
struct PictureTile {
    PictureRect rect, frame;
};

/// Corners of frames are multiples of this: effects have textures of halved sizes, and patterns
/// that repeat [px].
inline constexpr int kTileStep_px = 64;

/// A picture in rows of tiles, the top row first, each from left to right. The tiles of a row have
/// the same height.
/// @param side_px    of tiles, a multiple of kTileStep_px
/// @param margin_px  a multiple of kTileStep_px
std::vector<PictureTile> tiles_of(const glm::ivec2& picture_px, int side_px, int margin_px);

/// Where the samples of a pixel are, from its centre [px], each in -0.5 to 0.5; their mean is 0. Of
/// any number of samples no two share a row or column of the grid of as many cells a side.
/// Source: Hammersley points; M. Pharr et al., Physically Based Rendering, 3rd edition, 7.4.
std::vector<glm::dvec2> sample_offsets(int samples);

}  // namespace relevo::session
