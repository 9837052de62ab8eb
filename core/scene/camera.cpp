#include "scene/camera.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "base/error.h"
#include "base/units.h"
#include "scene/ground_nodes.h"

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

    /// @param margins  within what the insets leave; below 0 beyond it
    static Room within(double fov_y_rad, double aspect, const Insets& insets,
                       const Insets& margins) {
        const double tan_y = std::tan(fov_y_rad / 2), tan_x = tan_y * aspect;
        const double width = 2 * (1 - insets.left - insets.right);
        const double height = 2 * (1 - insets.bottom - insets.top);
        return {tan_x * (2 * insets.left - 1 + width * margins.left),
                tan_x * (1 - 2 * insets.right - width * margins.right),
                tan_y * (2 * insets.bottom - 1 + height * margins.bottom),
                tan_y * (1 - 2 * insets.top - height * margins.top)};
    }
};

/// Of an aerial view: most of the ground lies in this part of the picture. The near corners are
/// cut, and the far edge is whole.
constexpr Insets kAerialMargins{-0.9, -0.9, -0.15, 0.2};
/// Of land with its sea around it.
constexpr Insets kLandMargins{0.1, 0.1, 0.1, 0.25};
/// The margins at the sides are narrower if else too few posts are in the picture.
constexpr double kMarginStep = 0.05;
/// The lower margin grows until the near edge is below the picture, to this at most.
constexpr double kLowestMargin = -0.55, kBareBelow = 0.001;

/// How far a camera looks below the horizon that is 13 % below the upper edge of its picture.
double below_horizon_deg(double fov_y_rad) {
    return degrees(std::atan(0.74 * std::tan(fov_y_rad / 2)));
}

/// Where a camera stands that looks along a direction: `a` to the right and `b` up from the axis
/// through the origin, and a distance back along it [m].
struct Fit {
    double a = 0, b = 0, distance_m = 0;

    /// The share of these points that the camera has in a part of its picture.
    double share_of(const Camera& camera, std::span<const glm::dvec3> points,
                    const Room& room) const {
        if (points.empty()) return 1;
        const glm::dvec3 right = cross(camera.forward, camera.up);
        const auto shown = std::ranges::count_if(points, [&](const glm::dvec3& point) {
            const double depth = distance_m + dot(point, camera.forward);
            const double x = dot(point, right) - a, y = dot(point, camera.up) - b;
            return x >= depth * room.left && x <= depth * room.right && y >= depth * room.bottom &&
                   y <= depth * room.top;
        });
        return static_cast<double>(shown) / static_cast<double>(points.size());
    }

    /// Fraction of a part of the picture that lies below all points in the same of some columns.
    double bare_below(const Camera& camera, std::span<const glm::dvec3> points,
                      const Room& room) const {
        constexpr int kColumns = 24;
        std::array<double, kColumns> lowest;
        lowest.fill(room.top);
        const glm::dvec3 right = cross(camera.forward, camera.up);
        for (const glm::dvec3& point : points) {
            const double depth = distance_m + dot(point, camera.forward);
            const double x = (dot(point, right) - a) / depth;
            const double column = kColumns * (x - room.left) / (room.right - room.left);
            if (!(depth > 0 && column >= 0 && column < kColumns)) continue;
            double& of_column = lowest[static_cast<std::size_t>(column)];
            of_column = std::min(of_column, (dot(point, camera.up) - b) / depth);
        }
        double bare = 0;
        for (const double y : lowest)
            bare += std::max(y - room.bottom, 0.0) / (room.top - room.bottom) / kColumns;
        return bare;
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

/// What the points ask of a camera's place: with it at target + d to_camera + a right + b up, a
/// point z towards the camera is inside while (d - z) left <= x - a <= (d - z) right.
struct Wedges {
    struct Spread {
        double highest = -1e300, lowest = 1e300;
    } horizontal, vertical;
    double distance_m = -1e300;  ///< the nearest from which all are seen

    Wedges(const Camera& camera, std::span<const glm::dvec3> points, const Room& room) {
        const glm::dvec3 to_camera = -camera.forward;
        const glm::dvec3 right = cross(camera.forward, camera.up);
        double nearest = -1e300;
        for (const glm::dvec3& point : points) {
            const double x = dot(point, right), y = dot(point, camera.up),
                         z = dot(point, to_camera);
            horizontal.highest = std::max(horizontal.highest, x + z * room.right);
            horizontal.lowest = std::min(horizontal.lowest, x + z * room.left);
            vertical.highest = std::max(vertical.highest, y + z * room.top);
            vertical.lowest = std::min(vertical.lowest, y + z * room.bottom);
            nearest = std::max(nearest, z);
        }
        // The least a that x + z right leaves and the largest that x + z left does meet at the
        // distance: the larger of both directions' is the tightest view, no iteration.
        distance_m = std::max({(horizontal.highest - horizontal.lowest) / (room.right - room.left),
                               (vertical.highest - vertical.lowest) / (room.top - room.bottom),
                               nearest + 1});
    }
};

/// The nearest place from which all points are in a part of the picture.
Fit fit_to(const Camera& camera, std::span<const glm::dvec3> points, const Room& room) {
    const glm::dvec3 to_camera = -camera.forward;
    const glm::dvec3 right = cross(camera.forward, camera.up);
    const Wedges wedges(camera, points, room);
    Fit fit;
    fit.distance_m = wedges.distance_m;
    // That is the nearest place from which all is seen, but where one direction has room to spare
    // the ground need not lie in its middle: shift it there, as seen.
    fit.a = centred(points, right, to_camera, fit.distance_m, 0.5 * (room.left + room.right),
                    wedges.horizontal.highest - fit.distance_m * room.right,
                    wedges.horizontal.lowest - fit.distance_m * room.left);
    fit.b = centred(points, camera.up, to_camera, fit.distance_m, 0.5 * (room.bottom + room.top),
                    wedges.vertical.highest - fit.distance_m * room.top,
                    wedges.vertical.lowest - fit.distance_m * room.bottom);
    return fit;
}

/// As fit_to(), with the lowest point at the lower side of the part.
Fit fit_above(const Camera& camera, std::span<const glm::dvec3> points, const Room& room) {
    const Wedges wedges(camera, points, room);
    Fit fit;
    fit.distance_m = wedges.distance_m;
    fit.a = 0.5 * (wedges.horizontal.highest + wedges.horizontal.lowest -
                   fit.distance_m * (room.right + room.left));
    fit.b = wedges.vertical.lowest - fit.distance_m * room.bottom;
    return fit;
}

/// The nearest place from which enough posts are in the picture and the near edge is below it.
/// Voids can rule that out: then the place with the least picture below the edge.
/// @param aspect  of what the insets leave
template <typename RoomWithin>
Fit aerial_fit(const Camera& camera, const AerialGround& ground, double aspect, const Room& picture,
               const RoomWithin& room_within) {
    // A tall picture shows a strip of the DEM.
    const double tall = std::max(1 / aspect, 1.0);
    const double least_in_picture = ground.least_in_picture * std::pow(tall, -0.6);
    std::vector<glm::dvec3> all = ground.posts;
    all.insert(all.end(), ground.rim.begin(), ground.rim.end());
    Fit best;
    double least_bare = 1e300;
    Insets margins = kAerialMargins;
    margins.left = 0.5 - (0.5 - kAerialMargins.left) * tall;
    for (; margins.left < 0.01; margins.left += kMarginStep) {
        margins.right = margins.left;
        for (margins.bottom = kAerialMargins.bottom; margins.bottom >= kLowestMargin;
             margins.bottom -= kMarginStep) {
            const Fit fit = fit_above(camera, ground.posts, room_within(margins));
            const double bare = fit.bare_below(camera, all, picture);
            const bool shows_enough =
                fit.share_of(camera, ground.posts, picture) >= least_in_picture;
            if (shows_enough && bare < kBareBelow) return fit;
            if (least_bare > 1e299 || (shows_enough && bare < least_bare)) best = fit;
            if (!shows_enough) break;
            least_bare = std::min(least_bare, bare);
        }
    }
    return best;
}

/// Looks from the side of an orbit, from a place that is not known yet.
Camera facing(const Orbit& orbit, double fov_y_rad) {
    const double azimuth = radians(orbit.azimuth_deg.value());
    Camera camera;
    camera.fov_y_rad = fov_y_rad;
    camera.forward = -towards(orbit.azimuth_deg.value(), orbit.elevation_deg.value());
    camera.up = upright(camera.forward, {0, 0, 1}, {-std::sin(azimuth), -std::cos(azimuth), 0});
    return camera;
}

/// Zooming moves towards the mean depth of the points.
void place(Camera& camera, const Fit& fit, std::span<const glm::dvec3> points, double zoom) {
    const glm::dvec3 to_camera = -camera.forward;
    double middle = 0;
    for (const glm::dvec3& point : points)
        middle += dot(point, to_camera) / static_cast<double>(points.size());
    camera.eye_m = cross(camera.forward, camera.up) * fit.a + camera.up * fit.b +
                   to_camera * (middle + (fit.distance_m - middle) / std::max(zoom, 1e-6));
}

}  // namespace

double aerial_fov_rad(double aspect) {
    constexpr double kWide = 1.9;
    const double tan_y = std::tan(radians(kAerialFov_deg) / 2);
    return 2 * std::atan(aspect > kWide ? tan_y * kWide / aspect
                                        : tan_y / std::sqrt(std::min(aspect, 1.0)));
}

double fov_y_of_focal_length(double focal_length_mm, double aspect) {
    const double height_mm = aspect >= 1 ? 36 / aspect : 36;
    return 2 * std::atan(height_mm / 2 / focal_length_mm);
}

Camera orbit_camera(const Orbit& orbit, std::span<const glm::dvec3> points, double fov_y_rad,
                    double aspect, std::span<const glm::dvec3> also, const Insets& insets) {
    assert(insets.left + insets.right < 1 && insets.bottom + insets.top < 1);
    Camera camera = facing(orbit, fov_y_rad);
    Fit fit = fit_to(camera, points, Room::of(fov_y_rad, aspect, insets, kFill));
    if (fit.share_of(camera, also, Room::of(fov_y_rad, aspect, insets, 1)) < 1) {
        std::vector<glm::dvec3> all(points.begin(), points.end());
        all.insert(all.end(), also.begin(), also.end());
        fit = fit_to(camera, all, Room::of(fov_y_rad, aspect, insets, kFill));
    }
    place(camera, fit, points, orbit.zoom);
    return camera;
}

Camera aerial_camera(const Orbit& orbit, const AerialGround& ground, double fov_y_rad,
                     double aspect, const Insets& insets) {
    assert(!ground.posts.empty());
    assert(insets.left + insets.right < 1 && insets.bottom + insets.top < 1);
    Orbit aimed = orbit;
    aimed.elevation_deg = std::min(*orbit.elevation_deg + below_horizon_deg(fov_y_rad) -
                                       below_horizon_deg(radians(kAerialFov_deg)),
                                   90.0);
    Camera camera = facing(aimed, fov_y_rad);
    const Room picture = Room::of(fov_y_rad, aspect, insets, 1);
    if (ground.land_alone) {
        const Room room = Room::within(fov_y_rad, aspect, insets, kLandMargins);
        place(camera, fit_above(camera, ground.posts, room), ground.posts, orbit.zoom);
        return camera;
    }
    const double free =
        aspect * (1 - insets.left - insets.right) / (1 - insets.bottom - insets.top);
    const Fit fit = aerial_fit(camera, ground, free, picture, [&](const Insets& margins) {
        return Room::within(fov_y_rad, aspect, insets, margins);
    });
    place(camera, fit, ground.posts, orbit.zoom);
    return camera;
}

double share_in_picture(const Camera& camera, std::span<const glm::dvec3> points, double aspect) {
    const Fit at{dot(camera.eye_m, cross(camera.forward, camera.up)), dot(camera.eye_m, camera.up),
                 -dot(camera.eye_m, camera.forward)};
    return at.share_of(camera, points, Room::of(camera.fov_y_rad, aspect, {}, 1));
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
