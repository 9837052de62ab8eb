#pragma once

#include "image/ktx.h"

namespace relevo::ground {

/// Cells of the lattice across the volume in its coarsest octave; the next two have 2 and 4 times
/// as many.
inline constexpr int kVolumeCells = 8;
inline constexpr int kVolumeOctaves = 3;

/// Perlin's improved noise in a volume of n^3 texels that repeats in all three directions: what
/// layering adds to the limits between grounds. R8 with a full mip chain.
///
/// value = 0.5 + noise / (2 peak): mean 0.5 (to 1/2000), least and greatest 0 and 1 at level 0. The
/// octaves halve in strength. n = 128 has four texels to a cell of the finest octave, enough for
/// trilinear filtering to follow it (tests/ground/test_volume.cpp).
/// @param n  a power of two, at least 32
image::TextureData perlin_texture(int n);

}  // namespace relevo::ground
