#include "figure/sun_over_middle.h"

#include <cmath>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "light/point/refraction_at.h"
#include "sun/position.h"

namespace relevo::figure {
namespace {

/// The ground at the DEM's centre.
geo::Geodetic middle_of(const dem::Posts& posts) {
    geo::Geodetic ground = posts.grid().center();
    const double height_m =
        posts.height_at((posts.grid().columns() - 1) / 2.0, (posts.grid().rows() - 1) / 2.0);
    ground.height_m = std::isnan(height_m) ? posts.lowest_m() : height_m;
    return ground;
}

}  // namespace

SunOverMiddle sun_over_middle(const dem::Posts& posts, sun::Instant utc,
                              const std::string& refraction) {
    const sun::Position position = sun::position(utc, posts.grid().center());
    const sun::Refraction air = light::refraction_at(refraction, middle_of(posts));
    return {light::SunOverDem::of(position), air.apparent_rad(position.elevation_rad), utc};
}

SunOverMiddle sun_as_seen(const std::string& text, const dem::Grid& grid) {
    constexpr std::string_view kGrid = "grid:";
    const bool on_grid = text.starts_with(kGrid);
    const std::vector<std::string> parts =
        split(std::string_view(text).substr(on_grid ? kGrid.size() : 0), ',');
    const auto azimuth_deg = parts.size() == 2 ? parse_number(parts[0]) : std::nullopt;
    const auto elevation_deg = parts.size() == 2 ? parse_number(parts[1]) : std::nullopt;
    if (!azimuth_deg || !elevation_deg || std::abs(*elevation_deg) > 90)
        bad_usage(
            fmt::format("--sun: {}: expected AZ,EL in degrees, clockwise from true north and -90 "
                        "to 90 above the horizon, or grid:AZ,EL from the north of the DEM's map",
                        text));
    light::SunOverDem sun;
    // Whole turns leave no trace: 360 and -720 are 0, without a sign.
    const double within_deg = std::fmod(*azimuth_deg, 360) + 0.0;
    const double turned_rad = radians(within_deg < 0 ? within_deg + 360 : within_deg);
    sun.azimuth_rad = on_grid ? light::true_azimuth_rad(grid, turned_rad) : turned_rad;
    sun.elevation_rad = radians(*elevation_deg);
    sun.semidiameter_rad = sun::semidiameter_rad(1);
    return {sun, sun.elevation_rad, {}};
}

output::RasterMetadata metadata_of(const SunOverMiddle& sun) {
    output::RasterMetadata about{
        {"SUN_AZIMUTH_DEG", fmt::format("{:.5f}", degrees(sun.sun.azimuth_rad))},
        {"SUN_APPARENT_ELEVATION_DEG", fmt::format("{:.5f}", degrees(sun.apparent_rad))},
        {"SUN_PLACE", "the middle of the DEM; azimuth from true north"}};
    if (sun.utc) {
        about.emplace_back("TIME_UTC", sun::to_iso(*sun.utc, 3));
        about.emplace_back("SUN_ELEVATION_DEG",
                           fmt::format("{:.5f}", degrees(sun.sun.elevation_rad)));
    }
    return about;
}

std::function<sun::Refraction(const geo::Geodetic&)> air_of(const std::string& refraction) {
    return [refraction](const geo::Geodetic& place) {
        return light::refraction_at(refraction, place);
    };
}

std::string air_of_posts(const std::string& refraction, const dem::Posts& posts) {
    if (refraction == "standard") return "integrated ICAO standard atmosphere over each post";
    return light::refraction_at(refraction, middle_of(posts)).description();
}

}  // namespace relevo::figure
