#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "geo/local_frame.h"

/// Where the picture is taken from. Positions are in the DEM's local frame: x east, y north, z up
/// at its centre, metres, the DEM's exaggeration included.
namespace relevo::scene {

class MapView;

/// A pinhole camera, or a map's.
struct Camera {
    glm::dvec3 eye_m{0, 0, 0};
    glm::dvec3 forward{0, 1, 0};  ///< unit
    glm::dvec3 up{0, 0, 1};       ///< unit, orthogonal to forward: the top of the picture
    double fov_y_rad = 0;         ///< angle from the bottom to the top of the picture
    /// Of an orthographic picture from above, whose points are where the map has them. The rest
    /// then is a pinhole far above (map_camera()), by which it is shaded. Null: a pinhole.
    std::shared_ptr<const MapView> map{};
    double map_aspect = 0;  ///< of a map: width / height of the ground that it shows
};

inline constexpr double kDefaultFov_deg = 40, kAerialFov_deg = 50;

/// The share of the picture's width or height that the ground's outline fills in an orbit of
/// zoom 1.
inline constexpr double kFill = 0.95;

/// What is covered along the sides of a picture, by a window's panels for instance: shares of its
/// width and height, opposite sides together below 1.
struct Insets {
    double left = 0, right = 0, bottom = 0, top = 0;

    bool operator==(const Insets&) const = default;
};

/// A camera that circles a target.
struct Orbit {
    /// Where the camera stands as seen from the target, from true north; none: where relief stands
    /// up (scene::frame_ground).
    std::optional<double> azimuth_deg{};
    std::optional<double> elevation_deg{};  ///< how high it stands, -90 to 90; none: likewise
    /// 1 shows the whole of the ground; 2 shows what is in the picture's middle from half as far.
    double zoom = 1;
    /// Framed as from an aeroplane above the near edge (scene/aerial.h); else all of the ground is
    /// in the picture.
    bool aerial = false;

    bool operator==(const Orbit&) const = default;
};

/// The ground that aerial views frame, in the local frame [m].
struct AerialGround {
    /// Evenly spread posts; of the land alone where most of the DEM is a level sea.
    std::vector<glm::dvec3> posts;
    /// The first and the last posts of rows and columns: the near ones are below the picture.
    std::vector<glm::dvec3> rim{};
    bool land_alone = false;
    /// Fraction of the posts that is in the picture at least.
    double least_in_picture = 0.81;
};

/// Vertical field of view of aerial views for which none is given: kAerialFov_deg, in very wide
/// pictures less, in tall ones more.
double aerial_fov_rad(double aspect);

/// Vertical field of view of a lens on 36 x 24 mm film, the long side of the film along the long
/// side of the picture. @param focal_length_mm  above 0
double fov_y_of_focal_length(double focal_length_mm, double aspect);

/// Stands so that all `points` are in the picture and their outline fills kFill of its width or
/// height, and then nearer to their mean distance, or farther from it, by `zoom`. Where ground is
/// in the picture's middle, make_camera() zooms to that instead.
/// @param orbit    with both angles
/// @param points   ground to show, in the local frame [m], at least one
/// @param aspect   width / height of the picture
/// @param also     has to be in the picture too; where it is, the camera stands as without it
/// @param insets   all of this beside them
Camera orbit_camera(const Orbit& orbit, std::span<const glm::dvec3> points, double fov_y_rad,
                    double aspect, std::span<const glm::dvec3> also = {},
                    const Insets& insets = {});

/// As from an aeroplane above the near edge: the nearest place from which most of the posts are in
/// the picture, with the near corners beyond its sides, the near edge below it and the far edge
/// whole. Land alone is in the picture as a whole, with the sea around it.
/// @param orbit  with both angles. Its elevation is the pitch downwards at kAerialFov_deg; with
///     other fields of view the pitch is such that the horizon stays where it is in the picture
Camera aerial_camera(const Orbit& orbit, const AerialGround& ground, double fov_y_rad,
                     double aspect, const Insets& insets = {});

/// Fraction of the points that is in a picture.
double share_in_picture(const Camera& camera, std::span<const glm::dvec3> points, double aspect);

/// Stands at `eye_m` and looks along a compass heading.
/// @param axes         east, north and up at the eye
/// @param heading_deg  clockwise from true north
/// @param pitch_deg    above the horizontal, -90 to 90
Camera heading_camera(const glm::dvec3& eye_m, const geo::Axes& axes, double heading_deg,
                      double pitch_deg, double fov_y_rad);

/// Stands at `eye_m` and looks at `target_m`; the local vertical `up` is upright in the picture.
/// @throws Error (BadInput) if both are the same point
Camera look_at_camera(const glm::dvec3& eye_m, const glm::dvec3& target_m, const glm::dvec3& up,
                      double fov_y_rad);

}  // namespace relevo::scene
