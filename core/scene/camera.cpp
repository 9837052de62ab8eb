#include "scene/camera.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

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

/// The part of a picture that ground is fitted into, of each direction the tangents of its sides.
struct Room {
    double left = 0, right = 0, bottom = 0, top = 0;

    /// @param share  of what the insets leave, about its middle
    static Room of(double fov_y_rad, double aspect, const Insets& insets, double share) {
        const double tan_y = std::tan(fov_y_rad / 2), tan_x = tan_y * aspect;
        const double x = insets.left - insets.right, y = insets.bottom - insets.top;
        const double width = share * (1 - insets.left - insets.right);
        const double height = share * (1 - insets.bottom - insets.top);
        return {tan_x * (x - width), tan_x * (x + width), tan_y * (y - height),
                tan_y * (y + height)};
    }
};

/// Where a camera stands that looks along a direction: `a` to the right and `b` up from the axis
/// through the origin, and a distance back along it [m].
struct Fit {
    double a = 0, b = 0, distance_m = 0;

    /// Whether the camera has all of these points in a part of its picture.
    bool shows(const Camera& camera, std::span<const glm::dvec3> points, const Room& room) const {
        const glm::dvec3 right = cross(camera.forward, camera.up);
        return std::ranges::all_of(points, [&](const glm::dvec3& point) {
            const double depth = distance_m + dot(point, camera.forward);
            const double x = dot(point, right) - a, y = dot(point, camera.up) - b;
            return x >= depth * room.left && x <= depth * room.right && y >= depth * room.bottom &&
                   y <= depth * room.top;
        });
    }
};

/// Where a camera stands along an axis of its picture so that the points reach as far to one side
/// of a place in it as to the other, between two places from which all are seen.
/// @param place  tangent of its direction
double centred(std::span<const glm::dvec3> points, const glm::dvec3& axis,
               const glm::dvec3& to_camera, double distance_m, double place, double low,
               double high) {
    constexpr int kHalvings = 40;
    for (int i = 0; i < kHalvings; ++i) {
        const double middle = 0.5 * (low + high);
        double least = 1e300, most = -1e300;
        for (const glm::dvec3& point : points) {
            const double at = (dot(point, axis) - middle) / (distance_m - dot(point, to_camera));
            least = std::min(least, at);
            most = std::max(most, at);
        }
        (least + most > 2 * place ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

/// The nearest place from which all points are in a part of the picture.
Fit fit_to(const Camera& camera, std::span<const glm::dvec3> points, const Room& room) {
    const glm::dvec3 to_camera = -camera.forward;
    const glm::dvec3 right = cross(camera.forward, camera.up);

    // Each point asks for a wedge: with the camera at target + d to_camera + a right + b up, the
    // point is inside while (d - z) left <= x - a <= (d - z) right. The least a that x + z right
    // leaves and the largest that x + z left does meet at the distance: the larger of both
    // directions' is the tightest view, no iteration.
    struct Spread {
        double highest = -1e300, lowest = 1e300;
    } horizontal, vertical;
    double nearest = -1e300;
    for (const glm::dvec3& point : points) {
        const double x = dot(point, right), y = dot(point, camera.up), z = dot(point, to_camera);
        horizontal.highest = std::max(horizontal.highest, x + z * room.right);
        horizontal.lowest = std::min(horizontal.lowest, x + z * room.left);
        vertical.highest = std::max(vertical.highest, y + z * room.top);
        vertical.lowest = std::min(vertical.lowest, y + z * room.bottom);
        nearest = std::max(nearest, z);
    }
    Fit fit;
    fit.distance_m = std::max((horizontal.highest - horizontal.lowest) / (room.right - room.left),
                              (vertical.highest - vertical.lowest) / (room.top - room.bottom));
    fit.distance_m = std::max(fit.distance_m, nearest + 1);
    // That is the nearest place from which all is seen, but where one direction has room to spare
    // the ground need not lie in its middle: shift it there, as seen.
    fit.a = centred(points, right, to_camera, fit.distance_m, 0.5 * (room.left + room.right),
                    horizontal.highest - fit.distance_m * room.right,
                    horizontal.lowest - fit.distance_m * room.left);
    fit.b = centred(points, camera.up, to_camera, fit.distance_m, 0.5 * (room.bottom + room.top),
                    vertical.highest - fit.distance_m * room.top,
                    vertical.lowest - fit.distance_m * room.bottom);
    return fit;
}

}  // namespace

double fov_y_of_focal_length(double focal_length_mm, double aspect) {
    const double height_mm = aspect >= 1 ? 36 / aspect : 36;
    return 2 * std::atan(height_mm / 2 / focal_length_mm);
}

Camera orbit_camera(const Orbit& orbit, std::span<const glm::dvec3> points, double fov_y_rad,
                    double aspect, std::span<const glm::dvec3> also, const Insets& insets) {
    const double azimuth = radians(orbit.azimuth_deg.value());
    const double elevation = radians(orbit.elevation_deg.value());
    const glm::dvec3 to_camera{std::sin(azimuth) * std::cos(elevation),
                               std::cos(azimuth) * std::cos(elevation), std::sin(elevation)};
    Camera camera;
    camera.fov_y_rad = fov_y_rad;
    camera.forward = -to_camera;
    camera.up = upright(camera.forward, {0, 0, 1}, {-std::sin(azimuth), -std::cos(azimuth), 0});

    double middle = 0;  // depth of the ground's middle
    for (const glm::dvec3& point : points)
        middle += dot(point, to_camera) / static_cast<double>(points.size());
    assert(insets.left + insets.right < 1 && insets.bottom + insets.top < 1);
    const Room room = Room::of(fov_y_rad, aspect, insets, kFill);
    Fit fit = fit_to(camera, points, room);
    if (!fit.shows(camera, also, Room::of(fov_y_rad, aspect, insets, 1))) {
        std::vector<glm::dvec3> all(points.begin(), points.end());
        all.insert(all.end(), also.begin(), also.end());
        fit = fit_to(camera, all, room);
    }
    // Zooming moves towards the ground's middle.
    camera.eye_m = cross(camera.forward, camera.up) * fit.a + camera.up * fit.b +
                   to_camera * (middle + (fit.distance_m - middle) / std::max(orbit.zoom, 1e-6));
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
