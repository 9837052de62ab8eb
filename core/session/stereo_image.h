#pragma once

#include "image/image.h"

/// Pictures of two eyes in one.
namespace relevo::session {

/// @param left, right  of one size and kind
image::Picture side_by_side(const image::Picture& left, const image::Picture& right);

/// For glasses with a red filter on the left and a cyan one on the right. Grey stays grey.
/// Source: E. Dubois, Conversion of a Stereo Pair to Anaglyph with the Least-Squares Projection
/// Method, University of Ottawa, 2009.
/// @param left, right  of one size and kind, Image16 or ImageF, RGB
image::Picture anaglyph(const image::Picture& left, const image::Picture& right);

}  // namespace relevo::session
