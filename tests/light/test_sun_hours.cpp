#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>

#include <fmt/format.h>

#include "base/parallel_for.h"
#include "base/text.h"
#include "base/units.h"
#include "light/fields.h"
#include "light/point/direct_light.h"
#include "light/point/horizon.h"
#include "light/raster/hours_by_sun.h"
#include "light/raster/sun_hours.h"
#include "sun/zone.h"
#include "support/support.h"

namespace relevo::light::test_sun_hours {
namespace {

using sun::Instant;

Instant utc(const std::string& text) {
    return sun::parse_time(text, {}).utc;
}

double number(const test::Csv& csv, std::size_t row, std::string_view column) {
    return *parse_number(csv.rows[row][csv.column(column)]);
}

double quantile(std::vector<double> numbers, double share) {
    std::sort(numbers.begin(), numbers.end());
    return numbers[static_cast<std::size_t>(share * double(numbers.size() - 1))];
}
double mean(const std::vector<double>& numbers) {
    double sum = 0;
    for (const double number : numbers)
        sum += number;
    return sum / double(numbers.size());
}

/// As the tables have it.
sun::Refraction saemundsson(const geo::Geodetic& place) {
    return sun::Refraction::saemundsson(sun::standard_air(place.height_m));
}

TEST(SunHours, OfDaysAgreeWithTheTables) {
    SKIP_WITHOUT_TEST_DATA(dir);
    const dem::Heightfield field =
        dem::load((dir / "dem" / "srtm_bigtujunga30m_utm11.tif").string());
    const dem::Posts posts(field);
    const test::Csv csv = test::read_csv(dir / "sun" / "terrain_sunhours.csv");
    std::map<std::string, SunHours> of_days;
    std::vector<double> minutes;
    for (std::size_t i = 0; i < csv.rows.size(); ++i) {
        const std::string date = csv.rows[i][csv.column("date_local")];
        if (!of_days.contains(date)) {
            // The tables have the sun over the level horizon alone.
            const Instant midnight = utc(date + "T00:00-08:00");
            std::vector<Instant> up;
            for (int s = 0; s < 86400; s += 15)
                if (saemundsson(field.grid.center())
                        .apparent_rad(
                            sun::position(midnight + s, field.grid.center()).elevation_rad) > 0)
                    up.push_back(midnight + s);
            of_days[date] = sun_hours(posts, up.front(), up.back(), {.air = saemundsson});
        }
        const int column = static_cast<int>(number(csv, i, "col")),
                  row = static_cast<int>(number(csv, i, "row"));
        minutes.push_back(60 * std::abs(of_days[date].hours.at(column, row) -
                                        number(csv, i, "sun_hours_crossings_curved_h")));
    }
    EXPECT_EQ(of_days.size(), 4U);
    fmt::print(
        "[ accuracy ] a day from suns 3 minutes apart, {} cell-days: mean {:.2f} min (limit 1.5; "
        "r.sun 14.6 to 22.6, SAGA 13.3 to 15.7), 99 % within {:.2f} (limit 5), worst {:.1f}\n",
        minutes.size(), mean(minutes), quantile(minutes, 0.99), quantile(minutes, 1));
    EXPECT_LE(mean(minutes), 1.5);
    EXPECT_LE(quantile(minutes, 0.99), 5);
}

TEST(SunHours, OfAYearAgreeWithTheTables) {
    SKIP_WITHOUT_TEST_DATA(dir);
    const dem::Heightfield field =
        dem::load((dir / "dem" / "srtm_bigtujunga30m_utm11.tif").string());
    const test::Csv csv = test::read_csv(dir / "sun" / "terrain_year.csv");
    const SunHours year = sun_hours(dem::Posts(field), utc("2023-01-01T00:00-08:00"),
                                    utc("2024-01-01T00:00-08:00"), {.air = saemundsson});
    std::vector<double> percent;
    for (std::size_t i = 0; i < csv.rows.size(); ++i) {
        const double wanted = number(csv, i, "sun_hours_crossings_flat_h");
        percent.push_back(100 * std::abs(year.hours.at(static_cast<int>(number(csv, i, "col")),
                                                       static_cast<int>(number(csv, i, "row"))) /
                                             wanted -
                                         1));
    }
    test::print_accuracy("sun hours of a year", percent, "%", 2);
    EXPECT_EQ(percent.size(), 40U);
    EXPECT_LE(quantile(percent, 0.5), 0.3);
    EXPECT_LE(quantile(percent, 1), 2);
}

/// A day of a DEM against the exact light of posts drawn by lot.
void compare_with_places(const std::string& name, const dem::Heightfield& field,
                         const std::string& date, int count) {
    const dem::Posts posts(field);
    const Instant begin = utc(date + "T00:00Z");
    const auto air = [](const geo::Geodetic& place) { return sun::Refraction::standard(place); };
    const SunHours day = sun_hours(posts, begin, begin + 86400.0, {.air = air});
    std::mt19937 lot(20260103);
    std::vector<double> minutes(static_cast<std::size_t>(count));
    std::vector<glm::ivec2> where;
    while (static_cast<int>(where.size()) < count) {
        const glm::ivec2 post(lot() % static_cast<unsigned>(field.grid.columns()),
                              lot() % static_cast<unsigned>(field.grid.rows()));
        if (!std::isnan(field.height_m.at(post.x, post.y))) where.push_back(post);
    }
    parallel_for(0, count, 1, [&](int first, int last) {
        for (int i = first; i < last; ++i) {
            const glm::ivec2 post = where[static_cast<std::size_t>(i)];
            const TerrainHorizon horizon(posts, field.grid.place(post.x, post.y));
            LightOptions options;
            options.refraction = air(horizon.place());
            const LightDay exact =
                DirectLight(horizon, options).day(sun::parse_date(date), sun::Zone::fixed(0));
            minutes[static_cast<std::size_t>(i)] =
                60 * std::abs(day.hours.at(post.x, post.y) - exact.lit_s / 3600);
        }
    });
    fmt::print(
        "[ accuracy ] {}, {}: sun hours of {} posts against exact ones: mean {:.2f} min "
        "(limit 1.5), 99 % within {:.1f} (limit 6); {} windows\n",
        name, date, count, mean(minutes), quantile(minutes, 0.99), day.tiles);
    EXPECT_LE(mean(minutes), 1.5) << name;
    EXPECT_LE(quantile(minutes, 0.99), 6) << name;
}

TEST(SunHours, OfDaysAgreeWithTheLightOfPlaces) {
    compare_with_places("jacksboro", test::bundled("jacksboro.tif"), "2026-12-21", 40);
    SKIP_WITHOUT_TEST_DATA(data);
    for (const char* const name : {"hawaii_rotated20.tif", "mt_rainier_90m.tif"})
        compare_with_places(name, dem::load((data / "dem" / name).string()), "2026-03-20", 40);
}

/// A plain of 61 x 61 posts with a wall 100 m high along column 40, at the equator in UTM.
dem::Heightfield walled(double low_m = 0) {
    return test::field_of(61, 61, {500000, 10, 0, 300, 0, -10}, "EPSG:32631",
                          [=](int column, int) { return column == 40 ? low_m + 100.0 : low_m; });
}

/// A minute that measured sunlight comes or goes at a station, behind a mountain.
struct MeasuredEdge {
    const char* name;
    double lat_deg, lon_deg;
    const char* day;  // the local one
    bool comes;
    const char* half_way;
};

TEST(SunHours, BeginAndEndAsMeasuredAtAlamosaAndGolden) {
    SKIP_WITHOUT_TEST_DATA(dir);
    // tests' data sun/outside/README.md: half-way between sun and shade of pyrheliometer and
    // pyranometer; the sun's own horizon is off by 5, 10 and 26 minutes.
    const std::vector<MeasuredEdge> edges{
        {"Alamosa, morning", 37.69673, -105.92313, "2016-01-01", true, "2016-01-01T14:26:14Z"},
        {"Alamosa, evening", 37.69673, -105.92313, "2016-01-01", false, "2016-01-01T23:43:49Z"},
        {"Golden, evening", 39.742, -105.18, "2022-01-20", false, "2022-01-20T23:38:16Z"}};
    const dem::Heightfield field = dem::load((dir / "dem" / "colorado_tut_relief.nc").string());
    const dem::Posts posts(field);
    for (const MeasuredEdge& edge : edges) {
        const glm::dvec2 at = field.grid.post({radians(edge.lat_deg), radians(edge.lon_deg), 0});
        const int column = static_cast<int>(at.x), row = static_cast<int>(at.y);
        const Instant begin = utc(std::string(edge.day) + "T00:00-07:00");
        SunHoursOptions options;
        options.air = [](const geo::Geodetic& place) { return sun::Refraction::standard(place); };
        options.spells = true;
        options.part = {column, row, 2, 2};
        const SunHours found = sun_hours(posts, begin, begin + 86400.0, options);
        const Array2d<float>& when_h = edge.comes ? found.first_h : found.last_h;
        const double u = at.x - column, v = at.y - row;  // posts are 900 m apart
        const double hours = (1 - v) * ((1 - u) * when_h.at(0, 0) + u * when_h.at(1, 0)) +
                             v * ((1 - u) * when_h.at(0, 1) + u * when_h.at(1, 1));
        const double off_min = ((begin + 3600 * hours) - utc(edge.half_way)) / 60;
        fmt::print("[ accuracy ] {}: {:+.1f} min from what was measured (limit 3)\n", edge.name,
                   off_min);
        EXPECT_LE(std::abs(off_min), 3) << edge.name;
    }
}

TEST(SunHours, SpellsBeginAndEndWhereTheWallHasThem) {
    const dem::Heightfield field = walled();
    const dem::Posts posts(field);
    const Instant begin = utc("2026-03-20T00:00Z");
    const SunHours day = sun_hours(posts, begin, begin + 86400.0, {.step_s = 60, .spells = true});
    // At the equinox the sun goes over the equator from east to west at a quarter of a degree a
    // minute. 50 m behind the wall in the west of it, it comes over it at atan(100 / 50).
    const auto at = [&](const Array2d<float>& figures, int column) {
        return double{figures.at(column, 30)};
    };
    const double rises_h = at(day.first_h, 60), sets_h = at(day.last_h, 0);
    EXPECT_NEAR(sets_h - rises_h, 12, 0.02);
    const double over_h = degrees(std::atan(2.0)) / 15;
    EXPECT_NEAR(at(day.first_h, 35) - rises_h, over_h, 0.02);
    EXPECT_NEAR(at(day.hours, 35), 12 - over_h, 0.03);
    EXPECT_NEAR(sets_h - at(day.last_h, 45), over_h, 0.02);
    EXPECT_NEAR(at(day.hours, 45), 12 - over_h, 0.03);
    for (const int column : {0, 35, 40, 45, 60})
        EXPECT_EQ(at(day.spells, column), 1) << column;
    EXPECT_NEAR(day.level_hours, 12, 0.02);
    // Of an afternoon alone, that is lit when it begins and when it ends.
    const SunHours part =
        sun_hours(posts, begin + 12 * 3600.0, begin + 13 * 3600.0, {.spells = true});
    EXPECT_EQ(at(part.first_h, 35), 0);
    EXPECT_NEAR(at(part.last_h, 35), 1, 1e-6);
    EXPECT_NEAR(at(part.hours, 35), 1, 1e-6);
    // And a night.
    const SunHours night = sun_hours(posts, begin, begin + 3600.0, {.spells = true});
    EXPECT_EQ(at(night.hours, 35), 0);
    EXPECT_EQ(at(night.spells, 35), 0);
    EXPECT_TRUE(std::isnan(night.first_h.at(35, 30)));
}

TEST(SunHours, ADayOfTwoPeriodsBeginsWithTheFirstAndEndsWithTheLast) {
    // A pillar of 100 m, 100 m south of a post at 47 N, hides the sun about noon in December, which
    // is 19.6 degrees high then. The sun's centre is up for half of a day's turn each side of
    // 11:22 UTC, at 9 E: acos(-tan 47 tan -23.44) = 62.3 degrees or 4.15 hours.
    const dem::Heightfield field = test::field_of(
        61, 61, {499700, 10, 0, 5205300, 0, -10}, "EPSG:32632",
        [](int column, int row) { return row == 40 && std::abs(column - 30) <= 2 ? 100.0 : 0.0; });
    const Instant begin = utc("2026-12-21T00:00Z");
    SunHoursOptions options;
    options.step_s = 60;
    options.spells = true;
    const SunHours day = sun_hours(dem::Posts(field), begin, begin + 86400.0, options);
    EXPECT_EQ(day.spells.at(30, 30), 2);
    EXPECT_NEAR(day.first_h.at(30, 30), 11.37 - 4.15, 0.05);
    EXPECT_NEAR(day.last_h.at(30, 30), 11.37 + 4.15, 0.05);
    // The pillar is 40 to 60 m wide: 11.3 to 16.7 degrees of azimuth to either side, which the low
    // sun of noon turns by in some 50 to 70 minutes.
    EXPECT_GT(day.hours.at(30, 30), 2 * (4.15 - 70 / 60.0));
    EXPECT_LT(day.hours.at(30, 30), 2 * (4.15 - 45 / 60.0));
    EXPECT_EQ(day.spells.at(5, 30), 1);  // beside it
    EXPECT_NEAR(day.hours.at(5, 30), 2 * 4.15, 0.05);
}

TEST(SunHours, ABrokenMorningBeginsWithItsFirstLight) {
    // The same place and day; three pickets stand where the sun is within two hours of its rise,
    // at azimuths of 130, 135 and 140 degrees, and hide it for some minutes each.
    const dem::Heightfield field = test::field_of(
        61, 61, {499900, 10, 0, 5205100, 0, -10}, "EPSG:32632", [](int column, int row) {
            const bool picket = (column == 33 && row == 29) || (column == 31 && row == 31) ||
                                (column == 29 && row == 33);
            return picket ? 100.0 : 0.0;
        });
    const Instant begin = utc("2026-12-21T00:00Z");
    SunHoursOptions options;
    options.step_s = 60;
    options.spells = true;
    const SunHours day = sun_hours(dem::Posts(field), begin, begin + 86400.0, options);
    EXPECT_EQ(day.spells.at(10, 10), 4);
    EXPECT_NEAR(day.first_h.at(10, 10), 11.37 - 4.15, 0.05);
    EXPECT_NEAR(day.last_h.at(10, 10), 11.37 + 4.15, 0.05);
}

TEST(SunHours, AFenceInTheMorningLeavesTheFirstLightFirst) {
    // The same place and day; pales stand 600 m off, at every third degree of azimuth from 127 on,
    // so that the sun comes and goes every 12 minutes from its rise on, at 125.6 degrees.
    constexpr int kColumn = 20, kRow = 20, kFar_posts = 60, kPales = 8;
    const auto is_pale = [](int column, int row) {
        for (int pale = 0; pale < kPales; ++pale) {
            const double azimuth = radians(127.0 + 3 * pale);
            if (column == kColumn + std::lround(kFar_posts * std::sin(azimuth)) &&
                row == kRow - std::lround(kFar_posts * std::cos(azimuth)))
                return true;
        }
        return false;
    };
    const dem::Heightfield field =
        test::field_of(101, 101, {499900, 10, 0, 5205100, 0, -10}, "EPSG:32632",
                       [&](int column, int row) { return is_pale(column, row) ? 150.0 : 0.0; });
    const Instant begin = utc("2026-12-21T00:00Z");
    SunHoursOptions options;
    options.step_s = 60;
    options.spells = true;
    const SunHours day = sun_hours(dem::Posts(field), begin, begin + 86400.0, options);
    EXPECT_GE(day.spells.at(kColumn, kRow), 6);
    EXPECT_NEAR(day.first_h.at(kColumn, kRow), 11.37 - 4.15, 0.05);
    EXPECT_NEAR(day.last_h.at(kColumn, kRow), 11.37 + 4.15, 0.05);
    // All over the shade of the fence: what comes later does not change the first light.
    const SunHours morning = sun_hours(dem::Posts(field), begin, begin + 7.75 * 3600, options);
    int again = 0;
    for (int row = 0; row < day.first_h.height(); ++row)
        for (int column = 0; column < day.first_h.width(); ++column) {
            const float first_h = morning.first_h.at(column, row);
            if (!(first_h < 7.7F)) continue;  // none, or as it ends
            EXPECT_NEAR(day.first_h.at(column, row), first_h, 0.005) << column << " " << row;
            again += first_h > 7.5F && day.spells.at(column, row) > 1;
        }
    EXPECT_GT(again, 20);
}

TEST(SunHours, ManyDaysAreAsLongAsTheirDays) {
    const dem::Heightfield field = test::bundled("jacksboro.tif");
    const dem::Posts posts(field);
    const auto air = [](const geo::Geodetic& place) { return sun::Refraction::standard(place); };
    const Instant begin = utc("2026-11-01T05:00Z");
    const SunHours all = sun_hours(posts, begin, begin + 6 * 86400.0, {.air = air});
    Array2d<float> sum(all.hours.width(), all.hours.height(), 0);
    for (int day = 0; day < 6; day += 3) {
        const SunHours days =
            sun_hours(posts, begin + day * 86400.0, begin + (day + 3) * 86400.0, {.air = air});
        for (std::size_t i = 0; i < sum.size(); ++i)
            sum.data()[i] += days.hours.data()[i];
    }
    std::vector<double> minutes;
    for (std::size_t i = 0; i < sum.size(); ++i)
        minutes.push_back(60.0 * std::abs(sum.data()[i] - all.hours.data()[i]) / 6);
    fmt::print(
        "[ accuracy ] six days by horizons against six by suns, {} posts: mean {:.2f} min a "
        "day, 99 % within {:.1f}\n",
        minutes.size(), mean(minutes), quantile(minutes, 0.99));
    EXPECT_LE(mean(minutes), 1);
    EXPECT_LE(quantile(minutes, 0.99), 10);
}

TEST(SunHours, TellHowMuchOfTheWorkIsDoneFromItsBeginningOn) {
    const dem::Heightfield field = test::bundled("jacksboro.tif");
    const dem::Posts posts(field);
    std::vector<double> told;
    SunHoursOptions options;
    options.step_s = 3600;
    options.done = [&](double share) { told.push_back(share); };
    const Instant begin = utc("2026-11-01T05:00Z");
    sun_hours(posts, begin, begin + 86400.0, options);
    ASSERT_GT(told.size(), 2U);
    EXPECT_EQ(told.front(), 0);  // windows and suns are there
    EXPECT_EQ(std::count(told.begin(), told.end(), 0.0), 1);
    EXPECT_NEAR(mean(told) * double(told.size()), 1, 1e-9);
}

TEST(SunHours, HolesHaveNone) {
    dem::Heightfield field = walled();
    field.height_m.at(20, 20) = std::numeric_limits<float>::quiet_NaN();
    field.about.statistics = dem::statistics(field.height_m);
    const dem::Posts posts(field);
    const Instant begin = utc("2026-03-20T00:00Z");
    for (const double days : {1.0, 10.0}) {
        const SunHours found = sun_hours(posts, begin, begin + days * 86400, {});
        EXPECT_EQ(found.holes, 1);
        EXPECT_TRUE(std::isnan(found.hours.at(20, 20)));
        EXPECT_FALSE(std::isnan(found.hours.at(21, 20)));
        EXPECT_GT(found.mean_hours, 9 * days);
        EXPECT_LT(found.mean_hours, 11 * days);
    }
}

TEST(SunHours, WhatItCannotDoIsRefused) {
    const dem::Heightfield field = walled();
    const dem::Posts posts(field);
    const Instant begin = utc("2026-03-20T00:00Z");
    EXPECT_EQ(test::error_of([&] { sun_hours(posts, begin, begin); }),
              "exit 3: sun hours: from 2026-03-20T00:00:00Z to 2026-03-20T00:00:00Z: "
              "expected an end after the beginning");
    EXPECT_EQ(test::error_of([&] { sun_hours(posts, begin, begin + 60.0, {.step_s = 0}); }),
              "exit 3: sun hours: step 0 s: expected 1 s to an hour");
    EXPECT_EQ(
        test::error_of([&] { sun_hours(posts, begin, begin + 5 * 86400.0, {.spells = true}); }),
        "exit 3: sun hours: 5.0 days: first and last light are known of 4 days at most");
}

TEST(SunHours, SunsThatMeasureTheTimeAreMixed) {
    EXPECT_EQ(order_of_suns(3, false), (std::vector<std::size_t>{0, 1, 2}));
    EXPECT_TRUE(order_of_suns(0, true).empty());
    for (const std::size_t count : {1, 2, 7, 193}) {
        std::vector<std::size_t> order = order_of_suns(count, true);
        if (count == 193) {
            // In any five there are suns of the first and the last third of a day, and of noon.
            for (std::size_t first = 0; first + 5 <= count; ++first) {
                const auto [low, high] =
                    std::minmax_element(order.begin() + static_cast<std::ptrdiff_t>(first),
                                        order.begin() + static_cast<std::ptrdiff_t>(first) + 5);
                EXPECT_LT(*low, count / 3) << first;
                EXPECT_GT(*high, 2 * count / 3) << first;
            }
        }
        std::ranges::sort(order);
        EXPECT_EQ(order, order_of_suns(count, false));
    }
}

}  // namespace
}  // namespace relevo::light::test_sun_hours
