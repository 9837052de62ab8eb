#include "session/seen_ground.h"

#include <cmath>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>

#include "scene/map_view.h"

namespace relevo::session {

SeenGround::SeenGround(const scene::Camera& camera, int width_px, int height_px,
                       std::vector<float> depths_m)
    : camera_(camera),
      right_(cross(camera.forward, camera.up)),
      width_px_(width_px),
      height_px_(height_px),
      focal_px_(0.5 * height_px / std::tan(camera.fov_y_rad / 2)),
      depths_m_(std::move(depths_m)) {
    if (camera.map) map_px_per_m_ = 1 / camera.map->pixel_m(0.5 * camera.map->size_px()).x;
}

double SeenGround::px_per_m(double depth_m) const {
    return camera_.map ? map_px_per_m_ : focal_px_ / depth_m;
}

glm::dvec3 SeenGround::at(const scene::Camera& camera, const glm::dvec2& position,
                          const glm::dvec2& picture_px, double depth_m) {
    if (camera.map) {
        const glm::dvec3 base = camera.map->point_m(position, 0), up = camera.map->up(position);
        const double base_m = dot(base - camera.eye_m, camera.forward);
        return base + (depth_m - base_m) / dot(up, camera.forward) * up;
    }
    const double pixel_rad = 2 * std::tan(camera.fov_y_rad / 2) / picture_px.y;
    const glm::dvec2 off = position - 0.5 * picture_px;
    return camera.eye_m +
           depth_m * (camera.forward + off.x * pixel_rad * cross(camera.forward, camera.up) -
                      off.y * pixel_rad * camera.up);
}

std::optional<glm::dvec3> SeenGround::point(int x, int y) const {
    const double depth = depth_m(x, y);
    if (!std::isfinite(depth)) return std::nullopt;
    return at(camera_, {x + 0.5, y + 0.5}, {width_px_, height_px_}, depth);
}

std::optional<glm::dvec2> SeenGround::project(const glm::dvec3& point_m) const {
    if (camera_.map) {
        const glm::dvec2 found = camera_.map->pixel_of(point_m);
        return std::isfinite(found.x + found.y) ? std::optional(found) : std::nullopt;
    }
    const glm::dvec3 way = point_m - camera_.eye_m;
    const double depth = dot(way, camera_.forward);
    if (!(depth > 0)) return std::nullopt;
    return glm::dvec2(0.5 * width_px_ + focal_px_ * dot(way, right_) / depth,
                      0.5 * height_px_ - focal_px_ * dot(way, camera_.up) / depth);
}

glm::dvec2 SeenGround::moved(const glm::dvec3& point_m, const glm::dvec3& direction) const {
    if (camera_.map) {
        const double pixel_m = 1 / map_px_per_m_;
        return (camera_.map->pixel_of(point_m + pixel_m * direction) -
                camera_.map->pixel_of(point_m)) *
               map_px_per_m_;
    }
    const glm::dvec3 way = point_m - camera_.eye_m;
    const double depth = dot(way, camera_.forward), ahead = dot(direction, camera_.forward);
    const glm::dvec2 at(dot(way, right_), -dot(way, camera_.up));
    const glm::dvec2 aside(dot(direction, right_), -dot(direction, camera_.up));
    return focal_px_ / (depth * depth) * (depth * aside - ahead * at);
}

std::optional<glm::ivec2> SeenGround::middle() const {
    std::optional<glm::ivec2> best;
    double best_px = std::numeric_limits<double>::infinity();
    for (int y = 0; y < height_px_; ++y)
        for (int x = 0; x < width_px_; ++x) {
            const double away = std::hypot(x + 0.5 - 0.5 * width_px_, y + 0.5 - 0.5 * height_px_);
            if (away >= best_px || !std::isfinite(depth_m(x, y))) continue;
            best = {x, y};
            best_px = away;
        }
    return best;
}

std::pair<double, double> SeenGround::depth_range_m() const {
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (const float depth : depths_m_) {
        if (!std::isfinite(depth)) continue;
        least = std::min(least, double{depth});
        most = std::max(most, double{depth});
    }
    return {least, most};
}

}  // namespace relevo::session
