#include "scene/default_time.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/units.h"
#include "sun/position.h"

namespace relevo::scene {
namespace {

constexpr int kMinutesApart = 5;
/// The best light, and the deviations that cost the same.
constexpr double kBestElevation_deg = 28, kBestAside_deg = 70;
/// Light between these is preferred.
constexpr double kPreferredLow_deg = 25, kPreferredHigh_deg = 30;
constexpr double kPreferredLeast_deg = 60, kPreferredMost_deg = 80;
constexpr double kBestGlobeElevation_deg = 60;  // in the middle of the map
constexpr double kElevationScale_deg = 30, kAsideScale_deg = 80;
/// Margin of the limits, for the error of a declination that is constant over the day.
constexpr double kInside_deg = 0.5;

double wrapped_deg(double angle_deg) {
    return angle_deg - 360 * std::round(angle_deg / 360);
}

double outside(double value, double low, double high) {
    return std::max({low - value, value - high, 0.0});
}

/// Lower is better. Light outside the limits costs most, above all by the sun's elevation.
double cost(double elevation_deg, double aside_deg) {
    const double away = std::abs(aside_deg);
    const double in = kInside_deg;
    return outside(elevation_deg, kLowestSun_deg + in, kHighestSun_deg - in) * 1000 +
           outside(away, kLeastAside_deg + in, kMostAside_deg - in) +
           outside(elevation_deg, kPreferredLow_deg, kPreferredHigh_deg) / kElevationScale_deg +
           outside(away, kPreferredLeast_deg, kPreferredMost_deg) / kAsideScale_deg +
           std::pow((elevation_deg - kBestElevation_deg) / kElevationScale_deg, 2) +
           std::pow((away - kBestAside_deg) / kAsideScale_deg, 2) + (aside_deg < 0 ? 0.1 : 0);
}

}  // namespace

std::string DefaultTime::reason() const {
    if (globe)
        return fmt::format("time: {}, chosen because most of the visible side of the globe is lit",
                           sun::to_iso(utc));
    return fmt::format(
        "time: {}, chosen for relief: sun {:.0f} degrees high, {:.0f} degrees {} of the camera{}",
        sun::to_iso(utc), elevation_deg, std::abs(aside_deg), aside_deg < 0 ? "right" : "left",
        within_bounds ? "" : " (wanted: 20 to 35 and 50 to 100)");
}

DefaultDay::DefaultDay(const geo::Geodetic& place, bool globe)
    : place_(place), globe_(globe), date_{2026, place.lat_rad >= 0 ? 6 : 12, 21} {
    const sun::Geocentric noon = sun::geocentric(sun::Epoch::at(
        sun::Instant::from_utc({.date = date_, .hour = 12}) - degrees(place.lon_rad) / 15 * 3600));
    const double declination = noon.declination_rad, lat = place.lat_rad;
    for (int minutes = 0; minutes < 24 * 60; minutes += kMinutesApart) {
        const double hours = minutes / 60.0;
        const double angle = radians(15 * (hours - 12 + noon.equation_of_time_s / 3600));
        const double east = -std::cos(declination) * std::sin(angle);
        const double north = std::cos(lat) * std::sin(declination) -
                             std::sin(lat) * std::cos(declination) * std::cos(angle);
        const double up = std::sin(lat) * std::sin(declination) +
                          std::cos(lat) * std::cos(declination) * std::cos(angle);
        hours_.push_back({hours, degrees(std::atan2(east, north)),
                          degrees(std::asin(std::clamp(up, -1.0, 1.0)))});
    }
}

DefaultTime DefaultDay::made(const Hour& hour, double camera_deg) const {
    DefaultTime result;
    // Fifteen degrees of longitude are an hour.
    result.utc = sun::Instant::from_utc({.date = date_}) + hour.hours * 3600 -
                 degrees(place_.lon_rad) / 15 * 3600;
    result.elevation_deg = hour.elevation_deg;
    result.aside_deg = wrapped_deg(hour.azimuth_deg - camera_deg);
    result.globe = globe_;
    result.within_bounds =
        !globe_ && outside(result.elevation_deg, kLowestSun_deg, kHighestSun_deg) == 0 &&
        outside(std::abs(result.aside_deg), kLeastAside_deg, kMostAside_deg) == 0;
    return result;
}

DefaultTime DefaultDay::estimate(double camera_deg) const {
    const auto cost_of = [&](const Hour& hour) {
        // In the afternoon: light from the left, as on maps.
        if (globe_)
            return std::abs(hour.elevation_deg - kBestGlobeElevation_deg) +
                   (hour.hours < 12 ? 5 : 0);
        return cost(hour.elevation_deg, wrapped_deg(hour.azimuth_deg - camera_deg));
    };
    const Hour* best = &hours_.front();
    double least = cost_of(*best);
    for (const Hour& hour : hours_) {
        const double asked = cost_of(hour);
        if (asked < least) best = &hour;
        least = std::min(least, asked);
    }
    return made(*best, camera_deg);
}

DefaultTime DefaultDay::time(double camera_deg) const {
    const DefaultTime near = estimate(camera_deg);
    const sun::Position sun = sun::position(near.utc, place_);
    DefaultTime result = made({(near.utc - made({0, 0, 0}, 0).utc) / 3600, degrees(sun.azimuth_rad),
                               degrees(sun.elevation_rad)},
                              camera_deg);
    result.utc = near.utc;
    return result;
}

double side_of_deg(const Camera& camera) {
    const glm::dvec2 level(camera.forward);
    // The picture's top points ahead if the camera looks down, and back if it looks up.
    const glm::dvec2 ahead =
        length(level) > 0.1 ? level : glm::dvec2(camera.up) * (camera.forward.z > 0 ? -1.0 : 1.0);
    const double side = degrees(std::atan2(-ahead.x, -ahead.y));
    return side < 0 ? side + 360 : side;
}

}  // namespace relevo::scene
