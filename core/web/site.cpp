#include "web/site.h"

#include <cmath>
#include <cstdint>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/units.h"
#include "geo/geodetic.h"

namespace relevo::web {
namespace {

using nlohmann::ordered_json;

constexpr std::int64_t kSecond_us = 1000000, kLast_s = 4133980800;  // the year 2100 ends before

double rounded(double value, double step) {
    return std::round(value / step) * step;
}

/// [deg], -180 to 180.
double signed_deg(double angle_rad) {
    const double deg = degrees(angle_rad);
    return deg > 180 ? deg - 360 : deg;
}

}  // namespace

std::string grid_json(const dem::Grid& grid) {
    ordered_json json{{"columns", kNodes}, {"rows", kNodes}};
    const glm::dvec2 spacing_m = grid.post_spacing_m();
    for (int r = 0; r < kNodes; ++r)
        for (int c = 0; c < kNodes; ++c) {
            const double column = c * (grid.columns() - 1.0) / (kNodes - 1);
            const double row = r * (grid.rows() - 1.0) / (kNodes - 1);
            const geo::Geodetic at = grid.place(column, row);
            if (std::isnan(at.lat_rad))
                bad_input(fmt::format(
                    "export web: the CRS has no place for column {:.0f}, row {:.0f}; pass --crop",
                    column, row));
            const auto step = [&](double x, double y) {
                return geo::geodesic(grid.place(column - x, row - y),
                                     grid.place(column + x, row + y));
            };
            const geo::Geodesic up = step(0, -0.5);
            json["lat"].push_back(degrees(at.lat_rad));
            json["lon"].push_back(degrees(at.lon_rad));
            json["convergence"].push_back(signed_deg(up.azimuth_rad));
            json["scale_x"].push_back(step(0.5, 0).distance_m / spacing_m.x);
            json["scale_y"].push_back(up.distance_m / spacing_m.y);
        }
    return json.dump();
}

std::string zone_json(const sun::Zone& zone) {
    auto transitions = ordered_json::array();
    const sun::TimeSpan all{sun::Instant::from_unix_us(0),
                            sun::Instant::from_unix_us(kLast_s * kSecond_us)};
    for (const sun::OffsetChange& change : zone.offsets(all))
        transitions.push_back({change.unix_s, change.utc_offset_s});
    return ordered_json{{"name", zone.name()}, {"transitions", transitions}}.dump();
}

std::string refraction_json(const sun::Refraction& refraction) {
    ordered_json json;
    for (double deg = -2; deg <= 90; deg += deg < 3 ? 0.125 : deg < 20 ? 0.5 : 2.5) {
        const double lift_rad = refraction.apparent_rad(radians(deg)) - radians(deg);
        json["elevation"].push_back(deg);
        json["lift"].push_back(rounded(degrees(lift_rad), 1e-5));
    }
    return json.dump();
}

}  // namespace relevo::web
