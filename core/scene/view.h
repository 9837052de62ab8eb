#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/units.h"
#include "geo/geodetic.h"
#include "scene/camera.h"

namespace relevo::scene {

/// A place and a height as people give them: above the DEM's zero, or above the ground there.
struct Standpoint {
    geo::Geodetic place;
    bool above_ground = false;  ///< place.height_m counts from the ground

    bool operator==(const Standpoint&) const = default;
};

/// How a picture all around the eye is projected: core/scene/panorama.h.
enum class Panorama { None, Cylindrical, Equirectangular };

/// How a pair of pictures for two eyes is put into one: core/scene/stereo.h.
enum class Stereo { None, Parallel, CrossEyed, Anaglyph };

/// What the user says of the camera, before the DEM is known: an orbit, or an eye that looks at a
/// place or along a heading.
struct View {
    Orbit orbit{.aerial = true};
    std::optional<Standpoint> eye;
    std::optional<Standpoint> look_at;
    double heading_deg = 0;
    double pitch_deg = 0;
    double fov_y_rad = 0;        ///< 0: from the focal length, else the default
    double focal_length_mm = 0;  ///< 35 mm equivalent; 0: none given
    Panorama panorama = Panorama::None;
    double hfov_rad = 2 * kPi;  ///< horizontal field of view of a panorama
    Stereo stereo = Stereo::None;
    double eye_distance_m = 0;  ///< between the eyes of a stereo pair; 0: by the near ground

    /// Takes what does not depend on the place of a camera from another.
    void take_lens_of(const View& other);

    bool operator==(const View&) const = default;
};

/// Beyond them the ground is less than a pixel, or less than a millimetre of it is seen.
inline constexpr double kMinZoom = 0.001, kMaxZoom = 1000000;

/// The same direction within one turn, -360 to 360, as scenes hold it.
double within_a_turn_deg(double angle_deg);

/// Vertical field of view of a map: from so far that ground leans by less than a hundredth of its
/// height at the picture's edges, as good as parallel rays.
inline constexpr double kMapFov_deg = 1;

/// Whether a view is `top`, which shows all of the ground from straight above with north up.
bool is_from_above(const View& view);

/// Reads `az=210,el=30,zoom=1`, or with a word in the place of the azimuth `north-east,el=45`: the
/// side that the camera stands on, north, north-east, ... north-west; `top`: from straight above
/// with north up, as a map; `whole`: all of the DEM, from a side that is chosen; or `aerial`. A
/// view is aerial if no word and no angle is given. Skipped angles stay open.
/// @throws Error (Usage) `--view: text: what, expected E but got G`
View parse_view(std::string_view text);

/// Height of the eye above the ground where none is given [m]: a person's.
inline constexpr double kEyeHeight_m = 1.7;

/// An orbit's eye is no nearer above the ground [m].
inline constexpr double kClearance_m = 2;

/// The DEM's height at a place [m]; NaN where it has no ground.
using GroundHeight = std::function<double(const geo::Geodetic& place)>;

/// Ground that an orbit has to show, in the DEM's local frame [m]: orbit_camera()'s points.
struct Outline {
    std::vector<glm::dvec3> points, also;
    AerialGround aerial;
};

/// The camera of a view of a DEM.
/// @param frame   the DEM's local frame
/// @param aspect  width / height of the picture
/// @param insets  as orbit_camera()'s
/// @throws Error (BadInput) for a standpoint above the ground where the DEM has none
Camera make_camera(const View& view, const GroundHeight& ground_height_m,
                   const geo::LocalFrame& frame, const Outline& outline, double aspect,
                   double exaggeration, const Insets& insets = {});

/// The first point of the ground along a ray from an eye, in the DEM's local frame [m]; none where
/// it meets no ground.
/// @param ray     unit
/// @param points  of the ground: no other is nearer or farther along the ray than these
std::optional<glm::dvec3> first_ground(const glm::dvec3& eye_m, const glm::dvec3& ray,
                                       const std::vector<glm::dvec3>& points,
                                       const GroundHeight& ground_height_m,
                                       const geo::LocalFrame& frame, double exaggeration);

/// Logs a warning where the eye of a view stands below the ground.
/// @throws Error (BadInput) as make_camera()
void warn_of_eye_below_ground(const View& view, const GroundHeight& ground_height_m,
                              const geo::LocalFrame& frame, double exaggeration);

}  // namespace relevo::scene
