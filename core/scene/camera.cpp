#include "scene/camera.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "base/error.h"
#include "base/units.h"

namespace relevo::scene {
namespace {

/// The upright direction of a picture taken along `forward`. Straight up or down has none of its
/// own: there the top of the picture is `fallback`.
glm::dvec3 upright(const glm::dvec3& forward, const glm::dvec3& up, const glm::dvec3& fallback) {
    const glm::dvec3 across = up - dot(up, forward) * forward;
    if (length(across) < 1e-9) return normalize(fallback - dot(fallback, forward) * forward);
    return normalize(across);
}

}  // namespace

double fov_y_of_focal_length(double focal_length_mm, double aspect) {
    const double height_mm = aspect >= 1 ? 36 / aspect : 36;
    return 2 * std::atan(height_mm / 2 / focal_length_mm);
}

Camera orbit_camera(const Orbit& orbit, std::span<const glm::dvec3> points, double fov_y_rad,
                    double aspect, std::span<const glm::dvec3> also) {
    const double azimuth = radians(orbit.azimuth_deg);
    const double elevation = radians(orbit.elevation_deg);
    const glm::dvec3 to_camera{std::sin(azimuth) * std::cos(elevation),
                               std::cos(azimuth) * std::cos(elevation), std::sin(elevation)};
    Camera camera;
    camera.fov_y_rad = fov_y_rad;
    camera.forward = -to_camera;
    camera.up = upright(camera.forward, {0, 0, 1}, {-std::sin(azimuth), -std::cos(azimuth), 0});
    const glm::dvec3 right = cross(camera.forward, camera.up);

    // Each point asks for a wedge: with the camera at target + d to_camera + a right + b up, the
    // point is inside while |x - a| <= (d - z) tan. The middle of the extremes of x + z tan and x -
    // z tan gives a, the larger of the two spreads gives d: the tightest view, no iteration.
    const double margin = 1.04;
    const double tan_y = std::tan(fov_y_rad / 2) / margin;
    const double tan_x = tan_y * aspect;
    struct Spread {
        double highest = -1e300, lowest = 1e300;
    } horizontal, vertical;
    double nearest = -1e300;
    std::vector<glm::dvec3> shown(points.begin(), points.end());
    shown.insert(shown.end(), also.begin(), also.end());
    for (const glm::dvec3& point : shown) {
        const double x = dot(point, right), y = dot(point, camera.up), z = dot(point, to_camera);
        horizontal.highest = std::max(horizontal.highest, x + z * tan_x);
        horizontal.lowest = std::min(horizontal.lowest, x - z * tan_x);
        vertical.highest = std::max(vertical.highest, y + z * tan_y);
        vertical.lowest = std::min(vertical.lowest, y - z * tan_y);
        nearest = std::max(nearest, z);
    }
    double distance = std::max((horizontal.highest - horizontal.lowest) / (2 * tan_x),
                               (vertical.highest - vertical.lowest) / (2 * tan_y));
    distance = std::max(distance, nearest + 1);
    // That is the nearest place from which all is seen, but where one direction has room to spare
    // the ground need not lie in its middle: shift it there, as seen.
    double a = (horizontal.highest + horizontal.lowest) / 2;
    double b = (vertical.highest + vertical.lowest) / 2;
    double middle = 0;  // depth of the ground's middle
    for (const glm::dvec3& point : points)
        middle += dot(point, to_camera) / static_cast<double>(points.size());
    for (int turn = 0; turn < 30; ++turn) {
        glm::dvec2 least(1e300), most(-1e300);
        for (const glm::dvec3& point : shown) {
            const glm::dvec2 at = glm::dvec2(dot(point, right) - a, dot(point, camera.up) - b) /
                                  (distance - dot(point, to_camera));
            least = glm::min(least, at);
            most = glm::max(most, at);
        }
        a += 0.5 * (least.x + most.x) * (distance - middle);
        b += 0.5 * (least.y + most.y) * (distance - middle);
    }
    // Zooming moves towards the ground's middle.
    camera.eye_m = right * a + camera.up * b +
                   to_camera * (middle + (distance - middle) / std::max(orbit.zoom, 1e-6));
    return camera;
}

Camera heading_camera(const glm::dvec3& eye_m, const geo::Axes& axes, double heading_deg,
                      double pitch_deg, double fov_y_rad) {
    const double heading = radians(heading_deg), pitch = radians(pitch_deg);
    const glm::dvec3 level = std::sin(heading) * axes.east + std::cos(heading) * axes.north;
    Camera camera;
    camera.eye_m = eye_m;
    camera.fov_y_rad = fov_y_rad;
    camera.forward = normalize(std::cos(pitch) * level + std::sin(pitch) * axes.up);
    camera.up = upright(camera.forward, axes.up, pitch_deg > 0 ? -level : level);
    return camera;
}

Camera look_at_camera(const glm::dvec3& eye_m, const glm::dvec3& target_m, const glm::dvec3& up,
                      double fov_y_rad) {
    if (distance(eye_m, target_m) < 1e-3)
        bad_input("camera: --eye and --look-at are the same place; move one of them");
    Camera camera;
    camera.eye_m = eye_m;
    camera.fov_y_rad = fov_y_rad;
    camera.forward = normalize(target_m - eye_m);
    camera.up = upright(camera.forward, up, {0, 1, 0});
    return camera;
}

}  // namespace relevo::scene
