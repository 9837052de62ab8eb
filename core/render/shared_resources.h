#pragma once

#include "render/effect_textures.h"
#include "render/line_textures.h"
#include "render/program_cache.h"
#include "render/texture_pool.h"

namespace relevo::render {

/// Objects that renderers of a context share, so that a new one reuses programs, textures and
/// targets. Must outlive them.
struct SharedResources {
    ProgramCache programs;
    TexturePool targets;
    EffectTextureCache textures;
    LineTextureCache lines;
};

}  // namespace relevo::render
