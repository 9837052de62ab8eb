#pragma once

#include "gl/texture.h"
#include "image/image.h"

namespace relevo::viewer {

/// A picture that panels show: RGB, or RGBA with straight alpha; rows from above, as ImGui has
/// them.
gl::Texture texture_of(const image::Image8& picture);

}  // namespace relevo::viewer
