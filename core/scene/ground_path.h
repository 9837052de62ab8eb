#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "geo/geodetic.h"
#include "geo/local_frame.h"

namespace relevo::scene {

/// A smooth line over the ellipsoid along places, by its length.
class GroundPath {
  public:
    /// @param places       heights are ignored; places within 1 cm of the previous one are skipped
    /// @param smoothing_m  bends narrower than this are cut; the ends stay
    /// @throws Error (BadInput) `expected E but got G` for fewer than two different places, and for
    ///     what is no place
    GroundPath(std::span<const geo::Geodetic> places, double smoothing_m);

    double length_m() const { return step_m_ * static_cast<double>(points_m_.size() - 1); }

    /// The place so far along the path, with height 0; beyond its ends straight on.
    geo::Geodetic at(double along_m) const;

  private:
    glm::dvec3 on_ellipsoid(const glm::dvec3& point_m) const;

    geo::LocalFrame frame_;
    std::vector<glm::dvec3> points_m_;  ///< in `frame_`, height 0, `step_m_` apart
    double step_m_ = 0;
};

}  // namespace relevo::scene
