#pragma once

#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "geo/local_frame.h"
#include "scene/camera.h"
#include "scene/view.h"

/// How the hand moves the camera. Positions are in the DEM's local frame, exaggerated, metres;
/// places in the picture run from -1 to 1, right and up.
namespace relevo::viewer {

/// Where the camera stands and looks: upright, as a person holds it.
struct Pose {
    glm::dvec3 eye_m{0};
    double heading_deg = 0;  ///< clockwise from true north
    double pitch_deg = 0;    ///< above the horizontal
    double fov_y_rad = 0;
};

/// The ground that the camera moves over.
struct Land {
    const geo::LocalFrame* frame = nullptr;
    double exaggeration = 1;
    /// The DEM's height at a place [m], not exaggerated; NaN where it has none.
    scene::GroundHeight height_m;
    /// The same as it is drawn, for the camera: session::Session::heights_to_aim_at().
    scene::GroundHeight aim_m;

    /// The drawn ground's height under a point, exaggerated; NaN where there is none.
    double ground_under(const glm::dvec3& point_m) const;
    geo::Axes axes(const glm::dvec3& point_m) const;
};

/// Heights above the ground that the camera keeps [m].
inline constexpr double kClearance_m = 1, kWalk_m = 1.7;

scene::Camera camera_of(const Pose& pose, const Land& land);
Pose pose_of(const scene::Camera& camera, const Land& land);
/// The same as an eye, as the command line and scenes have it.
scene::View view_of(const Pose& pose, const Land& land);

/// Direction of a place in the picture, unit.
glm::dvec3 ray(const scene::Camera& camera, glm::dvec2 at, double aspect);
/// Where a point is in the picture; none behind the camera.
std::optional<glm::dvec2> in_picture(const scene::Camera& camera, const glm::dvec3& point_m,
                                     double aspect);

/// From -1 to 1 to the window's pixels, from its upper left, and back.
glm::vec2 in_window(glm::dvec2 at, glm::vec2 size_px);
glm::dvec2 in_view(glm::vec2 at_px, glm::vec2 size_px);

/// Turns about a point of the ground, which stays where it is in the picture.
Pose orbit(const Pose& pose, const Land& land, const glm::dvec3& pivot_m, double right_deg,
           double up_deg);
/// Moves level, so that the ground that was grabbed comes to a place in the picture.
Pose pan(const Pose& pose, const Land& land, const glm::dvec3& grabbed_m, glm::dvec2 to,
         double aspect);
/// The DEM's height where a point of its surface is drawn [m], not exaggerated. NaN where the DEM
/// has none, which may be drawn filled, and on what is cut off below its surface.
/// @param within_m  how far below the ground's place its surface may be drawn, exaggerated
double drawn_height_m(const glm::dvec3& point_m, const Land& land, double within_m);
/// Nearer to a point, which stays where it is in the picture. @param factor  of the distance
Pose zoom(const Pose& pose, const Land& land, const glm::dvec3& point_m, double factor);
/// The factor of the distance that a wheel's turn means. @param notches  touchpads send parts of
/// one
double zoom_of_scroll(double notches);
/// Turns the head.
Pose look_around(const Pose& pose, double right_deg, double up_deg);
/// Flies: right, forward as it looks, up [m].
Pose fly(const Pose& pose, const Land& land, const glm::dvec3& by_m);
/// Walks: right and forward on the level, at eye height above the ground [m].
Pose walk(const Pose& pose, const Land& land, glm::dvec2 by_m);
/// Looks at a point from a distance, from the side that it looks from now; down at it at least by
/// 20 degrees.
Pose look_at(const Pose& pose, const Land& land, const glm::dvec3& point_m, double distance_m);
/// Looks from above, north up, at a point from a distance.
Pose from_above(const Pose& pose, const Land& land, const glm::dvec3& point_m, double distance_m);

}  // namespace relevo::viewer
