#include "output/horizon_files.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "base/units.h"

namespace relevo::output {
namespace {

constexpr double kRound_deg = 1e8;  // azimuths to that part of a degree: 112.5, not 112.49999999

double azimuth_deg(const light::HorizonPoint& point) {
    return std::round(degrees(point.azimuth_rad) * kRound_deg) / kRound_deg;
}

double height_deg(const light::HorizonPoint& point) {
    return std::max(0.0, degrees(point.elevation_rad));
}

}  // namespace

std::string pvlib_text(const std::vector<light::HorizonPoint>& profile) {
    std::string text = "horizon_azimuth,horizon_elevation\n";
    for (const light::HorizonPoint& point : profile)
        text += fmt::format("{:.10g},{:.4f}\n", azimuth_deg(point), degrees(point.elevation_rad));
    return text;
}

std::string pvgis_text(const std::vector<light::HorizonPoint>& profile) {
    std::string text;
    for (const light::HorizonPoint& point : profile)
        text += fmt::format("{:.3f}\n", height_deg(point));
    return text;
}

std::string pvsyst_text(const std::vector<light::HorizonPoint>& profile,
                        const geo::Geodetic& place) {
    const bool southern = place.lat_rad < 0;
    std::vector<std::pair<double, double>> points;
    for (const light::HorizonPoint& point : profile) {
        double from_equator_deg = southern ? -azimuth_deg(point) : azimuth_deg(point) - 180;
        if (from_equator_deg < -180) from_equator_deg += 360;
        points.emplace_back(from_equator_deg + 0.0, height_deg(point));  // no -0
    }
    std::sort(points.begin(), points.end());
    std::string text = fmt::format(
        "Relevo, Latitude {:.5f}, Longitude {:.5f}\n"
        "Azimuth {}, east -90, west 90; height; degrees\n",
        degrees(place.lat_rad), degrees(place.lon_rad),
        southern ? "0 north, counterclockwise" : "0 south, clockwise, north -180");
    for (const auto& [azimuth, height] : points)
        text += fmt::format("{:.10g} {:.2f}\n", azimuth, height);
    return text;
}

}  // namespace relevo::output
