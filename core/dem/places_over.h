#pragma once

#include <cstdint>
#include <string>

#include <glm/vec2.hpp>

#include "base/array2d.h"
#include "dem/grid.h"

namespace relevo::dem {

/// Rows and columns of points of a DEM, at equal steps.
struct PointsOver {
    glm::dvec2 first_post{0};  ///< the first point, column and row of the DEM
    glm::dvec2 step{1};        ///< posts from point to point
    glm::ivec2 count{1};       ///< columns and rows of points
};

/// Where points of a DEM lie among the cells of another raster, in any CRS.
///
/// Accuracy: 0.05 cells of the raster, or 0.05 points where those are wider apart. Between every
/// kNet-th point, places are interpolated only where that holds.
class PlacesOver {
  public:
    static constexpr int kNet = 16;  ///< points between places that are computed

    /// @param dem, raster  must outlive this
    PlacesOver(const Grid& dem, const Grid& raster, const PointsOver& points);

    /// Column and row of the raster, with fractions. Safe on several threads at once.
    glm::dvec2 operator()(int column, int row) const;

  private:
    glm::dvec2 linear(const glm::dvec2& post) const;
    glm::dvec2 exact(const glm::dvec2& point) const;
    bool is_linear() const;
    glm::dvec2 interpolated(const glm::dvec2& at) const;
    bool is_uneven(int column, int row) const;

    const Grid& dem_;
    const Grid& raster_;
    PointsOver points_;
    bool same_crs_;
    bool linear_;
    Array2d<glm::dvec2> net_;
    Array2d<std::uint8_t> uneven_;
};

/// "latitude 46.900 to 47.100, longitude 8.950 to 9.200": a box around samples of a raster.
std::string extent_text(const Grid& grid);

}  // namespace relevo::dem
