#pragma once

#include <array>
#include <functional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "geo/local_frame.h"

namespace relevo::render {

/// A tile proxy grid: polynomials for the position and the vertical of the posts of a rectangular
/// part of a raster on the curved Earth. The vertex program needs no map projection. With u along
/// columns and v along rows, both 0..1, a post of height h is at
///
///     centre + sum over i, j of position[3 j + i] u^i v^j + h (n0 + u nu + v nv),  i, j = 0..2
///
/// in the DEM's local frame [m]. The biquadratic interpolates 3 x 3 exact positions, so that
/// neighbours agree along their common side. If some posts are off the Earth, it is a least-squares
/// fit to the others. Error: below 1 % of the post spacing for parts up to 200 km; it grows with
/// the cube of the side (tests/render/test_patch_net.cpp prints it).
struct PatchNet {
    glm::dvec3 centre_m;                   ///< exact position of the centre
    std::array<glm::dvec3, 9> position_m;  ///< coefficients of u^i v^j at 3 j + i
    std::array<glm::dvec3, 3> vertical;    ///< n0, nu, nv

    glm::dvec3 place(double u, double v, double height_m) const;
};

/// Position of a post at height 0, by fractional column and row.
using PostPlace = std::function<geo::Geodetic(double column, double row)>;

/// @param first  column and row of the first post
/// @param sides  columns and rows from the first to the last post
PatchNet fit_patch_net(const PostPlace& place, const geo::LocalFrame& frame, glm::dvec2 first,
                       glm::dvec2 sides);

}  // namespace relevo::render
