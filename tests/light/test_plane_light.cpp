#include <cmath>

#include <glm/geometric.hpp>

#include "base/units.h"
#include "light/plane/plane_light.h"
#include "light/point/clear_sky.h"
#include "sun/position.h"
#include "support/support.h"

namespace relevo::light::test_plane_light {
namespace {

const geo::Geodetic kPlace = geo::geodetic_deg(47, 11, 600);

sun::Instant utc(const char* text) {
    return sun::parse_time(text).utc;
}

LightOptions no_air() {
    LightOptions options;
    options.refraction = sun::Refraction::none();
    return options;
}

/// Hours of a day from its midnight in UTC on.
std::vector<Irradiance> day_of(const char* midnight, double ghi, double dni, double dhi) {
    std::vector<Irradiance> rows;
    for (int hour = 0; hour < 24; ++hour)
        rows.push_back({{utc(midnight) + 3600.0 * hour, utc(midnight) + 3600.0 * (hour + 1)},
                        ghi,
                        dni,
                        dhi,
                        static_cast<std::size_t>(hour + 2)});
    return rows;
}

struct Expected {
    double up_s = 0, lit_s = 0, beam = 0;
};

/// Counts every five seconds.
Expected counted(const Irradiance& row, const Plane& plane, const Skyline& horizon) {
    Expected sum;
    for (double t = 2.5; t < row.span.length_s(); t += 5) {
        const sun::Position sun = sun::position(row.span.begin + t, kPlace);
        if (sun.elevation_rad <= 0) continue;
        sum.up_s += 5;
        if (sun.elevation_rad <= horizon.elevation_rad(sun.azimuth_rad)) continue;
        sum.lit_s += 5;
        sum.beam += 5 * row.dni * std::max(0.0, glm::dot(plane.normal(), sun.direction));
    }
    if (sum.up_s > 0) sum.beam /= sum.up_s;
    return sum;
}

TEST(PlaneLight, TheBeamIsSpreadOverTheTimeInWhichTheSunIsUp) {
    std::vector<double> ridge(360, radians(2));
    for (std::size_t k = 100; k < 150; ++k)
        ridge[k] = radians(25);
    const Skyline skyline(ridge);
    const DirectLight level(kPlace, Skyline({0.0}), "a level horizon", no_air());
    const DirectLight over(kPlace, skyline, "a ridge", no_air());
    const std::vector<Irradiance> rows = day_of("2026-03-20T00:00Z", 500, 700, 120);
    int partly = 0;
    for (const Plane& plane :
         {Plane{}, Plane{radians(90), radians(90)}, Plane{radians(30), radians(180)}}) {
        const PlaneLight light({plane}, level, &over);
        const std::vector<PlaneHour> hours = light.of(rows, {}).hours;
        ASSERT_EQ(hours.size(), rows.size());
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const Expected expected = counted(rows[i], plane, skyline);
            EXPECT_NEAR(hours[i].up_s, expected.up_s, 5);
            EXPECT_NEAR(hours[i].lit_s, expected.lit_s, 8);
            EXPECT_NEAR(hours[i].beam, expected.beam, 0.001 * expected.beam + 700 * 8 / 3600.0);
            EXPECT_NEAR(hours[i].diffuse, 120 * light.sky(), 1e-9);
            EXPECT_NEAR(hours[i].reflected, 0.2 * 500 * (1 - light.sky()), 1e-9);
            partly += hours[i].lit_s > 10 && hours[i].lit_s < hours[i].up_s - 10;
        }
    }
    EXPECT_GE(partly, 3);
}

TEST(PlaneLight, WithoutTerrainOpenAndPlaneAreOne) {
    const DirectLight level(kPlace, Skyline({0.0}), "a level horizon");
    const DirectLight flat(kPlace, Skyline({0.0}), "a flat file");
    const std::vector<Irradiance> rows = day_of("2026-03-20T00:00Z", 500, 700, 120);
    for (const SkyModel sky : {SkyModel::Isotropic, SkyModel::HayDavies, SkyModel::Perez}) {
        const PlaneOptions options{{radians(50), radians(200)}, sky, 0.3};
        const auto alone = PlaneLight(options, level, nullptr).of(rows, {}).hours,
                   over_file = PlaneLight(options, level, &flat).of(rows, {}).hours;
        for (std::size_t i = 0; i < alone.size(); ++i) {
            EXPECT_DOUBLE_EQ(alone[i].global(), alone[i].open_global);
            EXPECT_EQ(alone[i].lit_s, alone[i].up_s);
            EXPECT_NEAR(over_file[i].global(), alone[i].global(), 1e-4);
        }
        EXPECT_EQ(alone[0].azimuth_rad, 0);  // night
    }
}

TEST(PlaneLight, AnInstantIsNotSpread) {
    const DirectLight level(kPlace, Skyline({0.0}), "a level horizon", no_air());
    const Plane plane{radians(90), radians(180)};
    const PlaneLight light({plane}, level, nullptr);
    // The sun rises at 5:25, between the two instants of its hour.
    const Irradiance row{{utc("2026-03-20T05:00Z"), utc("2026-03-20T06:00Z")}, 50, 300, 20, 1};
    const PlaneHour before = light.of({row}, 0.25 * 3600).hours.front(),
                    after = light.of({row}, 0.75 * 3600).hours.front();
    EXPECT_EQ(before.up_s, 0);
    EXPECT_EQ(before.beam, 0);
    EXPECT_EQ(after.up_s, 3600);
    const sun::Position sun = sun::position(utc("2026-03-20T05:45Z"), kPlace);
    EXPECT_NEAR(after.beam, 300 * std::max(0.0, glm::dot(plane.normal(), sun.direction)), 1e-6);
    EXPECT_NEAR(degrees(after.elevation_rad), degrees(sun.elevation_rad), 1e-6);
}

TEST(PlaneLight, CircumsolarLightGoesWithTheSun) {
    const DirectLight level(kPlace, Skyline({0.0}), "a level horizon", no_air());
    std::vector<double> ridge(360, 0.0);
    for (std::size_t k = 150; k < 210; ++k)
        ridge[k] = radians(89);
    const DirectLight over(kPlace, Skyline(ridge), "a wall in the south", no_air());
    const Plane plane{radians(60), radians(180)};
    const std::vector<Irradiance> noon{
        {{utc("2026-06-21T11:00Z"), utc("2026-06-21T12:00Z")}, 800, 800, 150, 1}};
    const PlaneOptions options{plane, SkyModel::HayDavies, 0};
    const PlaneLight light(options, level, &over);
    const PlaneHour hidden = light.of(noon, {}).hours.front(),
                    open = PlaneLight(options, level, nullptr).of(noon, {}).hours.front();
    EXPECT_EQ(hidden.lit_s, 0);
    EXPECT_EQ(hidden.beam, 0);
    const double share = 800 / (kSkySolarConstant / (1.0163 * 1.0163));
    EXPECT_NEAR(hidden.diffuse, 150 * (1 - share) * light.sky(), 0.1);
    EXPECT_GT(open.diffuse, hidden.diffuse + 50);
    EXPECT_EQ(hidden.open_global, open.open_global);
}

TEST(PlaneLight, TheClearSkyFollowsTheSunWithinTheHour) {
    const DirectLight level(kPlace, Skyline({0.0}), "a level horizon", no_air());
    const Plane plane{radians(30), radians(120)};
    const PlaneLight light({plane}, level, nullptr);
    std::vector<sun::TimeSpan> spans;
    for (const Irradiance& row : day_of("2026-04-10T00:00Z", 0, 0, 0))
        spans.push_back(row.span);
    const auto hours = light.clear(spans, [](sun::Instant) { return 4.0; }).hours;
    for (std::size_t i = 0; i < spans.size(); ++i) {
        double beam = 0, diffuse = 0, global = 0;
        for (double t = 5; t < 3600; t += 10) {
            const sun::Position sun = sun::position(spans[i].begin + t, kPlace);
            const ClearSky sky(4, sun.distance_au);
            const double dni = sky.beam(sun.elevation_rad, 600),
                         dhi = sky.diffuse(sun.elevation_rad);
            beam += dni * std::max(0.0, glm::dot(plane.normal(), sun.direction)) / 360;
            diffuse += dhi / 360;
            global += (dni * std::max(0.0, sun.direction.z) + dhi) / 360;
        }
        EXPECT_NEAR(hours[i].beam, beam, 0.001 * beam + 0.01);
        EXPECT_NEAR(hours[i].dhi, diffuse, 0.001 * diffuse + 0.01);
        EXPECT_NEAR(hours[i].ghi, global, 0.001 * global + 0.01);
    }
}

TEST(PlaneLight, ATableOfAnotherPlaceDoesNotFit) {
    const DirectLight here(kPlace, Skyline({0.0}), "a level horizon", no_air());
    const DirectLight away(geo::geodetic_deg(47, -100), Skyline({0.0}), "a level horizon");
    std::vector<Irradiance> rows = day_of("2026-06-20T00:00Z", 0, 600, 100);
    for (Irradiance& row : rows) {
        const sun::Position sun = sun::position(row.span.begin + 1800.0, kPlace);
        row.dni *= sun.elevation_rad > 0;
        row.ghi = row.dni * sun.direction.z + row.dhi;
    }
    const auto misfit = [&](const DirectLight& level, double shift_h) {
        std::vector<Irradiance> moved = rows;
        for (Irradiance& row : moved)
            row.span = {row.span.begin + shift_h * 3600, row.span.end + shift_h * 3600};
        const auto found = PlaneLight({}, level, nullptr).misfit(moved, {});
        return found ? found->what : std::string();
    };
    EXPECT_EQ(misfit(here, 0), "");
    EXPECT_EQ(misfit(away, 0), "direct irradiance, but the sun is down");
    for (const double shift_h : {-0.5, 0.5}) {
        const std::string what = misfit(here, shift_h);
        EXPECT_TRUE(what.ends_with(shift_h < 0 ? "to 0.0 % with times moved by +0.5 h"
                                               : "to 0.0 % with times moved by -0.5 h"))
            << what;
    }
}

TEST(PlaneLight, SumsGoByTheClockAtWhichHoursBegin) {
    std::vector<PlaneHour> hours;
    for (const char* midnight : {"1995-01-31T00:00Z", "2003-02-01T00:00Z"})
        for (const Irradiance& row : day_of(midnight, 0, 0, 0))
            hours.push_back({.span = row.span, .lit_s = 3600, .beam = 10, .diffuse = 5});
    const auto sums = [&](SumBy by, bool typical) {
        return sums_by(by, hours, sun::Zone(), typical);
    };
    ASSERT_EQ(sums(SumBy::Day, true).size(), 2U);
    ASSERT_EQ(sums(SumBy::Month, true).size(), 2U);
    EXPECT_EQ(sums(SumBy::Month, true)[1].date, (sun::Date{2003, 2, 1}));
    EXPECT_EQ(sums(SumBy::Year, false).size(), 2U);
    ASSERT_EQ(sums(SumBy::Year, true).size(), 1U);
    EXPECT_NEAR(sums(SumBy::Year, true)[0].global_wh(), 48 * 15, 1e-9);
    EXPECT_NEAR(sums(SumBy::Year, true)[0].lit_s, 48 * 3600, 1e-9);
    ASSERT_EQ(sums(SumBy::HourOfMonth, true).size(), 48U);
    EXPECT_EQ(sums(SumBy::HourOfMonth, true)[25].hour, 1);
    EXPECT_NEAR(sums(SumBy::HourOfMonth, true)[25].beam_wh, 10, 1e-9);
    // By another clock an hour begins on another day.
    EXPECT_EQ(sums_by(SumBy::Day, hours, sun::Zone::fixed(-3600), true).size(), 4U);
}

}  // namespace
}  // namespace relevo::light::test_plane_light
