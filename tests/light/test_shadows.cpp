#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <fmt/format.h>

#include "base/parallel_for.h"
#include "base/units.h"
#include "light/fields.h"
#include "light/point/horizon.h"
#include "light/raster/shadows.h"
#include "sun/zone.h"
#include "support/support.h"

namespace relevo::light::test_shadows {
namespace {

ShadowOptions with_air() {
    return {.air = [](const geo::Geodetic& place) { return sun::Refraction::standard(place); }};
}

/// The moment of a day, in steps of two minutes, at which the sun over a place is nearest to an
/// elevation, before or after noon.
sun::Instant moment_of(const geo::Geodetic& place, const sun::Date& date, double elevation_deg,
                       bool morning) {
    const sun::Instant begin = sun::parse_time(sun::to_string(date) + "T00:00Z", {}).utc;
    sun::Instant best = begin;
    double best_deg = 1e9;
    for (int minute = 0; minute < 1440; minute += 2) {
        const sun::Instant utc = begin + 60.0 * minute;
        const sun::Position at = sun::position(utc, place);
        if ((at.azimuth_rad < kPi) != morning) continue;
        const double off_deg = std::abs(degrees(at.elevation_rad) - elevation_deg);
        if (off_deg < best_deg) best_deg = off_deg, best = utc;
    }
    return best;
}

/// A moment of which light and shade are compared.
struct Moment {
    double elevation_deg;  // about
    sun::Instant utc;
    Shadows light;
};

std::vector<Moment> moments_of(const dem::Posts& posts, const std::vector<double>& elevations_deg) {
    std::vector<Moment> moments;
    const geo::Geodetic middle = posts.grid().center();
    for (const double elevation_deg : elevations_deg)
        for (const sun::Date& date : {sun::Date{2026, 3, 20}, sun::Date{2026, 6, 21}})
            for (const bool morning : {true, false}) {
                const sun::Instant utc = moment_of(middle, date, elevation_deg, morning);
                moments.push_back(
                    {elevation_deg, utc,
                     shadows(posts, SunOverDem::of(sun::position(utc, middle)), with_air())});
            }
    return moments;
}

/// Light and shade of moments against the exact horizons of posts drawn by lot, each with its own
/// sun and air.
void compare_all(const std::string& name, const dem::Heightfield& field, int count,
                 double most_share, const std::vector<double>& elevations_deg) {
    const dem::Posts posts(field);
    const dem::Grid& grid = posts.grid();
    const std::vector<Moment> moments = moments_of(posts, elevations_deg);
    std::mt19937 lot(20260101);
    std::vector<glm::ivec2> where;
    while (static_cast<int>(where.size()) < count) {
        const glm::ivec2 post(lot() % static_cast<unsigned>(grid.columns()),
                              lot() % static_cast<unsigned>(grid.rows()));
        if (!std::isnan(field.height_m.at(post.x, post.y))) where.push_back(post);
    }
    // By how much the sun clears the horizon.
    Array2d<double> clear_deg(static_cast<int>(moments.size()), count);
    parallel_for(0, count, 1, [&](int first, int last) {
        for (int i = first; i < last; ++i) {
            const glm::ivec2 post = where[static_cast<std::size_t>(i)];
            const TerrainHorizon horizon(posts, grid.place(post.x, post.y));
            const sun::Refraction air = sun::Refraction::standard(horizon.place());
            for (int k = 0; k < clear_deg.width(); ++k) {
                const sun::Position at =
                    sun::position(moments[static_cast<std::size_t>(k)].utc, horizon.place());
                clear_deg.at(k, i) = degrees(air.apparent_rad(at.elevation_rad) -
                                             horizon.elevation_rad(at.azimuth_rad));
            }
        }
    });
    for (const double elevation_deg : elevations_deg) {
        int differ = 0, all = 0, tiles = 0;
        double worst_deg = 0;
        for (std::size_t k = 0; k < moments.size(); ++k) {
            if (moments[k].elevation_deg != elevation_deg) continue;
            tiles = std::max(tiles, moments[k].light.tiles);
            for (int i = 0; i < count; ++i) {
                ++all;
                const glm::ivec2 post = where[static_cast<std::size_t>(i)];
                const double by_deg = clear_deg.at(static_cast<int>(k), i);
                if ((moments[k].light.lit.at(post.x, post.y) > 0) == (by_deg >= 0)) continue;
                ++differ;
                worst_deg = std::max(worst_deg, std::abs(by_deg));
            }
        }
        const double share = differ / double(all);
        fmt::print(
            "[ accuracy ] {}, sun at {} degrees: of {} posts {} ({:.2f} %) lit otherwise than "
            "by their exact horizon, all within {:.3f} degrees of it; {} tiles (limit {} %)\n",
            name, elevation_deg, all, differ, 100 * share, worst_deg, tiles, 100 * most_share);
        EXPECT_LE(share, most_share) << name << " " << elevation_deg;
    }
    std::fflush(stdout);
}

TEST(Shadows, AgreeWithTheExactHorizonOfPosts) {
    compare_all("jacksboro", test::bundled("jacksboro.tif"), 400, 0.005, {1, 3, 10, 25, 50});
    compare_all("vancouver-island", test::bundled("vancouver-island.tif"), 400, 0.015, {1, 3, 10});
}

TEST(Shadows, SunOfEachPlaceIsItsOwn) {
    // Four degrees of bumps in the north: one sun would be off by 3 degrees of azimuth in the east.
    const dem::Heightfield bumps = test::field_of(
        321, 201, {10, 0.0125, 0, 62, 0, -0.0125}, "EPSG:4326", [](int column, int row) {
            return 1000 * std::sin(0.9 * column + 0.4 * std::sin(0.7 * row)) * std::sin(0.8 * row);
        });
    compare_all("bumps", bumps, 400, 0.005, {3, 20, 35});
}

TEST(Shadows, AirIsThatOfEachHeight) {
    // Two plateaus with walls: at 3 degrees the sun stands 0.09 degrees lower over the upper one.
    const dem::Heightfield plateaus = test::field_of(
        400, 60, {500000 - 6000, 30, 0, 5200000, 0, -30}, "EPSG:32632", [](int column, int) {
            return (column < 200 ? 0 : 3500) + (column % 80 == 40 ? 60 : 0) + 0.001 * column;
        });
    compare_all("plateaus", plateaus, 400, 0.003, {1.5, 3});
}

TEST(Shadows, AgreeWithTheExactHorizonOfRealMountains) {
    SKIP_WITHOUT_TEST_DATA(data);
    for (const std::string name :
         {"srtm_bigtujunga30m_utm11.tif", "hawaii_rotated20.tif", "dem_RGI50-05.08389.tif",
          "mt_rainier_90m.tif", "holyroodpark.tif", "tyrol_aw3d30_n47e011_1s_cog.tif",
          "colorado_tut_relief.nc"})
        compare_all(name, dem::load((data / "dem" / name).string()), 400, 0.0075, {0, 2, 10, 30});
}

/// A plain with a wall along the column 100, at the equator in UTM, where the map is true.
dem::Heightfield wall(double height_m, const std::string& crs = "EPSG:32631") {
    return test::field_of(201, 101, {500000 - 3000, 30, 0, 1500, 0, -30}, crs,
                          [=](int column, int) { return column == 100 ? 250 + height_m : 250.0; });
}

SunOverDem sun_at(double azimuth_deg, double elevation_deg) {
    return {radians(azimuth_deg), radians(elevation_deg), radians(0.2666)};
}

TEST(Shadows, SoftnessIsTheShareOfTheDiscOverTheWall) {
    const dem::Heightfield field = wall(100);
    const dem::Posts posts(field);
    const SunOverDem sun = sun_at(90, 10);
    const Shadows hard = shadows(posts, sun), soft = shadows(posts, sun, {.soft = true});
    int between = 0;
    double worst = 0;
    for (int column = 60; column < 100; ++column) {
        const double wall_deg = degrees(std::atan(100 / ((100 - column) * 30.0)));
        const double expected = share_of_disc((10 + 0.2666 - wall_deg) / (2 * 0.2666));
        const double share = soft.lit.at(column, 50);
        between += share > 0 && share < 1;
        worst = std::max(worst, std::abs(share - expected));
        EXPECT_EQ(hard.lit.at(column, 50), wall_deg > 10 ? 0 : 1) << column;
    }
    EXPECT_GE(between, 1);
    EXPECT_LT(worst, 0.01);
    EXPECT_EQ(soft.lit.at(150, 50), 1);
}

/// The share of points all over the disc that stand over a post's exact horizon.
double true_share(const TerrainHorizon& horizon, sun::Instant utc) {
    constexpr int kPoints = 64;
    const sun::Position at = sun::position(utc, horizon.place());
    const double elevation_rad =
        sun::Refraction::standard(horizon.place()).apparent_rad(at.elevation_rad);
    int seen = 0;
    for (int k = 0; k < kPoints; ++k) {
        const double out_rad = at.semidiameter_rad * std::sqrt((k + 0.5) / kPoints);
        const double turn_rad = 2.399963229728653 * k;  // the golden angle
        const double azimuth_rad =
            at.azimuth_rad + out_rad * std::sin(turn_rad) / std::cos(elevation_rad);
        seen += elevation_rad + out_rad * std::cos(turn_rad) >= horizon.elevation_rad(azimuth_rad);
    }
    return seen / double{kPoints};
}

TEST(Shadows, SoftnessIsTheShareOfTheDiscOverRealRidges) {
    const dem::Heightfield field = test::bundled("jacksboro.tif");
    const dem::Posts posts(field);
    const geo::Geodetic middle = posts.grid().center();
    ShadowOptions options = with_air();
    options.soft = true;
    std::mt19937 lot(20260101);
    for (const double elevation_deg : {2.0, 5.0})
        for (const bool morning : {true, false}) {
            const sun::Instant utc = moment_of(middle, {2026, 3, 20}, elevation_deg, morning);
            const Shadows soft =
                shadows(posts, SunOverDem::of(sun::position(utc, middle)), options);
            std::vector<glm::ivec2> partly;
            for (int row = 0; row < soft.lit.height(); ++row)
                for (int column = 0; column < soft.lit.width(); ++column)
                    if (soft.lit.at(column, row) > 0 && soft.lit.at(column, row) < 1)
                        partly.emplace_back(column, row);
            ASSERT_GT(partly.size(), 300U);
            std::shuffle(partly.begin(), partly.end(), lot);
            partly.resize(300);
            double off = 0, size = 0;
            for (const glm::ivec2& post : partly) {
                const TerrainHorizon horizon(posts, posts.grid().place(post.x, post.y));
                const double by = soft.lit.at(post.x, post.y) - true_share(horizon, utc);
                off += by / 300;
                size += std::abs(by) / 300;
            }
            fmt::print(
                "[ accuracy ] jacksboro, share of the disc in half shade, sun at {} degrees, {}: "
                "off by {:+.3f} in the mean, {:.3f} in size (limits 0.05, 0.1)\n",
                elevation_deg, morning ? "morning" : "afternoon", off, size);
            EXPECT_LE(std::abs(off), 0.05);
            EXPECT_LE(size, 0.1);
        }
}

TEST(Shadows, ShareOfDiscIsThatOfACircle) {
    EXPECT_EQ(share_of_disc(-0.1), 0);
    EXPECT_EQ(share_of_disc(0), 0);
    EXPECT_DOUBLE_EQ(share_of_disc(0.5), 0.5);
    // A segment as high as half the radius: 1/3 - sqrt(3) / (4 pi).
    EXPECT_NEAR(share_of_disc(0.25), 1.0 / 3 - std::sqrt(3) / (4 * kPi), 1e-12);
    EXPECT_NEAR(share_of_disc(0.75), 1 - share_of_disc(0.25), 1e-12);
    EXPECT_EQ(share_of_disc(1), 1);
}

TEST(Shadows, NightShadesAllAndTheZenithNothing) {
    const dem::Heightfield field = wall(100);
    const dem::Posts posts(field);
    for (const double elevation_deg : {-90.0, -30.0, -4.1, -3.9, -1.0}) {
        const Shadows night = shadows(posts, sun_at(77, elevation_deg));
        EXPECT_EQ(night.lit_posts, 0) << elevation_deg;
        EXPECT_EQ(night.shaded_posts, 201 * 101) << elevation_deg;
    }
    for (const double elevation_deg : {85.0, 89.99, 90.0})
        EXPECT_EQ(shadows(posts, sun_at(77, elevation_deg)).shaded_posts, 0) << elevation_deg;
}

TEST(Shadows, HeightsSeeTheSunBelowTheLevel) {
    // The dip from 100 m over the lowest ground is sqrt(2 * 0.87 * 100 / 6378137) = 0.2993 degrees.
    const dem::Heightfield field = wall(100);
    const dem::Posts posts(field);
    for (const double elevation_deg : {-0.29, -0.31}) {
        const Shadows light = shadows(posts, sun_at(90, elevation_deg));
        EXPECT_EQ(light.lit.at(100, 50), elevation_deg > -0.3 ? 1 : 0) << elevation_deg;
        EXPECT_EQ(light.lit.at(150, 50), 0);
    }
}

TEST(Shadows, HolesAreNeitherLitNorShading) {
    dem::Heightfield field = wall(100);
    for (int row = 40; row < 60; ++row)
        field.height_m.at(100, row) = std::numeric_limits<float>::quiet_NaN();
    const Shadows light = shadows(dem::Posts(field), sun_at(90, 10));
    EXPECT_EQ(light.holes, 20);
    EXPECT_EQ(light.lit_posts + light.shaded_posts, 201 * 101 - 20);
    EXPECT_TRUE(std::isnan(light.lit.at(100, 50)));
    EXPECT_EQ(light.lit.at(95, 50), 1);
    EXPECT_EQ(light.lit.at(95, 20), 0);
}

TEST(Shadows, AzimuthIsFromTrueNorthWhereverTheMapHasIt) {
    // A grid turned by 90 degrees, and one whose north is 2.2 degrees off: 3 degrees from the
    // central meridian at 47 degrees of latitude.
    const dem::Grid turned(11, 11, {500000, 0, 30, 5200000, 30, 0},
                           geo::Crs::parse("EPSG:32632", "test"));
    EXPECT_NEAR(degrees(true_azimuth_rad(turned, radians(30))), 30, 0.01);
    const dem::Grid east(11, 11, {728000, 30, 0, 5210000, 0, -30},
                         geo::Crs::parse("EPSG:32632", "test"));
    const geo::Geodetic middle = east.center();
    const double convergence_deg =
        degrees(std::atan(std::tan(middle.lon_rad - radians(9)) * std::sin(middle.lat_rad)));
    EXPECT_GT(convergence_deg, 2);
    EXPECT_NEAR(degrees(true_azimuth_rad(east, radians(30))), 30 + convergence_deg, 0.01);
    // On a map in degrees the way is that over the ground, whatever a degree of longitude is long;
    // one of latitude is shorter by the Earth's flattening than a sphere has it.
    for (const double lat_deg : {47.0, -60.0}) {
        const dem::Grid degrees_of(11, 11, {8, 0.001, 0, lat_deg, 0, -0.001},
                                   geo::Crs::parse("EPSG:4326", "test"));
        for (const double azimuth_deg : {30.0, 135.0, 250.0})
            EXPECT_NEAR(degrees(true_azimuth_rad(degrees_of, radians(azimuth_deg))), azimuth_deg,
                        0.2)
                << lat_deg;
    }
}

TEST(Shadows, WhatItCannotDoIsRefused) {
    const dem::Heightfield field = wall(100);
    EXPECT_EQ(
        test::error_of([&] { shadows(dem::Posts(field), sun_at(90, 10), {.refraction = 1.5}); }),
        "exit 3: horizon: refraction 1.5: impossible, expected -1 to 0.9 of the Earth's curvature; "
        "0.13 is the mean");
    // Meridians run together: at 89.99 degrees a post is 0.02 degrees of longitude.
    const dem::Heightfield pole = test::field_of(400, 40, {0, 0.9, 0, 89.999, 0, -0.0001},
                                                 "EPSG:4326", [](int c, int) { return c % 7; });
    EXPECT_EQ(test::error_of([&] { shadows(dem::Posts(pole), sun_at(90, 10)); }),
              "exit 3: sun: WGS 84: the sun's direction on this grid changes by more than "
              "0.05 degrees within 2 posts; expected a map on which it does not, such as UTM: "
              "gdalwarp -t_srs");
}

TEST(Shadows, TerrestrialRefractionBendsTheRays) {
    // A ridge 79 km off stands higher the more the air bends lines of sight.
    const dem::Heightfield ridge =
        test::field_of(420, 60, {400000, 200, 0, 5200000, 0, -200}, "EPSG:32632",
                       [](int column, int) { return column == 400 ? 1800.0 : 100.0; });
    const dem::Posts posts(ridge);
    const dem::Grid& grid = posts.grid();
    std::vector<double> horizons_deg;
    for (const double k : {0.0, 0.13, 0.5}) {
        HorizonOptions options;
        options.refraction = k;
        const glm::dvec2 post(5, 30);
        const TerrainHorizon horizon(posts, grid.place(post.x, post.y), options);
        // Where the middle's sun has to stand for it to be on the horizon of the post.
        const double azimuth_rad = radians(90);
        horizons_deg.push_back(degrees(horizon.elevation_rad(azimuth_rad)));
        const SunTerrain terrain(posts, {k, {}}, false);
        for (const double over_deg : {-0.03, 0.03}) {
            SunOverDem sun{azimuth_rad, radians(horizons_deg.back()), 0};
            for (int i = 0; i < 4; ++i) {
                const SunOverDem there = SunField(terrain, grid.center(), sun).at(post);
                sun.azimuth_rad += azimuth_rad - there.azimuth_rad;
                sun.elevation_rad += radians(horizons_deg.back() + over_deg) - there.elevation_rad;
            }
            ShadowOptions of_k;
            of_k.refraction = k;
            EXPECT_EQ(shadows(posts, sun, of_k).lit.at(5, 30), over_deg > 0 ? 1 : 0)
                << "k " << k << ", " << horizons_deg.back() << " deg";
        }
    }
    EXPECT_GT(horizons_deg[2], horizons_deg[0] + 0.1);
}

}  // namespace
}  // namespace relevo::light::test_shadows
