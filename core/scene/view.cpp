#include "scene/view.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/error.h"
#include "base/log.h"
#include "base/text.h"
#include "base/units.h"
#include "geo/format.h"

namespace relevo::scene {
namespace {

constexpr double kClearance_m = 2;  // of a camera above the ground

/// A standpoint in the local frame, the DEM's exaggeration included.
glm::dvec3 position_of(const Standpoint& standpoint, std::string_view option,
                       const GroundHeight& ground_height_m, const geo::LocalFrame& frame,
                       double exaggeration) {
    geo::Geodetic place = standpoint.place;
    if (standpoint.above_ground) {
        const double ground_m = ground_height_m(place);
        if (std::isnan(ground_m))
            bad_input(fmt::format(
                "{}: {}: outside the DEM or in a void, so there is no ground height; give one "
                "above the DEM's zero, as in {:.10g},{:.10g},500",
                option, geo::degrees_text(place), degrees(place.lat_rad), degrees(place.lon_rad)));
        place.height_m += ground_m * exaggeration;
    } else {
        place.height_m *= exaggeration;
    }
    return frame.to_local(place);
}

}  // namespace

double within_a_turn_deg(double angle_deg) {
    return std::abs(angle_deg) <= 360 ? angle_deg : std::fmod(angle_deg, 360.0);
}

namespace {

struct Side {
    std::string_view word;
    double azimuth_deg;
};
constexpr Side kSides[] = {{"north", 0},   {"north-east", 45},  {"east", 90},  {"south-east", 135},
                           {"south", 180}, {"south-west", 225}, {"west", 270}, {"north-west", 315}};

/// Whether it is a word of --view, which is then in the view.
bool read_side(std::string_view word, View& view) {
    if (word == "top") {
        // South of the middle, so that north is up.
        view.orbit.azimuth_deg = 180;
        view.orbit.elevation_deg = 90;
        view.fov_y_rad = radians(kMapFov_deg);
        return true;
    }
    for (const Side& side : kSides) {
        if (word != side.word) continue;
        view.orbit.azimuth_deg = side.azimuth_deg;
        return true;
    }
    return false;
}

}  // namespace

View parse_view(std::string_view text) {
    View view;
    Orbit& orbit = view.orbit;
    bool first = true;
    for (const std::string& piece : split(text, ',')) {
        if (std::exchange(first, false) && read_side(piece, view)) continue;
        const std::size_t equals = piece.find('=');
        const std::string key = piece.substr(0, equals);
        const auto value = equals == std::string::npos
                               ? std::nullopt
                               : parse_number(std::string_view(piece).substr(equals + 1));
        if (!value || (key != "az" && key != "el" && key != "zoom"))
            bad_usage(
                fmt::format("--view: {}: expected top, north, north-east, ... north-west, or "
                            "az=DEG,el=DEG,zoom=FACTOR, but got \"{}\"",
                            text, piece));
        if (key == "az") orbit.azimuth_deg = within_a_turn_deg(*value);
        if (key == "el") orbit.elevation_deg = *value;
        if (key == "zoom") orbit.zoom = *value;
    }
    if (orbit.elevation_deg && (*orbit.elevation_deg < -90 || *orbit.elevation_deg > 90))
        bad_usage(fmt::format("--view: {}: expected an elevation of -90 to 90 degrees but got {}",
                              text, *orbit.elevation_deg));
    if (!(orbit.zoom >= kMinZoom && orbit.zoom <= kMaxZoom))
        bad_usage(fmt::format("--view: {}: expected a zoom of {} to {} but got {}", text, kMinZoom,
                              kMaxZoom, orbit.zoom));
    return view;
}

Camera make_camera(const View& view, const GroundHeight& ground_height_m,
                   const geo::LocalFrame& frame, const Outline& outline, double aspect,
                   double exaggeration, const Insets& insets) {
    const double fov_y_rad = view.fov_y_rad > 0 ? view.fov_y_rad
                             : view.focal_length_mm > 0
                                 ? fov_y_of_focal_length(view.focal_length_mm, aspect)
                                 : radians(kDefaultFov_deg);
    if (!view.eye) {
        Camera camera =
            orbit_camera(view.orbit, outline.points, fov_y_rad, aspect, outline.also, insets);
        // Zoomed in, the camera may come to stand inside a mountain: then it stands on it.
        const geo::Geodetic place = frame.to_geodetic(camera.eye_m);
        const double ground_m = ground_height_m(place) * exaggeration;
        if (!std::isnan(ground_m) && place.height_m < ground_m + kClearance_m)
            camera.eye_m = frame.to_local({place.lat_rad, place.lon_rad, ground_m + kClearance_m});
        return camera;
    }
    const glm::dvec3 eye_m = position_of(*view.eye, "--eye", ground_height_m, frame, exaggeration);
    const geo::Geodetic place = frame.to_geodetic(eye_m);
    const geo::Axes axes = frame.axes(place.lat_rad, place.lon_rad);
    if (view.look_at)
        return look_at_camera(
            eye_m, position_of(*view.look_at, "--look-at", ground_height_m, frame, exaggeration),
            axes.up, fov_y_rad);
    return heading_camera(eye_m, axes, view.heading_deg, view.pitch_deg, fov_y_rad);
}

void warn_of_eye_below_ground(const View& view, const GroundHeight& ground_height_m,
                              const geo::LocalFrame& frame, double exaggeration) {
    if (!view.eye) return;
    const geo::Geodetic place =
        frame.to_geodetic(position_of(*view.eye, "--eye", ground_height_m, frame, exaggeration));
    const double ground_m = ground_height_m(place) * exaggeration;
    if (place.height_m < ground_m)
        log::warning(fmt::format(
            "--eye: it is {:.0f} m below the ground, which is at {:.0f} m there; a height "
            "with the suffix agl counts from the ground",
            ground_m - place.height_m, ground_m / exaggeration));
}

}  // namespace relevo::scene
