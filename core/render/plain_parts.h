#pragma once

#include "render/picture_parts.h"

namespace relevo::render {

struct PassContext;

/// Pixels on the ground at least this wide are drawn without what HAS_near has [m].
inline constexpr double kNearPixel_m = 24;

/// Parts whose ground may have water, or pixels narrower than kNearPixel_m: the plain program of
/// the ground lacks HAS_water and HAS_near.
PictureParts parts_of_ground(PassContext& frame);

/// Parts with some of the moon's disc or the sun's corona, or all where the moon lights the air:
/// the plain program of the sky has NO_MOON.
PictureParts parts_of_sky(PassContext& frame);

}  // namespace relevo::render
