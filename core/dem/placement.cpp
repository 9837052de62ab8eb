#include "dem/placement.h"

#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "geo/ellipsoid.h"

namespace relevo::dem {
namespace {

std::optional<int> whole_number(std::string_view text) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < 0) return std::nullopt;
    return value;
}

/// From the outer corners of the first cell and of the last to the centres of all.
Affine between(const glm::dvec2& north_west, const glm::dvec2& south_east, int columns, int rows) {
    const double dx = (south_east.x - north_west.x) / columns;
    const double dy = (south_east.y - north_west.y) / rows;
    return {north_west.x + dx / 2, dx, 0, north_west.y + dy / 2, 0, dy};
}

}  // namespace

Bounds parse_bounds(std::string_view text, std::string_view who) {
    const std::vector<std::string> pieces = split(text, ',');
    std::array<double, 4> numbers{};
    bool good = pieces.size() == 4;
    for (std::size_t i = 0; good && i < 4; ++i) {
        const std::optional<double> number = parse_number(trimmed(pieces[i]));
        good = number.has_value();
        numbers[i] = number.value_or(0);
    }
    if (!good)
        bad_usage(fmt::format("{}: {}: expected WEST,SOUTH,EAST,NORTH in degrees", who,
                              text.empty() ? "\"\"" : text));
    Bounds bounds{numbers[0], numbers[1], numbers[2], numbers[3]};
    if (!(bounds.south_deg >= -90 && bounds.north_deg <= 90 && bounds.south_deg < bounds.north_deg))
        bad_usage(
            fmt::format("{}: {}: latitudes, expected -90 <= south < north <= 90 but got {:g} "
                        "and {:g}; the order is WEST,SOUTH,EAST,NORTH",
                        who, text, bounds.south_deg, bounds.north_deg));
    if (bounds.east_deg < bounds.west_deg) bounds.east_deg += 360;
    if (!(bounds.west_deg >= -180 && bounds.west_deg <= 360 && bounds.east_deg > bounds.west_deg &&
          bounds.east_deg - bounds.west_deg <= 360))
        bad_usage(
            fmt::format("{}: {}: longitudes, expected two between -180 and 360 degrees but "
                        "got {:g} and {:g}; the order is WEST,SOUTH,EAST,NORTH",
                        who, text, numbers[0], numbers[2]));
    return bounds;
}

Affine affine_of(const Bounds& bounds, const geo::Crs& crs, int columns, int rows) {
    glm::dvec2 south_west = crs.from_geodetic(geo::geodetic_deg(bounds.south_deg, bounds.west_deg));
    glm::dvec2 north_east = crs.from_geodetic(geo::geodetic_deg(bounds.north_deg, bounds.east_deg));
    if (crs.is_geographic()) {
        // Longitudes as they were given: 10 to 190, not 10 to -170.
        const double turn = 2 * kPi / crs.unit_si();
        const double unit_deg = degrees(crs.unit_si());
        south_west.x += turn * std::round((bounds.west_deg / unit_deg - south_west.x) / turn);
        north_east.x += turn * std::round((bounds.east_deg / unit_deg - north_east.x) / turn);
    }
    return between({south_west.x, north_east.y}, {north_east.x, south_west.y}, columns, rows);
}

std::optional<WebTile> web_tile(const std::string& path) {
    if (path.starts_with("/vsi")) return std::nullopt;
    std::error_code unknown;
    const std::filesystem::path whole = std::filesystem::absolute(path, unknown);
    std::string last = whole.stem().string();
    last = last.substr(0, last.find('@'));  // "1435@2x": of twice the posts
    const std::optional<int> zoom =
        whole_number(whole.parent_path().parent_path().filename().string());
    const std::optional<int> x = whole_number(whole.parent_path().filename().string());
    const std::optional<int> y = whole_number(last);
    if (unknown || !zoom || !x || !y || *zoom > 24 || *x >= 1 << *zoom || *y >= 1 << *zoom)
        return std::nullopt;
    return WebTile{*zoom, *x, *y};
}

Affine affine_of(const WebTile& tile, int columns, int rows) {
    constexpr double kHalf_m = kPi * geo::kEquatorialRadius_m;  // half the world's side, EPSG:3857
    const double side_m = std::ldexp(2 * kHalf_m, -tile.zoom);
    const glm::dvec2 north_west(-kHalf_m + tile.x * side_m, kHalf_m - tile.y * side_m);
    return between(north_west, north_west + glm::dvec2(side_m, -side_m), columns, rows);
}

}  // namespace relevo::dem
