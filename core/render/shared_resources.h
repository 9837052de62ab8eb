#pragma once

#include "render/effect_textures.h"
#include "render/program_cache.h"
#include "render/texture_pool.h"

namespace relevo::render {

/// What renderers of one context share, so that one which follows another links no program, uploads
/// no texture and allocates no frame that the other had. Must outlive them.
struct SharedResources {
    ProgramCache programs;
    TexturePool targets;
    EffectTextureCache textures;
};

}  // namespace relevo::render
