#pragma once

#include <optional>
#include <span>

#include <glm/glm.hpp>

#include "dem/grid.h"
#include "geo/local_frame.h"

namespace relevo::output {

/// Cartesian coordinates of the posts of a DEM: x east, y north, z up, in metres.
///
/// Round: the local frame at the DEM's centre, as pictures have it. The Earth keeps its shape: at
/// 10 km from the centre the same height is 7.8 m lower. Flat: the plane of the DEM's CRS about the
/// centre, heights as z; x and y are scaled so that at the centre they are metres on the ground.
class GroundFrame {
  public:
    /// @throws Error (BadInput) for a flat frame at a pole of a grid in degrees, which has no plane
    GroundFrame(const dem::Grid& grid, bool flat);

    bool is_flat() const { return is_flat_; }
    /// The place of (0, 0, 0), on the ellipsoid.
    const geo::Geodetic& origin() const { return frame_.origin(); }
    /// Of a flat frame: the origin in coordinates of the CRS, and metres in a unit of x and of y.
    const glm::dvec2& origin_crs() const { return origin_crs_; }
    const glm::dvec2& metres_a_unit() const { return metres_a_unit_; }

    struct Point {
        glm::dvec3 at_m{0};
        glm::dvec3 up{0, 0, 1};  ///< unit
    };
    /// @param posts     x the column, y the row
    /// @param height_m  one for each post
    /// @param points    one for each post
    /// Safe on several threads at once.
    void place(std::span<const glm::dvec2> posts, std::span<const double> height_m,
               std::span<Point> points) const;

    /// How much the ground bends: the largest second derivative of a position by posts, in any
    /// direction, at posts all over the grid [m]. 0 of a flat frame.
    double bend_m() const;

  private:
    const dem::Grid grid_;
    bool is_flat_;
    geo::LocalFrame frame_;
    glm::dvec2 origin_crs_{0}, metres_a_unit_{1};
};

}  // namespace relevo::output
