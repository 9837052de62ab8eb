// Light of clear days against sums of the model that are made here, on ground for which they have
// closed forms.
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include "light/fields.h"
#include "light/point/clear_sky.h"
#include "light/raster/ground_slope.h"
#include "light/raster/sun_hours.h"
#include "sun/position.h"
#include "sun/zone.h"

namespace relevo::light::test_irradiation {
namespace {

constexpr double kLinke = 3, kAlbedo = 0.2;
constexpr char kUtm32[] = "EPSG:32632";

/// What falls on open ground in a time, by the model alone [kWh/m2].
struct Light {
    double beam = 0, level_beam = 0, diffuse = 0;
};

/// @param place   with the height of the ground
/// @param normal  of the ground: east, north, up; need not be a unit
Light light_by_hand(const geo::Geodetic& place, sun::Instant begin, double length_s,
                    const glm::dvec3& normal = {0, 0, 1}) {
    constexpr double kStep_s = 60, kHours = kStep_s / 3600;
    Light sum;
    for (double at_s = kStep_s / 2; at_s < length_s; at_s += kStep_s) {
        const sun::Position sun = sun::position(begin + at_s, place);
        if (sun.elevation_rad <= 0) continue;
        const ClearSky clear(kLinke, sun.distance_au);
        const double beam = clear.beam(sun.elevation_rad, place.height_m) * kHours / 1000;
        sum.beam += beam * std::max(0.0, glm::dot(glm::normalize(normal), sun.direction));
        sum.level_beam += beam * sun.direction.z;
        sum.diffuse += clear.diffuse(sun.elevation_rad) * kHours / 1000;
    }
    return sum;
}

SunHours hours_of(const dem::Heightfield& field, sun::Instant begin, double length_s,
                  double step_s = 180) {
    SunHoursOptions options;
    options.step_s = step_s;
    options.irradiation =
        SunHoursOptions::Irradiation{.linke = kLinke, .albedo = kAlbedo, .sky_directions = 180};
    return sun_hours(dem::Posts(field), begin, begin + length_s, options);
}

sun::Instant utc(const char* text) {
    return sun::parse_time(text, {}).utc;
}

geo::Geodetic at_height(geo::Geodetic place, double height_m) {
    place.height_m = height_m;
    return place;
}

void expect_share(double found, double expected, double tolerance, const std::string& what) {
    fmt::print("[ accuracy ] {}: {:.4f} kWh/m2, by hand {:.4f} ({:+.2f} %, limit {} %)\n", what,
               found, expected, 100 * (found / expected - 1), 100 * tolerance);
    EXPECT_NEAR(found, expected, tolerance * expected) << what;
}

/// A plane that rises by 0.3 to the east and by 0.4 to the north faces south-west; it is 26.6
/// degrees steep and sees (1 + cos) / 2 of the sky, its own ground in the rest.
TEST(Irradiation, OfASlopeIsThatOfTheModelForOneDayAndForMany) {
    constexpr double kEast = 0.3, kNorth = 0.4, kSpacing_m = 30;
    const dem::Heightfield field = test::field_of(
        81, 81, {498800, kSpacing_m, 0, 5206200, 0, -kSpacing_m}, kUtm32, [](int column, int row) {
            return 1000 + kSpacing_m * (kEast * column - kNorth * row) + 40 * kSpacing_m * kNorth;
        });
    const geo::Geodetic middle =
        at_height(field.grid.place(40, 40), double{field.height_m.at(40, 40)});
    const double cosine = 1 / std::sqrt(1 + kEast * kEast + kNorth * kNorth);
    const double sky = (1 + cosine) / 2;
    const sun::Instant begin = utc("2026-02-10T00:00Z");
    for (const double days : {1.0, 10.0}) {  // by suns, and by directions of them
        const Light by_hand = light_by_hand(middle, begin, days * 86400, {-kEast, -kNorth, 1});
        const SunHours found = hours_of(field, begin, days * 86400);
        const std::string of = fmt::format(" of {} days", days);
        expect_share(found.beam_kwh.at(40, 40), by_hand.beam, 0.005, "beam" + of);
        expect_share(found.diffuse_kwh.at(40, 40), sky * by_hand.diffuse, 0.005, "diffuse" + of);
        expect_share(found.reflected_kwh.at(40, 40),
                     kAlbedo * (1 - sky) * (by_hand.level_beam + by_hand.diffuse), 0.01,
                     "reflected" + of);
    }
}

TEST(GroundSlope, OfAPlaneIsTheSameOnTheEdgeAndBesideAVoid) {
    constexpr int kSide = 41;
    const dem::Heightfield field = test::field_of(
        kSide, kSide, {498800, 30, 0, 5206200, 0, -30}, kUtm32, [](int column, int row) {
            return column == 20 && row == 20 ? std::nan("")
                                             : 1000 + 30 * (0.3 * column - 0.4 * row) + 480;
        });
    const dem::Posts posts(field);
    const Window all{0, 0, kSide, kSide};
    const SunTerrain terrain(posts, {}, false);
    const GroundSlope slope(terrain, WindowHeights(posts, all), all);
    for (const auto& [column, row] :
         {std::pair{10, 10}, {0, 20}, {40, 20}, {20, 0}, {20, 40}, {0, 0}, {40, 40}, {21, 20}}) {
        EXPECT_NEAR(slope.x.at(column, row), 0.3, 0.002) << column << " " << row;
        EXPECT_NEAR(slope.y.at(column, row), 0.4, 0.002) << column << " " << row;
    }
}

TEST(Irradiation, OfASummitIsThatOfItsThinnerAir) {
    // A table mountain of 8000 m on a plain by the sea.
    const dem::Heightfield field =
        test::field_of(41, 41, {499400, 30, 0, 5200600, 0, -30}, kUtm32, [](int column, int row) {
            return std::abs(column - 20) <= 10 && std::abs(row - 20) <= 10 ? 8000.0 : 0.0;
        });
    const geo::Geodetic top = at_height(field.grid.place(20, 20), 8000);
    const sun::Instant begin = utc("2026-06-21T00:00Z");
    const Light by_hand = light_by_hand(top, begin, 86400);
    const SunHours day = hours_of(field, begin, 86400, 60);
    expect_share(day.beam_kwh.at(20, 20), by_hand.beam, 0.003, "beam at 8000 m");
    expect_share(hours_of(field, begin, 6 * 86400.0).beam_kwh.at(20, 20),
                 light_by_hand(top, begin, 6 * 86400.0).beam, 0.01, "beam at 8000 m, of 6 days");
}

TEST(Irradiation, OfAWideDemIsThatOfEachOfItsPlaces) {
    // A plain of 200 km by the sea, on a winter's morning that ends at noon in its middle: the east
    // has more of it than the west, the south more than the north.
    const dem::Heightfield field = test::field_of(21, 21, {400000, 10000, 0, 5300000, 0, -10000},
                                                  kUtm32, [](int, int) { return 0.0; });
    const sun::Instant begin = utc("2026-12-21T00:00Z");
    constexpr double kLength_s = 11.4 * 3600;
    const SunHours found = hours_of(field, begin, kLength_s, 60);
    for (const auto& [column, row] :
         {std::pair(0, 0), {20, 0}, {0, 20}, {20, 20}, {10, 10}, {3, 17}}) {
        const Light by_hand =
            light_by_hand(at_height(field.grid.place(column, row), 0), begin, kLength_s);
        const std::string at = fmt::format(" of column {} and row {}", column, row);
        expect_share(found.diffuse_kwh.at(column, row), by_hand.diffuse, 0.003, "diffuse" + at);
        expect_share(found.beam_kwh.at(column, row), by_hand.beam, 0.02, "beam" + at);
    }
}

}  // namespace
}  // namespace relevo::light::test_irradiation
