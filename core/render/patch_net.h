#pragma once

#include <array>
#include <functional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "geo/local_frame.h"

namespace relevo::render {

/// Where the posts of a rectangular piece of a raster lie on the round Earth: position of height 0
/// and local vertical as polynomials over the piece, so that the vertex program needs no
/// projection. With u along the columns and v along the rows, both 0..1 over the piece, a post of
/// height h lies at
///
///     centre + sum over i, j of position[3 j + i] u^i v^j + h (n0 + u nu + v nv),  i, j = 0..2
///
/// in the DEM's local frame [m]: the biquadratic through 3 x 3 exact places, so that neighbours
/// agree along the side they share. Of a piece with posts that have no place on the Earth it is the
/// biquadratic nearest to those that have one. Accuracy: below a hundredth of the post spacing for
/// pieces up to 200 km; the error grows with the cube of the side (tests/render/test_patch_net.cpp
/// prints it).
struct PatchNet {
    glm::dvec3 centre_m;                   ///< exact place of the piece's middle
    std::array<glm::dvec3, 9> position_m;  ///< coefficients, see above
    std::array<glm::dvec3, 3> vertical;    ///< n0, nu, nv

    glm::dvec3 place(double u, double v, double height_m) const;
};

/// Place of a post, fractional column and row, height 0.
using PostPlace = std::function<geo::Geodetic(double column, double row)>;

/// @param first  column and row of the piece's first post
/// @param sides  columns and rows from its first to its last post
PatchNet fit_patch_net(const PostPlace& place, const geo::LocalFrame& frame, glm::dvec2 first,
                       glm::dvec2 sides);

}  // namespace relevo::render
