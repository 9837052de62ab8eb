#include <cmath>
#include <limits>

#include "base/units.h"
#include "dem/fixture.h"
#include "light/fields.h"
#include "light/point/direct_light.h"
#include "light/point/ground_at.h"

namespace relevo::light::test_few_posts {
namespace {

using test::Raster;
using test::write_raster;

constexpr std::int64_t kFew = 1 << 16;  // posts that are allowed

using test::folder;

/// Alpine ground with ridges of one post, which means would flatten.
double ground_m(int column, int row) {
    const double ridge = std::abs(column - 2 * row) % 61 == 0 ? 350 : 0;
    return 900 + 500 * std::sin(column * 0.031) * std::cos(row * 0.023) + ridge +
           (column * 7 + row * 13) % 29;
}

Raster alps(int columns, int rows) {
    Raster raster;
    raster.columns = columns;
    raster.rows = rows;
    raster.value = [](int column, int row, int) { return ground_m(column, row); };
    return raster;
}

bool same(double a, double b) {
    return a == b || (std::isnan(a) && std::isnan(b));
}

/// The figures of a place over a DEM of which memory holds few posts, and of one in memory.
void expect_same_light(const std::vector<std::string>& paths, double column, double row) {
    const dem::Source source = dem::Source::open(paths);
    const dem::Heightfield field = dem::load(source, MemoryBudget::of_posts(std::int64_t{1} << 28));
    const dem::Posts few(source, kFew);
    ASSERT_FALSE(few.in_memory());
    const geo::Geodetic place = field.grid.place(column, row);
    HorizonOptions options;
    options.eye_height_m = 2;
    const TerrainHorizon whole(field, place, options), parts(few, place, options);
    EXPECT_EQ(parts.eye_m(), whole.eye_m());
    EXPECT_EQ(parts.place(), whole.place());
    EXPECT_EQ(parts.description(), whole.description());
    const std::vector<HorizonPoint> a = whole.profile(3600), b = parts.profile(3600);
    for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_EQ(b[i].elevation_rad, a[i].elevation_rad) << i / 10.0;
        ASSERT_TRUE(same(b[i].distance_m, a[i].distance_m)) << i / 10.0;
        ASSERT_TRUE(same(b[i].height_m, a[i].height_m)) << i / 10.0;
        ASSERT_EQ(b[i].hole, a[i].hole) << i / 10.0;
        ASSERT_EQ(b[i].reach_m, a[i].reach_m) << i / 10.0;
    }
    for (int degree = 0; degree < 360; degree += 7)
        EXPECT_EQ(parts.elevation_within_rad(radians(degree), 2000),
                  whole.elevation_within_rad(radians(degree), 2000));
    const sun::Zone zone = sun::Zone::named("UTC");
    const LightDay day = DirectLight(whole).day({2026, 2, 10}, zone);
    const LightDay again = DirectLight(parts).day({2026, 2, 10}, zone);
    ASSERT_EQ(again.lit.size(), day.lit.size());
    for (std::size_t i = 0; i < day.lit.size(); ++i) {
        EXPECT_EQ(again.lit[i].begin.utc, day.lit[i].begin.utc);
        EXPECT_EQ(again.lit[i].end.utc, day.lit[i].end.utc);
    }
    const geo::Geodetic summit = summit_near(few, place, 3000);
    EXPECT_EQ(summit, summit_near(dem::Posts(field), place, 3000));
    const Sight sight = whole.sight(summit), again_sight = parts.sight(summit);
    EXPECT_EQ(again_sight.elevation_rad, sight.elevation_rad);
    EXPECT_EQ(again_sight.hidden_by_rad, sight.hidden_by_rad);
}

TEST(LightOfFewPosts, IsThatOfAllPosts) {
    expect_same_light({write_raster(folder() / "alps.tif", alps(500, 380))}, 213.4, 177.7);
}

TEST(LightOfFewPosts, WithHoles) {
    Raster holed = alps(500, 380);
    holed.nodata = -9999;
    holed.value = [](int column, int row, int) {
        const bool void_ = std::hypot(column - 300, row - 120) < 30 || column % 97 == 3;
        return void_ ? -9999.0 : ground_m(column, row);
    };
    expect_same_light({write_raster(folder() / "holed.tif", holed)}, 213, 177);
}

TEST(LightOfFewPosts, InDegreesAndOnTurnedGrids) {
    Raster degrees_grid = alps(500, 380);
    degrees_grid.crs = "EPSG:4326";
    degrees_grid.geotransform = {{7, 1.0 / 3600, 0, 46, 0, -1.0 / 3600}};
    expect_same_light({write_raster(folder() / "degrees.tif", degrees_grid)}, 250, 100.5);
    Raster turned = alps(500, 380);
    const double c = 30 * std::cos(radians(20)), s = 30 * std::sin(radians(20));
    turned.geotransform = {{500000, c, s, 5200000, s, -c}};
    expect_same_light({write_raster(folder() / "turned.tif", turned)}, 33.3, 350);
}

TEST(LightOfFewPosts, OfSeveralFiles) {
    Raster east = alps(260, 380), shifted = alps(200, 200);
    east.geotransform = {{500000 + 30.0 * 240, 30, 0, 5200000, 0, -30}};
    shifted.geotransform = {{500000 + 30.0 * 100.4, 30, 0, 5200000 - 30.0 * 90.3, 0, -30}};
    expect_same_light({write_raster(folder() / "west.tif", alps(250, 380)),
                       write_raster(folder() / "east.tif", east),
                       write_raster(folder() / "shifted.tif", shifted)},
                      251, 222);
}

TEST(LightOfFewPosts, AViewpointInAHoleIsToldOfTheSamePost) {
    Raster holed = alps(500, 380);
    holed.nodata = -9999;
    holed.value = [](int column, int row, int) {
        return std::hypot(column - 250, row - 200) < 90 ? -9999.0 : ground_m(column, row);
    };
    const std::string path = write_raster(folder() / "hole.tif", holed);
    const dem::Source source = dem::Source::open(path);
    const dem::Heightfield field = dem::load(source, MemoryBudget::of_posts(std::int64_t{1} << 28));
    const dem::Posts few(source, kFew);
    const geo::Geodetic place = field.grid.place(260, 190);
    const std::string whole = test::error_of([&] { TerrainHorizon(field, place); });
    EXPECT_NE(whole.find("; a post with a height is at "), std::string::npos) << whole;
    EXPECT_EQ(test::error_of([&] { TerrainHorizon(few, place); }), whole);
}

}  // namespace
}  // namespace relevo::light::test_few_posts
