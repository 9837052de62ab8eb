#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "geo/geodetic.h"
#include "geo/local_frame.h"
#include "scene/camera.h"
#include "scene/view.h"

/// Cameras that move: a view for each frame of a film. Pure: the ground comes in as functions.
namespace relevo::scene {

/// Limits of a motion's frames.
inline constexpr int kMostFrames = 1'000'000;

/// No camera turns faster, unless its views ask for it [degrees/s].
inline constexpr double kMostTurn_deg_s = 30;

/// The scene that a camera moves over.
struct MotionGround {
    GroundHeight height_m;  ///< of the drawn ground, without the exaggeration; NaN: none
    geo::LocalFrame frame;  ///< the DEM's
    double exaggeration = 1;
    std::vector<glm::dvec3> points;  ///< that an orbit has to show, in `frame` [m]
    double aspect = 1;               ///< width / height of the frames
    /// The camera that a view has, in `frame`.
    std::function<Camera(const View&)> camera;
};

/// Once around what a camera looks at, at one height and distance.
struct OrbitMotion {
    double turns = 1;   ///< clockwise from above; negative: the other way
    int frames = 240;   ///< the last is one step before the first again
    bool ease = false;  ///< begins and ends at rest; the last frame is then the end of the turn
};

/// The views of an orbit around the target of a view: the place that it looks at, or the ground in
/// the picture's middle. A view that is an orbit shows the whole ground from all sides, and stands
/// as near as that allows.
/// @param view  of the orbit's beginning
/// @throws Error (BadInput) `expected E but got G` where the view has no target, or looks straight
///     down
std::vector<View> orbit_views(const OrbitMotion& motion, const View& view,
                              const MotionGround& ground);

/// A flight along a line, or through views.
struct FlightMotion {
    std::vector<geo::Geodetic> along;  ///< empty: through `views`
    std::vector<View> views;
    double height_m = 150;  ///< above ground at least, of a flight along a line
    /// How far ahead on the line the camera looks; bends narrower than it are cut. 0: chosen by
    /// reach_of().
    double look_ahead_m = 0;
    int frames = 300;
    double fps = 30;   ///< for how fast the camera turns
    bool ease = true;  ///< begins and ends at rest
};

/// How far a flight along a line looks ahead, and over how much of the line it rises and sinks [m].
struct Reach {
    double look_ahead_m = 0;
    double rise_m = 0;  ///< at least `look_ahead_m`, and two seconds of the flight
};
/// @param mean_speed_m_s  of the flight
Reach reach_of(const FlightMotion& motion, double mean_speed_m_s);

/// Frames of a flight along a line at a speed, the highest of one that begins and ends at rest. May
/// be more than kMostFrames.
/// @throws Error (BadInput) as GroundPath
double frames_at_speed(const FlightMotion& motion, double speed_m_s);

/// The views of a flight. The eye is nowhere below the ground: along a line it is `height_m` above
/// all ground within Reach::rise_m along it, through views it is raised where it would come nearer
/// to the ground than the views are. Where the line has no ground, it keeps the height from the
/// nearest that it has.
/// @param view     its field of view is that of a flight along a line
/// @param warning  is set if more than 1 % of the line has no ground
/// @throws Error (BadInput) `expected E but got G` for a line or views that are one place, and for
///     a line without any ground
std::vector<View> flight_views(const FlightMotion& motion, const View& view,
                               const MotionGround& ground, std::string& warning);

/// Raises eyes that are less than `clearance_m` above the ground, and their neighbours with them.
/// @param eyes      heights with the exaggeration; of places without ground nothing is asked
/// @param radius    frames over which an eye rises
/// @param cyclic    the last eye is next to the first
void keep_above_ground(std::vector<geo::Geodetic>& eyes, const MotionGround& ground,
                       double clearance_m, std::size_t radius, bool cyclic);

/// A view from an eye whose height has the exaggeration.
View view_from(const geo::Geodetic& eye, const MotionGround& ground);

}  // namespace relevo::scene
