#pragma once

#include "gl/texture.h"
#include "render/frame_block.h"

namespace relevo::render {

/// Texture for shaders/lib/floor.glsl. R: footprint with a narrow blur; G: with a wide blur.
gl::Texture footprint_texture(const Footprint& footprint);

}  // namespace relevo::render
