#pragma once

#include <optional>
#include <span>

#include <glm/vec2.hpp>

#include "base/array2d.h"
#include "dem/grid.h"
#include "zones/even_odd.h"

namespace relevo::zones {

/// The area of cells of a raster [m2].
class CellArea {
  public:
    /// @param on_ellipsoid  of WGS 84; else, and never of degrees, in the plane of the CRS
    CellArea(const dem::Grid& grid, bool on_ellipsoid);

    /// Of a cell around a place; (0, 0) is the outer corner of the first cell.
    double at(const glm::dvec2& place) const;

    /// All cells have this one.
    const std::optional<double>& alike() const { return alike_m2_; }

    /// What edges enclose, in cells and also outside of the raster [m2].
    double enclosed(std::span<const Edge> edges) const;

  private:
    double exact(const glm::dvec2& place) const;
    double to_the_right(double from, double to, double y) const;

    dem::Grid grid_;
    std::optional<double> alike_m2_;
    Array2d<double> nodes_m2_;  // all over a projected raster, from corner to corner
};

}  // namespace relevo::zones
