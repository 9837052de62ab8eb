#pragma once

#include "gl/texture.h"
#include "render/frame_block.h"

namespace relevo::render {

/// A footprint as shaders/lib/floor.glsl reads it: blurred a little, and more.
gl::Texture footprint_texture(const Footprint& footprint);

}  // namespace relevo::render
