#pragma once

#include "image/ktx.h"

namespace relevo::ground {

/// How ground varies from place to place, from a few texels to a sixth of the tile: what layering
/// changes the materials' colours by, so that a landscape is not one lawn. n x n texels, RGBA8 with
/// a full mip chain, periodic.
///
/// R and A are tones, G is a hue (dry or lush), all with mean 0.5 (to 1/500) and a standard
/// deviation of 0.16: R and G in broad patches with ever finer detail, A in small ones. B is where
/// shrubs stand, 0 or 1 with soft rims, over 0.2 to 0.4 of the tile, in groups.
/// @param n  a power of two, at least 64
image::TextureData patches_texture(int n);

/// The same in half floats, less 0.5, for what is moved by it and not only coloured: 8 bits are
/// filtered to steps, and a step of 1/255 is 50 m of ground where regions push patches about.
image::TextureData regions_texture(int n);

}  // namespace relevo::ground
