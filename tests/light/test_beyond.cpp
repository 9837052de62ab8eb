#include <cmath>

#include <gtest/gtest.h>

#include "base/units.h"
#include "dem/fixture.h"
#include "light/fields.h"
#include "light/raster/beyond.h"
#include "sun/zone.h"

namespace relevo::light::test_beyond {
namespace {

// 201 x 201 posts 10 m apart: 2 km of a plain at 100 m, and a tower of 400 m in the middle.
dem::Heightfield plain_with_tower(double tower_m) {
    return test::field_of(
        201, 201, {500000, 10, 0, 0, 0, -10}, "EPSG:32631",
        [=](int column, int row) { return column == 100 && row == 100 ? tower_m : 100.0; });
}

SunOverDem sun_in_the_south(double elevation_deg) {
    return {kPi, radians(elevation_deg), 0};
}

TEST(TerrainBeyond, MattersAsFarAsItsShadowReaches) {
    const dem::Heightfield field = plain_with_tower(400);
    const dem::Posts posts(field);
    // 300 m over the plain, at 45 degrees: posts within 300 m of the southern edge, of 2010.
    const auto found =
        terrain_beyond(posts, {}, {sun_in_the_south(45)},
                       {.refraction = 0.13, .air = {}, .soft = false, .part = {}, .done = {}});
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->share, 300.0 / 2010, 1.0 / 24);
    EXPECT_EQ(found->highest_m, 400);
    EXPECT_GT(found->least_m, 100);
    EXPECT_LT(found->least_m, 100 + 2010.0 / 24 + 20) << "the post nearest to the edge";
    EXPECT_NEAR(found->needed_m, 300, 2010.0 / 24 + 20);
    // As high as the Earth's, it matters everywhere: 8750 m over the plain reach as far.
    ASSERT_TRUE(found->earths);
    EXPECT_EQ(found->earths->highest_m, 8850);
    EXPECT_EQ(found->earths->share, 1);
    EXPECT_NEAR(found->earths->needed_m, 8750, 50);
    EXPECT_TRUE(found->text(kHides).ends_with(
        "if none is higher than 400 m (the DEM's highest post); at 100 %, up to 9 km, if none is "
        "higher than 8850 m (the Earth's)"))
        << found->text(kHides);
    EXPECT_EQ(found->advice(),
              "mountains outside this DEM could change 17 % of the values if as high as its "
              "highest post (400 m), all values if 8850 m; use a DEM 1 or 9 km larger on each "
              "side or --surroundings, or set --highest");
    // Only the bound that is given counts.
    EXPECT_FALSE(terrain_beyond(posts, {}, {sun_in_the_south(45)}, {}, 400)->earths);
    // What is known to be lower does not.
    EXPECT_FALSE(terrain_beyond(posts, {}, {sun_in_the_south(45)}, {}, 100));
    // At 5 degrees it reaches 3.4 km: over all of the DEM.
    EXPECT_GT(terrain_beyond(posts, {}, {sun_in_the_south(5)}, {})->share, 0.95);
    // Nor does what lies far from the part that is asked for.
    EXPECT_FALSE(terrain_beyond(posts, {0, 0, 201, 100}, {sun_in_the_south(45)}, {}));
}

TEST(TerrainBeyond, MattersNotWhereTheDemsOwnGroundHidesTheSun) {
    // A wall of 110 m along the southern edge, as high as any ground.
    const dem::Heightfield field =
        test::field_of(201, 201, {500000, 10, 0, 0, 0, -10}, "EPSG:32631",
                       [=](int, int row) { return row >= 190 ? 400.0 : 100.0; });
    const dem::Posts posts(field);
    EXPECT_FALSE(terrain_beyond(posts, {0, 0, 201, 180}, {sun_in_the_south(20)}, {}));
    EXPECT_TRUE(terrain_beyond(posts, {0, 0, 201, 180}, {{0, radians(5), 0}}, {})) << "the north";
    // A sun that is down has nothing that hides it.
    EXPECT_FALSE(terrain_beyond(posts, {}, {sun_in_the_south(-3)}, {}));
}

TEST(TerrainBeyond, IsHiddenByTheCurvedEarth) {
    // A plain of 100 km at 100 m, and a summit. A sun of 1 degree over its middle stands 0.55
    // degrees high over the northern edge, 50 km farther from it. Seen from there, what ends just
    // beyond the southern edge has to be as high as 100 km * tan 0.55 degrees and the 683 m that
    // the Earth sinks by with a refraction of 0.13: 1743 m in all, from 100 m on.
    const dem::Heightfield field = test::field_of(
        201, 201, {450000, 500, 0, 0, 0, -500}, "EPSG:32631",
        [=](int column, int row) { return column == 100 && row == 100 ? 4000.0 : 100.0; });
    const dem::Posts posts(field);
    const auto matters = [&](double highest_m) {
        return terrain_beyond(
                   posts, {0, 0, 60, 1}, {sun_in_the_south(1)},
                   {.refraction = 0.13, .air = {}, .soft = false, .part = {}, .done = {}},
                   highest_m)
            .has_value();
    };
    EXPECT_FALSE(matters(1690));
    EXPECT_TRUE(matters(1800));
}

TEST(TerrainBeyond, IsTheSameHoweverLittleMemoryThereIs) {
    test::Raster raster;
    raster.columns = 1400;
    raster.rows = 1100;
    raster.value = [](int column, int row, int) {
        return 900 + 400 * std::sin(column * 0.031) * std::cos(row * 0.023) +
               (std::abs(column - 2 * row) % 61 == 0 ? 150.0 : 0.0);
    };
    const std::vector<std::string> paths{test::write_raster(test::folder() / "beyond.tif", raster)};
    const dem::Source source = dem::Source::open(paths);
    const dem::Heightfield field = dem::load(source, MemoryBudget::of_posts(std::int64_t{1} << 28));
    const dem::Posts all(field), few(source, 1 << 16);
    ASSERT_FALSE(few.in_memory());
    for (const dem::Window& part : {dem::Window{}, dem::Window{600, 500, 90, 500}}) {
        const auto at_sun = [&](const dem::Posts& posts) {
            return terrain_beyond(posts, part, {sun_in_the_south(8)}, {});
        };
        const auto with = at_sun(all), without = at_sun(few);
        ASSERT_TRUE(with && without);
        EXPECT_EQ(without->text(kHides), with->text(kHides));
        EXPECT_EQ(without->share, with->share);
        // Most of these posts have ground of the DEM's own before the sun.
        EXPECT_LT(with->share, 0.5);
        const auto over = [&](const dem::Posts& posts) {
            return terrain_beyond(posts, part, std::vector<double>{0.3, 2}, 0.13);
        };
        ASSERT_TRUE(over(all) && over(few));
        EXPECT_EQ(over(few)->text(kStandsOver), over(all)->text(kStandsOver));
    }
}

TEST(TerrainBeyond, StandsOverHorizons) {
    const dem::Heightfield field = plain_with_tower(400);
    const dem::Posts posts(field);
    const auto found = terrain_beyond(posts, {}, std::vector<double>{0, kPi}, 0.13);
    ASSERT_TRUE(found);
    EXPECT_GT(found->share, 0.95);
    EXPECT_FALSE(terrain_beyond(posts, {}, std::vector<double>{0, kPi}, 0.13, 90));
}

TEST(TerrainBeyond, SunsOfATimeStandForIt) {
    const dem::Heightfield field = plain_with_tower(400);
    const sun::Instant begin = sun::parse_time("2026-06-21T00:00Z", {}).utc;
    EXPECT_EQ(suns_of(field.grid, begin, begin + 86400.0).size(), 73U);
    EXPECT_EQ(suns_of(field.grid, begin, begin + 2 * 86400.0).size(), 2 * 73U);
    const std::vector<SunOverDem> year = suns_of(field.grid, begin, begin + 365 * 86400.0);
    EXPECT_EQ(year.size(), 14 * 73U);
}

}  // namespace
}  // namespace relevo::light::test_beyond
