#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/text.h"
#include "base/units.h"
#include "geo/local_frame.h"
#include "light/fields.h"
#include "light/point/ground_at.h"
#include "light/point/horizon.h"
#include "light/point/sectors.h"

namespace relevo::light::test_horizon {
namespace {

using test::bundled;
using test::error_of;
using test::field_of;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSphere_m = 6'371'000, kPlane_m = 1e18;  // HorizonOptions::map_radius_m

double number(const test::Csv& csv, std::size_t row, std::string_view column) {
    return *parse_number(csv.rows[row][csv.column(column)]);
}

/// A plain at 100 m with 30 m posts near 47 N 9 E, 201 x 201, the viewpoint in its middle.
dem::Heightfield plain(const std::function<double(int, int)>& height_m = [](int, int) {
    return 100.0;
}) {
    return field_of(201, 201, {497000, 30, 0, 5208000, 0, -30}, "EPSG:32632", height_m);
}
geo::Geodetic middle(const dem::Heightfield& field) {
    return field.grid.place((field.grid.columns() - 1) / 2, (field.grid.rows() - 1) / 2);
}

/// What a place with its height would be seen at from `eye`, without air: straight geometry.
struct Direction {
    double azimuth_rad, elevation_rad, horizontal_m;
};
Direction seen(const geo::LocalFrame& eye, const geo::Geodetic& place) {
    const glm::dvec3 p = eye.to_local(place);
    const double azimuth = std::atan2(p.x, p.y);
    return {azimuth < 0 ? azimuth + 2 * kPi : azimuth, std::atan2(p.z, std::hypot(p.x, p.y)),
            std::hypot(p.x, p.y)};
}

TEST(TerrainHorizon, AgreesWithCrossingsComputedIndependently) {
    SKIP_WITHOUT_TEST_DATA(dir);
    const dem::Heightfield field =
        dem::load((dir / "dem" / "srtm_bigtujunga30m_utm11.tif").string());
    const test::Csv csv = test::read_csv(dir / "sun" / "terrain_horizon.csv");
    ASSERT_EQ(csv.rows.size(), 720U);
    constexpr double kLimit_deg = 0.001;
    for (const bool flat : {true, false}) {
        HorizonOptions options;
        options.map_radius_m = flat ? kPlane_m : kSphere_m;
        std::vector<double> errors_deg, distances_m;
        for (std::size_t i = 0; i < csv.rows.size(); ++i) {
            const glm::ivec2 post(number(csv, i, "col"), number(csv, i, "row"));
            const TerrainHorizon horizon(field, field.grid.place(post.x, post.y), options);
            ASSERT_EQ(horizon.post(), glm::dvec2(post));
            const double azimuth_rad =
                radians(number(csv, i, "grid_azimuth_deg")) - horizon.true_north_on_map_rad();
            const HorizonPoint found = horizon.at(azimuth_rad);
            // The file has the DEM's ground alone, and verticals that do not spread with height.
            const double wanted_m = number(csv, i, "distance_to_horizon_m");
            const double tangent = std::tan(horizon.elevation_within_rad(azimuth_rad, kInfinity));
            const double spread =
                horizon.towards(azimuth_rad).height_m(tangent, wanted_m) / *options.map_radius_m;
            const double elevation_rad = std::atan(tangent * (1 + spread));
            const double wanted_deg = number(
                csv, i, flat ? "horizon_crossings_flat_deg" : "horizon_crossings_curved_k013_deg");
            errors_deg.push_back(std::abs(degrees(elevation_rad) - wanted_deg));
            EXPECT_LE(errors_deg.back(), kLimit_deg) << "row " << i + 2;
            distances_m.push_back(std::abs(found.distance_m - wanted_m));
        }
        test::print_accuracy(flat ? "terrain horizon, flat" : "terrain horizon, curved", errors_deg,
                             "deg", kLimit_deg);
        if (!flat) continue;
        // A few slopes of whole metres are even: two crossings are equally high, and either will
        // do. The file's distances have one decimal.
        std::sort(distances_m.begin(), distances_m.end());
        EXPECT_LE(distances_m[720 - 16], 0.051);
    }
}

/// Looks at every post of a DEM by straight geometry, which knows nothing of rays, grids, rings,
/// blocks or radii of curvature: none may stand over the horizon, and the blocking points must
/// stand where the horizon says.
/// @param few  by lines that are followed one by one
void expect_true_horizon(const dem::Heightfield& field, const geo::Geodetic& place,
                         const std::string& name, int every, bool few) {
    HorizonOptions options;
    options.few_directions = few;
    options.refraction = 0;
    options.eye_height_m = 1.5;
    const TerrainHorizon horizon(field, place, options);
    geo::Geodetic eye = horizon.place();
    eye.height_m = horizon.eye_m();
    const geo::LocalFrame frame(eye);

    double worst_over_deg = 0;
    for (int row = 1; row < field.grid.rows() - 1; row += every)
        for (int column = 1; column < field.grid.columns() - 1; column += every) {
            const geo::Geodetic post = field.place(column, row);
            if (std::isnan(post.height_m) || glm::dvec2(column, row) == horizon.post()) continue;
            const Direction d = seen(frame, post);
            worst_over_deg = std::max(
                worst_over_deg, degrees(d.elevation_rad - horizon.elevation_rad(d.azimuth_rad)));
        }
    EXPECT_LE(worst_over_deg, 0.0005) << name;

    std::vector<double> azimuth_deg, elevation_deg, distance;
    for (const HorizonPoint& point : horizon.profile(720)) {
        if (std::isnan(point.distance_m)) continue;
        const Direction d = seen(frame, horizon.place_of(point));
        azimuth_deg.push_back(
            std::abs(degrees(std::remainder(d.azimuth_rad - point.azimuth_rad, 2 * kPi))));
        elevation_deg.push_back(std::abs(degrees(d.elevation_rad - point.elevation_rad)));
        distance.push_back(std::abs(d.horizontal_m / point.distance_m - 1));
    }
    for (const auto& [errors, limit] :
         {std::pair{azimuth_deg, 0.001}, std::pair{elevation_deg, 0.0005},
          std::pair{distance, 0.001}})
        EXPECT_LE(*std::max_element(errors.begin(), errors.end()), limit) << name;
    test::print_accuracy(name + ": azimuth of the blocking point", azimuth_deg, "deg", 0.001);
    test::print_accuracy(name + ": its elevation", elevation_deg, "deg", 0.0005);
}

void expect_true_horizon(const dem::Heightfield& field, const geo::Geodetic& place,
                         const std::string& name, int every = 1) {
    expect_true_horizon(field, place, name, every, false);
    expect_true_horizon(field, place, name + ", followed", 5 * every, true);
}

TEST(TerrainHorizon, NoPostStandsOverItInDegrees) {
    const dem::Heightfield field = bundled("jacksboro.tif");
    expect_true_horizon(field, middle(field), "jacksboro, middle");
    expect_true_horizon(field, field.grid.place(77.3, 250.8), "jacksboro, between posts");
    expect_true_horizon(field, field.grid.place(402, 0), "jacksboro, corner");
}

TEST(TerrainHorizon, NoPostStandsOverItInMercatorAt49North) {
    const dem::Heightfield field = bundled("vancouver-island.tif");
    // 350 km wide, the map stretched by half: curvature and the scale of the map both count.
    expect_true_horizon(field, field.grid.place(60, 45), "vancouver-island");
}

TEST(TerrainHorizon, NoPostStandsOverItWhateverTheGrid) {
    const auto hills = [](int column, int row) {
        return 800 + 300 * std::sin(column * 0.11) * std::cos(row * 0.07) +
               40 * std::sin(column * row);
    };
    const double c = 92 * std::cos(radians(20)), s = 92 * std::sin(radians(20));
    expect_true_horizon(
        field_of(160, 120, {220000, c, s, 2190000, s, -c}, "EPSG:32605", hills),
        field_of(160, 120, {220000, c, s, 2190000, s, -c}, "EPSG:32605", hills).grid.place(90, 50),
        "rotated");
    const dem::Affine south_up{7, 1.0 / 1200, 0, 46, 0, 1.0 / 1200};
    const dem::Heightfield up = field_of(160, 120, south_up, "EPSG:4326", hills);
    expect_true_horizon(up, up.grid.place(33, 70), "south up");
    // Half a degree from the pole, meridians meet within the DEM.
    const dem::Affine arctic{0, 0.05, 0, 89.9, 0, -0.005};
    const dem::Heightfield pole = field_of(1200, 160, arctic, "EPSG:4326", hills);
    expect_true_horizon(pole, pole.grid.place(600, 80), "89.5 north", 11);
    const dem::Affine stereographic{-40000, 500, 0, 40000, 0, -500};
    const dem::Heightfield over = field_of(161, 161, stereographic, "EPSG:3413", hills);
    expect_true_horizon(over, over.grid.place(75, 83), "over the north pole");
    const dem::Affine dateline{179.9, 1.0 / 600, 0, -16, 0, -1.0 / 600};
    const dem::Heightfield fiji = field_of(160, 120, dateline, "EPSG:4326", hills);
    expect_true_horizon(fiji, fiji.grid.place(90, 50), "across 180 degrees");
    const dem::Affine feet{5.2e6, 30, 0, 3.6e6, 0, -30};
    const dem::Heightfield kentucky = field_of(160, 120, feet, "EPSG:3088", hills);
    expect_true_horizon(kentucky, kentucky.grid.place(90, 50), "in US survey feet");
}

TEST(TerrainHorizon, NoPostStandsOverItOnRealGround) {
    SKIP_WITHOUT_TEST_DATA(dir);
    for (const auto& [name, every] :
         {std::pair{"srtm_bigtujunga30m_utm11.tif", 7}, std::pair{"hawaii_rotated20.tif", 3},
          std::pair{"dem_RGI50-05.08389.tif", 2}, std::pair{"colorado_tut_relief.nc", 5},
          std::pair{"tyrol_aw3d30_n47e011_1s_cog.tif", 37}, std::pair{"avaGar.asc", 5}}) {
        dem::LoadOptions options;
        if (std::string(name) == "avaGar.asc") options.crs = "EPSG:31287";
        const dem::Heightfield field = dem::load((dir / "dem" / name).string(), options);
        expect_true_horizon(field, middle(field), name, every);
    }
}

TEST(TerrainHorizon, OfAWallIsItsHeightOverItsDistance) {
    // A wall of 60 m along a column, 40 posts to the east; the map's scale there is 0.9996.
    const dem::Heightfield field =
        plain([](int column, int) { return column == 140 ? 160.0 : 100.0; });
    HorizonOptions options;
    options.refraction = 0;
    const TerrainHorizon horizon(field, middle(field), options);
    const HorizonPoint east = horizon.at(radians(90) - horizon.true_north_on_map_rad());
    const double distance_m = 1200 / 0.9996;
    EXPECT_NEAR(east.distance_m, distance_m, 0.05);
    // The top is farther out than its foot by 160 m in 6380 km; the plain falls 0.113 m.
    EXPECT_NEAR(degrees(east.elevation_rad),
                degrees(std::atan((60 - distance_m * distance_m / 2 / 6.38e6) / distance_m /
                                  (1 + 160 / 6.38e6))),
                0.0002);
    EXPECT_EQ(east.height_m, 160);
    EXPECT_NEAR(east.post.x, 140, 1e-6);
    EXPECT_NEAR(east.post.y, 100, 1e-3);
    EXPECT_NEAR(east.reach_m, 3000 / 0.9996, 0.1);
    const geo::Geodetic place = horizon.place_of(east);
    EXPECT_NEAR(geo::geodesic(horizon.place(), place).distance_m, distance_m, 0.05);
    EXPECT_EQ(place.height_m, 160);
    // Seen at 45 degrees the wall is as high, and farther by the root of two.
    const HorizonPoint north_east = horizon.at(radians(45) - horizon.true_north_on_map_rad());
    EXPECT_NEAR(north_east.distance_m, distance_m * std::sqrt(2), 0.1);
    EXPECT_NEAR(std::tan(north_east.elevation_rad) * std::sqrt(2), std::tan(east.elevation_rad),
                2e-4);
    // To the west lies the plain alone.
    EXPECT_LT(horizon.elevation_rad(radians(270)), 0);
}

TEST(TerrainHorizon, RefractionLiftsFarGroundByHalfTheCoefficientTimesTheAngleAtTheCentre) {
    const dem::Heightfield field =
        plain([](int column, int) { return column == 190 ? 160.0 : 100.0; });
    HorizonOptions options;
    const auto elevation_rad = [&](double refraction) {
        options.refraction = refraction;
        return TerrainHorizon(field, middle(field), options).elevation_rad(radians(90));
    };
    const double at_center_rad = 2700 / 0.9996 / 6.387e6;
    EXPECT_NEAR((elevation_rad(0.2) - elevation_rad(0)) / kArcsecond_rad,
                0.1 * at_center_rad / kArcsecond_rad, 0.02);
}

TEST(TerrainHorizon, OfAPlainDipsByTheRootOfTheEyeHeight) {
    // The Nautical Almanac's 1.76 arc-minutes are for its own refraction, k = 0.165 or so; without
    // air it is 1.93 (Explanatory Supplement to the Astronomical Almanac, 1992, 9.331).
    const dem::Heightfield field = plain();
    HorizonOptions options;
    options.refraction = 0;
    for (const double eye_m : {2.0, 100.0, 2500.0}) {
        options.eye_height_m = eye_m;
        const TerrainHorizon horizon(field, middle(field), options);
        EXPECT_NEAR(degrees(horizon.elevation_rad(0.3)) * 60, -1.926 * std::sqrt(eye_m),
                    0.005 * std::sqrt(eye_m));
        // At two metres the horizon is 5 km away, outside of this DEM's three.
        EXPECT_TRUE(std::isnan(horizon.at(0.3).distance_m));
        EXPECT_TRUE(std::isnan(horizon.at(0.3).height_m));
        EXPECT_TRUE(std::isnan(horizon.place_of(horizon.at(0.3)).lat_rad));
    }
    // Of half a metre it is 2.5 km away, on the DEM.
    options.eye_height_m = 0.5;
    EXPECT_NEAR(TerrainHorizon(field, middle(field), options).at(0).distance_m,
                std::sqrt(2 * 6.36e6 * 0.5), 60);
}

TEST(TerrainHorizon, BeyondTheDemIsASmoothEarthAsHighAsItsEdge) {
    const dem::Heightfield field =
        plain([](int column, int row) { return column == 0 && row == 0 ? 5.0 : 100.0; });
    HorizonOptions options;
    options.refraction = 0;
    options.eye_height_m = 10;
    const TerrainHorizon horizon(field, middle(field), options);
    EXPECT_NEAR(degrees(horizon.elevation_rad(1)) * 60, -1.926 * std::sqrt(10), 0.05);
    // The DEM alone: its edge, 3.5 km away.
    EXPECT_LT(degrees(horizon.elevation_within_rad(1, kInfinity)) * 60, -9);
}

TEST(TerrainHorizon, TakesGroundBetweenPostsAsLinearAlongTheGrid) {
    // One post of 40 m, seen between the posts: the line of sight crosses the edge beside it.
    const dem::Heightfield field =
        plain([](int column, int row) { return column == 110 && row == 100 ? 140.0 : 100.0; });
    HorizonOptions options;
    options.map_radius_m = kPlane_m;
    const TerrainHorizon horizon(field, middle(field), options);
    for (const double beside : {0.0, 0.25, 0.5, 0.75, -0.3}) {
        const double bearing = std::atan2(10, beside);  // beside: rows to the north
        EXPECT_NEAR(std::tan(horizon.elevation_rad(bearing - horizon.true_north_on_map_rad())),
                    40 * (1 - std::abs(beside)) / (30 * std::hypot(10, beside)), 1e-9)
            << beside;
    }
}

TEST(TerrainHorizon, SeesOverGroundFromAHigherEye) {
    const dem::Heightfield field =
        plain([](int column, int) { return column == 140 ? 160.0 : 100.0; });
    HorizonOptions options;
    options.map_radius_m = kPlane_m;
    options.eye_height_m = 20;
    EXPECT_NEAR(std::tan(TerrainHorizon(field, middle(field), options).elevation_rad(radians(90))),
                40.0 / 1200, 1e-5);
    options.eye_height_m = 170;
    options.eye_above_ground = false;
    const TerrainHorizon over(field, middle(field), options);
    EXPECT_EQ(over.eye_m(), 170);
    EXPECT_EQ(over.place().height_m, 100);
    EXPECT_LE(over.elevation_rad(radians(90)), 0);
}

TEST(TerrainHorizon, PassesOverHolesAndSaysWhereTheyMatter) {
    // A hill of 60 m to the east, its top cut out; holes in the plain to the north, behind a wall
    // of 250 m to the west. None reaches the edge of the DEM.
    const auto heights = [](int column, int row) {
        if (std::min({column, row, 200 - column, 200 - row}) == 0) return 100.0;
        if (column >= 139 && column <= 141) return column == 140 ? kNaN : 140.0;
        if (row == 50) return kNaN;
        if (column == 60) return 350.0;
        if (column == 20) return kNaN;
        return 100.0;
    };
    const dem::Heightfield field = plain(heights);
    HorizonOptions options;
    options.map_radius_m = kPlane_m;
    const TerrainHorizon horizon(field, middle(field), options);
    const HorizonPoint east = horizon.at(radians(90));
    EXPECT_TRUE(east.hole);
    EXPECT_NEAR(std::tan(east.elevation_rad), 40.0 / 1170, 1e-5);
    EXPECT_TRUE(horizon.at(0).hole);
    // Behind the wall, a hole could hide no more than ground as high as the wall.
    EXPECT_FALSE(horizon.at(radians(270)).hole);
    EXPECT_FALSE(horizon.at(radians(180)).hole);
    // A post beside a hole counts where the line of sight goes through it.
    const dem::Heightfield single = plain([](int column, int row) {
        return row == 100 && column == 120 ? 150 : row == 99 && column == 120 ? kNaN : 100.0;
    });
    EXPECT_NEAR(
        std::tan(TerrainHorizon(single, middle(single), options)
                     .elevation_rad(
                         radians(90) -
                         TerrainHorizon(single, middle(single), options).true_north_on_map_rad())),
        50.0 / 600, 1e-9);
}

TEST(TerrainHorizon, SaysHowFarTheDemWouldHaveToReach) {
    // A valley: slopes of 20 degrees to the east and the west, open to the north and the south.
    const dem::Heightfield field = plain(
        [](int column, int) { return 100 + std::abs(column - 100) * 30 * std::tan(radians(20)); });
    HorizonOptions options;
    const TerrainHorizon horizon(field, middle(field), options);
    const auto profile = horizon.profile(360);
    // Terrain as high as the slopes' upper ends, 1192 m, hides nothing more behind them.
    const auto sectors = open_sectors(horizon, profile, 1191);
    ASSERT_EQ(sectors.size(), 2U);
    // The second one goes through the north.
    EXPECT_NEAR(degrees(sectors[0].from_azimuth_rad + sectors[0].to_azimuth_rad) / 2, 180, 1);
    EXPECT_NEAR(degrees(sectors[1].from_azimuth_rad + sectors[1].to_azimuth_rad) / 2, 180, 1);
    EXPECT_GT(sectors[1].from_azimuth_rad, sectors[1].to_azimuth_rad);
    EXPECT_NEAR(sectors[0].reach_m, 3000 / 0.9996, 1);
    // To the south the horizon is level: 1091 m stand over it to sqrt(2 R h / (1 - k)), 126 km.
    EXPECT_NEAR(sectors[0].needed_m, std::sqrt(2 * 6.365e6 * 1091 / 0.87), 500);
    // Higher terrain could stand over the slopes, too.
    const auto all = open_sectors(horizon, profile, 4000);
    ASSERT_EQ(all.size(), 1U);
    EXPECT_EQ(degrees(all[0].from_azimuth_rad), 0);
    EXPECT_NEAR(degrees(all[0].to_azimuth_rad), 359, 1e-9);
    const auto none = open_sectors(horizon, profile, -1000);
    EXPECT_EQ(none.size(), 0U);
}

/// A strip of posts 500 m apart from west to east at 47 N, flat at 0 m but for one of its columns.
dem::Heightfield strip(int columns, int column, double summit_m, double flat_m = 0) {
    return field_of(columns, 21, {500000, 500, 0, 5205000, 0, -500}, "EPSG:32632",
                    [=](int c, int) { return c == column ? summit_m : flat_m; });
}

TEST(TerrainHorizon, LooksAsFarAsASummitCanBeSeen) {
    // Over a level sea, from the shore, 3000 m are seen from sqrt(2 R h / (1 - k)) = 209.6 km; from
    // 100 m up from 38.3 km farther.
    const double r_m = 6.3745e6 / 0.87;  // of the ellipsoid from east to west there
    for (const double eye_m : {0.0, 100.0}) {
        const double seen_m = std::sqrt(2 * r_m * 3000) + std::sqrt(2 * r_m * eye_m);
        for (const double share : {0.3, 0.7, 0.97, 1.03}) {
            const int column = 2 + static_cast<int>(share * seen_m / 500);
            const dem::Heightfield field = strip(column + 60, column, 3000);
            HorizonOptions options;
            options.eye_height_m = eye_m;
            const TerrainHorizon horizon(field, field.grid.place(2, 10), options);
            const geo::Geodetic summit = field.grid.place(column, 10);
            const geo::Geodesic way = geo::geodesic(field.grid.place(2, 10), summit);
            const HorizonPoint point = horizon.at(way.azimuth_rad);
            if (share < 1) {
                EXPECT_NEAR(point.distance_m, way.distance_m, 600) << share << " " << eye_m;
                EXPECT_EQ(point.height_m, 3000) << share << " " << eye_m;
                const double up_m = 3000 - eye_m - way.distance_m * way.distance_m / 2 / r_m;
                EXPECT_NEAR(std::tan(point.elevation_rad), up_m / way.distance_m, 2e-4);
            } else {
                EXPECT_TRUE(std::isnan(point.height_m) || point.height_m == 0) << eye_m;
                EXPECT_NEAR(degrees(point.elevation_rad), -degrees(std::sqrt(2 * eye_m / r_m)),
                            0.02);
            }
        }
    }
}

TEST(TerrainHorizon, ReachesToTheEdgeOfTheDem) {
    // From a corner of a strip, and of one that is cut off at half the way: the summit behind the
    // edge is gone, and it is said how far the DEM goes.
    const dem::Heightfield whole = strip(120, 100, 1500), half = strip(60, 100, 1500, 0);
    for (const dem::Heightfield* field : {&whole, &half}) {
        const TerrainHorizon horizon(*field, field->grid.place(2, 10));
        const geo::Geodesic way = geo::geodesic(field->grid.place(2, 10),
                                                field->grid.place(field->grid.columns() - 1, 10));
        const std::vector<HorizonPoint> profile = horizon.profile(1440);
        const HorizonPoint east = horizon.at(way.azimuth_rad);
        if (field == &whole) {
            EXPECT_NEAR(east.reach_m, way.distance_m, 1);
            EXPECT_GT(degrees(east.elevation_rad), 1.5);
        } else {
            EXPECT_NEAR(degrees(east.elevation_rad), 0, 1e-3);
        }
        // Terrain of 2500 m beyond either would be seen; the DEM ends where it ends, although the
        // flat half holds nothing that is looked for.
        for (const OpenSector& sector : open_sectors(horizon, profile, 2500)) {
            if (sector.from_azimuth_rad > sector.to_azimuth_rad) continue;
            EXPECT_GE(sector.reach_m, 500);
        }
        std::vector<double> only_east(profile.size(), kInfinity);
        only_east[360] = radians(-90);
        const auto open = open_sectors(horizon, profile, 2500, only_east);
        ASSERT_EQ(open.size(), 1U);
        EXPECT_EQ(degrees(open[0].from_azimuth_rad), 90);
        EXPECT_NEAR(open[0].reach_m, way.distance_m, 100);
        // The least height that stands over the horizon there: that of the line of sight.
        const double r_m = 6.3745e6 / 0.87, s = open[0].reach_m;
        EXPECT_NEAR(open[0].least_m, std::tan(profile[360].elevation_rad) * s + s * s / 2 / r_m,
                    5 + 0.01 * open[0].least_m);
    }
}

TEST(TerrainHorizon, TerrainBeyondMattersOnlyBeforeTheSun) {
    const dem::Heightfield field = plain();
    const TerrainHorizon horizon(field, middle(field));
    const auto profile = horizon.profile(360);
    ASSERT_EQ(open_sectors(horizon, profile, 400).size(), 1U);
    std::vector<double> sun_rad(360, kInfinity);
    EXPECT_TRUE(open_sectors(horizon, profile, 400, sun_rad).empty());
    // The edge is 3 km away in the south: 300 m stand 5.7 degrees high there.
    for (int i = 170; i < 190; ++i)
        sun_rad[static_cast<std::size_t>(i)] = radians(6);
    EXPECT_TRUE(open_sectors(horizon, profile, 400, sun_rad).empty());
    for (int i = 175; i < 185; ++i)
        sun_rad[static_cast<std::size_t>(i)] = radians(2);
    const auto open = open_sectors(horizon, profile, 400, sun_rad);
    ASSERT_EQ(open.size(), 1U);
    EXPECT_NEAR(degrees(open[0].from_azimuth_rad), 175, 1e-9);
    EXPECT_NEAR(degrees(open[0].to_azimuth_rad), 184, 1e-9);
    EXPECT_NEAR(open[0].least_m, 100 + 3000 * std::tan(radians(2)), 2);
    // Less the 4.9 m that the Earth falls away by.
    EXPECT_NEAR(open[0].needed_m, 295.1 / std::tan(radians(2)), 30);
    // From high up, lines of sight go down, and lower ground matters farther away.
    HorizonOptions high;
    high.eye_height_m = 3000;
    const TerrainHorizon above(field, middle(field), high);
    const auto below = open_sectors(above, above.profile(360), 2000);
    ASSERT_EQ(below.size(), 1U);
    EXPECT_NEAR(below[0].least_m, 100, 5);
    EXPECT_GT(below[0].needed_m, 100e3);
}

TEST(TerrainHorizon, SeesASummitUnlessGroundStandsBeforeIt) {
    const dem::Heightfield field = bundled("jacksboro.tif");
    HorizonOptions options;
    options.eye_height_m = 2;
    const TerrainHorizon horizon(field, field.grid.place(120, 200), options);
    int blocking = 0, hidden = 0;
    for (const HorizonPoint& point : horizon.profile(360)) {
        if (std::isnan(point.distance_m) || point.distance_m < 1000) continue;
        ++blocking;
        // What blocks is seen, and stands where the horizon is.
        const Sight sight = horizon.sight(horizon.place_of(point));
        EXPECT_TRUE(sight.visible) << degrees(point.azimuth_rad);
        EXPECT_EQ(sight.hidden_by_rad, 0);
        EXPECT_NEAR(degrees(std::remainder(sight.azimuth_rad - point.azimuth_rad, 2 * kPi)), 0,
                    0.001);
        EXPECT_NEAR(degrees(sight.elevation_rad), degrees(point.elevation_rad), 1e-4);
        EXPECT_NEAR(sight.distance_m, point.distance_m, 0.05);
        // What lies under it, farther away, is not.
        geo::Geodetic behind =
            geo::destination(horizon.place(), point.azimuth_rad, point.distance_m + 2000);
        behind.height_m = 300;
        const Sight below = horizon.sight(behind);
        if (below.elevation_rad > point.elevation_rad) continue;
        EXPECT_FALSE(below.visible);
        EXPECT_NEAR(below.hidden_by_rad, point.elevation_rad - below.elevation_rad, 1e-4);
        ++hidden;
    }
    EXPECT_GT(blocking, 100);
    EXPECT_GT(hidden, 100);
}

TEST(TerrainHorizon, FindsTheSummitThatWasMeant) {
    const dem::Heightfield field =
        plain([](int column, int row) { return column == 110 && row == 104 ? 180.0 : 100.0; });
    const geo::Geodetic meant = field.grid.place(108.6, 102.2);  // 69 m away
    const dem::Posts posts(field);
    EXPECT_EQ(summit_near(posts, meant, 100), field.place(110, 104));
    const geo::Geodetic itself = summit_near(posts, meant, 50);
    EXPECT_NEAR(itself.lat_rad, meant.lat_rad, 1e-12);
    EXPECT_EQ(itself.height_m, 100);
    EXPECT_NEAR(summit_near(posts, field.grid.place(109.5, 104), 0).height_m, 140, 1e-3);
}

TEST(TerrainHorizon, ErrorsSayWhatIsWrong) {
    const dem::Heightfield field = plain(
        [](int column, int row) { return std::hypot(column - 20, row - 20) < 5 ? kNaN : 100.0; });
    EXPECT_EQ(error_of([&] { TerrainHorizon(field, geo::geodetic_deg(46.5, 9)); }),
              "exit 3: horizon: 46.5,9: outside of the DEM, expected a point within "
              "latitudes 46.9715 to 47.0255 and longitudes 8.9605 to 9.0395");
    EXPECT_EQ(error_of([&] { TerrainHorizon(field, field.grid.place(20, 20)); }),
              "exit 3: horizon: 47.02012,8.96842: the point is in a void of the DEM; a post with a "
              "height is at 47.0212,8.96684");
    HorizonOptions options;
    options.eye_above_ground = false;
    options.eye_height_m = 99;
    EXPECT_EQ(error_of([&] { TerrainHorizon(field, middle(field), options); }),
              "exit 3: horizon: 46.99852,9: the eye at 99.0 m is under the ground, which is "
              "at 100.0 m there; a height above the ground is written as 2agl");
    options.eye_height_m = 1e9;
    EXPECT_EQ(
        error_of([&] { TerrainHorizon(field, middle(field), options); }),
        "exit 3: horizon: 46.99852,9: the eye at 1000000000 m, expected at most 10000 m above the "
        "ground, which is at 100.0 m there; the refraction model does not hold above");
    for (const double height_m : {10'100.1, 1e308, kInfinity, kNaN}) {
        options.eye_height_m = height_m;
        EXPECT_NE(error_of([&] {
                      TerrainHorizon(field, middle(field), options);
                  }).find("expected at most 10000 m above the ground"),
                  std::string::npos)
            << height_m;
    }
    options.eye_height_m = 10'100;
    EXPECT_EQ(TerrainHorizon(field, middle(field), options).eye_m(), 10'100);
    const dem::Heightfield centimetres = plain([](int, int) { return 112'300; });
    EXPECT_EQ(error_of([&] { TerrainHorizon(centimetres, middle(centimetres)); }),
              "exit 3: horizon: 46.99852,9: the ground is at 112300 m there, expected a "
              "height of the Earth; pass --unit cm where the DEM's heights are centimetres, or "
              "--nodata V where V is no height");
    options = {};
    options.refraction = 1.5;
    EXPECT_EQ(error_of([&] { TerrainHorizon(field, middle(field), options); }),
              "exit 3: horizon: refraction 1.5: impossible, expected -1 to 0.9 of the Earth's "
              "curvature; 0.13 is the mean");
    options = {};
    options.map_radius_m = kPlane_m;
    EXPECT_EQ(error_of([&] {
                  const dem::Heightfield degrees_field = bundled("jacksboro.tif");
                  TerrainHorizon(degrees_field, middle(degrees_field), options);
              }),
              "exit 3: horizon: WGS 84: a map in degrees cannot be taken as flat ground; "
              "expected a projected CRS");
}

TEST(TerrainHorizon, SaysHowItWasMade) {
    const dem::Heightfield field = plain();
    HorizonOptions options;
    EXPECT_EQ(TerrainHorizon(field, middle(field), options).description(),
              "terrain horizon: highest crossing with the rows and columns of the DEM, on the WGS "
              "84 ellipsoid with terrestrial refraction k = 0.13; eye at ground level, on ground "
              "at 100.0 m; outside the DEM smooth ground as high as its edge there");
    options.map_radius_m = kSphere_m;
    options.eye_height_m = 1.6;
    EXPECT_EQ(
        TerrainHorizon(field, middle(field), options).description(),
        "terrain horizon: highest crossing with the rows and columns of the DEM, on the map, "
        "on a sphere with terrestrial refraction k = 0.13; eye 1.6 m up, on ground at 100.0 m; "
        "outside the DEM smooth ground as high as its edge there");
}

}  // namespace
}  // namespace relevo::light::test_horizon
