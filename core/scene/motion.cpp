#include "scene/motion.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <glm/geometric.hpp>

#include "base/error.h"
#include "base/units.h"
#include "scene/series.h"

namespace relevo::scene {

View view_from(const geo::Geodetic& eye, const MotionGround& ground) {
    View view;
    view.eye = Standpoint{{eye.lat_rad, eye.lon_rad, eye.height_m / ground.exaggeration}, false};
    return view;
}

void keep_above_ground(std::vector<geo::Geodetic>& eyes, const MotionGround& ground,
                       double clearance_m, std::size_t radius, bool cyclic) {
    std::vector<double> missing_m;
    missing_m.reserve(eyes.size());
    for (const geo::Geodetic& eye : eyes) {
        const double ground_m = ground.height_m(eye) * ground.exaggeration;
        missing_m.push_back(std::max(0.0, ground_m + clearance_m - eye.height_m));
        if (std::isnan(ground_m)) missing_m.back() = 0;
    }
    if (std::ranges::all_of(missing_m, [](double m) { return m == 0; })) return;
    const auto raised_m = smooth_above(missing_m, radius, cyclic ? Ends::Cyclic : Ends::Held);
    for (std::size_t i = 0; i < eyes.size(); ++i)
        eyes[i].height_m += raised_m[i];
}

namespace {

/// What an orbit turns around, and the camera's place relative to it.
struct Turn {
    glm::dvec3 target_m;
    geo::Axes axes;      ///< at the target
    double azimuth_rad;  ///< of the camera as seen from the target
    double elevation_rad;
    double distance_m;
};

Turn turn_about(const glm::dvec3& target_m, const glm::dvec3& eye_m, const geo::LocalFrame& frame) {
    const geo::Geodetic place = frame.to_geodetic(target_m);
    const geo::Axes axes = frame.axes(place.lat_rad, place.lon_rad);
    const glm::dvec3 to_eye = eye_m - target_m;
    const double east = dot(to_eye, axes.east), north = dot(to_eye, axes.north);
    return {target_m, axes, std::atan2(east, north),
            std::atan2(dot(to_eye, axes.up), std::hypot(east, north)), length(to_eye)};
}

glm::dvec3 eye_of(const Turn& turn, double azimuth_rad) {
    const double level = std::cos(turn.elevation_rad);
    return turn.target_m + turn.distance_m * (std::sin(azimuth_rad) * level * turn.axes.east +
                                              std::cos(azimuth_rad) * level * turn.axes.north +
                                              std::sin(turn.elevation_rad) * turn.axes.up);
}

/// A point as seen from a side of a turn: right of the target, above it and towards the camera [m].
using Seen = std::function<void(double right_m, double up_m, double near_m)>;

/// Visits all points from sides all around.
void from_all_sides(const Turn& turn, const std::vector<glm::dvec3>& points, const Seen& visit) {
    constexpr int kSides = 72;
    for (int side = 0; side < kSides; ++side) {
        const glm::dvec3 to_camera =
            normalize(eye_of(turn, 2 * kPi * side / kSides) - turn.target_m);
        const glm::dvec3 right = normalize(cross(turn.axes.up, to_camera));
        const glm::dvec3 up = cross(to_camera, right);
        for (const glm::dvec3& point : points) {
            const glm::dvec3 from = point - turn.target_m;
            visit(dot(from, right), dot(from, up), dot(from, to_camera));
        }
    }
}

/// The least distance from which all points are in the picture from every side.
double distance_to_show(const Turn& turn, const std::vector<glm::dvec3>& points, double fov_y_rad,
                        double aspect) {
    const double tan_y = kFill * std::tan(fov_y_rad / 2), tan_x = tan_y * aspect;
    double most_m = 1;
    from_all_sides(turn, points, [&](double right_m, double up_m, double near_m) {
        const double aside_m = std::max(std::abs(right_m) / tan_x, std::abs(up_m) / tan_y);
        most_m = std::max(most_m, near_m + aside_m);
    });
    return most_m;
}

/// How much farther the ground reaches up in the pictures than down: sum of the tangents of its
/// highest and its lowest point.
double excess_above(const Turn& turn, const std::vector<glm::dvec3>& points) {
    double lowest = 0, highest = 0;
    from_all_sides(turn, points, [&](double, double up_m, double near_m) {
        const double tangent = up_m / (turn.distance_m - near_m);
        lowest = std::min(lowest, tangent);
        highest = std::max(highest, tangent);
    });
    return highest + lowest;
}

/// Moves the target of a turn along the vertical until the ground reaches as far below the middle
/// of the pictures as above, and stands as near as shows all of it.
void centre(Turn& turn, const std::vector<glm::dvec3>& points, double fov_y_rad, double aspect) {
    const glm::dvec3 middle_m = turn.target_m;
    double low_m = -turn.distance_m, high_m = turn.distance_m;
    constexpr int kHalvings = 20;
    for (int i = 0; i < kHalvings; ++i) {
        const double shift_m = 0.5 * (low_m + high_m);
        turn.target_m = middle_m + shift_m * turn.axes.up;
        turn.distance_m = distance_to_show(turn, points, fov_y_rad, aspect);
        (excess_above(turn, points) > 0 ? low_m : high_m) = shift_m;
    }
}

/// The turn of a view that is an orbit: about the middle of the ground.
Turn whole_turn(const View& view, const Camera& camera, const MotionGround& ground) {
    glm::dvec3 low(1e300), high(-1e300);
    for (const glm::dvec3& point : ground.points) {
        low = min(low, point);
        high = max(high, point);
    }
    geo::Geodetic place = ground.frame.to_geodetic(0.5 * (low + high));
    const double ground_m = ground.height_m(place) * ground.exaggeration;
    if (!std::isnan(ground_m)) place.height_m = ground_m;
    const glm::dvec3 target_m = ground.frame.to_local(place);
    Turn turn = turn_about(target_m, target_m - camera.forward, ground.frame);
    const double fov_y_rad = camera.fov_y_rad, aspect = ground.aspect;
    turn.distance_m = distance_to_show(turn, ground.points, fov_y_rad, aspect);
    if (view.orbit.zoom == 1)
        centre(turn, ground.points, fov_y_rad, aspect);
    else
        turn.distance_m /= view.orbit.zoom;  // the ground in the middle stays there
    return turn;
}

Turn turn_of(const View& view, const MotionGround& ground) {
    if (!view.eye) {
        View whole = view;
        whole.orbit.aerial = false;
        return whole_turn(whole, ground.camera(whole), ground);
    }
    const Camera camera = ground.camera(view);
    if (view.look_at) {
        // The camera looks at it, so its distance is all that is missing.
        geo::Geodetic target = view.look_at->place;
        target.height_m *= view.look_at->above_ground ? 1 : ground.exaggeration;
        if (view.look_at->above_ground)
            target.height_m += ground.height_m(target) * ground.exaggeration;
        return turn_about(ground.frame.to_local(target), camera.eye_m, ground.frame);
    }
    const auto target_m = first_ground(camera.eye_m, camera.forward, ground.points, ground.height_m,
                                       ground.frame, ground.exaggeration);
    if (!target_m)
        bad_input(
            "expected a camera that faces the ground, or a place (look_at), but it "
            "looks past all ground");
    return turn_about(*target_m, camera.eye_m, ground.frame);
}

}  // namespace

std::vector<View> orbit_views(const OrbitMotion& motion, const View& view,
                              const MotionGround& ground) {
    const Turn turn = turn_of(view, ground);
    if (std::abs(turn.elevation_rad) > radians(89))
        bad_input(
            "expected a camera next to its target but it looks straight down; give it an "
            "elevation below 89 degrees");
    std::vector<geo::Geodetic> eyes;
    const int last = motion.frames - 1;
    for (int i = 0; i < motion.frames; ++i) {
        const double share = motion.ease ? eased(last > 0 ? double(i) / last : 0)
                                         : static_cast<double>(i) / motion.frames;
        eyes.push_back(ground.frame.to_geodetic(
            eye_of(turn, turn.azimuth_rad + 2 * kPi * motion.turns * share)));
    }
    const auto radius = static_cast<std::size_t>(motion.frames / 12);
    keep_above_ground(eyes, ground, kClearance_m, radius, !motion.ease);
    geo::Geodetic target = ground.frame.to_geodetic(turn.target_m);
    target.height_m /= ground.exaggeration;
    std::vector<View> views;
    for (const geo::Geodetic& eye : eyes) {
        views.push_back(view_from(eye, ground));
        views.back().look_at = Standpoint{target, false};
        views.back().take_lens_of(view);
    }
    return views;
}

}  // namespace relevo::scene
