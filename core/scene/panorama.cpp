#include "scene/panorama.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "base/units.h"

namespace relevo::scene {
namespace {

/// Largest distance of a row from the horizon, as PanoramaMap::rise().
double most_rise(Panorama kind) {
    return kind == Panorama::Cylindrical ? std::tan(radians(kSteepest_deg)) : kPi / 2;
}

/// Vertical field of view of a lens; 0 if none is given.
double fov_y_rad(const View& view) {
    constexpr double kFilm = 1.5;  // width / height
    if (view.fov_y_rad > 0 || view.focal_length_mm <= 0) return view.fov_y_rad;
    return fov_y_of_focal_length(view.focal_length_mm, kFilm);
}

}  // namespace

PanoramaMap::PanoramaMap(const View& view, const glm::ivec2& picture_px, double heading_rad,
                         double pitch_rad)
    : kind_(view.panorama),
      picture_px_(picture_px),
      px_per_rad_(picture_px.x / view.hfov_rad),
      heading_rad_(heading_rad) {
    const double half = 0.5 * picture_px.y / px_per_rad_;
    const double most = std::max(most_rise(kind_) - half, 0.0);
    const double steepest = kind_ == Panorama::Cylindrical ? radians(kSteepest_deg) : kPi / 2;
    top_ = half + std::clamp(rise(std::clamp(pitch_rad, -steepest, steepest)), -most, most);
}

double PanoramaMap::rise(double elevation_rad) const {
    return kind_ == Panorama::Cylindrical ? std::tan(elevation_rad) : elevation_rad;
}

double PanoramaMap::azimuth_rad(double x_px) const {
    return heading_rad_ + (x_px - 0.5 * picture_px_.x) / px_per_rad_;
}

double PanoramaMap::elevation_rad(double y_px) const {
    const double rise = top_ - y_px / px_per_rad_;
    return kind_ == Panorama::Cylindrical ? std::atan(rise) : std::clamp(rise, -kPi / 2, kPi / 2);
}

glm::dvec3 PanoramaMap::direction(const glm::dvec2& at_px) const {
    const double azimuth = azimuth_rad(at_px.x), elevation = elevation_rad(at_px.y);
    return {std::sin(azimuth) * std::cos(elevation), std::cos(azimuth) * std::cos(elevation),
            std::sin(elevation)};
}

std::optional<glm::dvec2> PanoramaMap::project(const glm::dvec3& direction) const {
    const double level = std::hypot(direction.x, direction.y);
    if (kind_ == Panorama::Cylindrical && level < 1e-9) return std::nullopt;
    const double turn =
        std::remainder(std::atan2(direction.x, direction.y) - heading_rad_, 2 * kPi);
    const double elevation = std::atan2(direction.z, level);
    return glm::dvec2(0.5 * picture_px_.x + turn * px_per_rad_,
                      (top_ - rise(elevation)) * px_per_rad_);
}

glm::ivec2 default_panorama_px(const View& view) {
    const bool cylindrical = view.panorama == Panorama::Cylindrical;
    const double px_per_rad = (cylindrical ? 8192 : 4096) / (2 * kPi);
    const double given = fov_y_rad(view);
    const double fov = given > 0 ? given : cylindrical ? radians(kDefaultFov_deg) : kPi;
    const double height = cylindrical ? 2 * std::tan(fov / 2) : fov;
    const auto side = [](double px) {
        return std::clamp(static_cast<int>(std::lround(px)), 1, kMaxSide_px);
    };
    return {side(view.hfov_rad * px_per_rad), side(height * px_per_rad)};
}

double perspective_fov_y_rad(const View& view, double aspect) {
    return 2 * std::atan(0.5 * view.hfov_rad / aspect);
}

void check_panorama(const Scene& scene) {
    const View& view = scene.view;
    if (view.panorama == Panorama::None) return;
    if (scene.ortho) bad_input("--panorama: not of a map; remove --ortho or --panorama");
    if (scene.stamps.margin)
        bad_input("--panorama: has no border for stamps; remove --margin or --panorama");
    if (!view.eye) bad_input("--panorama: needs a place to stand; add --eye LAT,LON");
    const double rows = view.hfov_rad * scene.height_px / scene.width_px;
    const double most = 2 * most_rise(view.panorama);
    if (rows <= most * (1 + 1e-9)) return;
    const bool cylindrical = view.panorama == Panorama::Cylindrical;
    bad_input(fmt::format(
        "--panorama: {} x {} px across {:.6g} degrees reach {}; use at most {} px of height",
        scene.width_px, scene.height_px, degrees(view.hfov_rad),
        cylindrical ? fmt::format("beyond an elevation of {} degrees", kSteepest_deg)
                    : "beyond the zenith and the nadir",
        std::floor(most * scene.width_px / view.hfov_rad + 1e-6)));
}

}  // namespace relevo::scene
