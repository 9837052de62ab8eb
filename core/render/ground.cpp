#include "render/ground.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace relevo::render {
namespace {

constexpr int kPiecesAcross = 48;  // of a DEM, when it is thinned out for the camera

}  // namespace

Ground make_ground(const dem::Heightfield& dem) {
    Ground ground{.frame = geo::LocalFrame(dem.grid.center())};
    ground.lowest_m = dem.about.statistics.min_m;
    ground.highest_m = dem.about.statistics.max_m;
    const double columns = dem.grid.columns() - 1, rows = dem.grid.rows() - 1;
    ground.south_west_m = glm::dvec2(1e300);
    ground.north_east_m = glm::dvec2(-1e300);
    // A map of the world has corners that are no place; more of it then says where its ground is.
    for (const int steps : {2, kPiecesAcross}) {
        bool all_on_earth = true;
        for (int i = 0; i <= steps; ++i) {
            for (int j = 0; j <= steps; ++j) {
                const geo::Geodetic place = dem.grid.place(columns * i / steps, rows * j / steps);
                all_on_earth = all_on_earth && std::isfinite(place.lat_rad);
                if (!std::isfinite(place.lat_rad)) continue;
                const glm::dvec2 at(ground.frame.to_local(place));
                ground.south_west_m = glm::min(ground.south_west_m, at);
                ground.north_east_m = glm::max(ground.north_east_m, at);
            }
        }
        if (all_on_earth) break;
    }
    return ground;
}

std::vector<glm::dvec3> points_to_show(const dem::Heightfield& dem, const Ground& ground,
                                       double exaggeration) {
    const Array2d<float>& height_m = dem.height_m;
    std::vector<glm::dvec3> points;
    const auto add = [&](int column, int row) {
        geo::Geodetic place = dem.grid.place(column, row);
        place.height_m = height_m.at(column, row) * exaggeration;
        points.push_back(ground.frame.to_local(place));
    };
    const int step_x = std::max(1, height_m.width() / kPiecesAcross);
    const int step_y = std::max(1, height_m.height() / kPiecesAcross);
    for (int y0 = 0; y0 < height_m.height(); y0 += step_y) {
        for (int x0 = 0; x0 < height_m.width(); x0 += step_x) {
            glm::ivec2 lowest(-1), highest(-1);
            for (int y = y0; y < std::min(y0 + step_y, height_m.height()); ++y) {
                for (int x = x0; x < std::min(x0 + step_x, height_m.width()); ++x) {
                    const float h = height_m.at(x, y);
                    if (std::isnan(h)) continue;
                    if (lowest.x < 0 || h < height_m.at(lowest.x, lowest.y)) lowest = {x, y};
                    if (highest.x < 0 || h > height_m.at(highest.x, highest.y)) highest = {x, y};
                }
            }
            if (lowest.x < 0) continue;
            add(lowest.x, lowest.y);
            add(highest.x, highest.y);
        }
    }
    return points;
}

std::vector<glm::dvec3> points_moved_to(std::span<const glm::dvec3> points, const Ground& ground,
                                        double exaggeration, const Displacement& displacement) {
    std::vector<glm::dvec3> moved;
    if (!displacement.any()) return moved;
    for (const glm::dvec3& point : points) {
        const geo::Geodetic place = ground.frame.to_geodetic(point);
        const double own_m = place.height_m / exaggeration;
        const auto [lowest_m, highest_m] = displacement.range_m(own_m, own_m);
        for (const double height_m : {lowest_m, highest_m}) {
            const glm::dvec3 at =
                ground.frame.to_local({place.lat_rad, place.lon_rad, height_m * exaggeration});
            for (const glm::dvec2 aside :
                 {glm::dvec2(1, 0), glm::dvec2(-1, 0), glm::dvec2(0, 1), glm::dvec2(0, -1)})
                moved.push_back(at + glm::dvec3(displacement.aside_m * aside, 0));
        }
    }
    return moved;
}

SunLight make_sun_light(const sun::Position& position, const sun::Refraction& refraction,
                        const Ground& ground, const dem::Grid& grid) {
    SunLight light;
    light.direction = position.direction;
    light.refraction_rad = [refraction](double elevation_rad) {
        return refraction.apparent_rad(elevation_rad) - elevation_rad;
    };
    light.ground_height_m = ground.air_height_m();
    light.semidiameter_rad = position.semidiameter_rad;
    light.lowest_sine = 1;
    light.highest_sine = -1;
    constexpr int kSamples = 8;
    for (int j = 0; j <= kSamples; ++j) {
        for (int i = 0; i <= kSamples; ++i) {
            const geo::Geodetic place = grid.place((grid.columns() - 1) * i / double{kSamples},
                                                   (grid.rows() - 1) * j / double{kSamples});
            const double sine = dot(light.direction, ground.frame.up(place.lat_rad, place.lon_rad));
            light.lowest_sine = std::min(light.lowest_sine, sine);
            light.highest_sine = std::max(light.highest_sine, sine);
        }
    }
    return light;
}

}  // namespace relevo::render
