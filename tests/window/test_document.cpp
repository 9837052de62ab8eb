// What a person sets in the viewer, and how it is taken away.
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/folder_watch.h"
#include "base/units.h"
#include "dem/load.h"
#include "light/fields.h"
#include "session/session.h"
#include "sun/position.h"
#include "sun/seasons.h"
#include "support/support.h"
#include "viewer/charts_panel.h"
#include "viewer/document.h"
#include "viewer/export.h"
#include "viewer/file_watch.h"
#include "viewer/fonts.h"
#include "viewer/history.h"
#include "viewer/navigation.h"
#include "viewer/point_light.h"
#include "viewer/settings.h"
#include "viewer/state.h"
#include "viewer/sun_model.h"
#include "viewer/sun_over.h"
#include "window/display.h"

namespace relevo::viewer::test_document {
namespace {

using testing::ElementsAre;

TEST(History, NamesWhatUndoAndRedoWouldChange) {
    History history;
    Document document;
    EXPECT_EQ(history.undo_name(&document), "");
    history.add(document);
    EXPECT_EQ(history.undo_name(&document), "");
    document.scene.effects.switches.disable = {"haze"};
    history.add(document);
    document.scene.exaggeration = 2;
    history.add(document);
    EXPECT_EQ(history.undo_name(&document), "heights");
    // What is no step yet is undone first.
    document.utc = document.utc + 60;
    EXPECT_EQ(history.undo_name(&document), "time");
    EXPECT_EQ(history.undo_name(nullptr), "heights");
    history.undo();
    EXPECT_EQ(history.undo_name(nullptr), "effects");
    EXPECT_EQ(history.redo_name(), "heights");
}

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

TEST(Effects, OfAGroundThatADemHasNotAreOff) {
    const scene::Effects effects;
    EXPECT_TRUE(EffectsModel::of(effects)->selection.has("sea"));
    EXPECT_TRUE(EffectsModel::of(effects, {{"water"}})->selection.has("sea"));
    EXPECT_FALSE(EffectsModel::of(effects, effect::GroundWords(std::vector<std::string>{}))
                     ->selection.has("sea"));
    EXPECT_TRUE(EffectsModel::of(switched(effects, "sea", true),
                                 effect::GroundWords(std::vector<std::string>{}))
                    ->selection.has("sea"));
}

TEST(Fonts, AreFoundForTheLettersOfAnyScript) {
    EXPECT_THAT(unusual_letters("Höhe ύψος высота 5°"), testing::IsEmpty());
    EXPECT_THAT(unusual_letters("雪 and 山, 雪"), ElementsAre(U'山', U'雪'));
    EXPECT_THAT(fonts_with({}), testing::IsEmpty());
    ASSERT_NE(usual_font_file(), "");
    const std::vector<FontFile> fonts = fonts_with({U'山', U'雪', U'の', U'ᚠ'});
    if (fonts.empty()) GTEST_SKIP() << "not run: no font has Chinese or Japanese here";
    EXPECT_TRUE(std::filesystem::exists(fonts[0].path));
    EXPECT_THAT(fonts[0].letters, testing::Contains(U'雪'));
}

TEST(Command, IsQuotedForAShell) {
    scene::Scene scene;
    scene.dems = {"/maps/it's here/a b.tif"};
    scene.view.eye = scene::Standpoint{geo::geodetic_deg(-46.5, 8.25, 1200), false};
    scene.view.heading_deg = 12.5;
    scene.view.pitch_deg = -3;
    scene.view.fov_y_rad = radians(40.0);
    scene.time.at = "2026-06-21T18:30:00+02:00";
    scene.effects.switches.disable = {"haze"};
    scene.effects.settings = {{"sea.colour", "0,0.1,0.2"}};
    EXPECT_EQ(capture_command(scene, "picture.png"),
              "relevo capture '/maps/it'\\''s here/a b.tif' --time 2026-06-21T18:30:00+02:00 "
              "--eye=-46.500000000,8.250000000,1200.000 --heading 12.500000 --pitch=-3.000000 "
              "--fov 40 --disable haze --set sea.colour=0,0.1,0.2 --size 1280x720 -o picture.png");
}

std::shared_ptr<const session::LoadedDem> jacksboro() {
    const std::string file = (test::source_dir() / "data/dem/jacksboro.tif").string();
    dem::Source source = dem::Source::open(file);
    dem::Heightfield field = dem::load(source, dem::LoadOptions{}.memory);
    return std::make_shared<const session::LoadedDem>(session::LoadedDem{
        std::make_shared<const dem::Source>(std::move(source)), std::move(field)});
}

// The figures are those of `relevo sun when --at 36.25,-84.28 --eye-height 2`.
TEST(SunOver, IsTheNextPassageInSight) {
    SunOverQuestion question{.dem = jacksboro(),
                             .scene = {},
                             .eye = geo::geodetic_deg(36.25, -84.28, 457),
                             .target = geo::geodetic_deg(36.22333333, -84.2275, 2100),
                             .after = sun::parse_time("2026-06-21T12:00:00Z").utc,
                             .zone = sun::Zone::named("America/New_York")};
    const auto next = [&] { return sun_over(question); };
    const SunOverAnswer first = next();
    ASSERT_TRUE(first.utc) << first.words;
    EXPECT_LT(std::abs(*first.utc - sun::parse_time("2026-10-30T13:32:51.277Z").utc), 1);
    question.after = *first.utc;
    const SunOverAnswer second = next();
    ASSERT_TRUE(second.utc);
    EXPECT_LT(std::abs(*second.utc - sun::parse_time("2026-10-31T13:32:48.283Z").utc), 1);
    // The ridge itself is hidden by ground nearer by, and the sun never stands in the north.
    question.target->height_m = 986;
    EXPECT_FALSE(next().utc);
    question.target = geo::geodetic_deg(36.40, -84.28, 3000);
    EXPECT_FALSE(next().utc);
    // Not within the DEM.
    question.eye = geo::geodetic_deg(40, -84.28, 457);
    EXPECT_THROW(next(), Error);
}

// As `relevo moon day DEM --at 36.25,-84.28 --eye-height 2` has it. On the 27th the moon is up 20
// minutes after sunset, before civil dusk.
TEST(SunOver, IsTheMoonsNextRiseOverTheGroundByNight) {
    SunOverQuestion question{.dem = jacksboro(),
                             .scene = {},
                             .eye = geo::geodetic_deg(36.25, -84.28, 457),
                             .target = {},
                             .after = sun::parse_time("2026-06-21T12:00:00Z").utc,
                             .zone = sun::Zone::named("America/New_York"),
                             .body = sun::Body::Moon};
    const SunOverAnswer first = sun_over(question);
    ASSERT_TRUE(first.utc) << first.words;
    EXPECT_TRUE(first.looks_to_moon);
    EXPECT_LT(std::abs(*first.utc - sun::parse_time("2026-06-29T01:46:30Z").utc), 1);
    EXPECT_EQ(first.words, "the moon rises on 28 Jun at 21:47, in the SE");
    question.after = *first.utc;
    EXPECT_LT(std::abs(*sun_over(question).utc - sun::parse_time("2026-06-30T02:31:54Z").utc), 1);
}

TEST(PointWork, KnowsTheGroundBehindWhichTheSunRises) {
    PointWanted wanted;
    wanted.dem = jacksboro();
    wanted.refraction = "standard";
    wanted.place = geo::geodetic_deg(36.25, -84.28, 0);
    wanted.date = {2026, 2, 10};
    wanted.zone = sun::Zone::named("America/New_York");
    PointWork work([] {});
    work.want(wanted);
    ASSERT_TRUE(test::WindowedProgram::wait([&] { return work.is_done(); }));
    const LitSpan& first = work.answer()->lit.front();
    EXPECT_NEAR(first.begins_over.azimuth_deg, 120.7, 0.3);
    EXPECT_NEAR(first.begins_over.elevation_deg, 14.96, 0.05);
    EXPECT_NEAR(first.begins_over.distance_m, 2004, 15);
}

TEST(PointWork, GivesUpWhatIsNotWantedAnyMoreAndNeverHoldsItsCallerUp) {
    PointWanted wanted;
    wanted.dem = jacksboro();
    wanted.refraction = "standard";
    wanted.date = {2026, 2, 10};
    wanted.zone = sun::Zone::named("America/New_York");
    wanted.chart_px = {640, 220};
    const auto at = [&](int i) { return geo::geodetic_deg(36.2 + 0.004 * i, -84.2, 0); };
    std::atomic<int> answers = 0;
    PointWork work([&] { ++answers; });
    const auto wait = [&] {
        ASSERT_TRUE(test::WindowedProgram::wait([&] { return work.is_done(); }));
    };
    wanted.place = at(40);
    work.want(wanted);
    wait();
    const std::shared_ptr<const PointLight> alone = work.answer();
    ASSERT_EQ(alone->error, "");
    EXPECT_EQ(answers, 3);  // the day, the horizon, the year
    EXPECT_EQ(alone->horizon->picture.width, 640);
    answers = 0;
    double longest_s = 0;
    for (int i = 0; i <= 40; ++i) {
        wanted.place = at(i);
        const auto began = std::chrono::steady_clock::now();
        work.want(wanted);
        longest_s = std::max(
            longest_s,
            std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count());
        const auto answer = work.answer();
        EXPECT_TRUE(!answer || answer->of.place.lat_rad == wanted.place.lat_rad);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    wait();
    fmt::print("[ measured ] of 123 answers {} were worked out; want() took {:.2f} ms at most\n",
               answers.load(), 1000 * longest_s);
    EXPECT_LT(answers, 60);
    EXPECT_LT(longest_s, 0.05);
    const std::shared_ptr<const PointLight> last = work.answer();
    EXPECT_EQ(last->lit_s, alone->lit_s);
    EXPECT_EQ(last->horizon->picture.values, alone->horizon->picture.values);
    EXPECT_EQ(last->year->picture.values, alone->year->picture.values);
    // Another day of the same point is another answer; a year stays what it is.
    wanted.date = {2026, 6, 21};
    work.want(wanted);
    wait();
    EXPECT_GT(work.answer()->lit_s, last->lit_s + 3600);
    EXPECT_NE(work.answer()->horizon->picture.values, last->horizon->picture.values);
    EXPECT_EQ(work.answer()->year->picture.values, last->year->picture.values);
}

TEST(PointWork, HasTheFiguresOfTheCommandLine) {
    for (const char* refraction : {"standard", "none"}) {
        PointWanted wanted;
        wanted.dem = jacksboro();
        wanted.refraction = refraction;
        wanted.place = geo::geodetic_deg(36.3, -84.2, 0);
        wanted.date = {2026, 2, 10};
        wanted.zone = sun::Zone::named("America/New_York");
        PointWork work([] {});
        work.want(wanted);
        while (!work.is_done())
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        const auto json =
            test::answer_of(fmt::format("sun day {} --at 36.3,-84.2 --date 2026-02-10 {} --json",
                                        (test::source_dir() / "data/dem/jacksboro.tif").string(),
                                        wanted.refraction == "none" ? "--no-refraction" : ""));
        EXPECT_NEAR(work.answer()->lit_s / 3600, json["days"][0]["direct_sun_h"], 1e-6);
        EXPECT_NEAR(work.answer()->flat_s / 3600, json["days"][0]["day_length_h"], 1e-6);
    }
}

TEST(PointWork, KnowsWhenTheSunComesBackAndTheDaysWithoutIt) {
    // Ten posts south of the place a wall from edge to edge, 41 degrees high.
    session::LoadedDem walled = *jacksboro();
    const double spacing_m = walled.field.grid.post_spacing_m().y;
    const auto height_m = static_cast<float>(walled.field.height_m.at(200, 100) +
                                             10 * spacing_m * std::tan(radians(41.0)));
    for (int column = 0; column < walled.field.grid.columns(); ++column)
        walled.field.height_m.at(column, 110) = height_m;
    PointWanted wanted;
    wanted.dem = std::make_shared<const session::LoadedDem>(std::move(walled));
    wanted.refraction = "standard";
    wanted.place = wanted.dem->field.grid.place(200, 100);
    wanted.date = {2026, 12, 21};
    wanted.zone = sun::Zone::named("America/New_York");
    wanted.chart_px = {640, 220};
    PointWork work([] {});
    const auto answer = [&] {
        work.want(wanted);
        while (!work.is_done())
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        return work.answer();
    };
    const auto winter = answer();
    ASSERT_EQ(winter->error, "");
    EXPECT_TRUE(winter->lit.empty());
    EXPECT_FALSE(winter->tomorrow);
    ASSERT_TRUE(winter->year);
    const auto [first, last] = winter->year->dark;
    EXPECT_TRUE(winter->tomorrow_is_known);
    EXPECT_EQ(winter->year->dark_row, sun::days_between(first, {2027, last.month, last.day}) + 1);
    EXPECT_EQ(winter->year->dark_days, winter->year->dark_row);
    const light::LightDay& june = winter->year->days[171];
    EXPECT_EQ(lit_label(june, wanted.zone),
              fmt::format("sun {} to {}", clock_label(june.lit.front().begin.utc, wanted.zone),
                          clock_label(june.lit.front().end.utc, wanted.zone)));
    EXPECT_EQ(june.date, (sun::Date{2026, 6, 21}));
    EXPECT_EQ(june.lit.size(), 1U);
    // As long before the solstice as after it.
    const int before = sun::days_between(first, {2026, 12, 21}),
              after = sun::days_between({2025, 12, 21}, last);
    EXPECT_GT(before, 30);
    EXPECT_NEAR(before, after, 2);
    wanted.date = last;
    const auto end = answer();
    EXPECT_TRUE(end->lit.empty());
    ASSERT_TRUE(end->tomorrow);
    wanted.date = sun::add_days(last, 1);
    EXPECT_EQ(answer()->lit.front().begin, *end->tomorrow);
    // After the last day for which the sun is computed nothing is known.
    wanted.date = {2100, 12, 31};
    EXPECT_EQ(answer()->error, "");
    EXPECT_FALSE(answer()->tomorrow_is_known);
}

TEST(PointWork, PolarNightIsDaysWithoutSun) {
    const auto plain = std::make_shared<const session::LoadedDem>(
        session::LoadedDem{nullptr, test::field_of(60, 60, {20, 0.001, 0, 75, 0, -0.001},
                                                   "EPSG:4326", [](int, int) { return 100.0; })});
    PointWanted wanted;
    wanted.dem = plain;
    wanted.refraction = "standard";
    wanted.place = plain->field.grid.place(30, 30);
    wanted.date = {2026, 6, 21};
    wanted.zone = sun::Zone::named("UTC");
    wanted.chart_px = {640, 220};
    PointWork work([] {});
    work.want(wanted);
    while (!work.is_done())
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ASSERT_EQ(work.answer()->error, "");
    // From the first days of November to the first ones of February.
    const YearPicture& year = *work.answer()->year;
    EXPECT_NEAR(year.dark_days, 92, 5);
    EXPECT_EQ(year.dark_row, year.dark_days);
    EXPECT_EQ(year.dark.first.month, 11);
    EXPECT_EQ(year.dark.second.month, 2);
    ASSERT_EQ(year.days.size(), 365U);
    EXPECT_EQ(lit_label(year.days.front(), wanted.zone), "no direct sun");
    EXPECT_EQ(lit_label(year.days[171], wanted.zone), "sun midnight to midnight");
}

TEST(PointLight, MidnightIsNoEdgeOfTheLight) {
    PointLight light;
    const sun::Instant begin = sun::parse_time("2026-06-21T00:00Z").utc;
    light.lit = {{{begin, begin + 86400.0}, true, true}};
    EXPECT_TRUE(light.is_lit(begin + 3600.0));
    EXPECT_FALSE(light.next_change(begin + 3600.0));
    light.lit = {{{begin, begin + 7200.0}, true, false},
                 {{begin + 9000.0, begin + 86400.0}, false, true}};
    EXPECT_EQ(light.next_change(begin + 3600.0), begin + 7200.0);
    EXPECT_EQ(light.next_change(begin + 8000.0), begin + 9000.0);
    EXPECT_FALSE(light.next_change(begin + 10000.0));
}

TEST(PointWork, APointInNoDemHasWordsForAnAnswer) {
    PointWanted wanted;
    wanted.dem = jacksboro();
    wanted.refraction = "standard";
    wanted.place = geo::geodetic_deg(40, -84.2, 0);
    wanted.date = {2026, 2, 10};
    PointWork work([] {});
    work.want(wanted);
    while (!work.is_done())
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_NE(work.answer()->error, "");
    work.forget();
    EXPECT_EQ(work.answer(), nullptr);
}

TEST(Memory, KeepsWhatWasWrittenAndStandsWhateverIsThere) {
    const std::filesystem::path folder = test::scratch_dir("memory");
    const Memory memory(folder / "config", folder / "state");
    EXPECT_EQ(memory.settings(), Settings{});
    EXPECT_THAT(memory.recent(), testing::IsEmpty());
    const Settings settings{.light_style = true,
                            .text_px = 20,
                            .coordinates = Coordinates::Mgrs,
                            .panels = false,
                            .charts = false};
    memory.write(settings);
    EXPECT_EQ(memory.settings(), settings);
    // The last one first, each once, and not without end.
    for (int i = 0; i < 30; ++i)
        memory.add_recent({{fmt::format("/dem{}.tif", i % 20)}, {}});
    memory.add_recent({{"/dem5.tif", "/dem6.tif"}, {}});
    ASSERT_EQ(memory.recent().size(), 12u);
    EXPECT_THAT(memory.recent()[0].files, ElementsAre("/dem5.tif", "/dem6.tif"));
    EXPECT_THAT(memory.recent()[1].files, ElementsAre("/dem9.tif"));
    // With the options that they were read with.
    RecentDem odd{{"/dem7.tif"}, {}};
    odd.options.crs = "EPSG:2056";
    odd.options.unit = "ft";
    odd.options.nodata = -32767;
    odd.holes = dem::Holes::Mark;
    memory.add_recent(odd);
    ASSERT_EQ(memory.recent().size(), 12u);
    EXPECT_EQ(memory.recent()[0].options.crs, "EPSG:2056");
    EXPECT_EQ(memory.recent()[0].options.unit, "ft");
    EXPECT_EQ(memory.recent()[0].options.nodata, -32767);
    EXPECT_EQ(memory.recent()[0].holes, dem::Holes::Mark);
    EXPECT_EQ(memory.recent()[1].options.crs, "");
    EXPECT_THAT(memory.recent()[1].files, ElementsAre("/dem5.tif", "/dem6.tif"));
    SavedView view;
    view.name = "Über \"quoted\"";
    view.eye = geo::geodetic_deg(-46.5, 170.25, 1234.5);
    view.heading_deg = 12.5;
    view.pitch_deg = -30;
    view.fov_y_rad = radians(40.0);
    view.utc = sun::parse_time("2026-06-21T18:30:00Z").utc;
    memory.write_views({"/a.tif"}, {view, view});
    EXPECT_THAT(memory.views({"/b.tif"}), testing::IsEmpty());
    const std::vector<SavedView> views = memory.views({"/a.tif"});
    ASSERT_EQ(views.size(), 2u);
    EXPECT_EQ(views[0].name, view.name);
    EXPECT_NEAR(views[0].eye.lon_rad, view.eye.lon_rad, 1e-12);
    EXPECT_EQ(views[0].utc, view.utc);
    // Broken, of another kind, or a folder.
    for (const char* text : {"", "{", "[1, {}]", "{\"text_px\": \"large\", \"style\": 7}", "null",
                             "{\"text_px\": 1e300, \"views\": {}}", "\xff\xfe"}) {
        for (const auto& file : std::filesystem::recursive_directory_iterator(folder))
            if (file.is_regular_file()) std::ofstream(file.path()) << text;
        const int text_px = memory.settings().text_px;
        EXPECT_TRUE(text_px == 16 || text_px == kMostText_px) << text;
        EXPECT_THAT(memory.recent(), testing::IsEmpty()) << text;
        EXPECT_THAT(memory.views({"/a.tif"}), testing::IsEmpty()) << text;
    }
    std::filesystem::remove(folder / "state/recent.json");
    std::filesystem::create_directories(folder / "state/recent.json");
    EXPECT_THAT(memory.recent(), testing::IsEmpty());
    EXPECT_THROW(memory.add_recent({{"/a.tif"}, {}}), Error);
    // Names of any bytes.
    std::filesystem::remove(folder / "state/recent.json");
    EXPECT_NO_THROW(memory.add_recent({{"/\xff.tif"}, {}}));
    // Nowhere to remember anything.
    const Memory none({}, {});
    none.write(settings);
    none.add_recent({{"/a.tif"}, {}});
    none.write_views({"/a.tif"}, {view});
    EXPECT_EQ(none.settings(), Settings{});
}

TEST(Scrolling, IsByAsMuchAsTheFingersMove) {
    // Ten tenths of a notch are a notch.
    EXPECT_NEAR(std::pow(zoom_of_scroll(0.1), 10), zoom_of_scroll(1), 1e-12);
    EXPECT_NEAR(1 - zoom_of_scroll(0.01), 0.01 * -std::log(zoom_of_scroll(1)), 1e-5);
    EXPECT_EQ(zoom_of_scroll(0), 1);
}

TEST(TakeAway, PicturesHaveNamesThatAreFree) {
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(test::scratch_dir("free_names"));
    EXPECT_EQ(free_picture_name(), "picture.png");
    std::ofstream("picture.png") << "";
    EXPECT_EQ(free_picture_name(), "picture-2.png");
    std::ofstream("picture-2.png") << "";
    EXPECT_EQ(free_picture_name(), "picture-3.png");
    std::filesystem::current_path(before);
}

TEST(Folder, HasNeighboursByName) {
    const std::filesystem::path folder = test::scratch_dir("neighbours");
    for (const char* name : {"b.tif", "a.TIF", "c.hgt", "notes.txt", "z.png"})
        std::ofstream(folder / name) << "x";
    std::filesystem::create_directories(folder / "d.tif");
    const auto next = [&](const char* name, int by) {
        return std::filesystem::path(neighbour_in_folder((folder / name).string(), by))
            .filename()
            .string();
    };
    EXPECT_EQ(next("a.TIF", 1), "b.tif");
    EXPECT_EQ(next("b.tif", 1), "c.hgt");
    EXPECT_EQ(next("c.hgt", 1), "a.TIF");
    EXPECT_EQ(next("a.TIF", -1), "c.hgt");
    EXPECT_EQ(next("gone.tif", 1), "a.TIF");  // its place in the order is known still
    EXPECT_EQ(neighbour_in_folder((folder / "d.tif/alone.tif").string(), 1), "");
}

TEST(FileWatch, TellsOfChangesOnceTheyRest) {
    const std::filesystem::path folder = test::scratch_dir("watch");
    std::ofstream(folder / "a.tif") << "1";
    FileWatch watch;
    watch.watch({folder / "a.tif", folder / "b.tif"});
    EXPECT_FALSE(watch.changed());
    std::ofstream(folder / "b.tif") << "2";
    EXPECT_FALSE(watch.changed());  // it may still be written
    EXPECT_TRUE(watch.changed());
    EXPECT_FALSE(watch.changed());
    std::filesystem::last_write_time(
        folder / "a.tif",
        std::filesystem::last_write_time(folder / "a.tif") + std::chrono::seconds(2));
    watch.changed();
    EXPECT_TRUE(watch.changed());
    std::filesystem::remove(folder / "b.tif");
    watch.changed();
    EXPECT_TRUE(watch.changed());
}

TEST(FolderWatch, TellsOfFilesOfItsKindsOnceTheyRest) {
    const std::filesystem::path folder = test::scratch_dir("folder_watch");
    std::filesystem::create_directories(folder / "one");
    std::ofstream(folder / "one/a.glsl") << "1";
    FolderWatch watch;
    watch.watch({folder, folder / "none"}, {".glsl", ".json"});
    const auto tells = [&] {
        EXPECT_FALSE(watch.changed());  // it may still be written
        const bool told = watch.changed();
        EXPECT_FALSE(watch.changed());
        return told;
    };
    EXPECT_FALSE(watch.changed());
    std::ofstream(folder / "one/picture.png") << "3";
    EXPECT_FALSE(watch.changed() || watch.changed());
    std::ofstream(folder / "one/a.glsl") << "2";
    EXPECT_TRUE(tells());
    std::filesystem::rename(folder / "one/a.glsl", folder / "one/b.glsl");
    EXPECT_TRUE(tells());
    std::filesystem::create_directories(folder / "two/deep");
    EXPECT_TRUE(tells());
    std::ofstream(folder / "two/deep/c.json") << "{}";
    EXPECT_TRUE(tells());
    std::filesystem::remove(folder / "two/deep/c.json");
    EXPECT_TRUE(tells());
}

}  // namespace
}  // namespace relevo::viewer::test_document
