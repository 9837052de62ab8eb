#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "image/image.h"

/// Frames in 256 colours, for GIF.
namespace relevo::film {

/// 0xRRGGBB.
using Palette = std::array<std::uint32_t, 256>;

/// The colours of a frame by median cut: the box of colours with the most pixels times its longest
/// side is halved at its median until there are 256.
/// P. Heckbert, Color image quantization for frame buffer display, SIGGRAPH 1982.
/// @param frame  RGB or RGBA
Palette median_cut(const image::Image8& frame);

/// For each pixel the number of the palette's nearest colour, after ordered dithering. Still parts
/// of a film have the same pattern in all frames.
std::vector<std::uint8_t> dithered(const image::Image8& frame, const Palette& palette);

}  // namespace relevo::film
