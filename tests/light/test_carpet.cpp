#include <numeric>

#include "base/units.h"
#include "light/fields.h"
#include "light/point/carpet.h"
#include "sun/position.h"

namespace relevo::light::test_carpet {
namespace {

using sun::Zone;
using test::error_of;

class Valley : public testing::Test {
  protected:
    dem::Heightfield field_ = test::bundled("jacksboro.tif");
    TerrainHorizon horizon_{field_, field_.grid.place(199, 136)};
    DirectLight light_{horizon_};
    Zone zone_ = Zone::named("America/New_York");
};

TEST_F(Valley, CarpetHasEveryDayAndItsExactHours) {
    const Carpet c = carpet(light_, 2024, zone_, 600);
    EXPECT_EQ(c.light.height(), 366);
    EXPECT_EQ(c.light.width(), 144);
    EXPECT_EQ(c.time_of_day_s(0), 300);
    EXPECT_NEAR(std::accumulate(c.month_lit_s.begin(), c.month_lit_s.end(), 0.0), c.lit_s, 1e-6);
    EXPECT_LT(c.lit_s, c.level_s);
    EXPECT_EQ(c.definition, light_.definition());
    // Lit cells, counted, come near the exact sum; not nearer than a few minutes a day can.
    std::int64_t lit = 0, up = 0;
    for (const Light light : c.light) {
        lit += light == Light::Lit;
        up += light == Light::Shaded || light == Light::Lit;
    }
    EXPECT_NEAR(static_cast<double>(lit) * 600, c.lit_s, 0.002 * c.lit_s);
    EXPECT_NEAR(static_cast<double>(up) * 600, c.level_s, 0.002 * c.level_s);
}

TEST_F(Valley, CarpetCellsAreWhatThereIsInTheMiddleOfTheirStep) {
    const Carpet c = carpet(light_, 2026, zone_, 900);
    int compared = 0;
    for (int row = 0; row < 365; row += 13) {
        const LightDay& day = c.days[static_cast<std::size_t>(row)];
        EXPECT_EQ(day.date, sun::add_days({2026, 1, 1}, row));
        for (int column = 0; column < c.light.width(); ++column) {
            const int minute = 15 * column + 7;
            const sun::Instant t = zone_.resolve({day.date, minute / 60, minute % 60, 30}).utc;
            bool lit = false;
            for (const LitInterval& interval : day.lit)
                lit |= interval.begin.utc <= t && t < interval.end.utc;
            EXPECT_EQ(c.light.at(column, row) == Light::Lit, lit);
            compared += lit;
        }
    }
    EXPECT_GT(compared, 500);
    // On a summer day the sun is up over the plain before it comes over the ridge.
    const LightDay& summer = c.days[171];
    const auto local_column = [&](sun::Instant t) {
        const sun::CivilTime wall = zone_.local(t).wall;
        return (wall.hour * 60 + wall.minute) / 15;
    };
    EXPECT_EQ(c.light.at(local_column(summer.flat.sun_up[0].begin) - 1, 171), Light::Twilight);
    EXPECT_EQ(c.light.at(local_column(summer.flat.sun_up[0].begin) + 1, 171), Light::Shaded);
}

TEST_F(Valley, TwilightOfTheCarpetIsBetweenTheHorizonAndSixDegreesBelow) {
    const Carpet c = carpet(light_, 2026, zone_, 1200);
    int twilight = 0, night = 0;
    for (int row = 0; row < 365; row += 7)
        for (int column = 0; column < c.light.width(); ++column) {
            const Light light = c.light.at(column, row);
            if (light != Light::Night && light != Light::Twilight) continue;
            const sun::Instant t = zone_
                                       .resolve({c.days[static_cast<std::size_t>(row)].date,
                                                 column / 3, column % 3 * 20 + 10})
                                       .utc;
            const double below_rad = sun::position(t, horizon_.place()).elevation_rad;
            EXPECT_EQ(light == Light::Twilight, below_rad > radians(-6));
            (light == Light::Night ? night : twilight)++;
        }
    EXPECT_GT(twilight, 100);
    EXPECT_GT(night, 1000);
}

TEST_F(Valley, CarpetErrorsSayWhatIsWrong) {
    EXPECT_EQ(error_of([&] { carpet(light_, 2150, zone_); }),
              "exit 3: carpet: year 2150: the sun is computed for the years 1900 to 2100");
    EXPECT_EQ(error_of([&] { carpet(light_, 2026, zone_, 7); }),
              "exit 3: carpet: step 7 s: does not divide a day, expected a divisor of 86400 s, "
              "such as 600");
}

TEST(Carpet, LeavesOutDaysThatTheZoneSkipped) {
    const dem::Heightfield plain = test::field_of(21, 21, {-171.77, 0.001, 0, -13.82, 0, -0.001},
                                                  "EPSG:4326", [](int, int) { return 10.0; });
    const TerrainHorizon horizon(plain, plain.grid.place(10, 10));
    const Carpet c = carpet(DirectLight(horizon), 2011, Zone::named("Pacific/Apia"), 3600);
    EXPECT_EQ(c.light.height(), 364);
    EXPECT_EQ(c.days.size(), 364U);
}

TEST(Carpet, TwilightLastsAllDayAroundThePolarNight) {
    // 75 N: the sun is down from 3 November to 8 February, and nearer than 6 degrees at noon but
    // for some weeks; in May it is up all day.
    const dem::Heightfield plain = test::field_of(21, 21, {15.0, 0.004, 0, 75.0, 0, -0.001},
                                                  "EPSG:4326", [](int, int) { return 10.0; });
    const TerrainHorizon horizon(plain, plain.grid.place(10, 10));
    const Carpet c = carpet(DirectLight(horizon), 2026, Zone::named("+01:00"), 3600);
    const auto row = [](int month, int day) {
        return sun::days_between({2026, 1, 1}, {2026, month, day});
    };
    EXPECT_EQ(c.light.at(11, row(1, 20)), Light::Twilight);
    EXPECT_EQ(c.light.at(0, row(1, 20)), Light::Night);
    EXPECT_EQ(c.light.at(11, row(12, 21)), Light::Night);
    EXPECT_EQ(c.light.at(0, row(4, 20)), Light::Twilight);  // no night between two days
    EXPECT_EQ(c.light.at(23, row(4, 20)), Light::Twilight);
    EXPECT_EQ(c.light.at(0, row(5, 20)), Light::Lit);
    EXPECT_EQ(name_of(Light::Twilight), "twilight");
}

}  // namespace
}  // namespace relevo::light::test_carpet
