#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "light/fields.h"
#include "light/point/alignment.h"
#include "sun/moon.h"
#include "sun/position.h"
#include "sun/position_table.h"

namespace relevo::light::test_alignment {
namespace {

using sun::Date;
using sun::Zone;
using test::error_of;

/// A plain near 47 N 9 E with a pole of 300 m, 60 posts to the west and 10 to the south, and a wall
/// of 150 m in front of it where `wall` is set.
dem::Heightfield pole(bool wall) {
    return test::field_of(201, 201, {497000, 30, 0, 5208000, 0, -30}, "EPSG:32632",
                          [wall](int column, int row) {
                              if (column == 40 && row == 110) return 400.0;
                              return wall && column == 60 ? 350.0 : 100.0;
                          });
}

const Zone kZurich = Zone::named("Europe/Zurich");

TEST(Alignments, AreTheMomentsOfLeastSeparation) {
    const dem::Heightfield field = pole(false);
    const TerrainHorizon here(field, field.grid.place(100, 100));
    const geo::Geodetic target = field.place(40, 110);
    AlignmentOptions options;
    options.tolerance_rad = radians(1.5);
    const Alignments found =
        alignments(here, target, {2026, 1, 1}, {2026, 12, 31}, kZurich, options);
    EXPECT_TRUE(found.sight.visible);
    EXPECT_NEAR(degrees(found.sight.azimuth_rad), 270 - degrees(std::atan2(10, 60)), 0.05);
    EXPECT_EQ(found.target, target);
    // The evening sun passes there in spring and again in autumn, some days in a row.
    ASSERT_GE(found.passages.size(), 8U);
    const sun::Refraction air = sun::Refraction::standard(here.place());
    const auto separation_deg = [&](sun::Instant t) {
        const sun::Position p = sun::position(t, here.place());
        const double a = p.azimuth_rad, b = found.sight.azimuth_rad;
        const double e = air.apparent_rad(p.elevation_rad), f = found.sight.elevation_rad;
        const double cosine =
            std::sin(e) * std::sin(f) + std::cos(e) * std::cos(f) * std::cos(a - b);
        return degrees(std::acos(std::min(1.0, cosine)));
    };
    int spring = 0;
    for (const Alignment& passage : found.passages) {
        EXPECT_NEAR(separation_deg(passage.utc), degrees(passage.separation_rad), 1e-4);
        EXPECT_LE(degrees(passage.separation_rad), 1.5);
        for (const double s : {-20.0, 20.0})
            EXPECT_GT(separation_deg(passage.utc + s), degrees(passage.separation_rad));
        // Across and up make the separation.
        EXPECT_NEAR(std::hypot(passage.right_rad, passage.above_rad), passage.separation_rad,
                    radians(0.01));
        EXPECT_EQ(passage.date, kZurich.local(passage.utc).wall.date);
        spring += passage.date.month < 6;
    }
    EXPECT_GE(spring, 4);
    EXPECT_GE(static_cast<int>(found.passages.size()) - spring, 4);
    EXPECT_EQ(found.definition,
              "closest approach of the sun's centre to the point, within 1.5 degrees; " +
                  air.description() + "; terrestrial refraction k = 0.13");
}

TEST(Alignments, OfTheMoonMissNoneAndAreClosest) {
    const dem::Heightfield field = pole(false);
    const TerrainHorizon here(field, field.grid.place(100, 100));
    AlignmentOptions options{.body = sun::Body::Moon};
    options.tolerance_rad = radians(4);
    const Alignments found =
        alignments(here, field.place(40, 110), {2026, 3, 1}, {2026, 3, 10}, kZurich, options);
    const sun::Refraction air = sun::Refraction::standard(here.place());
    const auto separation_rad = [&](sun::Instant t) {
        const sun::MoonPosition p = sun::moon_position(t, here.place());
        const double a = p.azimuth_rad - found.sight.azimuth_rad;
        const double e = air.apparent_rad(p.elevation_rad), f = found.sight.elevation_rad;
        return std::acos(
            std::min(1.0, std::sin(e) * std::sin(f) + std::cos(e) * std::cos(f) * std::cos(a)));
    };
    // Looked at every ten minutes, it comes near at no other time.
    int times = 0;
    const sun::Instant begin = kZurich.day({2026, 3, 1}).begin;
    for (double t_s = 0; t_s < 10 * 86400; t_s += 600) {
        if (separation_rad(begin + t_s) > options.tolerance_rad) continue;
        ++times;
        EXPECT_TRUE(std::ranges::any_of(found.passages, [&](const Alignment& passage) {
            return std::abs(passage.utc - (begin + t_s)) < 3600;
        })) << t_s;
    }
    EXPECT_GE(times, 2);
    for (const Alignment& passage : found.passages) {
        EXPECT_NEAR(separation_rad(passage.utc), passage.separation_rad, 1e-6);
        for (const double s : {-20.0, 20.0})
            EXPECT_GT(separation_rad(passage.utc + s), passage.separation_rad);
    }
    EXPECT_TRUE(found.definition.starts_with("closest approach of the moon's centre"));
}

TEST(Alignments, MissNoDay) {
    // Every day of the year whose sun, looked at every ten seconds, comes within the tolerance.
    const dem::Heightfield field = pole(false);
    const TerrainHorizon here(field, field.grid.place(100, 100));
    AlignmentOptions options;
    options.tolerance_rad = radians(3);
    options.refraction = sun::Refraction::none();
    const Alignments found =
        alignments(here, field.place(40, 110), {2026, 1, 1}, {2026, 12, 31}, kZurich, options);
    std::vector<Date> expected;
    const sun::PositionTable table(sun::Instant::from_utc({{2025, 12, 31}}),
                                   sun::Instant::from_utc({{2027, 1, 1}}));
    const sun::Observer observer(here.place());
    const double a = found.sight.azimuth_rad, e = found.sight.elevation_rad;
    const glm::dvec3 wanted(std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e));
    for (Date date{2026, 1, 1}; date.year == 2026; date = sun::add_days(date, 1)) {
        const sun::TimeSpan day = kZurich.day(date);
        double nearest = 0;
        for (double t = 0; t < day.length_s(); t += 10)
            nearest = std::max(nearest, glm::dot(wanted, table.direction(day.begin + t, observer)));
        if (nearest >= std::cos(options.tolerance_rad)) expected.push_back(date);
    }
    std::vector<Date> dates;
    for (const Alignment& passage : found.passages)
        dates.push_back(passage.date);
    EXPECT_EQ(dates, expected);
    EXPECT_GE(dates.size(), 20U);
}

TEST(Alignments, SayWhetherTheTargetAndTheSunAreSeen) {
    const dem::Heightfield open = pole(false), walled = pole(true);
    AlignmentOptions options;
    options.tolerance_rad = radians(1.5);
    for (const dem::Heightfield* field : {&open, &walled}) {
        const TerrainHorizon here(*field, field->grid.place(100, 100));
        const Alignments found =
            alignments(here, field->place(40, 110), {2026, 1, 1}, {2026, 12, 31}, kZurich, options);
        EXPECT_EQ(found.sight.visible, field == &open);
        ASSERT_FALSE(found.passages.empty());
        for (const Alignment& passage : found.passages)
            EXPECT_EQ(passage.sun_visible,
                      passage.elevation_rad > here.elevation_rad(passage.azimuth_rad));
        // The pole itself hides little of the sky beside it.
        EXPECT_EQ(std::any_of(found.passages.begin(), found.passages.end(),
                              [](const Alignment& p) { return p.sun_visible; }),
                  field == &open);
    }
}

TEST(Alignments, OfHighTargetsAreMeasuredOnTheSky) {
    // Points above a place to the south, 30, 45 and 60 degrees up: along the horizon the sun's way
    // is shorter by the cosine of that.
    const dem::Heightfield field = pole(false);
    const TerrainHorizon here(field, field.grid.place(100, 100));
    const sun::Refraction air = sun::Refraction::standard(here.place());
    AlignmentOptions options;
    options.tolerance_rad = radians(2);
    for (const double up_deg : {30.0, 45.0, 60.0}) {
        geo::Geodetic target = field.grid.place(100, 160);
        target.height_m = 100 + 1800 * std::tan(radians(up_deg));
        const Alignments found =
            alignments(here, target, {2026, 1, 1}, {2026, 12, 31}, kZurich, options);
        EXPECT_TRUE(found.sight.visible);
        EXPECT_NEAR(degrees(found.sight.elevation_rad), up_deg, 0.05);
        ASSERT_GE(found.passages.size(), 8U) << up_deg;
        double farthest_right_rad = 0;
        for (const Alignment& p : found.passages) {
            const sun::Position sun = sun::position(p.utc, here.place());
            const double e = air.apparent_rad(sun.elevation_rad), f = found.sight.elevation_rad;
            const double aside = std::remainder(sun.azimuth_rad - found.sight.azimuth_rad, 2 * kPi);
            const double cosine =
                std::sin(e) * std::sin(f) + std::cos(e) * std::cos(f) * std::cos(aside);
            EXPECT_NEAR(degrees(std::acos(std::min(1.0, cosine))), degrees(p.separation_rad), 1e-4);
            EXPECT_NEAR(degrees(p.above_rad), degrees(e - f), 1e-4);
            EXPECT_NEAR(std::hypot(p.right_rad, p.above_rad), p.separation_rad, radians(0.03));
            EXPECT_NEAR(degrees(p.right_rad), degrees(aside * std::cos(f)), 1e-4);
            EXPECT_TRUE(p.sun_visible);
            farthest_right_rad = std::max(farthest_right_rad, std::abs(p.right_rad));
        }
        EXPECT_GT(found.passages.size(), 0U);
    }
}

TEST(Alignments, TargetsThatNoLandscapeHasAreErrors) {
    const dem::Heightfield field = pole(false);
    const TerrainHorizon here(field, field.grid.place(100, 100));
    geo::Geodetic target = field.grid.place(100, 160);
    for (const double height_m : {1e9, 20'001.0, -12'001.0, -1e308, static_cast<double>(INFINITY),
                                  static_cast<double>(NAN)}) {
        target.height_m = height_m;
        const std::string error = error_of([&] { here.sight(target); });
        EXPECT_TRUE(error.starts_with("exit 3: horizon: 46.98233,9: the target at ") &&
                    error.ends_with(", expected -12000 to 20000; no landscape has such a height"))
            << error;
    }
    target.height_m = 20'000;
    EXPECT_TRUE(here.sight(target).visible);
    EXPECT_EQ(error_of([&] { here.sight(geo::geodetic_deg(-33.9, 18.4, 1000)); }),
              "exit 3: horizon: -33.9,18.4: the target is 9009 km away, expected at most "
              "1000; nothing on Earth is seen from so far");
}

TEST(Alignments, ErrorsSayWhatIsWrong) {
    const dem::Heightfield field = pole(false);
    const TerrainHorizon here(field, field.grid.place(100, 100));
    const geo::Geodetic target = field.place(40, 110);
    EXPECT_EQ(error_of([&] {
                  alignments(here, target, {2026, 6, 22}, {2026, 6, 21}, kZurich);
              }),
              "exit 3: sun when: from 2026-06-22 to 2026-06-21: ends before it begins");
    EXPECT_EQ(error_of([&] {
                  alignments(here, target, {2150, 6, 22}, {2150, 6, 23}, kZurich);
              }),
              "exit 3: time: 2150-06-21T23:00:00Z: sun and moon are computed for the years 1900 "
              "to 2100");
    AlignmentOptions options;
    options.tolerance_rad = 0;
    EXPECT_EQ(
        error_of([&] {
            alignments(here, target, {2026, 6, 21}, {2026, 6, 21}, kZurich, options);
        }),
        "exit 3: sun when: tolerance 0 degrees: out of range, expected more than 0 and up to 45");
}

}  // namespace
}  // namespace relevo::light::test_alignment
