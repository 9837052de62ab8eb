#pragma once

#include "dem/quick_look.h"
#include "image/image.h"

namespace relevo::chart {

/// A small picture of heights, colours by height and shaded from the north-west, without a device:
/// for thumbnails.
/// @param longest_px  the picture's longer side
/// @returns RGBA; voids are transparent
image::Image8 shaded_relief(const dem::QuickLook& look, int longest_px);

}  // namespace relevo::chart
