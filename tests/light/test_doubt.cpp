#include <algorithm>
#include <cmath>
#include <limits>

#include "base/units.h"
#include "light/fields.h"
#include "light/point/carpet.h"
#include "light/point/doubt.h"

namespace relevo::light::test_doubt {
namespace {

using sun::Zone;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
const Zone kZurich = Zone::named("Europe/Zurich");

/// A ridge of 420 m, 2400 m to the west, ten degrees high, with a gap of five posts.
dem::Heightfield ridge(double in_the_gap_m) {
    return test::field_of(201, 201, {497000, 30, 0, 5208000, 0, -30}, "EPSG:32632",
                          [=](int column, int row) {
                              if (column != 20) return 100.0;
                              return row >= 98 && row <= 102 ? in_the_gap_m : 520.0;
                          });
}

TEST(Doubt, LightThroughAHoleIsNotKnown) {
    const dem::Heightfield open = ridge(100), holed = ridge(kNaN), closed = ridge(520);
    const TerrainHorizon through(open, open.grid.place(100, 100));
    const TerrainHorizon hole(holed, holed.grid.place(100, 100));
    const TerrainHorizon wall(closed, closed.grid.place(100, 100));
    const DirectLight light(hole);
    EXPECT_TRUE(DirectLight(through).holes().empty());
    // On 1 April the evening sun comes by the gap.
    const sun::Date date{2026, 4, 1};
    const LightDay day = light.day(date, kZurich);
    ASSERT_EQ(day.lit.size(), 2U);
    EXPECT_TRUE(day.lit[0].not_known.empty());
    EXPECT_FALSE(day.lit[0].all_unknown());
    ASSERT_EQ(day.lit[1].not_known.size(), 1U);
    EXPECT_TRUE(day.lit[1].all_unknown());
    EXPECT_EQ(day.lit[1].not_known[0].begin, day.lit[1].begin.utc);
    EXPECT_EQ(day.lit[1].not_known[0].end, day.lit[1].end.utc);
    EXPECT_NEAR(day.not_known_s, day.lit[1].length_s(), 1e-6);
    // What is known is what there is in any case.
    EXPECT_NEAR(day.lit_s - day.not_known_s, DirectLight(wall).day(date, kZurich).lit_s, 1);
    EXPECT_EQ(DirectLight(through).day(date, kZurich).not_known_s, 0);

    const Doubt doubt = doubt_of(light, {day}, hole.profile(1440), std::nullopt);
    ASSERT_EQ(doubt.holes.size(), 1U);
    EXPECT_NEAR(degrees(doubt.holes[0].from_azimuth_rad), degrees(day.lit[1].begin.azimuth_rad),
                0.3);
    EXPECT_NEAR(degrees(doubt.holes[0].to_azimuth_rad), degrees(day.lit[1].end.azimuth_rad), 0.3);
    EXPECT_EQ(doubt.not_known_s, day.not_known_s);
    // The horizon's own doubt is there whatever the day; the sun's only where it comes by.
    const Doubt horizon = doubt_of(hole, hole.profile(1440), std::nullopt);
    ASSERT_EQ(horizon.holes.size(), 1U);
    EXPECT_NEAR(degrees(horizon.holes[0].from_azimuth_rad), 268.0, 1.2);
    EXPECT_NEAR(degrees(horizon.holes[0].to_azimuth_rad), 271.9, 1.2);
    for (const sun::Date other : {sun::Date{2026, 12, 21}, {2026, 6, 21}}) {
        const LightDay far = light.day(other, kZurich);
        EXPECT_EQ(far.not_known_s, 0) << sun::to_string(other);
        EXPECT_TRUE(doubt_of(light, {far}, hole.profile(1440), std::nullopt).holes.empty());
    }
    const Carpet year = carpet(light, 2026, kZurich, 3600);
    double sum_s = 0;
    for (const LightDay& of : year.days)
        sum_s += of.not_known_s;
    EXPECT_GT(sum_s, 3600);
    EXPECT_NEAR(year.not_known_s, sum_s, 1e-6);
    EXPECT_NEAR(year.lit_s - year.not_known_s, carpet(DirectLight(wall), 2026, kZurich, 3600).lit_s,
                400);
}

TEST(Doubt, AHoleThatIsTooLowOrBehindARidgeMattersNot) {
    // The same gap behind a wall as high as the ridge is.
    const dem::Heightfield field = test::field_of(
        201, 201, {497000, 30, 0, 5208000, 0, -30}, "EPSG:32632", [](int column, int row) {
            if (column == 20) return row >= 98 && row <= 102 ? kNaN : 520.0;
            return column == 40 ? 520.0 : 100.0;
        });
    const TerrainHorizon horizon(field, field.grid.place(100, 100));
    const DirectLight light(horizon);
    EXPECT_TRUE(light.holes().empty());
    EXPECT_EQ(light.day({2026, 4, 1}, kZurich).not_known_s, 0);
}

TEST(Doubt, WithTheUpperAndTheLowerLimb) {
    const dem::Heightfield field = ridge(kNaN);
    const TerrainHorizon horizon(field, field.grid.place(100, 100));
    double before_s = 1e9;
    for (const sun::Limb limb : {sun::Limb::Upper, sun::Limb::Center, sun::Limb::Lower}) {
        LightOptions options;
        options.limb = limb;
        const LightDay day = DirectLight(horizon, options).day({2026, 4, 1}, kZurich);
        EXPECT_GT(day.not_known_s, 0);
        EXPECT_LT(day.not_known_s, before_s);
        before_s = day.not_known_s;
    }
}

TEST(Doubt, TerrainBeyondTheDemMattersWhereTheSunShines) {
    const dem::Heightfield field = ridge(520);
    const TerrainHorizon horizon(field, field.grid.place(100, 100));
    const DirectLight light(horizon);
    const auto profile = horizon.profile(1440);
    // In winter the sun keeps to the south; the ridge hides its last degrees in any case.
    const Doubt winter =
        doubt_of(light, {light.day({2026, 12, 21}, kZurich)}, profile, std::nullopt);
    ASSERT_FALSE(winter.open.empty());
    for (const OpenSector& sector : winter.open) {
        EXPECT_GT(degrees(sector.from_azimuth_rad), 120);
        EXPECT_LT(sector.from_azimuth_rad, sector.to_azimuth_rad);  // not through the north
        EXPECT_LT(degrees(sector.to_azimuth_rad), 235);
        EXPECT_GT(sector.least_m, 100);
        EXPECT_LT(sector.least_m, 520);
        EXPECT_NEAR(sector.reach_m, 3000, 1500);
    }
    // The lowest sun is that of the edges; where it stands higher, terrain must be higher.
    const Doubt high = doubt_of(light, {light.day({2026, 12, 21}, kZurich)}, profile, 1500.0);
    EXPECT_GT(high.open.front().to_azimuth_rad - high.open.front().from_azimuth_rad,
              winter.open.front().to_azimuth_rad - winter.open.front().from_azimuth_rad);
    // No terrain is as high as the Earth's is not.
    const dem::Heightfield spike = test::field_of(
        201, 201, {497000, 30, 0, 5208000, 0, -30}, "EPSG:32632",
        [](int column, int row) { return column == 3 && row == 3 ? 60'000.0 : 100.0; });
    const TerrainHorizon beside(spike, spike.grid.place(100, 100));
    EXPECT_EQ(doubt_of(beside, beside.profile(360), std::nullopt).highest_m, kHighestTerrain_m);
    // Under a sun that stays high no plausible terrain does.
    const dem::Heightfield low = ridge(100);
    const TerrainHorizon plain(low, low.grid.place(100, 100));
    EXPECT_TRUE(doubt_of(DirectLight(plain), {}, plain.profile(360), std::nullopt).open.empty());
}

TEST(Doubt, TerrainBeyondTheDemCanHideASummitAndTheSunOverIt) {
    const dem::Heightfield field = ridge(100);
    const TerrainHorizon horizon(field, field.grid.place(100, 100));
    AlignmentOptions options;
    options.tolerance_rad = radians(3);
    const auto doubt = [&](double column, double height_m, double highest_m) {
        geo::Geodetic target = field.grid.place(column, 100);
        target.height_m = height_m;
        const Alignments found =
            alignments(horizon, target, {2026, 3, 1}, {2026, 4, 20}, kZurich, options);
        EXPECT_TRUE(found.sight.visible);
        EXPECT_FALSE(found.passages.empty());
        return doubt_of(horizon, found, highest_m);
    };
    // Through the gap, to the west, over a point of the DEM's own: terrain of 520 m beyond it,
    // 3 km away and more, would hide the sun where that stands less than eight degrees high.
    const Doubt within = doubt(10, 110, 520);
    EXPECT_EQ(within.matters, Matters::Alignment);
    ASSERT_FALSE(within.open.empty());
    for (std::size_t i = 0; i < within.open.size(); ++i) {
        const OpenSector& open = within.open[i];
        EXPECT_NEAR(degrees(open.from_azimuth_rad), 270, 5);
        EXPECT_NEAR(open.reach_m, 3000, 30);
        EXPECT_GT(open.needed_m, open.reach_m);
        EXPECT_GT(open.least_m, 100);
        EXPECT_LT(open.least_m, 520);
        EXPECT_LE(within.open[i > 0 ? i - 1 : 0].from_azimuth_rad, open.from_azimuth_rad);
    }
    EXPECT_TRUE(doubt(10, 110, 100).open.empty());
    // A point 20 km off, twelve degrees up, with the sun over it: terrain of 400 m hides neither;
    // terrain of 3000 m hides both, and the point from no farther away than itself.
    const double high_m = 100 + 20'000 * std::tan(radians(12));
    EXPECT_TRUE(doubt(100 - 20'000 / 30.0, high_m, 400).open.empty());
    const Doubt beyond = doubt(100 - 20'000 / 30.0, high_m, 3000);
    ASSERT_GE(beyond.open.size(), 2U);
    EXPECT_TRUE(std::any_of(beyond.open.begin(), beyond.open.end(), [](const OpenSector& open) {
        return std::abs(degrees(open.from_azimuth_rad) - 270) < 0.5 && open.needed_m < 20'000;
    }));
    // Without passages what is before the target still matters, and what is behind it does not.
    const auto sight_alone = [&](double distance_m, double highest_m) {
        geo::Geodetic target = field.grid.place(100 - distance_m / 30, 100);
        target.height_m = 150;
        Alignments found;
        found.target = target;
        found.sight = horizon.sight(target);
        EXPECT_TRUE(found.sight.visible);
        return doubt_of(horizon, found, highest_m).open;
    };
    EXPECT_TRUE(sight_alone(2900, 3000).empty());
    ASSERT_EQ(sight_alone(4000, 3000).size(), 1U);
    EXPECT_NEAR(sight_alone(4000, 3000)[0].needed_m, 4000, 5);
    EXPECT_TRUE(sight_alone(4000, 100).empty());
}

TEST(Doubt, SectorsFollowEachOtherThroughNorth) {
    const auto of = [](const std::vector<int>& directions) {
        std::vector<bool> holds(360);
        for (const int i : directions)
            holds[static_cast<std::size_t>(i)] = true;
        std::vector<std::pair<int, int>> found;
        for (const Sector& s : sectors_of(holds))
            found.emplace_back(std::lround(degrees(s.from_azimuth_rad)),
                               std::lround(degrees(s.to_azimuth_rad)));
        return found;
    };
    using Pairs = std::vector<std::pair<int, int>>;
    EXPECT_EQ(of({}), Pairs());
    EXPECT_EQ(of({0}), (Pairs{{0, 0}}));
    EXPECT_EQ(of({3, 4, 5, 9}), (Pairs{{3, 5}, {9, 9}}));
    EXPECT_EQ(of({358, 359, 0, 1, 77}), (Pairs{{77, 77}, {358, 1}}));
    std::vector<int> all(360);
    for (int i = 0; i < 360; ++i)
        all[static_cast<std::size_t>(i)] = i;
    EXPECT_EQ(of(all), (Pairs{{0, 359}}));
    EXPECT_TRUE(sectors_of({}).empty());
}

}  // namespace
}  // namespace relevo::light::test_doubt
