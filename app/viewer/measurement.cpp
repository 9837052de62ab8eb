#include "viewer/measurement.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/vec2.hpp>

#include "base/units.h"
#include "figure/options.h"
#include "light/point/apparent_elevation.h"

namespace relevo::viewer {
namespace {

constexpr double kLeastSteps = 400, kMostSteps = 4000;

void add_rise(Profile& profile, const ProfilePoint& from, const ProfilePoint& to) {
    const double rise_m = to.place.height_m - from.place.height_m;
    if (std::isnan(rise_m)) return;
    profile.surface_m += std::hypot(to.distance_m - from.distance_m, rise_m);
    (rise_m > 0 ? profile.up_m : profile.down_m) += std::abs(rise_m);
}

/// On which side of the line from a to b a point lies.
double side(glm::dvec2 a, glm::dvec2 b, glm::dvec2 of) {
    return (b.x - a.x) * (of.y - a.y) - (b.y - a.y) * (of.x - a.x);
}

bool cross(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c, glm::dvec2 d) {
    return side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;
}

/// Whether the outline of a polygon crosses itself, on a plane of latitude and longitude.
bool outline_crosses(std::span<const geo::Geodetic> corners) {
    const std::size_t n = corners.size();
    const auto at = [&](std::size_t i) {
        const geo::Geodetic& corner = corners[i % n];
        // Longitudes near the first one: an outline may cross 180 degrees.
        return glm::dvec2(std::remainder(corner.lon_rad - corners[0].lon_rad, 2 * kPi),
                          corner.lat_rad);
    };
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = i + 2; k < n; ++k)
            if (cross(at(i), at(i + 1), at(k), at(k + 1))) return true;
    return false;
}

}  // namespace

Profile Profile::along(std::span<const geo::Geodetic> corners, const Land& land, double spacing_m) {
    Profile profile;
    std::vector<geo::Geodesic> legs;
    for (std::size_t i = 1; i < corners.size(); ++i) {
        legs.push_back(geo::geodesic(corners[i - 1], corners[i]));
        profile.level_m += legs.back().distance_m;
    }
    const double steps = std::clamp(profile.level_m / spacing_m, kLeastSteps, kMostSteps);
    const double step_m = std::max(profile.level_m / steps, 1e-9);
    const auto add = [&](const geo::Geodetic& place, double distance_m) {
        profile.points.push_back({distance_m, place});
        profile.points.back().place.height_m = land.height_m(place);
    };
    add(corners[0], 0);
    double before_m = 0;
    for (std::size_t i = 0; i < legs.size(); ++i) {
        const geo::Geodesic& leg = legs[i];
        const int count = std::max(1, static_cast<int>(std::lround(leg.distance_m / step_m)));
        for (int k = 1; k <= count; ++k) {
            const double way_m = leg.distance_m * k / count;
            add(k == count ? corners[i + 1] : geo::destination(corners[i], leg.azimuth_rad, way_m),
                before_m + way_m);
        }
        before_m += leg.distance_m;
    }
    profile.azimuth_rad = legs.front().azimuth_rad;
    profile.back_rad = std::fmod(legs.back().end_azimuth_rad + kPi, 2 * kPi);
    profile.lowest_m = profile.highest_m = std::nan("");
    for (std::size_t i = 0; i < profile.points.size(); ++i) {
        const double height_m = profile.points[i].place.height_m;
        profile.has_voids = profile.has_voids || std::isnan(height_m);
        profile.lowest_m = std::fmin(profile.lowest_m, height_m);
        profile.highest_m = std::fmax(profile.highest_m, height_m);
        if (i > 0) add_rise(profile, profile.points[i - 1], profile.points[i]);
    }
    return profile;
}

std::optional<LineOfSight> line_of_sight(const Profile& profile, double eye_m, double target_m) {
    if (profile.points.size() < 3) return std::nullopt;
    const ProfilePoint &first = profile.points.front(), &last = profile.points.back();
    if (std::isnan(first.place.height_m + last.place.height_m)) return std::nullopt;
    const light::ApparentElevation elevation{
        light::radius_of_curvature_m(first.place.lat_rad, profile.azimuth_rad),
        first.place.height_m + eye_m, figure::kTerrestrialRefraction.value};
    const auto tangent = [&](const ProfilePoint& point) {
        return elevation.tangent(point.place.height_m, point.distance_m);
    };
    const ProfilePoint* highest = nullptr;
    for (std::size_t i = 1; i + 1 < profile.points.size(); ++i) {
        const ProfilePoint& point = profile.points[i];
        if (std::isnan(point.place.height_m)) continue;
        if (!highest || tangent(point) > tangent(*highest)) highest = &point;
    }
    if (!highest) return std::nullopt;
    const double needed_m = elevation.height_m(tangent(*highest), last.distance_m);
    return LineOfSight{needed_m - (last.place.height_m + target_m), *highest};
}

void Measurement::start(glm::dvec3 point_m) {
    const float eye = eye_m, target = target_m;
    *this = {};
    eye_m = eye;
    target_m = target;
    corners_m = {point_m};
    set_ = 1;
}

void Measurement::follow(const glm::dvec3& point_m, const Land& land, double spacing_m) {
    if (corners_m.size() == set_ + 1 && corners_m.back() == point_m) return;
    corners_m.resize(set_);
    if (corners_m.back() != point_m) corners_m.push_back(point_m);
    work_out(land, spacing_m);
}

void Measurement::set_corner(const glm::dvec3& point_m, const Land& land, double spacing_m) {
    follow(point_m, land, spacing_m);
    set_ = corners_m.size();
}

void Measurement::drop_corner(const Land& land, double spacing_m) {
    if (set_ < 2) return;
    corners_m.erase(corners_m.begin() + static_cast<std::ptrdiff_t>(--set_));
    work_out(land, spacing_m);
}

void Measurement::end() {
    follows_cursor = false;
    set_ = corners_m.size();
}

void Measurement::work_out(const Land& land, double spacing_m) {
    profile.reset();
    area_m2.reset();
    line_m.clear();
    marked.reset();
    crosses_itself = false;
    if (corners_m.size() < 2) return;
    std::vector<geo::Geodetic> corners;
    for (const glm::dvec3& corner_m : corners_m)
        corners.push_back(land.frame->to_geodetic(corner_m));
    profile = Profile::along(corners, land, spacing_m);
    for (const ProfilePoint& point : profile->points) {
        geo::Geodetic drawn = point.place;
        drawn.height_m = land.aim_m(point.place) * land.exaggeration;
        line_m.push_back(land.frame->to_local(drawn));
    }
    if (corners.size() < 3) return;
    crosses_itself = outline_crosses(corners);
    if (!crosses_itself) area_m2 = geo::polygon_area_m2(corners);
}

std::string csv_text(const Profile& profile) {
    std::string text = "distance_m,latitude_deg,longitude_deg,height_m\n";
    for (const ProfilePoint& point : profile.points) {
        text += fmt::format("{:.3f},{:.8f},{:.8f},", point.distance_m, degrees(point.place.lat_rad),
                            degrees(point.place.lon_rad));
        if (!std::isnan(point.place.height_m)) text += fmt::format("{:.3f}", point.place.height_m);
        text += '\n';
    }
    return text;
}

}  // namespace relevo::viewer
