// A session that goes on is one that began there.
#include <bit>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/log.h"
#include "base/units.h"
#include "render/overlay_raster.h"
#include "session/session.h"
#include "session/words.h"
#include "sun/time.h"
#include "support/change.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::session::test_session {
namespace {

/// Two effects of the test's own: a film over the ground with a parameter, and one with a static
/// parameter. The scene names them, so that nothing of the session depends on what is shipped.
std::filesystem::path plugin_folder() {
    static const std::filesystem::path folder = [] {
        std::filesystem::path made = test::scratch_dir("session_plugins");
        const auto add = [&](const std::string& id, const std::string& glsl) {
            std::filesystem::create_directory(made / id);
            std::ofstream(made / id / "plugin.json") << fmt::format(
                R"({{"format": 1, "id": "{0}", "name": "{0}", "version": "1.0"}})", id);
            std::ofstream(made / id / (id + ".glsl")) << glsl;
        };
        add("film",
            "uniform float film_density = 0.2;  //@ range(0, 1) unit(1/km)\n"
            "void film_on_atmosphere(in Surface s, in vec3 view, inout vec3 radiance) {\n"
            "    radiance = mix(radiance, vec3(0.05, 0.1, 0.2) / frame.exposure, film_density);\n"
            "}\n");
        add("paint",
            "uniform bool paint_slope = true;  //@ static\n"
            "void paint_on_albedo(inout Surface s) {\n"
            "    s.diffuse = paint_slope ? vec3(s.geometric_normal.z) : vec3(0.3);\n"
            "}\n");
        // A file that changes while it is read is read again.
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        return made;
    }();
    return folder;
}

scene::Scene bundled_scene() {
    scene::Scene scene;
    scene.dems = {(test::source_dir() / "data/dem/jacksboro.tif").string()};
    scene.time.at = "2026-06-21T22:30Z";
    scene.width_px = 200;
    scene.height_px = 160;
    scene.effects.switches.only = std::vector<std::string>{"film", "paint"};
    scene.effects.plugin_path = {plugin_folder().string()};
    return scene;
}

image::Image8 picture_of(const scene::Scene& scene) {
    FilesInUse files;
    Session session(scene, {.device = test::gl_device()}, files);
    session.draw();
    return session.picture();
}

TEST(Session, CameraTimeParametersAndSizeChangeWithoutANewProgram) {
    FilesInUse files;
    int stitched = 0;
    Options options{.device = test::gl_device()};
    options.stitched = [&](const render::StitchedFrames&) { ++stitched; };
    Session session(bundled_scene(), options, files);
    session.draw();
    const image::Image8 before = session.picture();
    EXPECT_EQ(before.values, picture_of(bundled_scene()).values);

    scene::Scene later = bundled_scene();
    later.view.orbit = {100, 20, 1.5};
    later.time.at = "2026-12-21T15:00Z";
    later.effects.settings = {{"film.density", "0.7"}};
    later.width_px = 320;
    test::look(session, later.view);
    test::set_time(session, sun::Instant::from_utc({.date = {2026, 12, 21}, .hour = 15}));
    test::set(session, "film.density", "0.7");
    test::resize(session, later.width_px, later.height_px);
    session.draw();
    const image::Image8 after = session.picture();
    EXPECT_EQ(after.width, 320);
    EXPECT_EQ(after.values, picture_of(later).values);
    EXPECT_EQ(session.texture().extent().width, 320);
    EXPECT_EQ(stitched, 1);

    // And back.
    const scene::Scene first = bundled_scene();
    test::look(session, first.view);
    test::set_time(session,
                   sun::Instant::from_utc({.date = {2026, 6, 21}, .hour = 22, .minute = 30}));
    test::set(session, "film.density", "0.2");
    test::resize(session, first.width_px, first.height_px);
    session.draw();
    EXPECT_EQ(session.picture().values, before.values);
}

/// Draws until a frame takes the least time. @returns it [ms]
double least_ms(int times, const std::function<void()>& draw) {
    using Clock = std::chrono::steady_clock;
    double least = 1e9;
    for (int i = 0; i < times; ++i) {
        const auto began = Clock::now();
        draw();
        least = std::min(least,
                         std::chrono::duration<double, std::milli>(Clock::now() - began).count());
    }
    return least;
}

TEST(Session, AToggleThereAndBackLinksNothing) {
    FilesInUse files;
    scene::Scene scene = bundled_scene();
    scene.effects = {};  // all that is on without a word
    scene.width_px = 640;
    scene.height_px = 480;
    Session session(scene, {.device = test::gl_device()}, files);
    scene::Effects fewer;
    fewer.switches.disable = {"haze", "bump"};
    const auto colours = std::make_shared<render::OverlayRaster>(
        render::OverlayRaster{Array2d<std::uint32_t>(2, 2, 0x80ff0000u)});
    std::vector<image::Image8> pictures;
    int linked = 0;
    // The second round links plain programs, too.
    for (int round = 0; round < 3; ++round) {
        const bool again = round > 0, all_linked = round > 1;
        std::size_t i = 0;
        for (const bool overlay : {false, true})
            for (const bool all : {true, false}) {
                test::set_effects(session, all ? scene::Effects{} : fewer);
                session.show(session.scene(), session.time(),
                             {.exact = false, .overlay = LaidOverlay{overlay ? colours : nullptr}});
                session.draw_alone();
                pictures.push_back(session.picture());
                EXPECT_TRUE(!again || pictures.back().values == pictures[i].values) << i;
                ++i;
            }
        EXPECT_TRUE(!all_linked || session.linked_programs() == linked);
        linked = session.linked_programs();
    }
    EXPECT_NE(pictures[0].values, pictures[1].values);
    EXPECT_NE(pictures[0].values, pictures[2].values);
    EXPECT_GT(linked, 8);
    constexpr int kTimes = 12;
    test::set_effects(session, fewer);
    const double fewer_ms = least_ms(kTimes, [&] { session.draw_alone(); });
    test::set_effects(session, {});
    const double all_ms = least_ms(kTimes, [&] { session.draw_alone(); });
    const double both_ms = least_ms(kTimes, [&] {
        for (const scene::Effects& effects : {fewer, scene::Effects{}}) {
            test::set_effects(session, effects);
            session.draw_alone();
        }
    });
    fmt::print(
        "[ toggle ] {} programs linked; frames after a toggle take {:.3f} of the others' time"
        " ({:.1f} ms)\n",
        linked, both_ms / (fewer_ms + all_ms), all_ms);
}

TEST(Session, AnEffectThatComesBackHasTheValuesThatAreAskedFor) {
    FilesInUse files;
    const scene::Scene scene = bundled_scene();
    Session session(scene, {.device = test::gl_device()}, files);
    const auto picture = [&](const scene::Effects& effects) {
        test::set_effects(session, effects);
        session.draw();
        return session.picture().values;
    };
    scene::Effects without = scene.effects, dense = scene.effects, flat = scene.effects;
    without.switches.only = {{"paint"}};
    dense.settings = {{"film.density", "0.9"}};
    flat.settings = {{"paint.slope", "false"}};  // another program
    const auto thin_picture = picture(scene.effects), dense_picture = picture(dense),
               flat_picture = picture(flat);
    EXPECT_NE(dense_picture, thin_picture);
    EXPECT_NE(flat_picture, thin_picture);
    test::set(session, "film.density", "0.5");
    picture(without);
    const int linked = session.linked_programs();
    EXPECT_EQ(picture(scene.effects), thin_picture);
    EXPECT_EQ(picture(flat), flat_picture);
    picture(without);
    EXPECT_EQ(picture(dense), dense_picture);
    EXPECT_EQ(session.linked_programs(), linked);
}

TEST(Session, AnEffectThatComesBackIsReadAgainWhereItsFileHasChanged) {
    const std::filesystem::path folder = test::scratch_dir("session_changed_plugin") / "paintbox";
    std::filesystem::create_directory(folder);
    std::ofstream(folder / "plugin.json")
        << R"({"format": 1, "id": "paintbox", "name": "paintbox", "version": "1.0"})";
    const auto write = [&](const std::string& colour) {
        std::ofstream(folder / "paintbox.glsl")
            << "void paintbox_on_albedo(inout Surface s) { s.diffuse = " << colour << "; }\n";
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    };
    write("vec3(0.9, 0.1, 0.1)");
    scene::Scene scene = bundled_scene();
    scene.effects.plugin_path = {folder.string()};
    scene.effects.switches.only = {{"paintbox"}};
    FilesInUse files;
    Session session(scene, {.device = test::gl_device()}, files);
    const auto picture = [&](const scene::Effects& effects) {
        test::set_effects(session, effects);
        session.draw();
        return session.picture().values;
    };
    scene::Effects none = scene.effects;
    none.switches.only = std::vector<std::string>();
    const auto red = picture(scene.effects);
    picture(none);
    write("vec3(0.1, 0.1, 0.9)");
    const auto blue = picture(scene.effects);
    EXPECT_NE(red, blue);
    write("nonsense");
    EXPECT_ANY_THROW(test::set_effects(session, scene.effects));
    session.draw();
    EXPECT_EQ(session.picture().values, blue);
    picture(none);
    EXPECT_ANY_THROW(test::set_effects(session, scene.effects));
    write("vec3(0.1, 0.1, 0.9)");
    EXPECT_EQ(picture(scene.effects), blue);
}

TEST(Session, LinksProgramsOfNightsInTheBackground) {
    double first_ms[2] = {0, 0};
    image::Image8 pictures[2];
    for (const bool ahead : {false, true}) {
        FilesInUse files;
        scene::Scene scene = bundled_scene();
        scene.effects = {};
        scene.view.eye.emplace();
        scene.view.eye->place = geo::Geodetic{radians(36.36), radians(-84.23), 900};
        Session session(scene, {.device = test::gl_device()}, files);
        session.draw();
        if (ahead) {
            session.link_rest();
            const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(60);
            int linked = -1, steady = 0;
            while (steady < 10 && std::chrono::steady_clock::now() < until) {
                std::this_thread::sleep_for(std::chrono::milliseconds(100));
                session.draw();
                steady = session.linked_programs() == linked ? steady + 1 : 0;
                linked = session.linked_programs();
            }
        }
        const int before = session.linked_programs();
        test::set_time(session, sun::parse_time("2026-06-21T06:00Z").utc);
        first_ms[ahead] = least_ms(1, [&] { session.draw_alone(); });
        EXPECT_EQ(session.linked_programs() == before, ahead);
        pictures[ahead] = session.picture();
    }
    EXPECT_EQ(pictures[0].values, pictures[1].values);
    fmt::print(
        "[ night ] the first frame takes {:.0f} ms, {:.0f} if its programs were linked in the"
        " background\n",
        first_ms[0], first_ms[1]);
}

TEST(Session, DrawsCoarserGroundUntilItsPagesAreThere) {
    scene::Scene scene = bundled_scene();
    scene.effects.switches.only->clear();
    scene.pixel_error = 0;  // every post
    FilesInUse files;
    Session session(scene, {.device = test::gl_device()}, files);
    EXPECT_FALSE(session.draw_available());
    const int first = session.triangles();
    const image::Image8 coarse = session.picture();
    const auto settle = [&] {
        constexpr int kMost = 2000;
        int frames = 1;
        while (!session.draw_available() && frames < kMost) {
            ++frames;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        EXPECT_LT(frames, kMost);
    };
    settle();
    EXPECT_GT(session.triangles(), 4 * first);
    EXPECT_NE(session.picture().values, coarse.values);
    EXPECT_EQ(session.picture().values, picture_of(scene).values);

    // The camera moves on while pages are made, and a capture waits for all.
    scene.view.orbit = {20, 15, 3};
    test::look(session, scene.view);
    session.draw_available();
    scene.view.orbit = {100, 35, 2};
    test::look(session, scene.view);
    session.draw_available();
    session.draw();
    EXPECT_EQ(session.picture().values, picture_of(scene).values);
    settle();
    EXPECT_EQ(session.picture().values, picture_of(scene).values);
}

TEST(Session, DrawsADemThatAnotherHasRead) {
    scene::Scene scene = bundled_scene();
    const auto dem = test::scratch_dir("shared_dem") / "mine.tif";
    std::filesystem::copy_file(scene.dems.front(), dem);
    scene.dems = {dem.string()};
    FilesInUse files, others;
    std::shared_ptr<const LoadedDem> read;
    image::Image8 first;
    {
        Session session(scene, {.device = test::gl_device()}, files);
        session.draw();
        first = session.picture();
        read = session.dem();
    }
    std::filesystem::remove(dem);
    Session session(scene, {.device = test::gl_device(), .dem = read}, others);
    EXPECT_EQ(session.dem(), read);
    session.draw();
    EXPECT_EQ(session.picture().values, first.values);
}

TEST(Session, AWindowDrawsOnForSnowAndNotForWaves) {
    const auto is_animated = [](const std::string& effect) {
        scene::Scene scene = bundled_scene();
        scene.effects.switches.only = std::vector<std::string>{effect, "layering", "sky"};
        FilesInUse files;
        return Session(scene, {.device = test::gl_device()}, files).is_animated();
    };
    EXPECT_TRUE(is_animated("snowfall"));
    EXPECT_FALSE(is_animated("sea"));
}

TEST(Session, FiguresHaveHolesWhateverIsDrawn) {
    scene::Scene scene = bundled_scene();
    scene.dem.nodata = 500;  // some hundred posts, here and there
    std::vector<std::uint32_t> bits[3];
    std::vector<std::uint8_t> pictures[3];
    for (const dem::Holes holes : {dem::Holes::Fill, dem::Holes::Cut, dem::Holes::Mark}) {
        scene.holes = holes;
        FilesInUse files;
        Session session(scene, {.device = test::gl_device()}, files);
        session.draw();
        const LoadedDem& dem = *session.dem();
        const auto i = static_cast<std::size_t>(holes);
        for (const float height_m : dem.field.height_m)
            bits[i].push_back(std::bit_cast<std::uint32_t>(height_m));
        EXPECT_GT(dem.field.about.statistics.holes, 100);
        EXPECT_EQ(dem.drawn.is_filled.empty(), holes == dem::Holes::Cut);
        ASSERT_EQ(session.ground_notes().size(), 1u);
        EXPECT_NE(session.ground_notes()[0].find("% of the DEM, "), std::string::npos);
        pictures[i] = session.picture().values;
    }
    EXPECT_EQ(bits[0], bits[1]);
    EXPECT_EQ(bits[0], bits[2]);
    EXPECT_NE(pictures[0], pictures[1]);
}

TEST(Session, KeepsItsValuesWhereOthersAreRefused) {
    FilesInUse files;
    Session session(bundled_scene(), {.device = test::gl_device()}, files);
    EXPECT_EQ(test::error_of([&] { test::set(session, "film.density", "-1"); }),
              "exit 3: parameter: film.density: expected a number in [0, 1] 1/km but got "
              "\"-1\"");
    EXPECT_EQ(test::error_of([&] { test::set(session, "film.densty", "1"); }),
              "exit 3: parameter: film.densty: no such parameter; did you mean "
              "film.density?");
    // The last good values stay.
    session.draw();
    EXPECT_EQ(session.picture().values, picture_of(bundled_scene()).values);
}

TEST(Session, TellsOfTheSunAsItsEyeSeesIt) {
    FilesInUse files;
    scene::Scene scene = bundled_scene();
    Session session(scene, {.device = test::gl_device()}, files);
    EXPECT_EQ(session.place_text(), "36.30292 N 84.24583 W");
    EXPECT_EQ(session.sun_text(), "azimuth 280.33, elevation 27.03 (27.05 with refraction)");
    scene.view.eye = scene::Standpoint{geo::geodetic_deg(36.05, -84.05, 3000), false};
    test::look(session, scene.view);
    EXPECT_EQ(session.place_text(), "36.05000 N 84.05000 W (the eye)");
}

TEST(Session, SaysOnceThatAnEyeIsBelowTheGround) {
    std::vector<std::string> said;
    log::set_sink([&](log::Level level, std::string_view text) {
        if (level == log::Level::Warning) said.emplace_back(text);
    });
    FilesInUse files;
    scene::Scene scene = bundled_scene();
    scene.view.eye = scene::Standpoint{geo::geodetic_deg(36.3, -84.2, 10), false};
    Session session(scene, {.device = test::gl_device()}, files);
    for (int frame = 0; frame < 3; ++frame) {
        test::look(session, scene.view);
        session.draw();
    }
    EXPECT_EQ(said.size(), 1u);
    // Another scene's eye is spoken of, too.
    session.show(scene, session.time());
    log::set_sink({});
    ASSERT_EQ(said.size(), 2u);
    for (const std::string& text : said)
        EXPECT_TRUE(text.starts_with("--eye: it is ") &&
                    text.find(" below the ground") != text.npos)
            << text;
}

TEST(Words, NeedTheDemWhereItsPlaceMatters) {
    struct Case {
        scene::TimeSpec time;
        bool needs_dem;
    };
    for (const Case& c : {Case{{"2026-06-21T18:30Z", "", ""}, false},
                          {{"2026-06-21T18:30+02:00", "", "auto"}, false},
                          {{"now", "", ""}, false},
                          {{"2026-06-21T18:30", "", "Europe/Zurich"}, false},
                          {{"2026-06-21T18:30", "", ""}, true},
                          {{"2026-06-21T18:30", "", "auto"}, true},
                          {{"2026-06-21T18:30Z", "", "solar"}, true},
                          {{"sunrise", "2026-06-21", "UTC"}, true},
                          {{"sunrise@46.55,8.56", "2026-06-21", ""}, false},
                          {{"sunrise@46.55,8.56", "2026-06-21", "solar"}, false},
                          {{"2026-06-21 first-light@46.55,8.56", "", "UTC"}, true}})
        EXPECT_EQ(needs_dem(c.time), c.needs_dem) << c.time.at << ' ' << c.time.zone;
}

TEST(Words, AreReadBeforeAnythingIsLoaded) {
    const auto error = [](const scene::TimeSpec& spec) {
        return test::error_of([&] { needs_dem(spec); });
    };
    EXPECT_EQ(error({"2026-06-21T18:30", "", "Europe/Zurick"}),
              "exit 3: time zone: Europe/Zurick: no such time zone; did you mean Europe/Zurich?");
    EXPECT_EQ(error({"2026-06-21T18", "", ""}),
              "exit 3: time: 2026-06-21T18: not a time, expected YYYY-MM-DDThh:mm with "
              "Z or an offset, such as 2026-06-21T18:30+02:00");
    EXPECT_EQ(error({"sunrise", "", ""}),
              "exit 3: time: sunrise: no date; write 2026-06-21 sunrise or pass "
              "--date");
    EXPECT_EQ(
        error({"2026-06-21 sunrise", "2026-06-22", ""}),
        "exit 3: time: 2026-06-21 sunrise: contradicts --date 2026-06-22; use only one of them");
    EXPECT_EQ(error({"2011-12-30 sunrise", "", "Pacific/Apia"}),
              "exit 3: time zone: 2011-12-30: there was no such day in Pacific/Apia, its clocks "
              "skipped it");
}

TEST(Words, TakeTheZoneOfTheNearestPlaceThatIsNamed) {
    const light::TerrainAccess dem{.middle = [] { return geo::geodetic_deg(36.3, -84.2); }};
    const geo::PlaceText here{geo::geodetic_deg(-45.031, 168.663)};
    const auto zone = [&](const std::string& time, const light::TerrainAccess& access,
                          const std::optional<geo::PlaceText>& at) {
        const sun::ParsedTime parsed = parse({time, "", "auto"}, access, at);
        EXPECT_EQ(parsed.assumption, "time zone " + parsed.zone.name() + " of the place");
        return parsed.zone.name();
    };
    EXPECT_EQ(zone("2026-06-21T18:30", dem, {}), "America/New_York");
    EXPECT_EQ(zone("2026-06-21T18:30", dem, here), "Pacific/Auckland");
    EXPECT_EQ(zone("2026-06-21 noon", dem, {}), "America/New_York");
    EXPECT_EQ(zone("2026-06-21 noon@46.55,8.56", dem, here), "Europe/Zurich");
    EXPECT_EQ(parse({"2026-06-21T18:30Z", "", "auto"}, dem, here).assumption, "");
    // Pacific/Apia skipped that day, which is known only with the place.
    EXPECT_EQ(test::error_of([] {
                  parse({"noon@-13.83,-171.76", "2011-12-30", ""});
              }),
              "exit 3: time zone: 2011-12-30: there was no such day in Pacific/Apia, its clocks "
              "skipped it");
    // Where there is no place there is no zone.
    EXPECT_EQ(test::error_of([] {
                  parse({"2026-06-21T18:30", "", ""});
              }),
              "exit 3: time: 2026-06-21T18:30: no time zone; write 2026-06-21T18:30Z "
              "for UTC or 2026-06-21T18:30+02:00, or pass --tz Europe/Zurich");
}

}  // namespace
}  // namespace relevo::session::test_session
