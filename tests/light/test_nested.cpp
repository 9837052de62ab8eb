// A fine DEM in a wider and coarser one.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "light/hills.h"
#include "light/point/horizon.h"
#include "light/raster/horizons.h"
#include "light/raster/shadows.h"
#include "light/raster/sun_hours.h"

namespace relevo::light::test_nested {
namespace {

std::shared_ptr<const dem::Posts> shared(const dem::Heightfield& field) {
    return std::make_shared<const dem::Posts>(field);
}

/// A site in the middle of hills whose shadows cross its border; they on a coarse grid, and all of
/// them on one as fine as the site's.
struct NestedHills {
    const geo::Geodetic middle = place_at(46.5, 9.3);
    const Hills hills{middle};
    const dem::Heightfield site = on("site", 30, 0, 121), coarse = on("around", 90, 20, 201),
                           fine = on("all", 30, 0, 601);

    dem::Heightfield on(const std::string& name, double step_m, double turn_deg, int side) const {
        return sampled(turned(name, "EPSG:32632", middle, step_m, turn_deg, side), hills);
    }
};

TEST(Nested, ASiteIsLitAsInAWideFineDem) {
    const NestedHills hills;
    const dem::Posts posts(hills.site), whole(hills.fine), inside = posts.in(shared(hills.coarse));
    const auto lit = [](const dem::Posts& of, const SunOverDem& sun, const Window& part) {
        SunPlan plan(of, {}, part);
        plan.add_suns(of.grid().center(), {sun});
        ShadowOptions options;
        options.part = part;
        return shadows(plan, plan.suns().front(), options).lit;
    };
    const Window inner{240, 240, 121, 121};
    int alone_differ = 0, most = 0;
    for (const double azimuth_deg : {20.0, 95.0, 170.0, 250.0, 310.0})
        for (const double elevation_deg : {-0.3, 3.0, 8.0, 20.0}) {
            const SunOverDem sun{radians(azimuth_deg), radians(elevation_deg), 0};
            const Array2d<float> expected = lit(whole, sun, inner), nested = lit(inside, sun, {}),
                                 alone = lit(posts, sun, {});
            int differ = 0;
            for (std::size_t i = 0; i < expected.size(); ++i) {
                differ += nested.data()[i] != expected.data()[i];
                alone_differ += alone.data()[i] != expected.data()[i];
            }
            most = std::max(most, differ);
        }
    fmt::print(
        "[ accuracy ] a site in a coarser DEM: of 14,641 posts at most {} lit otherwise than in a "
        "wide fine one, of 20 suns; without the wider DEM {} of all\n",
        most, alone_differ);
    EXPECT_LE(most, 150);
    EXPECT_GT(alone_differ, 20'000);
}

TEST(Nested, AHorizonGoesOnOverTheWiderDem) {
    const NestedHills hills;
    const dem::Posts inside = dem::Posts(hills.site).in(shared(hills.coarse));
    const TerrainHorizon nested(inside, hills.middle), whole(hills.fine, hills.middle),
        alone(hills.site, hills.middle);
    double worst = 0, worst_alone = 0;
    for (int azimuth_deg = 0; azimuth_deg < 360; ++azimuth_deg) {
        const HorizonPoint found = nested.at(radians(azimuth_deg)),
                           expected = whole.at(radians(azimuth_deg));
        worst = std::max(worst, std::abs(found.elevation_rad - expected.elevation_rad));
        worst_alone = std::max(worst_alone, std::abs(alone.elevation_rad(radians(azimuth_deg)) -
                                                     expected.elevation_rad));
        EXPECT_NEAR(found.distance_m, expected.distance_m, 150) << azimuth_deg;
        EXPECT_GT(found.reach_m, 8000) << azimuth_deg;
    }
    fmt::print(
        "[ accuracy ] horizons of a site in a coarser DEM: within {:.4f} degrees, without "
        "it {:.2f}\n",
        degrees(worst), degrees(worst_alone));
    EXPECT_LE(degrees(worst), 0.03);
    EXPECT_GE(degrees(worst_alone), 5);
}

/// How far two rasters are apart [as their values], where both have some.
struct Apart {
    static constexpr double kLimit = 0.1;
    double mean = 0, worst = 0, over_limit = 0;  // the last one is a share of the posts

    Apart(const Array2d<float>& a, const Array2d<float>& b) {
        double count = 0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            const double apart = std::abs(double{a.data()[i]} - double{b.data()[i]});
            if (std::isnan(apart)) continue;
            mean += apart, ++count;
            worst = std::max(worst, apart);
            over_limit += apart > kLimit;
        }
        mean /= std::max(1.0, count);
        over_limit /= std::max(1.0, count);
    }
};

/// The middle of a site, a third of its side, and the same posts of a wide fine DEM. Ground beyond
/// the site is 60 posts of the coarse DEM away or more.
struct FineHills : NestedHills {
    const dem::Heightfield near = on("near", 10, 0, 361), far = on("far", 20, 20, 901),
                           all = on("wide", 10, 0, 1801);
    const dem::Posts posts{near}, whole{all}, inside = posts.in(shared(far));
    static constexpr Window kMiddle{120, 120, 121, 121}, kMiddleOfAll{840, 840, 121, 121};
};

TEST(Nested, HorizonsOfAllPostsGoOnOverTheWiderDem) {
    const FineHills hills;
    const dem::Posts &posts = hills.posts, &inside = hills.inside, &whole = hills.whole;
    const std::vector<double> azimuths{radians(3.0),   radians(48.0),  radians(95.0),
                                       radians(140.0), radians(201.0), radians(310.0)};
    const auto found = [&](const dem::Posts& of, const Window& part, std::size_t k) {
        SunPlan plan(of, {}, part);
        add_horizon_directions(plan, azimuths);
        Array2d<float> horizon = horizon_elevations(plan, plan.suns()[k], part);
        for (float& value : horizon)
            value = static_cast<float>(degrees(double{value}));
        return horizon;
    };
    double mean = 0, over_limit = 0, mean_alone = 0;
    for (std::size_t k = 0; k < azimuths.size(); ++k) {
        const Array2d<float> expected = found(whole, FineHills::kMiddleOfAll, k);
        const Apart nested(found(inside, FineHills::kMiddle, k), expected),
            alone(found(posts, FineHills::kMiddle, k), expected);
        fmt::print("[ accuracy ] azimuth {:3.0f}: mean {:.4f}, worst {:.3f}; alone {:.3f}\n",
                   degrees(azimuths[k]), nested.mean, nested.worst, alone.mean);
        mean += nested.mean / static_cast<double>(azimuths.size());
        mean_alone += alone.mean / static_cast<double>(azimuths.size());
        over_limit = std::max(over_limit, nested.over_limit);
    }
    EXPECT_LE(mean, 0.02);
    // A sweep over a grid that begins elsewhere is as far off at single posts.
    EXPECT_LE(over_limit, 1e-3);
    EXPECT_GE(mean_alone, 0.5);
}

TEST(Nested, SkyViewAndHoursOfManyDaysAreThoseOfAWideFineDem) {
    const FineHills hills;
    const dem::Posts &posts = hills.posts, &inside = hills.inside, &whole = hills.whole;
    const auto sky = [](const dem::Posts& of, const Window& part) {
        SkyViewOptions options;
        options.part = part;
        SunPlan plan(of, {}, part);
        add_sky_view_directions(plan, options.directions);
        return sky_view(plan, options).share;
    };
    const Apart in_sky(sky(inside, FineHills::kMiddle), sky(whole, FineHills::kMiddleOfAll));
    const auto hours = [](const dem::Posts& of, const Window& part) {
        SunHoursOptions options;
        options.part = part;
        constexpr double kDays = 100;
        const sun::Instant begin = sun::Instant::from_utc({{2026, 11, 1}});
        Array2d<float> found = sun_hours(of, begin, begin + kDays * 86400, options).hours;
        for (float& value : found)
            value *= static_cast<float>(60 / kDays);
        return found;
    };
    const Array2d<float> expected = hours(whole, FineHills::kMiddleOfAll);
    const Apart nested(hours(inside, FineHills::kMiddle), expected),
        alone(hours(posts, FineHills::kMiddle), expected);
    fmt::print(
        "[ accuracy ] sky view: mean {:.5f}, worst {:.4f}; minutes a day, of 100: mean {:.2f}, "
        "worst {:.1f}, without the wider DEM {:.1f} and {:.0f}\n",
        in_sky.mean, in_sky.worst, nested.mean, nested.worst, alone.mean, alone.worst);
    EXPECT_LE(in_sky.mean, 5e-4);
    EXPECT_LE(in_sky.worst, 3e-3);
    EXPECT_LE(nested.mean, 0.5);
    EXPECT_LE(nested.worst, 3);
    EXPECT_GE(alone.worst, 10);
}

/// Ground of 200 m with a wall of 2000 m that runs north, on a grid in degrees.
dem::Heightfield walled(double west_deg, double step_deg, int columns, int rows) {
    return test::field_of(columns, rows,
                          {west_deg, step_deg, 0, 46 + step_deg * (rows - 1) / 2, 0, -step_deg},
                          "EPSG:4326", [&](int column, int) {
                              const double lon = radians(west_deg + column * step_deg);
                              return std::cos(lon) < std::cos(radians(179.95)) ? 2000.0 : 200.0;
                          });
}

TEST(Nested, ASiteLiesAcrossTheFirstColumnOfADemRoundTheEarth) {
    // The wall, at 180 degrees, is in the wider DEM alone: its first columns and its last.
    const dem::Heightfield site = test::field_of(40, 40, {180.1, 0.001, 0, 46.02, 0, -0.001},
                                                 "EPSG:4326", [](int, int) { return 200.0; }),
                           wider = walled(-180, 1 / 30.0, 10800, 21);
    const dem::Posts posts = dem::Posts(site).in(shared(wider));
    const TerrainHorizon horizon(posts, place_at(46, -179.88));
    EXPECT_GT(degrees(horizon.elevation_rad(radians(270))), 10);
    EXPECT_LT(degrees(horizon.elevation_rad(radians(90))), 1);
    const auto lit = [&](double azimuth_deg) {
        SunPlan plan(posts, {}, {});
        plan.add_suns(site.grid.center(), {{radians(azimuth_deg), radians(5), 0}});
        return shadows(plan, plan.suns().front(), {}).lit_posts;
    };
    EXPECT_EQ(lit(270), 0);
    EXPECT_EQ(lit(90), 1600);
}

TEST(Nested, VoidsOfASiteAreGroundOfTheWiderDem) {
    // The west of the site has no heights; the wall there is in the wider DEM.
    const auto field = [](double step_m, int side, bool has_west) {
        return test::field_of(side, side,
                              {500000 - step_m * (side - 1) / 2, step_m, 0,
                               5200000 + step_m * (side - 1) / 2, 0, -step_m},
                              "EPSG:32632", [=](int column, int) {
                                  const double x_m = step_m * (column - (side - 1) / 2.0);
                                  if (!has_west && x_m < -500) return std::nan("");
                                  return std::abs(x_m + 1500) < 100 ? 800.0 : 100.0;
                              });
    };
    const dem::Heightfield site = field(30, 121, false), wider = field(90, 121, true);
    const dem::Posts posts = dem::Posts(site).in(shared(wider));
    SunPlan plan(posts, {}, {});
    plan.add_suns(site.grid.center(), {{radians(270), radians(10), 0}});
    EXPECT_EQ(shadows(plan, plan.suns().front(), {}).lit.at(60, 60), 0);
    const TerrainHorizon horizon(posts, site.grid.place(60, 60));
    EXPECT_GT(degrees(horizon.elevation_rad(radians(270))), 20);
}

TEST(Nested, AHighSiteInAFlatDemSeesTheSunBelowTheLevel) {
    const auto island = [](double step_m, int side) {
        return test::field_of(side, side,
                              {500000 - step_m * (side - 1) / 2, step_m, 0,
                               5200000 + step_m * (side - 1) / 2, 0, -step_m},
                              "EPSG:32632", [=](int column, int row) {
                                  const double x_m = step_m * (column - (side - 1) / 2.0),
                                               y_m = step_m * (row - (side - 1) / 2.0);
                                  return std::max(0.0, 3000 - 0.5 * std::hypot(x_m, y_m));
                              });
    };
    const dem::Heightfield site = island(60, 121),
                           flat = test::field_of(201, 201, {400000, 1000, 0, 5300000, 0, -1000},
                                                 "EPSG:32632", [](int, int) { return 0.0; });
    const dem::Posts posts = dem::Posts(site).in(shared(flat));
    SunPlan plan(posts, {}, {});
    plan.add_suns(site.grid.center(), {{radians(180), radians(-1.2), 0}});
    EXPECT_EQ(shadows(plan, plan.suns().front(), {}).lit.at(60, 60), 1);
}

TEST(Nested, ADemThatDoesNotContainTheSiteIsRefused) {
    const dem::Heightfield site = test::field_of(40, 40, {500000, 30, 0, 5200000, 0, -30},
                                                 "EPSG:32632", [](int, int) { return 100.0; }),
                           beside = test::field_of(40, 40, {510000, 90, 0, 5200000, 0, -90},
                                                   "EPSG:32632", [](int, int) { return 100.0; });
    const dem::Posts posts = dem::Posts(site).in(shared(beside));
    EXPECT_EQ(test::error_of([&] { SunPlan(posts, {}, {}); }),
              "exit 3: sun: the wider DEM does not contain all of the DEM in it");
    EXPECT_NE(test::error_of([&] {
                  TerrainHorizon(posts, site.grid.place(20, 20));
              }).find("outside of the wider DEM"),
              std::string::npos);
}

}  // namespace
}  // namespace relevo::light::test_nested
