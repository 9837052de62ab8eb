#include "geo/geodetic.h"

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <GeographicLib/Geodesic.hpp>
#include <GeographicLib/PolygonArea.hpp>
#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"

namespace relevo::geo {
namespace {

double azimuth_from_deg(double azimuth_deg) {
    const double azimuth = radians(azimuth_deg);
    return azimuth < 0 ? azimuth + 2 * kPi : azimuth;
}

constexpr double kMinLon_deg = -180;
constexpr double kMaxLon_deg = 360;

bool is_lat_deg(double value) {
    return std::abs(value) <= 90;
}

bool is_lon_deg(double value) {
    return value >= kMinLon_deg && value <= kMaxLon_deg;
}

}  // namespace

double normalized_lon_deg(double lon_deg) {
    if (lon_deg >= -180 && lon_deg < 180) return lon_deg;
    const double lon = std::remainder(lon_deg, 360.0);
    return lon >= 180 ? lon - 360 : lon;
}

Geodetic geodetic_deg(double lat_deg, double lon_deg, double height_m) {
    return {radians(lat_deg), radians(normalized_lon_deg(lon_deg)), height_m};
}

Geodesic geodesic(const Geodetic& from, const Geodetic& to) {
    double distance_m = 0;
    double start_deg = 0;
    double end_deg = 0;
    GeographicLib::Geodesic::WGS84().Inverse(degrees(from.lat_rad), degrees(from.lon_rad),
                                             degrees(to.lat_rad), degrees(to.lon_rad), distance_m,
                                             start_deg, end_deg);
    return {distance_m, azimuth_from_deg(start_deg), azimuth_from_deg(end_deg)};
}

double polygon_area_m2(std::span<const Geodetic> corners) {
    GeographicLib::PolygonArea polygon(GeographicLib::Geodesic::WGS84());
    for (const Geodetic& corner : corners)
        polygon.AddPoint(degrees(corner.lat_rad), degrees(corner.lon_rad));
    double perimeter_m = 0;
    double area_m2 = 0;
    polygon.Compute(/*reverse=*/false, /*sign=*/true, perimeter_m, area_m2);
    return std::abs(area_m2);
}

Geodetic destination(const Geodetic& from, double azimuth_rad, double distance_m) {
    double lat_deg = 0;
    double lon_deg = 0;
    GeographicLib::Geodesic::WGS84().Direct(degrees(from.lat_rad), degrees(from.lon_rad),
                                            degrees(azimuth_rad), distance_m, lat_deg, lon_deg);
    return geodetic_deg(lat_deg, lon_deg, from.height_m);
}

PlaceText parse_place(std::string_view text, std::string_view who) {
    const std::vector<std::string> pieces = split(text, ',');
    if (pieces.size() < 2 || pieces.size() > 3)
        bad_usage(
            fmt::format("{}: {}: a place, expected LAT,LON or LAT,LON,H but got {} part{}; write "
                        "decimal degrees, latitude first, as in 46.55,8.56",
                        who, text, pieces.size(), pieces.size() == 1 ? "" : "s"));
    PlaceText result;
    std::array<double, 3> numbers{};
    constexpr std::array kNames = {"latitude", "longitude", "height"};
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        std::string_view piece = trimmed(pieces[i]);
        if (i == 2 && piece.ends_with("agl")) {
            result.above_ground = true;
            piece = trimmed(piece.substr(0, piece.size() - 3));
        }
        const std::optional<double> number = parse_number(piece);
        if (!number)
            bad_usage(fmt::format(
                "{}: {}: {}, expected a number of {} but got \"{}\"", who, text, kNames[i],
                i == 2 ? "metres (suffix agl: above ground)" : "degrees", trimmed(pieces[i])));
        numbers[i] = *number;
    }
    const auto [lat_deg, lon_deg, height_m] = numbers;
    if (!is_lat_deg(lat_deg)) {
        const std::string swapped =
            is_lat_deg(lon_deg) && is_lon_deg(lat_deg)
                ? fmt::format("; latitude comes first, perhaps {},{}", lon_deg, lat_deg)
                : "";
        bad_usage(fmt::format("{}: {}: latitude, expected -90 to 90 degrees but got {}{}", who,
                              text, lat_deg, swapped));
    }
    if (!is_lon_deg(lon_deg))
        bad_usage(fmt::format("{}: {}: longitude, expected {} to {} degrees but got {}", who, text,
                              kMinLon_deg, kMaxLon_deg, lon_deg));
    result.has_height = pieces.size() == 3;
    result.place = geodetic_deg(lat_deg, lon_deg, height_m);
    return result;
}

}  // namespace relevo::geo
