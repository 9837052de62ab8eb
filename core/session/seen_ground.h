#pragma once

#include <optional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "scene/camera.h"

namespace relevo::session {

/// The ground that a picture shows. Pixels are counted from the upper left corner, places in
/// pixels too: the middle of the first one is (0.5, 0.5). Points are in the local frame of the
/// camera [m].
class SeenGround {
  public:
    /// @param depths_m  along the camera's view, as render::Renderer::read_depths() has them
    SeenGround(const scene::Camera& camera, int width_px, int height_px,
               std::vector<float> depths_m);

    int width_px() const { return width_px_; }
    int height_px() const { return height_px_; }

    /// Infinite where there is no ground [m].
    double depth_m(int x, int y) const {
        return depths_m_[static_cast<std::size_t>(height_px_ - 1 - y) *
                             static_cast<std::size_t>(width_px_) +
                         static_cast<std::size_t>(x)];
    }
    /// The point in the middle of a pixel; none where there is no ground.
    std::optional<glm::dvec3> point(int x, int y) const;
    /// Where a point is in the picture, also outside of it; none behind the eye.
    std::optional<glm::dvec2> project(const glm::dvec3& point_m) const;
    /// How a place in the picture moves with a point, pixels a metre, right and down.
    glm::dvec2 moved(const glm::dvec3& point_m, const glm::dvec3& direction) const;
    /// Pixels of a metre across the view, at a depth.
    double px_per_m(double depth_m) const { return focal_px_ / depth_m; }

    /// The pixel with ground that is nearest to the picture's middle.
    std::optional<glm::ivec2> middle() const;
    /// The least and the greatest depth there is [m].
    std::pair<double, double> depth_range_m() const;

  private:
    scene::Camera camera_;
    glm::dvec3 right_;
    int width_px_, height_px_;
    double focal_px_;
    std::vector<float> depths_m_;
};

}  // namespace relevo::session
