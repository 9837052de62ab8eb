#pragma once

#include <functional>

#include "image/image.h"

namespace relevo::session {

/// What a function draws on a picture, as RGBA with straight alpha. Found by drawing it on black
/// and on white; it may only blend, and its places may depend on the picture's size alone.
image::Image8 drawn_alone(int width_px, int height_px,
                          const std::function<void(image::Image8&)>& draw);

/// Draws on a picture of 8 or 16 bits, also where it is transparent.
/// @param draw  as drawn_alone()
void annotate(image::Picture& picture, const std::function<void(image::Image8&)>& draw);

/// Lays an image with straight alpha over a picture of the same size, which may be transparent too.
void lay_over(const image::Image8& over, image::Image8& picture);
void lay_over(const image::Image8& over, image::Image16& picture);

}  // namespace relevo::session
