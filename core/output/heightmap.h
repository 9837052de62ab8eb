#pragma once

#include "base/array2d.h"
#include "base/output_file.h"
#include "dem/heightfield.h"
#include "image/image.h"

/// Heights and normals as images, as game engines and 3-D programs read them.
namespace relevo::output {

/// What whole numbers of a heightmap mean: height = offset + step * value.
struct HeightScale {
    double offset_m = 0;
    double step_m = 1;
};

inline constexpr int kMostValue = 65535;

/// The scale whose values 0 and kMostValue are the lowest and the highest height; steps of 1 m of
/// a plain.
HeightScale height_scale(double lowest_m, double highest_m);

/// Heights in whole steps, within half a step; voids are 0.
/// @param height_m  within the scale
image::Image16 heightmap(const Array2d<float>& height_m, const HeightScale& scale);

/// Writes values without a header, rows from the top, two bytes each, the low one first; all of the
/// file but finish().
void write_raw(OutputFile& file, const image::Image16& values);

/// Which way green grows in a normal map.
enum class Green {
    Up,    ///< to the upper edge: OpenGL, Unity, Blender, glTF
    Down,  ///< to the lower edge: DirectX, Unreal Engine
};

/// Unit normals of the ground as RGB: x to the right (east), y up the map (north), z up, -1 to 1 as
/// 0 to 65535. Central differences of the posts, one-sided beside voids and at edges, over the
/// ground metres between them in each row. Voids have (0, 0, 1).
image::Image16 normal_map(const dem::Heightfield& field, Green green);

/// The same with eight bits, -1 to 1 as 0 to 255.
image::Image8 to_8_bits(const image::Image16& normals);

}  // namespace relevo::output
