#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "base/units.h"
#include "light/fields.h"
#include "light/point/carpet.h"
#include "light/point/direct_light.h"
#include "light/point/doubt.h"
#include "light/point/horizon.h"
#include "light/raster/horizons.h"
#include "light/raster/sun_hours.h"
#include "sun/time.h"
#include "sun/zone.h"

namespace relevo::light::test_edge_ground {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr int kSide = 120;
constexpr double kPost_m = 90;
const char* const kUtm = "EPSG:32632";

/// Low hills, 400 to 600 m high.
double hills_m(int column, int row) {
    return 500 + 60 * std::sin(column / 7.0) + 40 * std::cos(row / 9.0 + column / 23.0);
}

dem::Heightfield field(const std::function<double(int, int)>& height_m) {
    return test::field_of(kSide, kSide, {500'000, kPost_m, 0, 5'200'000, 0, -kPost_m}, kUtm,
                          height_m);
}

SunHours day_of(const dem::Heightfield& field, bool spells = false) {
    const dem::Posts posts(field);
    const auto time = [](const char* text) { return sun::parse_time(text, {}).utc; };
    SunHoursOptions options;
    options.spells = spells;
    options.air = [](const geo::Geodetic& place) { return sun::Refraction::standard(place); };
    return sun_hours(posts, time("2026-03-21T00:00Z"), time("2026-03-22T00:00Z"), options);
}

SunHours first_light_of(const dem::Heightfield& field) {
    return day_of(field, true);
}

// A void of -9998 that no metadata declares, in one post of 14 400: the lowest one in a basin,
// which shades nothing when it is there.
const glm::ivec2 kLow(77, 55);

TEST(EdgeGround, OneLowPostMovesNoHorizonElsewhere) {
    const dem::Heightfield sound = field(hills_m);
    const dem::Heightfield spoiled = field([](int column, int row) {
        return column == kLow.x && row == kLow.y ? -9998 : hills_m(column, row);
    });
    double worst_rad = 0;
    for (const glm::ivec2 at : {glm::ivec2(20, 20), {100, 30}, {3, 116}, {90, 90}}) {
        const TerrainHorizon before(sound, sound.grid.place(at.x, at.y));
        const TerrainHorizon after(spoiled, spoiled.grid.place(at.x, at.y));
        for (int i = 0; i < 72; ++i) {
            const double azimuth_rad = radians(5.0 * i);
            worst_rad = std::max(worst_rad, std::abs(after.elevation_rad(azimuth_rad) -
                                                     before.elevation_rad(azimuth_rad)));
        }
    }
    fmt::print("[ edge ground ] horizons move by {:.4f} degrees\n", degrees(worst_rad));
    EXPECT_LE(degrees(worst_rad), 0.001);
    const dem::Posts posts(sound), spoiled_posts(spoiled);
    const Horizons all = horizons(posts, {0, radians(90), radians(200)});
    const Horizons moved = horizons(spoiled_posts, {0, radians(90), radians(200)});
    for (std::size_t k = 0; k < all.azimuth_rad.size(); ++k)
        for (int row = 0; row < kSide; ++row)
            for (int column = 0; column < kSide; ++column) {
                if (std::max(std::abs(column - kLow.x), std::abs(row - kLow.y)) <= 2) continue;
                ASSERT_NEAR(degrees(moved.elevation_rad[k].at(column, row)),
                            degrees(all.elevation_rad[k].at(column, row)), 0.01)
                    << k << ": " << column << ", " << row;
            }
}

TEST(EdgeGround, OneLowPostGivesNoSunElsewhere) {
    const SunHours sound = day_of(field(hills_m));
    const SunHours spoiled = day_of(field([](int column, int row) {
        return column == kLow.x && row == kLow.y ? -9998 : hills_m(column, row);
    }));
    double most_h = 0;
    int touched = 0;
    // The sun of the equinox rises along the first and the last row, and beyond them or not.
    for (int row = 1; row + 1 < kSide; ++row)
        for (int column = 0; column < kSide; ++column) {
            if (std::max(std::abs(column - kLow.x), std::abs(row - kLow.y)) <= 2) continue;
            const double more_h =
                spoiled.hours.at(column, row) - double{sound.hours.at(column, row)};
            most_h = std::max(most_h, std::abs(more_h));
            touched += std::abs(more_h) > 0.02;
        }
    fmt::print("[ edge ground ] {:.2f} % of the posts change, by up to {:.3f} h\n",
               100.0 * touched / (kSide * kSide), most_h);
    // Suns of other air and paths: both change with the DEM's range of heights.
    EXPECT_LE(most_h, 0.05);
    EXPECT_LE(touched, kSide * kSide / 1000);
}

// A plateau whose west breaks down to a sea floor: the ground beyond the plateau's own edges is
// level, and nobody there sees the sun rise earlier than over a level horizon.
TEST(EdgeGround, IsAsHighAsTheEdgeThatWay) {
    const auto plateau_m = [](int column, int) { return column < 40 ? -2800.0 : 300.0; };
    const dem::Heightfield plateau = field(plateau_m), level = field([](int, int) { return 300; });
    const TerrainHorizon east(plateau, plateau.grid.place(110, 60));
    EXPECT_NEAR(degrees(east.elevation_rad(radians(90))), 0, 0.01);
    const dem::Posts posts(plateau);
    EXPECT_NEAR(degrees(horizons(posts, {radians(90)}).elevation_rad[0].at(110, 60)), 0, 0.01);

    const SunHours of_plateau = first_light_of(plateau), of_level = first_light_of(level);
    double most_h = 0;
    for (int row = 0; row < kSide; ++row)
        for (int column = 45; column < kSide; ++column)
            most_h = std::max(most_h, of_level.first_h.at(column, row) -
                                          double{of_plateau.first_h.at(column, row)});
    fmt::print("[ edge ground ] the sun rises up to {:.3f} h before it does on level ground\n",
               most_h);
    EXPECT_LE(most_h, 0.01);
}

// Of a survey that is cut out along a circle, with a void of 3 x 3 posts within it.
dem::Heightfield cut_out() {
    return field([](int column, int row) {
        const bool is_outside = std::hypot(column - 60, row - 60) > 50;
        const bool is_void = std::abs(column - 80) <= 1 && std::abs(row - 60) <= 1;
        return is_outside || is_void ? kNaN : 3 * hills_m(column, row);
    });
}

TEST(EdgeGround, AVoidThatReachesTheEdgeIsOutside) {
    const dem::Heightfield survey = cut_out();
    const dem::Posts posts(survey);
    EXPECT_TRUE(posts.is_outside(0, 0));
    EXPECT_TRUE(posts.is_outside(60, 5));
    EXPECT_FALSE(posts.is_outside(80, 60));
    EXPECT_FALSE(posts.is_outside(60, 60));

    const TerrainHorizon horizon(posts, survey.grid.place(60, 60));
    const std::vector<HorizonPoint> profile = horizon.profile(360);
    for (const HorizonPoint& point : profile) {
        EXPECT_LE(point.reach_m, 52 * kPost_m);
        const bool to_the_void = std::abs(degrees(point.azimuth_rad) - 90) < 8;
        EXPECT_TRUE(to_the_void || !point.hole) << degrees(point.azimuth_rad);
    }
    EXPECT_TRUE(horizon.at(radians(90)).hole);

    // What lies outside is said once, by direction, and takes no light away.
    const DirectLight light(horizon);
    const sun::Zone zone = sun::Zone::named("Europe/Zurich");
    const LightDay day = light.day({2026, 12, 21}, zone);
    EXPECT_GT(day.lit_s, 3600);
    EXPECT_EQ(day.not_known_s, 0);
    const Doubt doubt = doubt_of(light, {day}, profile, 4000);
    EXPECT_TRUE(doubt.holes.empty());
    ASSERT_EQ(doubt.open.size(), 1U);
    EXPECT_LT(degrees(doubt.open[0].from_azimuth_rad), 150);
    EXPECT_GT(degrees(doubt.open[0].to_azimuth_rad), 210);
}

// A level survey, cut out likewise, on a sheet that is lower elsewhere: no more sun than over a
// level horizon.
TEST(EdgeGround, OfAnOutlineIsAsHighAsItsRim) {
    const auto survey_m = [](int column, int row) {
        if (std::hypot(column - 60, row - 60) <= 50) return 900.0;
        return column < 3 && row < 3 ? 0.0 : kNaN;
    };
    const dem::Heightfield survey = field(survey_m);
    const TerrainHorizon horizon(survey, survey.grid.place(100, 60));
    const Carpet year = carpet(DirectLight(horizon), 2026, sun::Zone::named("Europe/Zurich"), 3600);
    fmt::print("[ edge ground ] {:.2f} h of direct sun, {:.2f} over a level horizon\n",
               year.lit_s / 3600, year.level_s / 3600);
    EXPECT_NEAR(year.lit_s, year.level_s, 0.001 * year.level_s);
}

TEST(EdgeGround, SunFromBelowTheLevelHorizonIsSaid) {
    // A tower of 800 m on a plain.
    const dem::Heightfield tower =
        field([](int column, int row) { return column == 60 && row == 60 ? 800.0 : 0.0; });
    const TerrainHorizon top(tower, tower.grid.place(60, 60)),
        foot(tower, tower.grid.place(90, 60));
    const sun::Zone zone = sun::Zone::named("Europe/Zurich");
    const auto lowest = [&](const TerrainHorizon& horizon) {
        const DirectLight light(horizon);
        return doubt_of(light, {light.day({2026, 3, 21}, zone)}, horizon.profile(360), {})
            .lowest_sun;
    };
    ASSERT_TRUE(lowest(top));
    // The dip of the sea's horizon from 800 m is 0.85 degrees (1.76 arcminutes a root of a metre).
    EXPECT_NEAR(degrees(lowest(top)->elevation_rad), -0.85, 0.06);
    EXPECT_TRUE(!lowest(foot) || degrees(lowest(foot)->elevation_rad) > -0.1);
}

}  // namespace
}  // namespace relevo::light::test_edge_ground
