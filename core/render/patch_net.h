#pragma once

#include <array>
#include <functional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "geo/local_frame.h"

namespace relevo::render {

/// Where the posts of a square piece of a raster lie on the round Earth: position of height 0 and
/// local vertical as polynomials over the piece, so that the vertex program needs no projection.
/// With u along the columns and v along the rows, both 0..1 over the piece, a post of height h lies
/// at
///
///     centre + p0 + u (pu + u puu + v puv) + v (pv + v pvv) + h (n0 + u nu + v nv)
///
/// in the DEM's local frame [m]. The polynomials are the least-squares fit through 3 x 3 exact
/// places. Accuracy: the terms of third order that are left out grow with the cube of the piece's
/// side: 2 mm for a piece of 20 km, below a hundredth of the post spacing up to pieces of 64 posts
/// 12 km apart (tests/render/test_patch_net.cpp).
struct PatchNet {
    glm::dvec3 centre_m;                   ///< exact place of the piece's middle
    std::array<glm::dvec3, 6> position_m;  ///< p0, pu, pv, puu, puv, pvv
    std::array<glm::dvec3, 3> vertical;    ///< n0, nu, nv

    glm::dvec3 place(double u, double v, double height_m) const;
};

/// Place of a post, fractional column and row, height 0.
using PostPlace = std::function<geo::Geodetic(double column, double row)>;

/// @param first  column and row of the piece's first post
/// @param side   columns and rows from its first to its last post
PatchNet fit_patch_net(const PostPlace& place, const geo::LocalFrame& frame, glm::dvec2 first,
                       double side);

}  // namespace relevo::render
