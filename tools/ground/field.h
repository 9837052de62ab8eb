#pragma once

#include <functional>

#include <glm/glm.hpp>

#include "base/array2d.h"

/// Quantities over one tile, which is a torus: what leaves at one edge comes in at the other.
/// Column c, row r of n stand for s = (c + 0.5) / n, t = (r + 0.5) / n; row 0 is the bottom.
namespace relevo::ground {

using Field = Array2d<float>;
using ColourField = Array2d<glm::vec3>;  ///< linear sRGB (BT.709 primaries, D65), reflectance 0..1

/// A field of n x n texels filled in parallel by value(s, t), 0 <= s, t < 1.
Field make_field(int n, const std::function<float(float s, float t)>& value);

/// The same in n/4 x n/4 texels, for what varies slowly; to be read with sample().
Field make_coarse_field(int n, const std::function<float(float s, float t)>& value);

/// Calls body(column, row) for all n x n texels in parallel.
void for_each_texel(int n, const std::function<void(int column, int row)>& body);

/// The value at (s, t), bilinear between texel centres, wrapped.
float sample(const Field& field, float s, float t);

/// The same with a quadratic B-spline: smooth in its slope, a little blurred. For fields that bend
/// others or that are heights.
float smooth_sample(const Field& field, float s, float t);

double mean(const Field& field);

/// Gaussian blur on the torus by a standard deviation in texels, cut off at 3.5 of it.
Field blurred(const Field& field, double sigma_px);

/// Takes out what makes a tile visible when it is repeated: waves of up to four cycles a tile are
/// gone, those of eight and more, in whatever direction, are left as they are, with a smooth
/// passage between. The mean stays.
void flatten(Field& field);

/// The share of a wave that flatten() leaves, by its cycles a tile.
double flatten_gain(double cycles);

}  // namespace relevo::ground
