#include "scene/view.h"

#include <algorithm>
#include <cmath>
#include <optional>
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

/// A standpoint in the local frame, the DEM's exaggeration included.
glm::dvec3 position_of(const Standpoint& standpoint, std::string_view option,
                       const GroundHeight& ground_height_m, const geo::LocalFrame& frame,
                       double exaggeration) {
    geo::Geodetic place = standpoint.place;
    if (standpoint.above_ground) {
        const double ground_m = ground_height_m(place);
        if (std::isnan(ground_m)) {
            const geo::Geodetic swapped{place.lon_rad, place.lat_rad, 0};
            if (std::abs(swapped.lat_rad) <= kPi / 2 && !std::isnan(ground_height_m(swapped)))
                bad_input(
                    fmt::format("{}: {}: outside the DEM; latitude comes first, perhaps "
                                "{:.10g},{:.10g}",
                                option, geo::degrees_text(place), degrees(swapped.lat_rad),
                                degrees(swapped.lon_rad)));
            bad_input(fmt::format(
                "{}: {}: outside the DEM or in a void, so there is no ground height; give one "
                "above the DEM's zero, as in {:.10g},{:.10g},500",
                option, geo::degrees_text(place), degrees(place.lat_rad), degrees(place.lon_rad)));
        }
        place.height_m += ground_m * exaggeration;
    } else {
        place.height_m *= exaggeration;
    }
    return frame.to_local(place);
}

/// A unit vector from the eye to the middle of the part of a picture that nothing covers.
glm::dvec3 middle_ray(const Camera& camera, double aspect, const Insets& insets) {
    const double tan_y = std::tan(camera.fov_y_rad / 2), tan_x = tan_y * aspect;
    return normalize(camera.forward +
                     tan_x * (insets.left - insets.right) * cross(camera.forward, camera.up) +
                     tan_y * (insets.bottom - insets.top) * camera.up);
}

/// The camera of an orbit. Zooming moves towards the ground in the picture's middle, which stays
/// there; where it shows none, towards the ground's mean distance.
Camera zoomed_orbit(const Orbit& orbit, const GroundHeight& ground_height_m,
                    const geo::LocalFrame& frame, const Outline& outline, double fov_y_rad,
                    double aspect, double exaggeration, const Insets& insets) {
    const auto fitted = [&](const Orbit& of) {
        return of.aerial
                   ? aerial_camera(of, outline.aerial, fov_y_rad, aspect, insets)
                   : orbit_camera(of, outline.points, fov_y_rad, aspect, outline.also, insets);
    };
    Orbit whole = orbit;
    whole.zoom = 1;
    Camera camera = fitted(whole);
    if (orbit.zoom == 1) return camera;
    const std::optional<glm::dvec3> target =
        first_ground(camera.eye_m, middle_ray(camera, aspect, insets), outline.points,
                     ground_height_m, frame, exaggeration);
    if (!target) return fitted(orbit);
    camera.eye_m = *target + (camera.eye_m - *target) / orbit.zoom;
    return camera;
}

}  // namespace

std::optional<glm::dvec3> first_ground(const glm::dvec3& eye_m, const glm::dvec3& ray,
                                       const std::vector<glm::dvec3>& points,
                                       const GroundHeight& ground_height_m,
                                       const geo::LocalFrame& frame, double exaggeration) {
    double nearest_m = 1e300, farthest_m = 0;
    for (const glm::dvec3& point : points) {
        nearest_m = std::min(nearest_m, dot(point - eye_m, ray));
        farthest_m = std::max(farthest_m, dot(point - eye_m, ray));
    }
    nearest_m = std::max(nearest_m, 0.0);
    const auto is_below = [&](double along_m) {
        const geo::Geodetic place = frame.to_geodetic(eye_m + along_m * ray);
        return place.height_m <= ground_height_m(place) * exaggeration;  // not in voids, NaN
    };
    constexpr int kSteps = 1024, kHalvings = 40;
    double above_m = nearest_m;
    for (int i = 0; i <= kSteps; ++i) {
        double below_m = nearest_m + (farthest_m - nearest_m) * i / kSteps;
        if (!is_below(below_m)) {
            above_m = below_m;
            continue;
        }
        for (int j = 0; j < kHalvings; ++j) {
            const double middle_m = 0.5 * (above_m + below_m);
            (is_below(middle_m) ? below_m : above_m) = middle_m;
        }
        return eye_m + above_m * ray;
    }
    return std::nullopt;
}

void View::take_lens_of(const View& other) {
    fov_y_rad = other.fov_y_rad;
    focal_length_mm = other.focal_length_mm;
    panorama = other.panorama;
    hfov_rad = other.hfov_rad;
    stereo = other.stereo;
    eye_distance_m = other.eye_distance_m;
}

double within_a_turn_deg(double angle_deg) {
    return std::abs(angle_deg) <= 360 ? angle_deg : std::fmod(angle_deg, 360.0);
}

bool is_from_above(const View& view) {
    const Orbit& orbit = view.orbit;
    return !view.eye && !view.look_at && !orbit.aerial && orbit.azimuth_deg == 180 &&
           orbit.elevation_deg == 90 && orbit.zoom == 1 && view.panorama == Panorama::None &&
           view.stereo == Stereo::None;
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
    if (word == "aerial" || word == "whole") {
        view.orbit.aerial = word == "aerial";
        return true;
    }
    view.orbit.aerial = false;
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

/// "; did you mean north?" of a word that is nearly a side's; else empty.
std::string meant_side(std::string_view word) {
    std::vector<std::string> words{"top", "whole", "aerial"};
    for (const Side& side : kSides)
        words.emplace_back(side.word);
    const std::optional<std::string> near = nearest(word, words);
    if (near == word) return "; a side comes first, as in north,el=40";
    return near ? fmt::format("; did you mean {}?", *near) : "";
}

}  // namespace

View parse_view(std::string_view text) {
    View view;
    Orbit& orbit = view.orbit;
    bool first = true, has_word = false;
    for (const std::string& piece : split(text, ',')) {
        if (std::exchange(first, false) && (has_word = read_side(piece, view))) continue;
        const std::size_t equals = piece.find('=');
        const std::string key = piece.substr(0, equals);
        const auto value = equals == std::string::npos
                               ? std::nullopt
                               : parse_number(std::string_view(piece).substr(equals + 1));
        if (!value || (key != "az" && key != "el" && key != "zoom"))
            bad_usage(fmt::format(
                "--view: {}: expected top, whole, north, north-east, ... north-west, or "
                "az=DEG,el=DEG,zoom=FACTOR, but got \"{}\"{}",
                text, piece, meant_side(piece)));
        if (key == "az") orbit.azimuth_deg = within_a_turn_deg(*value);
        if (key == "el") orbit.elevation_deg = *value;
        if (key == "zoom") orbit.zoom = *value;
    }
    if (!has_word) orbit.aerial = !orbit.azimuth_deg && !orbit.elevation_deg;
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
                             : !view.eye && view.orbit.aerial ? aerial_fov_rad(aspect)
                                                              : radians(kDefaultFov_deg);
    if (!view.eye) {
        Camera camera = zoomed_orbit(view.orbit, ground_height_m, frame, outline, fov_y_rad, aspect,
                                     exaggeration, insets);
        // Where no ground is in the middle it may come to stand inside a mountain: then on it.
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
