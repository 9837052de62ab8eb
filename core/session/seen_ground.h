#pragma once

#include <optional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "scene/camera.h"

namespace relevo::session {

/// Ground in an image, from its depth buffer. Pixels are counted from the upper left corner; image
/// positions are in pixels, with the first pixel's centre at (0.5, 0.5). Points are in the camera's
/// local frame [m]. Of a map, too (Camera::map), where the scale does not depend on depth.
class SeenGround {
  public:
    /// @param depths_m  along the optical axis, as render::Renderer::read_depths()
    SeenGround(const scene::Camera& camera, int width_px, int height_px,
               std::vector<float> depths_m);

    int width_px() const { return width_px_; }
    int height_px() const { return height_px_; }

    /// Depth along the optical axis [m]; infinite without ground.
    double depth_m(int x, int y) const {
        return depths_m_[static_cast<std::size_t>(height_px_ - 1 - y) *
                             static_cast<std::size_t>(width_px_) +
                         static_cast<std::size_t>(x)];
    }
    /// The point at the centre of a pixel; nullopt without ground.
    std::optional<glm::dvec3> point(int x, int y) const;
    /// Image position of a point, possibly outside the image; nullopt behind the eye.
    std::optional<glm::dvec2> project(const glm::dvec3& point_m) const;
    /// Image motion per metre of a point's motion along `direction`: pixels/m, right and down.
    glm::dvec2 moved(const glm::dvec3& point_m, const glm::dvec3& direction) const;
    /// Scale across the view at a depth [pixels/m].
    double px_per_m(double depth_m) const;

    /// The point at an image position and a depth, in the camera's local frame [m].
    static glm::dvec3 at(const scene::Camera& camera, const glm::dvec2& position,
                         const glm::dvec2& picture_px, double depth_m);

    /// The pixel with ground nearest to the image's centre; nullopt without ground.
    std::optional<glm::ivec2> middle() const;
    /// Least and greatest depth of ground [m].
    std::pair<double, double> depth_range_m() const;

  private:
    scene::Camera camera_;
    glm::dvec3 right_;
    int width_px_, height_px_;
    double focal_px_;
    double map_px_per_m_ = 0;  // of a map, along its rows in the middle
    std::vector<float> depths_m_;
};

}  // namespace relevo::session
