// The light of one relief, sampled on grids of all kinds.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/units.h"
#include "geo/local_frame.h"
#include "light/hills.h"
#include "light/point/horizon.h"
#include "light/raster/horizons.h"
#include "light/raster/shadow_heights.h"
#include "light/raster/shadows.h"
#include "light/raster/sun_hours.h"
#include "sun/zone.h"
#include "support/support.h"

namespace relevo::light::test_grids {
namespace {

/// In degrees from west to east and north to south, `step_m` apart both ways in the middle.
NamedGrid in_degrees(const std::string& name, const geo::Geodetic& middle, double step_m,
                     int side = 401) {
    NamedGrid grid = turned(name, "EPSG:4326", middle, step_m / 111150, 0, side);
    grid.affine.x_column /= std::cos(middle.lat_rad);
    grid.affine.x0 = degrees(middle.lon_rad) - (side - 1) / 2.0 * grid.affine.x_column;
    return grid;
}

/// The same posts in another order.
std::vector<NamedGrid> reordered(const NamedGrid& grid) {
    std::vector<NamedGrid> grids{3, grid};
    grids[0].name = "south-up";
    grids[0].affine.y0 += grid.affine.y_row * (grid.rows - 1);
    grids[0].affine.y_row *= -1;
    grids[1].name = "transposed";
    std::swap(grids[1].affine.x_column, grids[1].affine.x_row);
    std::swap(grids[1].affine.y_column, grids[1].affine.y_row);
    grids[2].name = "mirrored";
    grids[2].affine.x0 += grid.affine.x_column * (grid.columns - 1);
    grids[2].affine.x_column *= -1;
    return grids;
}

std::vector<NamedGrid> turned_grids(const geo::Geodetic& middle) {
    std::vector<NamedGrid> grids;
    for (int turn_deg = 5; turn_deg <= 90; turn_deg += 5)
        grids.push_back(
            turned(fmt::format("turned by {}", turn_deg), "EPSG:32632", middle, 30, turn_deg));
    return grids;
}

/// Of other kinds than UTM.
std::vector<NamedGrid> projected_grids(const geo::Geodetic& middle) {
    constexpr double kDegree_m = 111150;
    NamedGrid turned_degrees = turned("degrees, turned", "EPSG:4326", middle, 30 / kDegree_m, 30);
    turned_degrees.affine.x_column /= std::cos(middle.lat_rad);
    turned_degrees.affine.x_row /= std::cos(middle.lat_rad);
    turned_degrees.affine.x0 = degrees(middle.lon_rad) -
                               (turned_degrees.columns - 1) / 2.0 *
                                   (turned_degrees.affine.x_column + turned_degrees.affine.x_row);
    NamedGrid bordered = turned("with a border of voids", "EPSG:32632", middle, 30, 0);
    bordered.with_border = true;
    return {bordered,
            in_degrees("degrees", middle, 30),
            turned("square degrees", "EPSG:4326", middle, 30 / kDegree_m, 0, 481),
            turned_degrees,
            turned("feet", "+proj=utm +zone=32 +datum=WGS84 +units=us-ft", middle,
                   30 / 0.3048006096, 0),
            turned("polar", "EPSG:3995", middle, 30 * 1.15, 0),
            turned("polar, turned", "EPSG:3995", middle, 30 * 1.15, 37),
            turned("Mercator", "EPSG:3857", middle, 30 * 1.45, 0),
            turned("equal area", "EPSG:3035", middle, 30, 0),
            turned("Lambert's conic", "EPSG:2154", middle, 30, 0),
            turned("oblique Mercator", "EPSG:2056", middle, 30, 0)};
}

/// Hours at a place, linear between posts.
double hours_at(const Array2d<float>& hours, const glm::dvec2& post) {
    const int c = static_cast<int>(post.x), r = static_cast<int>(post.y);
    const double u = post.x - c, v = post.y - r;
    return (1 - v) * ((1 - u) * double{hours.at(c, r)} + u * double{hours.at(c + 1, r)}) +
           v * ((1 - u) * double{hours.at(c, r + 1)} + u * double{hours.at(c + 1, r + 1)});
}

/// Hours of sun at the places of the hills.
std::vector<double> hours_of(const NamedGrid& of, const Hills& hills, const sun::TimeSpan& span) {
    const dem::Heightfield field = sampled(of, hills);
    std::vector<glm::dvec2> posts;
    glm::dvec2 least(1e9), most(-1e9);
    for (const geo::Geodetic& place : hills.places()) {
        posts.push_back(field.grid.post(place));
        least = glm::min(least, posts.back());
        most = glm::max(most, posts.back());
    }
    SunHoursOptions options;
    const glm::ivec2 first = glm::floor(least), end = glm::floor(most) + 2.0;
    options.part = {first.x, first.y, end.x - first.x, end.y - first.y};
    const SunHours found = sun_hours(dem::Posts(field), span.begin, span.end, options);
    std::vector<double> hours;
    for (const glm::dvec2& post : posts)
        hours.push_back(hours_at(found.hours, post - glm::dvec2(first)));
    return hours;
}

struct Difference {
    double mean_min = 0, most_min = 0;  // the latter of 99 %
};

Difference difference(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> minutes;
    Difference found;
    for (std::size_t i = 0; i < a.size(); ++i) {
        minutes.push_back(60 * std::abs(a[i] - b[i]));
        found.mean_min += minutes.back() / static_cast<double>(a.size());
    }
    std::sort(minutes.begin(), minutes.end());
    found.most_min = minutes[minutes.size() * 99 / 100];
    return found;
}

/// Compares hours at the same places.
void expect_same_hours(const std::string& name, const std::vector<double>& hours,
                       const std::vector<double>& expected, double mean_min, double most_min) {
    const Difference found = difference(hours, expected);
    fmt::print(
        "[ accuracy ] hours on a grid {}: off by {:.3f} min in the mean (limit {}), 99 % within "
        "{:.2f} (limit {})\n",
        name, found.mean_min, mean_min, found.most_min, most_min);
    EXPECT_LE(found.mean_min, mean_min) << name;
    EXPECT_LE(found.most_min, most_min) << name;
}

TEST(Grids, OfOneReliefHaveTheSameHours) {
    const geo::Geodetic middle = place_at(46.5, 9.3);
    const Hills hills(middle);
    const NamedGrid utm = turned("UTM", "EPSG:32632", middle, 30, 0);
    const sun::TimeSpan day{utc("2026-03-20T00:00Z"), utc("2026-03-21T00:00Z")};
    const std::vector<double> expected = hours_of(utm, hills, day);
    for (const NamedGrid& grid : reordered(utm))
        expect_same_hours(grid.name, hours_of(grid, hills, day), expected, 0.01, 0.05);
    for (const std::vector<NamedGrid>& grids : {turned_grids(middle), projected_grids(middle)})
        for (const NamedGrid& grid : grids)
            expect_same_hours(grid.name, hours_of(grid, hills, day), expected, 0.5, 2.5);
}

TEST(Grids, AcrossTheAntimeridianHaveTheSameHours) {
    const geo::Geodetic middle = place_at(51.9, 179.999);
    const Hills hills(middle);
    const sun::TimeSpan day{utc("2026-03-19T12:00Z"), utc("2026-03-20T12:00Z")};
    const std::vector<double> expected =
        hours_of(turned("UTM", "EPSG:32660", middle, 30, 0), hills, day);
    const NamedGrid east = in_degrees("in degrees to 180.1", middle, 30);
    NamedGrid west = east;
    west.name = "in degrees from -180.1";
    west.affine.x0 -= 360;
    for (const NamedGrid& grid : {east, west})
        expect_same_hours(grid.name, hours_of(grid, hills, day), expected, 0.5, 2.5);
}

TEST(Grids, OfManyDegreesHaveTheHoursOfLocalOnes) {
    // Posts 1.2 km apart, as 30 m all around the Earth are 880 000 columns. So hills are 40 times
    // as wide, and 5 times as high, as the Earth's curvature hides low ground. The sun differs by 2
    // degrees between the places, so each is compared with itself on a local grid.
    const geo::Geodetic middle = place_at(46.5, 9.3);
    const Hills hills(middle, 40, 5);
    // An afternoon until after sunset, as a sun over all of the Earth is never down. Its rays cross
    // the first column.
    const sun::TimeSpan afternoon{utc("2026-03-20T11:30Z"), utc("2026-03-20T18:00Z")};
    const std::vector<double> expected = hours_of(
        turned("local", "+proj=stere +lat_0=46.5 +lon_0=9.3 +datum=WGS84", middle, 1200, 0), hills,
        afternoon);
    constexpr int kRound = 22930;
    constexpr double kStep_deg = 360.0 / kRound;
    NamedGrid round = in_degrees("round the Earth", middle, 1200);
    round.columns = kRound;
    round.affine.x_column = kStep_deg;
    round.affine.x0 = 7;  // among the hills, 90 km west of the places
    NamedGrid wide = round;
    wide.name = "60 degrees wide";
    wide.columns = kRound / 6;
    wide.affine.x0 = -10;
    for (const NamedGrid& grid : {round, wide})
        expect_same_hours(grid.name, hours_of(grid, hills, afternoon), expected, 0.5, 2.5);
}

/// Flat ground in degrees, with bumps.
dem::Heightfield bumps(int columns, int rows, double west_deg, double north_deg, double step_deg) {
    return test::field_of(columns, rows, {west_deg, step_deg, 0, north_deg, 0, -step_deg},
                          "EPSG:4326", [](int column, int row) {
                              return 900 + 600 * std::sin(column / 7.0) * std::cos(row / 5.0);
                          });
}

TEST(Grids, ThatAreWideHaveTheShadowsOfTheirThirds) {
    // 30 x 0.8 degrees: it was refused, and each third of it was not.
    const dem::Heightfield wide = bumps(1500, 40, 0, 46.4, 0.02);
    const dem::Posts posts(wide);
    for (const double elevation_deg : {0.5, 3.0, 12.0, 40.0}) {
        const SunOverDem sun{radians(150), radians(elevation_deg), 0};
        const Shadows all = shadows(posts, sun);
        EXPECT_GT(all.tiles, 1) << elevation_deg;
        // The same sun over the middle of the middle third.
        Array2d<float> third(500, 40);
        for (int row = 0; row < 40; ++row)
            for (int column = 0; column < 500; ++column)
                third.at(column, row) = wide.height_m.at(500 + column, row);
        const dem::Heightfield middle =
            test::field_of(500, 40, {10, 0.02, 0, 46.4, 0, -0.02}, "EPSG:4326",
                           [&](int column, int row) { return third.at(column, row); });
        const Shadows some = shadows(dem::Posts(middle), sun);
        int differ = 0;
        for (int row = 0; row < 40; ++row)
            for (int column = 150; column < 350; ++column)
                differ += all.lit.at(500 + column, row) != some.lit.at(column, row);
        // Suns are each within 0.05 degrees: at half a degree that is a tenth of a shadow.
        EXPECT_LE(differ, elevation_deg < 1 ? 120 : 80) << elevation_deg;  // of 8000
    }
    // Sixty degrees, 5' from post to post, low suns.
    const dem::Heightfield widest = bumps(720, 120, -30, 50, 1 / 12.0);
    const dem::Posts all(widest);
    for (const double elevation_deg : {-1.0, 0.2, 2.0, 20.0})
        EXPECT_GT(shadows(all, {radians(120), radians(elevation_deg), 0}).lit_posts, 0)
            << elevation_deg;
}

/// How many of the posts a sun's tiles do not have, or have more than once.
int posts_not_once(const dem::Heightfield& field, const SunOverDem& sun) {
    const dem::Posts posts(field);
    SunPlan plan(posts, {}, {});
    plan.add_suns(field.grid.center(), {sun});
    Array2d<int> times(field.grid.columns(), field.grid.rows(), 0);
    const PlannedSun& planned = plan.suns().front();
    EXPECT_GT(planned.tiles.size(), 1U);
    each_shadow(planned.field, planned.tiles, plan.window(), 0, [&](const SweepRun& run) {
        for (int i = 0; i < run.count; ++i)
            ++times.at(run.column + i, run.row);
    });
    return static_cast<int>(
        std::count_if(times.begin(), times.end(), [](int count) { return count != 1; }));
}

TEST(Grids, OfManyTilesHaveEachPostOnce) {
    // Long and narrow, rays across: tiles are short pieces of long windows.
    const dem::Heightfield strip = bumps(400, 14400, 11, 49, 1 / 3600.0);
    // Ten degrees a side: a hundred tiles and more from corner to corner.
    const dem::Heightfield square = bumps(3000, 3000, 5, 52, 1 / 300.0);
    for (const double azimuth_deg : {45.0, 135.0, 260.0})
        for (const double elevation_deg : {3.0, 25.0}) {
            const SunOverDem sun{radians(azimuth_deg), radians(elevation_deg), 0};
            EXPECT_EQ(posts_not_once(strip, sun), 0) << azimuth_deg << " " << elevation_deg;
            EXPECT_EQ(posts_not_once(square, sun), 0) << azimuth_deg << " " << elevation_deg;
        }
}

TEST(Grids, OverAPoleHaveHoursAndSkyViews) {
    // A cone on the pole, 20 km around it: the sun goes round it at one height.
    const dem::Heightfield cone = test::field_of(
        201, 201, {-20000, 200, 0, 20000, 0, -200}, "EPSG:3031", [](int column, int row) {
            return 2800 +
                   std::max(0.0, 600 - 0.1 * std::hypot(200 * (column - 100), 200 * (row - 100)));
        });
    const dem::Posts posts(cone);
    const SkyView view = sky_view(posts);
    // Ground that is inclined by 0.1 sees (1 + cos) / 2 of the sky, whichever way it faces.
    const double share = (1 + 1 / std::sqrt(1 + 0.1 * 0.1)) / 2;
    for (const auto& [column, row] :
         {std::pair{110, 100}, {100, 110}, {90, 100}, {100, 90}, {110, 110}, {95, 104}})
        EXPECT_NEAR(view.share.at(column, row), share, 0.002) << column << " " << row;
    EXPECT_NEAR(view.share.at(100, 100), 1, 0.005);
    const sun::Instant begin = utc("2026-12-20T00:00Z");
    for (const double days : {1.0, 10.0}) {
        const SunHours found = sun_hours(posts, begin, begin + 86400 * days);
        EXPECT_NEAR(found.hours.at(100, 100), 24 * days, 0.02 * days) << days;
        EXPECT_NEAR(found.hours.at(103, 141), 24 * days, 0.02 * days) << days;
    }
}

TEST(Grids, OfFlatGroundSeeAllOfTheSkyAndThrowNothingBack) {
    const dem::Heightfield flat = test::field_of(60, 60, {500000, 30, 0, 5200000, 0, -30},
                                                 "EPSG:32632", [](int, int) { return 500.0; });
    const dem::Posts posts(flat);
    const SkyView view = sky_view(posts);
    EXPECT_LE(*std::max_element(view.share.begin(), view.share.end()), 1);
    EXPECT_GE(*std::min_element(view.share.begin(), view.share.end()), 0.9999);
    SunHoursOptions options;
    options.irradiation = SunHoursOptions::Irradiation{};
    const sun::Instant begin = utc("2026-06-20T22:00Z");
    const SunHours hours = sun_hours(posts, begin, begin + 86400.0, options);
    EXPECT_GE(*std::min_element(hours.reflected_kwh.begin(), hours.reflected_kwh.end()), 0);
}

/// How many of the last 15 rows' posts are lit behind a wall that hides a low sun.
/// @param from_edge  how far within the DEM rays to the sun meet the wall at least [posts]
int lit_behind_a_wall(double from_edge) {
    constexpr int kSide = 101, kWall = 60;
    const dem::Heightfield field =
        test::field_of(kSide, kSide, {500000, 30, 0, 5200000, 0, -30}, "EPSG:32632",
                       [](int column, int) { return column == kWall ? 200.0 : 0.0; });
    const dem::Posts posts(field);
    int lit = 0;
    for (int tenths = 910; tenths < 1100; ++tenths) {
        // From 40 columns away the wall is over 9 degrees high.
        const double azimuth_rad = radians(tenths / 10.0);
        const Shadows found = shadows(posts, {azimuth_rad, radians(5), 0});
        for (int row = kSide - 15; row < kSide; ++row)
            for (int column = 20; column < kWall - 1; ++column) {
                const double met = row - (kWall - column) / std::tan(azimuth_rad);
                if (met <= kSide - 1 - from_edge) lit += found.lit.at(column, row);
            }
    }
    return lit;
}

TEST(Grids, HaveTheShadowsOfWallsThatGoToTheirEdges) {
    EXPECT_EQ(lit_behind_a_wall(0.5), 0);
}

// Rays are met within a quarter of a post at the edge, too, where one of the two lines next to a
// post comes from outside of the DEM.
TEST(Grids, HaveTheShadowsOfTheirLastHalfRow) {
    EXPECT_EQ(lit_behind_a_wall(0.25), 0);
}

}  // namespace
}  // namespace relevo::light::test_grids
