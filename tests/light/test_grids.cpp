// The light of one relief, sampled on grids of all kinds, and suns that are looked at more or less
// often.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/units.h"
#include "geo/local_frame.h"
#include "light/fields.h"
#include "light/point/horizon.h"
#include "light/raster/horizons.h"
#include "light/raster/shadow_heights.h"
#include "light/raster/shadows.h"
#include "light/raster/sun_hours.h"
#include "sun/zone.h"
#include "support/support.h"

namespace relevo::light {
namespace {

sun::Instant utc(const std::string& text) {
    return sun::parse_time(text, {}).utc;
}

geo::Geodetic place_at(double lat_deg, double lon_deg) {
    return {radians(lat_deg), radians(lon_deg), 0};
}

/// Hills about a place: a sum of Gaussians, the same on whatever grid.
class Hills {
  public:
    explicit Hills(const geo::Geodetic& middle) : frame_(middle) {}

    double height_m(const geo::Geodetic& place) const {
        const glm::dvec3 at = frame_.to_local(place);
        double sum = 400;
        for (const auto& [x_m, y_m, up_m, width_m] : kHills) {
            const double dx = at.x - x_m, dy = at.y - y_m;
            sum += up_m * std::exp(-(dx * dx + dy * dy) / (2 * width_m * width_m));
        }
        return sum;
    }

  private:
    static constexpr std::array<std::array<double, 4>, 8> kHills{{{-3600, 1800, 1400, 1300},
                                                                  {3000, -1400, 1200, 1100},
                                                                  {600, 4200, 1500, 1400},
                                                                  {-1200, -4000, 1300, 1200},
                                                                  {4600, 3000, 900, 1000},
                                                                  {-5000, -1800, 1100, 1200},
                                                                  {400, 400, 500, 900},
                                                                  {1800, -5200, 1300, 1400}}};
    geo::LocalFrame frame_;
};

/// Grids about a place, of `side` posts a side.
struct NamedGrid {
    std::string name, crs;
    dem::Affine affine;
    int columns, rows;
    bool with_border = false;  // of voids, three posts wide
};

dem::Heightfield sampled(const NamedGrid& of, const Hills& hills) {
    const dem::Grid grid(of.columns, of.rows, of.affine, geo::Crs::parse(of.crs, "test"));
    return test::field_of(of.columns, of.rows, of.affine, of.crs, [&](int column, int row) {
        const bool is_border =
            column < 3 || row < 3 || column >= of.columns - 3 || row >= of.rows - 3;
        if (of.with_border && is_border) return std::nan("");
        return hills.height_m(grid.place(column, row));
    });
}

/// Posts `step_m` apart about a point of a CRS, turned clockwise.
NamedGrid turned(const std::string& name, const std::string& crs, const geo::Geodetic& middle,
                 double step, double turn_deg, int side = 401) {
    const glm::dvec2 at = geo::Crs::parse(crs, "test").from_geodetic(middle);
    const double c = step * std::cos(radians(turn_deg)), s = step * std::sin(radians(turn_deg));
    const double half = (side - 1) / 2.0;
    return {name,
            crs,
            {at.x - half * c + half * s, c, -s, at.y + half * s + half * c, -s, -c},
            side,
            side};
}

std::vector<NamedGrid> grids_about(const geo::Geodetic& middle) {
    const std::string utm = "EPSG:32632";
    std::vector<NamedGrid> grids{turned("UTM", utm, middle, 30, 0)};
    for (int turn_deg = 10; turn_deg <= 90; turn_deg += 10)
        grids.push_back(turned(fmt::format("turned by {}", turn_deg), utm, middle, 30, turn_deg));
    NamedGrid flipped = grids.front();
    flipped.name = "south-up";
    flipped.affine.y0 += flipped.affine.y_row * (flipped.rows - 1);
    flipped.affine.y_row *= -1;
    grids.push_back(flipped);
    NamedGrid transposed = grids.front();
    transposed.name = "transposed";
    std::swap(transposed.affine.x_column, transposed.affine.x_row);
    std::swap(transposed.affine.y_column, transposed.affine.y_row);
    grids.push_back(transposed);
    NamedGrid mirrored = grids.front();
    mirrored.name = "mirrored";
    mirrored.affine.x0 += mirrored.affine.x_column * (mirrored.columns - 1);
    mirrored.affine.x_column *= -1;
    grids.push_back(mirrored);
    NamedGrid bordered = grids.front();
    bordered.name = "with a border of voids";
    bordered.with_border = true;
    grids.push_back(bordered);
    constexpr double kLat_m = 111150;
    NamedGrid degrees = turned("degrees", "EPSG:4326", middle, 30 / kLat_m, 0);
    degrees.affine.x_column /= std::cos(middle.lat_rad);
    degrees.affine.x0 =
        relevo::degrees(middle.lon_rad) - (degrees.columns - 1) / 2.0 * degrees.affine.x_column;
    grids.push_back(degrees);
    grids.push_back(turned("square degrees", "EPSG:4326", middle, 30 / kLat_m, 0, 481));
    grids.push_back(turned("feet", "+proj=utm +zone=32 +datum=WGS84 +units=us-ft", middle,
                           30 / 0.3048006096, 0));
    grids.push_back(turned("polar", "EPSG:3995", middle, 30 * 1.15, 0));
    grids.push_back(turned("polar, turned", "EPSG:3995", middle, 30 * 1.15, 37));
    grids.push_back(turned("Mercator", "EPSG:3857", middle, 30 * 1.45, 0));
    grids.push_back(turned("equal area", "EPSG:3035", middle, 30, 0));
    return grids;
}

/// Hours at a place, linear between posts.
double hours_at(const Array2d<float>& hours, const glm::dvec2& post) {
    const int c = static_cast<int>(post.x), r = static_cast<int>(post.y);
    const double u = post.x - c, v = post.y - r;
    return (1 - v) * ((1 - u) * double{hours.at(c, r)} + u * double{hours.at(c + 1, r)}) +
           v * ((1 - u) * double{hours.at(c, r + 1)} + u * double{hours.at(c + 1, r + 1)});
}

std::vector<double> hours_of(const NamedGrid& of, const Hills& hills, const geo::Geodetic& middle,
                             sun::Instant begin) {
    const dem::Heightfield field = sampled(of, hills);
    const SunHours found = sun_hours(dem::Posts(field), begin, begin + 86400.0);
    const geo::LocalFrame frame(middle);
    std::vector<double> hours;
    for (int i = -12; i <= 12; ++i)
        for (int k = -12; k <= 12; ++k)
            hours.push_back(hours_at(
                found.hours, field.grid.post(frame.to_geodetic({170.0 * i, 170.0 * k, 0}))));
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

TEST(Grids, OfOneReliefHaveTheSameHours) {
    const geo::Geodetic middle = place_at(46.5, 9.3);
    const Hills hills(middle);
    const std::vector<NamedGrid> grids = grids_about(middle);
    const sun::Instant begin = utc("2026-03-20T00:00Z");
    const std::vector<double> expected = hours_of(grids.front(), hills, middle, begin);
    for (const NamedGrid& grid : grids) {
        const Difference found = difference(hours_of(grid, hills, middle, begin), expected);
        fmt::print(
            "[ accuracy ] hours on a grid {}: off by {:.3f} min in the mean, 99 % within "
            "{:.2f}\n",
            grid.name, found.mean_min, found.most_min);
        const bool is_same =
            grid.name == "south-up" || grid.name == "transposed" || grid.name == "mirrored";
        EXPECT_LE(found.mean_min, is_same ? 0.01 : 0.5) << grid.name;
        EXPECT_LE(found.most_min, is_same ? 0.05 : 2.5) << grid.name;
    }
}

TEST(Grids, AcrossTheAntimeridianHaveTheSameHours) {
    const geo::Geodetic middle = place_at(51.9, 179.999);
    const Hills hills(middle);
    const sun::Instant begin = utc("2026-03-20T12:00Z");
    const NamedGrid utm = turned("UTM", "EPSG:32660", middle, 30, 0);
    NamedGrid degrees = turned("degrees", "EPSG:4326", middle, 30 / 111250.0, 0);
    degrees.affine.x_column /= std::cos(middle.lat_rad);
    degrees.affine.x0 = 179.999 - (degrees.columns - 1) / 2.0 * degrees.affine.x_column;
    const Difference found =
        difference(hours_of(utm, hills, middle, begin), hours_of(degrees, hills, middle, begin));
    EXPECT_LE(found.mean_min, 0.5);
    EXPECT_LE(found.most_min, 2.5);
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

/// The hills, so wide that their shadows cross the border of a site in their middle.
TEST(Nested, ASiteIsLitAsInAWideFineDem) {
    const geo::Geodetic middle = place_at(46.5, 9.3);
    const Hills hills(middle);
    const std::string utm = "EPSG:32632";
    const dem::Heightfield site = sampled(turned("site", utm, middle, 30, 0, 121), hills),
                           coarse = sampled(turned("around", utm, middle, 90, 20, 201), hills),
                           fine = sampled(turned("all", utm, middle, 30, 0, 601), hills);
    const dem::Posts posts(site), around(coarse), whole(fine);
    const auto lit = [](const dem::Posts& of, const dem::Posts* wider, const SunOverDem& sun,
                        const Window& part) {
        SunPlan plan(of, {}, part, false, wider);
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
            const Array2d<float> expected = lit(whole, nullptr, sun, inner),
                                 nested = lit(posts, &around, sun, {}),
                                 alone = lit(posts, nullptr, sun, {});
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
    const geo::Geodetic middle = place_at(46.5, 9.3);
    const Hills hills(middle);
    const std::string utm = "EPSG:32632";
    const dem::Heightfield site = sampled(turned("site", utm, middle, 30, 0, 121), hills),
                           coarse = sampled(turned("around", utm, middle, 90, 20, 201), hills),
                           fine = sampled(turned("all", utm, middle, 30, 0, 601), hills);
    const dem::Posts around(coarse);
    HorizonOptions options;
    options.around = &around;
    const TerrainHorizon nested(site, middle, options), whole(fine, middle), alone(site, middle);
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

TEST(Steps, ThatAreLongLoseNoLightAtDawnAndDusk) {
    const dem::Heightfield flat = test::field_of(40, 40, {500000, 30, 0, 5200000, 0, -30},
                                                 "EPSG:32632", [](int, int) { return 500.0; });
    const dem::Posts posts(flat);
    const sun::Instant begin = utc("2026-06-20T22:00Z");
    for (const double step_min : {1.0, 3.0, 15.0, 30.0, 60.0}) {
        SunHoursOptions options;
        options.step_s = 60 * step_min;
        const SunHours found = sun_hours(posts, begin, begin + 86400.0, options);
        fmt::print("[ accuracy ] flat ground, suns {} min apart: {:.4f} h, of {:.4f}\n", step_min,
                   found.hours.at(20, 20), found.level_hours);
        EXPECT_NEAR(found.hours.at(20, 20), found.level_hours, 0.02) << step_min;
    }
}

TEST(Steps, ThatAreShortComeToOneResult) {
    const dem::Heightfield field = test::bundled("jacksboro.tif");
    const dem::Posts posts(field);
    const sun::Instant begin = utc("2026-12-21T05:00Z");
    const auto hours = [&](double step_s) {
        SunHoursOptions options;
        options.step_s = step_s;
        options.part = {120, 90, 160, 140};
        return sun_hours(posts, begin, begin + 86400.0, options).hours;
    };
    const Array2d<float> expected = hours(6);
    double last_min = 0;
    for (const double step_s : {180.0, 60.0, 30.0}) {
        const Array2d<float> found = hours(step_s);
        double sum_min = 0, worst_min = 0;
        int far = 0;
        for (std::size_t i = 0; i < found.size(); ++i) {
            const double off_min = 60 * std::abs(double{found.data()[i]} - expected.data()[i]);
            sum_min += off_min;
            worst_min = std::max(worst_min, off_min);
            far += off_min > 1;
        }
        const double mean_min = sum_min / static_cast<double>(found.size());
        fmt::print(
            "[ accuracy ] suns {} s apart against 6 s: mean {:.3f} min, {:.3f} % beyond a "
            "minute, worst {:.2f}\n",
            step_s, mean_min, 100.0 * far / static_cast<double>(found.size()), worst_min);
        if (step_s == 60) {
            EXPECT_LE(far, static_cast<int>(found.size() / 1000));
            EXPECT_LE(worst_min, 3);
        }
        // It falls with the step.
        if (last_min > 0) {
            EXPECT_LE(mean_min, last_min / 1.5);
        }
        last_min = mean_min;
    }
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
}  // namespace relevo::light
