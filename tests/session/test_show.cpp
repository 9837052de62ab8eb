// What a session shows next is as if it had been opened for it: nothing is kept that has changed.
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "scene/options.h"
#include "session/session.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::session::test_show {
namespace {

/// A low sun, with the light that core finds by place.
scene::Scene evening() {
    scene::Scene scene;
    scene.dems = {(test::source_dir() / "data/dem/jacksboro.tif").string()};
    scene.time.at = "2026-06-21T23:30:00Z";
    scene.view.orbit = {250, 30, 1};
    scene.width_px = 200;
    scene.height_px = 160;
    scene.effects.switches.only =
        std::vector<std::string>{"block", "haze", "shadows", "sky", "skylight"};
    return scene;
}

struct Change {
    std::string what;
    std::function<void(scene::Scene&)> make;
};

const std::vector<Change>& changes() {
    static const std::vector<Change> all{
        {"exaggeration", [](scene::Scene& s) { s.exaggeration = 3; }},
        {"exaggeration below 1", [](scene::Scene& s) { s.exaggeration = 0.4; }},
        {"refraction", [](scene::Scene& s) { s.refraction = "none"; }},
        {"time", [](scene::Scene& s) { s.time.at = "2026-12-21T14:00:00Z"; }},
        {"camera",
         [](scene::Scene& s) {
             s.view.orbit = {60, 20, 2};
         }},
        {"exposure", [](scene::Scene& s) { s.exposure_ev = -1; }},
        {"backdrop", [](scene::Scene& s) { s.backdrop = scene::Backdrop::Horizon; }},
        {"pixel error", [](scene::Scene& s) { s.pixel_error = 60; }},
        {"size", [](scene::Scene& s) { s.width_px = 120; }},
        {"effects", [](scene::Scene& s) { s.effects.switches.only = std::vector<std::string>{}; }},
        {"a parameter",
         [](scene::Scene& s) {
             s.effects.settings = {{"skylight.strength", "3"}};
         }},
        {"stamps", [](scene::Scene& s) { s.stamps.scale = s.stamps.north = true; }},
    };
    return all;
}

image::Image8 picture_of(Session& session) {
    session.draw();
    return session.picture();
}

/// @param constants  as sessions of pictures have parameters, unless the scene sets values
Options options(bool constants) {
    Options result{.device = test::gl_device()};
    if (constants) result.format = PictureFormat{};
    return result;
}

image::Image8 alone(const scene::Scene& scene, bool constants = false) {
    FilesInUse files;
    Session session(scene, options(constants), files);
    return picture_of(session);
}

/// @param begin  of which each change is made, shown, and taken back
void expect_nothing_kept(const scene::Scene& begin, const std::vector<Change>& changes,
                         bool constants = false) {
    const image::Image8 first = alone(begin, constants);
    const sun::Instant begin_utc = sun::parse_time(begin.time.at).utc;
    FilesInUse files;
    Session session(begin, options(constants), files);
    ASSERT_EQ(picture_of(session).values, first.values);
    for (const Change& change : changes) {
        scene::Scene scene = begin;
        change.make(scene);
        session.show(scene, sun::parse_time(scene.time.at).utc);
        const image::Image8 next = picture_of(session);
        EXPECT_EQ(next.values, alone(scene, constants).values) << change.what;
        EXPECT_NE(next.values, first.values) << change.what << " changes nothing";
        session.show(begin, begin_utc);
        EXPECT_EQ(picture_of(session).values, first.values) << "after " << change.what;
    }
}

TEST(Show, APictureIsTheSameWhateverWasShownBefore) {
    expect_nothing_kept(evening(), changes());
}

TEST(Show, ConstantsOfProgramsChangeNoPicture) {
    expect_nothing_kept(evening(), changes(), /*constants=*/true);
    const image::Image8 with = alone(evening(), /*constants=*/true), without = alone(evening());
    ASSERT_EQ(with.values.size(), without.values.size());
    // Compilers compute functions of constants more exactly than devices do.
    for (std::size_t i = 0; i < with.values.size(); ++i)
        ASSERT_NEAR(with.values[i], without.values[i], 1) << i;
}

/// A value that is not the default.
std::string other_value(const scene::Option& option) {
    using Kind = scene::Option::Kind;
    if (option.kind == Kind::Word) return std::string(option.words.back());
    if (option.key == "weather") return "LSZB 011150Z 24009KT CAVOK 17/13 Q1014";
    if (option.kind == Kind::Text) return "a text";
    if (option.kind == Kind::Whole) return "2";
    if (option.kind == Kind::Flag)
        return scene::text_of(option, scene::Scene()) == "true" ? "false" : "true";
    return fmt::format("{}", option.min + (option.max - option.min) / 4);
}

TEST(Show, EachOptionIsThatOfTheSceneThatIsShown) {
    scene::Scene begin = evening();
    begin.width_px = begin.height_px = 48;
    const sun::Instant utc = sun::parse_time(begin.time.at).utc;
    FilesInUse files;
    Session session(begin, {.device = test::gl_device()}, files);
    int shown = 0;
    for (const scene::Option& option : scene::options()) {
        SCOPED_TRACE(option.flag);
        // What a session opens with, and maps, of which test_land_cover has one.
        if (option.object == "dem" || option.object == "overlay" || option.key == "holes" ||
            option.key.starts_with("land_cover"))
            continue;
        scene::Scene next = begin;
        option.set(next, scene::value_of(option, other_value(option)));
        session.show(next, utc);
        EXPECT_EQ(scene::text_of(option, session.scene()), scene::text_of(option, next));
        EXPECT_EQ(picture_of(session).values, alone(next).values);
        session.show(begin, utc);
        EXPECT_EQ(scene::text_of(option, session.scene()), scene::text_of(option, begin));
        ++shown;
    }
    EXPECT_GT(shown, 20);
}

TEST(Show, ShadowMapsAreOfTheGroundAndTheSunThatAreShown) {
    scene::Scene scene = evening();
    scene.effects.switches.only = std::vector<std::string>{"vsm"};
    expect_nothing_kept(scene,
                        {{"exaggeration", [](scene::Scene& s) { s.exaggeration = 3; }},
                         {"time", [](scene::Scene& s) { s.time.at = "2026-06-21T22:00:00Z"; }},
                         {"camera", [](scene::Scene& s) {
                              s.view.orbit = {60, 20, 2};
                          }}});
}

}  // namespace
}  // namespace relevo::session::test_show
