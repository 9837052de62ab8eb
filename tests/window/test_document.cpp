// What a person sets in the viewer, and how it is taken away.
#include <cstdio>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "base/units.h"
#include "session/session.h"
#include "sun/position.h"
#include "sun/seasons.h"
#include "support/support.h"
#include "viewer/document.h"
#include "viewer/file_watch.h"
#include "viewer/state.h"
#include "viewer/sun_model.h"

namespace relevo::viewer {
namespace {

using testing::ElementsAre;

TEST(History, GoesBackAndForth) {
    History history;
    Document document;
    for (const double heading : {1, 2, 3}) {
        document.pose.heading_deg = heading;
        history.add(document);
    }
    EXPECT_FALSE(history.can_redo());
    EXPECT_EQ(history.undo().pose.heading_deg, 2);
    EXPECT_EQ(history.undo().pose.heading_deg, 1);
    EXPECT_FALSE(history.can_undo());
    EXPECT_EQ(history.redo().pose.heading_deg, 2);
    EXPECT_TRUE(history.differs(document));  // its heading is 3
    document.pose.heading_deg = 2;
    EXPECT_FALSE(history.differs(document));
    document.utc = document.utc + 1.0;
    EXPECT_TRUE(history.differs(document));
    document.pose.heading_deg = 9;
    history.add(document);
    EXPECT_FALSE(history.can_redo());
    EXPECT_EQ(history.undo().pose.heading_deg, 2);
}

TEST(Effects, AreSwitchedWhateverWasSaidBefore) {
    scene::Effects effects;
    effects.switches.enable = {"wet"};
    EXPECT_THAT(switched(effects, "wet", false).switches.enable, testing::IsEmpty());
    EXPECT_THAT(switched(effects, "wet", false).switches.disable, ElementsAre("wet"));
    effects.switches = {};
    effects.switches.only = std::vector<std::string>{"sky"};
    EXPECT_THAT(*switched(effects, "haze", true).switches.only, ElementsAre("sky", "haze"));
    EXPECT_THAT(*switched(effects, "sky", false).switches.only, testing::IsEmpty());
    effects = with_value(effects, "haze.density", "0.1");
    effects = with_value(effects, "haze.blue", "0.2");
    effects = with_value(effects, "haze.density", "0.3");
    ASSERT_EQ(effects.settings.size(), 2u);
    EXPECT_EQ(effects.settings.back().text, "0.3");
    EXPECT_EQ(without_values(effects, "haze.density").settings.size(), 1u);
    EXPECT_EQ(without_values(effects, "haze").settings.size(), 0u);
    EXPECT_EQ(without_values(effects, "ha").settings.size(), 2u);
}

TEST(Command, IsQuotedForAShell) {
    scene::Scene scene;
    scene.dems = {"/maps/it's here/a b.tif"};
    scene.view.eye = scene::Standpoint{geo::geodetic_deg(-46.5, 8.25, 1200), false};
    scene.view.heading_deg = 12.5;
    scene.view.pitch_deg = -3;
    scene.view.fov_y_rad = radians(40.0);
    scene.moment.time = "2026-06-21T18:30:00+02:00";
    scene.effects.switches.disable = {"haze"};
    scene.effects.settings = {{"sea.colour", "0,0.1,0.2"}};
    EXPECT_EQ(capture_command(scene, "picture.png"),
              "relevo capture '/maps/it'\\''s here/a b.tif' --time 2026-06-21T18:30:00+02:00 "
              "--eye=-46.500000000,8.250000000,1200.000 --heading 12.500000 --pitch=-3.000000 "
              "--fov 40 --disable haze --set sea.colour=0,0.1,0.2 --size 1280x1024 -o picture.png");
}

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

/// What `relevo sun position` has of a place [deg].
double apparent_elevation_deg(const std::string& place, const std::string& time,
                              const std::string& refraction) {
    const std::string command =
        fmt::format("{} -q sun position --at={} --time {} --refraction {} --json",
                    (test::build_dir() / "bin/relevo").string(), place, time, refraction);
    std::FILE* const pipe = popen(command.c_str(), "r");
    std::string text(4096, ' ');
    text.resize(std::fread(text.data(), 1, text.size(), pipe));
    pclose(pipe);
    return nlohmann::json::parse(text)["apparent_elevation_deg"];
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
        const double expected = apparent_elevation_deg(
            fmt::format("{:.7f},{:.7f},{:.1f}", degrees(at.lat_rad), degrees(at.lon_rad),
                        session.ground().air_height_m()),
            time, refraction);
        ASSERT_GT(expected, 0.2);
        ASSERT_LT(expected, 3);
        EXPECT_THAT(sun_figures(state),
                    testing::EndsWith(fmt::format(", height {:.2f}°", expected)));
        // And so does the way of the day.
        const SunPoint& dawn = state.day.points[62];
        EXPECT_NEAR(
            dawn.elevation_deg,
            degrees(state.air.apparent_rad(sun::position(dawn.utc, state.centre).elevation_rad)),
            1e-9);
    }
}

TEST(FileWatch, TellsOfChangesOnceTheyRest) {
    const std::filesystem::path folder = test::scratch_dir("watch");
    std::ofstream(folder / "a.glsl") << "1";
    FileWatch watch;
    watch.watch({folder, folder / "none"});
    EXPECT_FALSE(watch.changed());
    std::ofstream(folder / "b.glsl") << "2";
    EXPECT_FALSE(watch.changed());  // it may still be written
    EXPECT_TRUE(watch.changed());
    EXPECT_FALSE(watch.changed());
    std::filesystem::last_write_time(
        folder / "a.glsl",
        std::filesystem::last_write_time(folder / "a.glsl") + std::chrono::seconds(2));
    watch.changed();
    EXPECT_TRUE(watch.changed());
    std::filesystem::remove(folder / "b.glsl");
    watch.changed();
    EXPECT_TRUE(watch.changed());
}

}  // namespace
}  // namespace relevo::viewer
