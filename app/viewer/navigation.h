#pragma once

#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "geo/local_frame.h"
#include "scene/camera.h"
#include "scene/view.h"

/// Camera motion by the user. Positions are in the DEM's local frame, exaggerated [m]; image
/// positions are from -1 to 1, right and up.
namespace relevo::viewer {

/// Position and direction of an upright camera.
struct Pose {
    glm::dvec3 eye_m{0};
    double heading_deg = 0;  ///< clockwise from true north
    double pitch_deg = 0;    ///< above the horizontal
    double fov_y_rad = 0;

    bool operator==(const Pose&) const = default;
};

/// The ground below the camera.
struct Land {
    const geo::LocalFrame* frame = nullptr;
    double exaggeration = 1;
    /// Height of the DEM [m], not exaggerated; NaN in voids.
    scene::GroundHeight height_m;
    /// Height of the drawn ground [m], for the camera: session::Session::heights_to_aim_at().
    scene::GroundHeight aim_m;

    /// Height of the drawn ground under a point [m], exaggerated; NaN without ground.
    double ground_under(const glm::dvec3& point_m) const;
    geo::Axes axes(const glm::dvec3& point_m) const;
};

/// Least height of the camera above ground, and eye height when walking [m].
inline constexpr double kClearance_m = 1, kWalk_m = 1.7;

scene::Camera camera_of(const Pose& pose, const Land& land);
Pose pose_of(const scene::Camera& camera, const Land& land);
/// The pose as a view, as on the command line and in scenes.
scene::View view_of(const Pose& pose, const Land& land);

/// A pose relative to ground that is drawn with another exaggeration.
Pose exaggerated(const Pose& pose, const Land& land, double from, double to);

/// Unit vector through an image position.
glm::dvec3 ray(const scene::Camera& camera, glm::dvec2 at, double aspect);
/// Image position of a point; nullopt behind the camera.
std::optional<glm::dvec2> in_picture(const scene::Camera& camera, const glm::dvec3& point_m,
                                     double aspect);

/// From image positions (-1 to 1) to the window's pixels from its upper left corner, and back.
glm::vec2 in_window(glm::dvec2 at, glm::vec2 size_px);
glm::dvec2 in_view(glm::vec2 at_px, glm::vec2 size_px);

/// Orbits a point of the ground, which keeps its image position.
Pose orbit(const Pose& pose, const Land& land, const glm::dvec3& pivot_m, double right_deg,
           double up_deg);
/// Moves horizontally, so that the grabbed ground reaches an image position.
Pose pan(const Pose& pose, const Land& land, const glm::dvec3& grabbed_m, glm::dvec2 to,
         double aspect);
/// Height of the DEM where a point of its surface is drawn [m], not exaggerated. NaN in voids,
/// filled or not, and on walls below the surface.
/// @param within_m  tolerance below the surface, exaggerated
double drawn_height_m(const glm::dvec3& point_m, const Land& land, double within_m);
/// within_m of a picture: everything where it may still show coarser ground than the DEM's, unless
/// it shows walls.
/// @param px_m  size of a pixel at the point
double height_tolerance_m(bool is_sharp, bool has_walls, double px_m, double spacing_m);
/// Zooms to a point, which keeps its image position. @param factor  of the distance
Pose zoom(const Pose& pose, const Land& land, const glm::dvec3& point_m, double factor);
/// Factor of the distance for a wheel event. @param notches  fractional on touchpads
double zoom_of_scroll(double notches);
/// Rotates the camera about its position.
Pose look_around(const Pose& pose, double right_deg, double up_deg);
/// Moves by (right, forward along the line of sight, up) [m].
Pose fly(const Pose& pose, const Land& land, const glm::dvec3& by_m);
/// Moves horizontally by (right, forward) [m], at eye height above ground.
Pose walk(const Pose& pose, const Land& land, glm::dvec2 by_m);
/// Stands at eye height on the drawn ground at a point, looking as before but not downwards.
/// @returns none: there is no ground
std::optional<Pose> stand(const Pose& pose, const Land& land, const glm::dvec3& point_m);
/// Turns to a point.
Pose facing(const Pose& pose, const Land& land, const glm::dvec3& point_m);
/// Turns to the middle of what the insets leave free of a window, which then fills a picture.
/// @param window, picture  their width over height
Pose centred(const Pose& pose, const Land& land, const scene::Insets& insets, double window,
             double picture);
/// Looks at a point from a distance, from the current direction but at least 20 degrees downwards.
Pose look_at(const Pose& pose, const Land& land, const glm::dvec3& point_m, double distance_m);
/// Looks straight down at a point from a distance, north up.
Pose from_above(const Pose& pose, const Land& land, const glm::dvec3& point_m, double distance_m);

}  // namespace relevo::viewer
