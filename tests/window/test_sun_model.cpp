// The sun of the viewer's panels.
#include <algorithm>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "base/units.h"
#include "session/session.h"
#include "sun/position.h"
#include "sun/seasons.h"
#include "support/support.h"
#include "viewer/state.h"
#include "viewer/sun_model.h"
#include "window/display.h"

namespace relevo::viewer::test_sun_model {
namespace {

TEST(SunModel, MinutesAndDaysOfTheYear) {
    const sun::Zone zone = sun::Zone::named("Europe/Zurich");
    const sun::Instant utc = sun::Instant::from_utc({.date = {2026, 6, 21}, .hour = 16});
    const DayMinute at = DayMinute::of(utc, zone);
    EXPECT_EQ(at.minute, 18 * 60);
    EXPECT_EQ(at.utc(zone), utc);
    EXPECT_EQ(day_of_year({2026, 1, 1}), 0);
    EXPECT_EQ(date_of(2024, day_of_year({2024, 12, 31})), (sun::Date{2024, 12, 31}));
    EXPECT_EQ(days_in_month(2024, 2), 29);
    EXPECT_EQ(in_year({2024, 2, 29}, 2026), (sun::Date{2026, 2, 28}));
    // The day's way passes where the sun is.
    const SunDay day =
        SunDay::of({2026, 6, 21}, zone, geo::geodetic_deg(46.5, 8, 0), sun::Refraction::none());
    EXPECT_EQ(day.points.size(), 145u);
    double highest = -90;
    for (const SunPoint& point : day.points)
        highest = std::max(highest, point.elevation_deg);
    EXPECT_NEAR(highest, 90 - 46.5 + 23.44, 0.1);
}

TEST(SunModel, SeasonsHaveTheDateOfTheZone) {
    // The autumn's equinox of 2026 is at 00:05 UTC on 23 September.
    const sun::Instant equinox = sun::seasons(2026).september_equinox;
    const auto label = [&](const char* zone) {
        return day_label(sun::Zone::named(zone).local(equinox).wall.date);
    };
    EXPECT_EQ(label("Europe/Zurich"), "23 Sep");
    EXPECT_EQ(label("America/New_York"), "22 Sep");
}

TEST(SunModel, TheNextTimeWithSun) {
    const sun::Zone zone = sun::Zone::named("UTC");
    const geo::Geodetic greenwich{radians(51.5), 0, 0}, north{radians(80.0), 0, 0};
    const sun::Refraction air = sun::Refraction::none();
    const auto elevation_deg = [&](sun::Instant at) {
        return sun_at(at, greenwich, air).elevation_deg;
    };
    const SunDay june = SunDay::of({2026, 6, 21}, zone, greenwich, air);
    const auto at = [&](int hour) {
        return zone.resolve({.date = {2026, 6, 21}, .hour = hour}).utc;
    };
    EXPECT_EQ(time_with_sun(june, at(12)), at(12));
    const sun::Instant morning = time_with_sun(june, at(1)).value();
    EXPECT_GE(elevation_deg(morning), 10);
    EXPECT_LT(elevation_deg(morning - 600), 10);
    EXPECT_LT(morning - at(0), 6 * 3600);
    EXPECT_GT(time_with_sun(june, at(23)).value() - at(12), 5 * 3600);
    // Low all day: half as high as at most.
    const SunDay february = SunDay::of({2026, 2, 24}, zone, north, air);
    EXPECT_TRUE(time_with_sun(february, at(12)));
    EXPECT_FALSE(time_with_sun(SunDay::of({2026, 12, 21}, zone, north, air), at(12)));
}

TEST(SunPanel, SaysWhatTheCommandLineSaysInTheSameAir) {
    const std::string time = "2026-06-21T10:32:00Z";  // low, where air lifts the most
    for (const char* refraction : {"standard", "none"}) {
        scene::Scene scene;
        scene.dems = {(test::source_dir() / "data/dem/jacksboro.tif").string()};
        scene.refraction = refraction;
        scene.effects.switches.only.emplace();
        FilesInUse files;
        const session::Session session(scene, {.device = "software"}, files);
        State state;
        state.document.scene = scene;
        state.stand_on(session.ground());
        state.set_utc(sun::parse_time(time).utc);
        const geo::Geodetic at = session.ground().frame.origin();
        const double expected = test::answer_of(
            fmt::format("sun position --at={:.7f},{:.7f},{:.1f} --time {} --refraction {} --json",
                        degrees(at.lat_rad), degrees(at.lon_rad), session.ground().air_height_m(),
                        time, refraction))["apparent_elevation_deg"];
        ASSERT_GT(expected, 0.2);
        ASSERT_LT(expected, 3);
        EXPECT_THAT(sun_figures(state),
                    testing::EndsWith(fmt::format(", elevation {:.2f}°", expected)));
        // And so does the way of the day.
        const SunPoint& dawn = state.day.points[62];
        EXPECT_NEAR(
            dawn.elevation_deg,
            degrees(state.air.apparent_rad(sun::position(dawn.utc, state.centre).elevation_rad)),
            1e-9);
    }
}

}  // namespace
}  // namespace relevo::viewer::test_sun_model
