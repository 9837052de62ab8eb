#pragma once

#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>

#include "dem/grid.h"
#include "geo/geodetic.h"
#include "render/frame_block.h"

namespace relevo::render {

/// Metres east and north on the ellipsoid for a step along the row (first column) and along the
/// column (second one), at a post. NaN where the grid has no place.
glm::dmat2 metres_per_post(const dem::Grid& grid, const glm::dvec2& post);

/// Writes the eye's place on the DEM's grid: eye_post, eye_axes and eye_bends.
void write_eye_post(const dem::Grid& grid, const geo::Geodetic& eye, EyeBlock& block);

}  // namespace relevo::render
