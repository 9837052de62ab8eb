#include "viewer/navigation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "base/units.h"

namespace relevo::viewer {
namespace {

constexpr double kSteepest_deg = 89.9;
constexpr double kNearest_m = 2;  // least distance when zooming

double wrapped_deg(double angle_deg) {
    return angle_deg - 360 * std::floor(angle_deg / 360);
}

/// Raises the pose to the least height above ground.
Pose above_ground(Pose pose, const Land& land) {
    const geo::Geodetic place = land.frame->to_geodetic(pose.eye_m);
    const double ground_m = land.aim_m(place) * land.exaggeration;
    if (std::isnan(ground_m) || place.height_m >= ground_m + kClearance_m) return pose;
    pose.eye_m = land.frame->to_local({place.lat_rad, place.lon_rad, ground_m + kClearance_m});
    return pose;
}

/// A pose at `eye_m` that looks along `forward`. Keeps the heading if that is vertical.
Pose looking(const Pose& before, const Land& land, const glm::dvec3& eye_m,
             const glm::dvec3& forward) {
    const geo::Axes axes = land.axes(eye_m);
    const double east = dot(forward, axes.east), north = dot(forward, axes.north);
    Pose pose = before;
    pose.eye_m = eye_m;
    pose.pitch_deg = degrees(std::asin(std::clamp(dot(forward, axes.up), -1.0, 1.0)));
    if (std::hypot(east, north) > 1e-6)
        pose.heading_deg = wrapped_deg(degrees(std::atan2(east, north)));
    return pose;
}

}  // namespace

double Land::ground_under(const glm::dvec3& point_m) const {
    return aim_m(frame->to_geodetic(point_m)) * exaggeration;
}

double drawn_height_m(const glm::dvec3& point_m, const Land& land, double within_m) {
    const geo::Geodetic place = land.frame->to_geodetic(point_m);
    const double height_m = land.height_m(place);
    return place.height_m < height_m * land.exaggeration - within_m ? std::nan("") : height_m;
}

double height_tolerance_m(bool is_sharp, bool has_walls, double px_m, double spacing_m) {
    constexpr double kWithin_px = 8;
    if (!is_sharp && !has_walls) return std::numeric_limits<double>::infinity();
    return std::max(kWithin_px * px_m, spacing_m / 4);
}

geo::Axes Land::axes(const glm::dvec3& point_m) const {
    const geo::Geodetic place = frame->to_geodetic(point_m);
    return frame->axes(place.lat_rad, place.lon_rad);
}

scene::Camera camera_of(const Pose& pose, const Land& land) {
    return scene::heading_camera(pose.eye_m, land.axes(pose.eye_m), pose.heading_deg,
                                 pose.pitch_deg, pose.fov_y_rad);
}

Pose pose_of(const scene::Camera& camera, const Land& land) {
    Pose pose;
    pose.fov_y_rad = camera.fov_y_rad;
    // When looking straight down, the image's upward direction is the heading.
    const geo::Axes axes = land.axes(camera.eye_m);
    pose.heading_deg =
        wrapped_deg(degrees(std::atan2(dot(camera.up, axes.east), dot(camera.up, axes.north))));
    return looking(pose, land, camera.eye_m, camera.forward);
}

scene::View view_of(const Pose& pose, const Land& land) {
    geo::Geodetic place = land.frame->to_geodetic(pose.eye_m);
    place.height_m /= land.exaggeration;
    scene::View view;
    view.eye = scene::Standpoint{place, /*above_ground=*/false};
    view.heading_deg = pose.heading_deg;
    view.pitch_deg = pose.pitch_deg;
    view.fov_y_rad = pose.fov_y_rad;
    return view;
}

Pose exaggerated(const Pose& pose, const Land& land, double from, double to) {
    if (from == to) return pose;  // to the last bit, so that it counts as the same
    geo::Geodetic place = land.frame->to_geodetic(pose.eye_m);
    place.height_m *= to / from;
    Pose moved = pose;
    moved.eye_m = land.frame->to_local(place);
    return moved;
}

glm::dvec3 ray(const scene::Camera& camera, glm::dvec2 at, double aspect) {
    const double tan_y = std::tan(camera.fov_y_rad / 2);
    const glm::dvec3 right = cross(camera.forward, camera.up);
    return normalize(camera.forward + at.x * tan_y * aspect * right + at.y * tan_y * camera.up);
}

std::optional<glm::dvec2> in_picture(const scene::Camera& camera, const glm::dvec3& point_m,
                                     double aspect) {
    const glm::dvec3 to = point_m - camera.eye_m;
    const double depth = dot(to, camera.forward);
    if (depth <= 1e-9) return std::nullopt;
    const double tan_y = std::tan(camera.fov_y_rad / 2);
    const glm::dvec3 right = cross(camera.forward, camera.up);
    return glm::dvec2(dot(to, right) / (depth * tan_y * aspect),
                      dot(to, camera.up) / (depth * tan_y));
}

glm::vec2 in_window(glm::dvec2 at, glm::vec2 size_px) {
    return glm::vec2((at.x + 1) / 2, (1 - at.y) / 2) * size_px;
}

glm::dvec2 in_view(glm::vec2 at_px, glm::vec2 size_px) {
    return {2 * at_px.x / size_px.x - 1, 1 - 2 * at_px.y / size_px.y};
}

Pose orbit(const Pose& pose, const Land& land, const glm::dvec3& pivot_m, double right_deg,
           double up_deg) {
    const scene::Camera camera = camera_of(pose, land);
    const glm::dvec3 up = land.axes(pivot_m).up;
    const glm::dvec3 offset = pose.eye_m - pivot_m;
    // Neither over the top nor through the ground.
    const double pitch_deg =
        std::clamp(pose.pitch_deg - up_deg, -kSteepest_deg, std::max(pose.pitch_deg, 60.0));
    const double tilt = radians(pitch_deg - pose.pitch_deg);
    const glm::dvec3 right = normalize(cross(camera.forward, camera.up));
    const glm::dquat turn = glm::angleAxis(radians(right_deg), up) * glm::angleAxis(tilt, right);
    return above_ground(looking(pose, land, pivot_m + turn * offset, turn * camera.forward), land);
}

Pose pan(const Pose& pose, const Land& land, const glm::dvec3& grabbed_m, glm::dvec2 to,
         double aspect) {
    const scene::Camera camera = camera_of(pose, land);
    const glm::dvec3 up = land.axes(grabbed_m).up;
    const glm::dvec3 direction = ray(camera, to, aspect);
    const double falls = -dot(direction, up), above_m = dot(pose.eye_m - grabbed_m, up);
    // Near the horizon the ground under the mouse is too far away.
    constexpr double kLeast = 0.02;
    if (above_m <= 0 || falls <= kLeast) return pose;
    const glm::dvec3 under_hand = pose.eye_m + above_m / falls * direction;
    Pose moved = looking(pose, land, pose.eye_m + (grabbed_m - under_hand), camera.forward);
    moved.heading_deg = pose.heading_deg;
    moved.pitch_deg = pose.pitch_deg;
    return above_ground(moved, land);
}

Pose zoom(const Pose& pose, const Land& land, const glm::dvec3& point_m, double factor) {
    const glm::dvec3 offset = pose.eye_m - point_m;
    const double now_m = length(offset);
    if (now_m <= 0) return pose;
    const double then_m = std::clamp(now_m * factor, std::min(now_m, kNearest_m), 1e9);
    const glm::dvec3 eye_m = point_m + offset * (then_m / now_m);
    Pose moved = looking(pose, land, eye_m, camera_of(pose, land).forward);
    // Near the vertical the heading is unstable and is kept.
    constexpr double kSteep_deg = 80;
    if (std::abs(pose.pitch_deg) > kSteep_deg) {
        moved.heading_deg = pose.heading_deg;
        moved.pitch_deg = pose.pitch_deg;
    }
    return above_ground(moved, land);
}

double zoom_of_scroll(double notches) {
    return std::exp(-0.25 * notches);
}

Pose look_around(const Pose& pose, double right_deg, double up_deg) {
    Pose turned = pose;
    turned.heading_deg = wrapped_deg(pose.heading_deg + right_deg);
    turned.pitch_deg = std::clamp(pose.pitch_deg + up_deg, -kSteepest_deg, kSteepest_deg);
    return turned;
}

Pose fly(const Pose& pose, const Land& land, const glm::dvec3& by_m) {
    const scene::Camera camera = camera_of(pose, land);
    const glm::dvec3 right = cross(camera.forward, camera.up);
    Pose moved = pose;
    moved.eye_m += by_m.x * right + by_m.y * camera.forward + by_m.z * land.axes(pose.eye_m).up;
    return above_ground(moved, land);
}

Pose walk(const Pose& pose, const Land& land, glm::dvec2 by_m) {
    const geo::Axes axes = land.axes(pose.eye_m);
    const double heading = radians(pose.heading_deg);
    const glm::dvec3 forward = std::sin(heading) * axes.east + std::cos(heading) * axes.north;
    const glm::dvec3 right = cross(forward, axes.up);
    Pose moved = pose;
    moved.eye_m += by_m.x * right + by_m.y * forward;
    const geo::Geodetic place = land.frame->to_geodetic(moved.eye_m);
    const double ground_m = land.aim_m(place) * land.exaggeration;
    if (std::isnan(ground_m)) return pose;
    moved.eye_m = land.frame->to_local({place.lat_rad, place.lon_rad, ground_m + kWalk_m});
    return moved;
}

std::optional<Pose> stand(const Pose& pose, const Land& land, const glm::dvec3& point_m) {
    constexpr double kAhead_deg = 0;
    if (std::isnan(land.ground_under(point_m))) return std::nullopt;
    Pose standing = pose;
    standing.eye_m = point_m;
    standing.pitch_deg = std::max(pose.pitch_deg, kAhead_deg);
    return walk(standing, land, {0, 0});
}

Pose facing(const Pose& pose, const Land& land, const glm::dvec3& point_m) {
    const glm::dvec3 to = point_m - pose.eye_m;
    if (length(to) < kNearest_m) return pose;
    return looking(pose, land, pose.eye_m, normalize(to));
}

Pose centred(const Pose& pose, const Land& land, const scene::Insets& insets, double window,
             double picture) {
    const scene::Camera camera = camera_of(pose, land);
    const glm::dvec2 low(2 * insets.left - 1, 2 * insets.bottom - 1),
        high(1 - 2 * insets.right, 1 - 2 * insets.top);
    // Angles, not pixels: off the axis of a lens a pixel is a smaller angle.
    const auto between = [&](glm::dvec2 a, glm::dvec2 b) {
        const glm::dvec3 bisector = ray(camera, a, window) + ray(camera, b, window);
        return in_picture(camera, camera.eye_m + normalize(bisector), window).value();
    };
    const glm::dvec2 half = 0.5 * (low + high);
    const glm::dvec2 middle(between({low.x, half.y}, {high.x, half.y}).x,
                            between({half.x, low.y}, {half.x, high.y}).y);
    const auto angle = [&](glm::dvec2 a, glm::dvec2 b) {
        return std::acos(
            std::clamp(dot(ray(camera, a, window), ray(camera, b, window)), -1.0, 1.0));
    };
    Pose turned = looking(pose, land, pose.eye_m, ray(camera, middle, window));
    const double height_rad = angle({middle.x, low.y}, {middle.x, high.y});
    const double width_rad = angle({low.x, middle.y}, {high.x, middle.y});
    turned.fov_y_rad = std::max(height_rad, 2 * std::atan(std::tan(width_rad / 2) / picture));
    return turned;
}

Pose look_at(const Pose& pose, const Land& land, const glm::dvec3& point_m, double distance_m) {
    constexpr double kDown_deg = -20;
    Pose there = pose;
    there.eye_m = point_m;  // the point's up and north apply
    there.pitch_deg = std::min(pose.pitch_deg, kDown_deg);
    there.eye_m -= distance_m * camera_of(there, land).forward;
    return above_ground(there, land);
}

Pose from_above(const Pose& pose, const Land& land, const glm::dvec3& point_m, double distance_m) {
    Pose above = pose;
    above.eye_m = point_m + land.axes(point_m).up * distance_m;
    above.heading_deg = 0;
    above.pitch_deg = -90;
    return above_ground(above, land);
}

}  // namespace relevo::viewer
