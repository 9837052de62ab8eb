// The list of what lies on the ground: its order, light, files, and the sun's figures as files.
#include <algorithm>
#include <fstream>

#include <gmock/gmock.h>

#include "dem/load.h"
#include "light/fields.h"
#include "viewer/layers.h"
#include "viewer/sun_overlay.h"
#include "window/viewer_fixture.h"

namespace relevo::viewer::test_layers {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

scene::Effects only(std::vector<std::string> ids) {
    scene::Effects effects;
    effects.switches.only = std::move(ids);
    return effects;
}

std::vector<Layer> layers_with(const scene::Effects& effects, const OverlayChoice& overlay = {}) {
    Document document;
    document.scene.effects = effects;
    document.overlay = overlay;
    return layers_of(*EffectsModel::of(effects), document);
}

std::vector<std::string> ids_of(const std::vector<Layer>& layers) {
    std::vector<std::string> ids;
    for (const Layer& layer : layers)
        ids.push_back(layer.id);
    return ids;
}

const Layer& find(const std::vector<Layer>& layers, const std::string& id) {
    return *std::ranges::find(layers, id, &Layer::id);
}

constexpr OverlayChoice kHours{.kind = OverlayKind::Hours};

// From top to bottom: names, what is in its own colours, what the sun lights.
TEST(Layers, AreFoundByWhatEffectsDraw) {
    const std::vector<Layer> layers = layers_with(
        only({"sky", "haze", "shadows", "drape", "tracks", "contours", "labels"}), kHours);
    EXPECT_THAT(ids_of(layers), ElementsAre("labels", "tracks", "contours", "overlay", "drape"));
    EXPECT_EQ(find(layers, "labels").group, Layer::Group::Marks);
    EXPECT_EQ(find(layers, "drape").group, Layer::Group::Lit);
    EXPECT_EQ(find(layers, "drape").opacity, "drape.opacity");
    EXPECT_EQ(find(layers, "drape").light, "drape.light");
    EXPECT_EQ(find(layers, "drape").file, "drape.file");
    EXPECT_EQ(find(layers, "tracks").file, "tracks.file");
    EXPECT_EQ(find(layers, "labels").file, "labels.file");
    EXPECT_EQ(find(layers, "contours").file, "");
    EXPECT_THAT(layers_with(only({"sky", "haze"})), IsEmpty());
}

TEST(Layers, LieOverEachOtherByLightAndOrder) {
    scene::Effects effects = only({"drape", "tint", "tracks"});
    EXPECT_THAT(ids_of(layers_with(effects, kHours)),
                ElementsAre("tracks", "overlay", "drape", "tint"));
    OverlayChoice lit = kHours;
    lit.lit = true;
    EXPECT_THAT(ids_of(layers_with(effects, lit)),
                ElementsAre("tracks", "overlay", "drape", "tint"));
    effects.switches.order = {"overlay", "drape", "tracks"};
    EXPECT_THAT(ids_of(layers_with(effects, lit)),
                ElementsAre("tracks", "drape", "overlay", "tint"));
    effects = with_value(effects, "drape.light", "flat");
    EXPECT_THAT(ids_of(layers_with(effects, kHours)),
                ElementsAre("tracks", "drape", "overlay", "tint"));
    effects.switches.order = {"drape", "overlay", "tracks"};
    EXPECT_THAT(ids_of(layers_with(effects, kHours)),
                ElementsAre("tracks", "overlay", "drape", "tint"));
}

TEST(Layers, ChangePlacesWithinTheirGroup) {
    scene::Effects effects = only({"drape", "tint", "tracks", "contours", "labels"});
    std::vector<Layer> layers = layers_with(effects, kHours);
    ASSERT_THAT(ids_of(layers),
                ElementsAre("labels", "tracks", "contours", "overlay", "drape", "tint"));
    EXPECT_FALSE(can_move(layers, 0, -1));
    EXPECT_FALSE(can_move(layers, 0, 1));  // names are over everything
    EXPECT_FALSE(can_move(layers, 1, -1));
    EXPECT_TRUE(can_move(layers, 1, 1));
    EXPECT_FALSE(can_move(layers, 3, 1));  // lit ground is under it
    EXPECT_TRUE(can_move(layers, 4, 1));
    EXPECT_FALSE(can_move(layers, 5, 1));
    effects.switches = moved(effects.switches, layers, 3, -1);
    EXPECT_THAT(effects.switches.order,
                ElementsAre("tint", "drape", "contours", "overlay", "tracks"));
    layers = layers_with(effects, kHours);
    EXPECT_THAT(ids_of(layers),
                ElementsAre("labels", "tracks", "overlay", "contours", "drape", "tint"));
    // Although the manifest of drape has it over tint.
    effects.switches = moved(effects.switches, layers, 4, 1);
    EXPECT_THAT(ids_of(layers_with(effects, kHours)),
                ElementsAre("labels", "tracks", "overlay", "contours", "tint", "drape"));
}

TEST(Layers, ThatAreOffStayInTheListUntilTheyAreRemoved) {
    scene::Effects effects;
    effects.switches.enable = {"contours"};
    effects = with_value(effects, "drape.file", "/maps/old map.tif");
    OverlayChoice hidden = kHours;
    hidden.visible = false;
    EXPECT_THAT(ids_of(layers_with(effects, hidden)), ElementsAre("contours", "drape", "overlay"));
    EXPECT_EQ(layers_with(effects)[1].source, "old map.tif");
    EXPECT_FALSE(layers_with(effects)[1].is_on);
    effects = switched(effects, "contours", false);
    EXPECT_THAT(ids_of(layers_with(effects)), ElementsAre("contours", "drape"));
    EXPECT_FALSE(can_move(layers_with(effects), 0, 1));
    effects = without_layer(effects, "contours", /*is_default=*/false);
    effects = without_layer(effects, "drape", /*is_default=*/false);
    EXPECT_THAT(layers_with(effects), IsEmpty());
    EXPECT_THAT(effects.settings, IsEmpty());
    const auto model = EffectsModel::of(effects);
    EXPECT_THAT(further_layers(*model, {}), testing::IsSupersetOf({"contours", "drape", "tracks"}));
    EXPECT_THAT(further_layers(*model, {}), testing::Not(testing::Contains("haze")));
}

TEST(Layers, AreLitByAWordOrASwitch) {
    scene::Effects effects = only({"drape", "tint"});
    auto model = EffectsModel::of(effects);
    EXPECT_TRUE(is_lit(*model, "drape.light"));
    EXPECT_TRUE(is_lit(*model, "tint.lit"));
    for (const char* address : {"drape.light", "tint.lit"})
        effects = with_value(effects, address, light_value(*model, address, false));
    model = EffectsModel::of(effects);
    EXPECT_FALSE(is_lit(*model, "drape.light"));
    EXPECT_FALSE(is_lit(*model, "tint.lit"));
    for (const Layer& layer : layers_with(effects))
        EXPECT_EQ(layer.group, Layer::Group::Flat) << layer.id;
}

// ---- figures of the sun

const sun::Zone kNewYork = sun::Zone::named("America/New_York");

FigureWanted figure_with(const OverlayChoice& choice) {
    return figure_of(choice, sun::parse_time("2026-12-24T16:00:00Z").utc, kNewYork, "standard");
}

TEST(SunFigures, HaveTheDaysOfTheirPeriod) {
    const auto title = [](const OverlayChoice& choice) { return title_of(figure_with(choice)); };
    OverlayChoice range{.kind = OverlayKind::Irradiation, .period = OverlayPeriod::Range};
    range.first = {2026, 10, 20};
    range.last = {2026, 10, 28};  // with a change of the clocks
    EXPECT_EQ(title(range), "Irradiation, 20 Oct to 28 Oct 2026");
    EXPECT_EQ(sun::to_iso(figure_with(range).time.begin, kNewYork), "2026-10-20T00:00:00-04:00");
    EXPECT_EQ(sun::to_iso(figure_with(range).time.end, kNewYork), "2026-10-29T00:00:00-04:00");
    range.last = {2027, 1, 2};
    EXPECT_EQ(title(range), "Irradiation, 20 Oct 2026 to 2 Jan 2027");
    EXPECT_EQ(sun::to_iso(figure_with(range).time.end, kNewYork), "2027-01-03T00:00:00-05:00");
    range.last = {2026, 10, 1};
    EXPECT_EQ(title(range), "Irradiation, 20 Oct 2026");
    range.period = OverlayPeriod::Year;
    EXPECT_EQ(title(range), "Irradiation, 2026");
    // First and last light are of a day.
    range.kind = OverlayKind::FirstLight;
    EXPECT_EQ(title(range), "First light, 24 Dec 2026");
    range.kind = OverlayKind::LastLight;
    EXPECT_EQ(title(range), "Last light, 24 Dec 2026");
}

/// A wall in the west of a plain at 46 N, 40 m high: at sunset its shadow grows by posts a minute.
const dem::Posts& walled() {
    static const dem::Heightfield field =
        test::field_of(40, 24, {500000, 30, 0, 5100000, 0, -30}, "EPSG:32632",
                       [](int x, int) { return x == 4 ? 140.0 : 100.0; });
    static const dem::Posts posts(field);
    return posts;
}

OverlayWanted evening(OverlayKind kind) {
    OverlayWanted wanted;
    wanted.figure.kind = kind;
    wanted.figure.time.begin = sun::parse_time("2026-03-20T17:15:00Z").utc;
    wanted.figure.time.end = wanted.figure.time.begin + 3600.0;
    return wanted;
}

bool same_values(const OverlayWanted& a, const OverlayWanted& b) {
    const figure::Raster first = figure::raster_of(*a.figure.of(walled()), walled());
    const figure::Raster second = figure::raster_of(*b.figure.of(walled()), walled());
    return std::ranges::equal(first.values, second.values);
}

TEST(SunFigures, OfOtherAirOrTimeAreNotTheSame) {
    for (const OverlayKind kind : {OverlayKind::Hours, OverlayKind::Mask}) {
        const OverlayWanted wanted = evening(kind);
        EXPECT_TRUE(same_figures(wanted, evening(kind)));
        OverlayWanted airless = wanted;
        airless.figure.refraction = "none";
        EXPECT_FALSE(same_values(wanted, airless));
        EXPECT_FALSE(same_figures(wanted, airless));
        OverlayWanted earlier = wanted;
        earlier.figure.time.begin = wanted.figure.time.begin + -1800.0;
        EXPECT_FALSE(same_values(wanted, earlier));
        EXPECT_FALSE(same_figures(wanted, earlier));
        OverlayWanted other = wanted;
        other.figure.kind = OverlayKind::SkyView;
        EXPECT_FALSE(same_figures(wanted, other));
    }
    OverlayWanted shorter = evening(OverlayKind::Hours);
    shorter.figure.time.end = shorter.figure.time.begin + 600.0;
    EXPECT_FALSE(same_values(shorter, evening(OverlayKind::Hours)));
    EXPECT_FALSE(same_figures(shorter, evening(OverlayKind::Hours)));
}

TEST(SunFigures, OfWhatTheyDoNotDependOnAreTheSame) {
    const auto later = [](OverlayKind kind, OverlayPeriod period, const char* refraction) {
        OverlayWanted wanted;
        wanted.figure =
            figure_of({.kind = kind, .period = period}, sun::parse_time("2026-12-24T17:00:00Z").utc,
                      kNewYork, refraction);
        return wanted;
    };
    using enum OverlayPeriod;
    EXPECT_TRUE(same_figures(later(OverlayKind::Mask, Day, "none"),
                             later(OverlayKind::Mask, Year, "none")));
    OverlayWanted mask = later(OverlayKind::Mask, Day, "none");
    mask.figure.zone = sun::Zone();
    EXPECT_TRUE(same_figures(mask, later(OverlayKind::Mask, Day, "none")));
    OverlayWanted sky;
    sky.figure = figure_with({.kind = OverlayKind::SkyView});
    EXPECT_TRUE(same_figures(sky, later(OverlayKind::SkyView, Week, "none")));
}

TEST(SunFigures, AreWrittenAsByTheCommandLine) {
    const std::string dem = (test::source_dir() / "data/dem/jacksboro.tif").string();
    const auto folder = test::scratch_dir("figures");
    std::filesystem::current_path(folder);
    dem::Source source = dem::Source::open(dem);
    dem::Heightfield field = dem::load(source, dem::LoadOptions{}.memory);
    OverlayWanted wanted;
    wanted.dem = std::make_shared<const session::LoadedDem>(session::LoadedDem{
        std::make_shared<const dem::Source>(std::move(source)), std::move(field)});
    wanted.dems = {dem};
    OverlayChoice few{.kind = OverlayKind::Hours, .period = OverlayPeriod::Range};
    few.first = {2026, 3, 1};
    few.last = {2026, 3, 3};
    OverlayChoice many = few;
    many.kind = OverlayKind::Irradiation;
    many.last = {2026, 3, 9};  // with a change of the clocks
    const std::pair<OverlayChoice, const char*> cases[] = {
        {few, "--from 2026-03-01 --to 2026-03-03"},
        {many, "--from 2026-03-01 --to 2026-03-09 --bands global"},
        {{.kind = OverlayKind::FirstLight}, "--date 2026-12-24 --bands first"},
        {{.kind = OverlayKind::LastLight}, "--date 2026-12-24 --bands last"},
    };
    int number = 0;
    for (const auto& [choice, options] : cases) {
        wanted.figure = figure_with(choice);
        const OverlaySave save(wanted, nullptr, [] {});
        ASSERT_TRUE(test::WindowedProgram::wait([&] { return save.is_done(); }));
        ASSERT_EQ(save.result(), fmt::format("relevo-{}.tif", ++number));
        const std::string command =
            fmt::format("{} -q sun hours {} {} -o command.tif --overwrite > /dev/null",
                        (test::build_dir() / "bin/relevo").string(), dem, options);
        ASSERT_EQ(std::system(command.c_str()), 0) << command;
        EXPECT_EQ(read_text(folder / save.result(), "test"),
                  read_text(folder / "command.tif", "test"))
            << options;
        // The time that stamps have is that of the file.
        const dem::Posts posts(wanted.dem->field);
        const output::RasterMetadata about = wanted.figure.of(posts)->metadata(posts);
        const auto computed = session::overlay_time({about.begin(), about.end()});
        const auto read = session::time_of(scene::Overlay{.file = save.result()});
        const geo::Geodetic place = wanted.dem->field.grid.center();
        EXPECT_EQ(session::clock_text(*computed, "", place), session::clock_text(*read, "", place));
    }
}

}  // namespace
}  // namespace relevo::viewer::test_layers

namespace relevo {
namespace {

constexpr glm::ivec4 kGroundPixels{400, 120, 640, 560};

class LayersInWindow : public Viewer {
  protected:
    /// Sun hours of a day in June, over a scene of a December afternoon.
    void open_with_hours(const std::vector<std::string>& more) {
        test::WindowedProgram hours(display_, test::build_dir() / "bin/relevo",
                                    {"-q", "sun", "hours", dem_, "--date", "2026-06-21",
                                     "--overwrite", "-o", (folder_ / "hours.tif").string()});
        ASSERT_EQ(hours.status(), 0) << hours.output();
        std::vector<std::string> arguments{dem_, "--time", "2026-12-21T21:00:00Z", "--overlay",
                                           (folder_ / "hours.tif").string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        open(arguments);
    }
    void click(int x, int y) const {
        act({"mousemove", std::to_string(x), std::to_string(y)});
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        act({"click", "1"});
    }
};

// A raster of another time than the scene's: its date is stamped, shadows are off unless asked for.
TEST_F(LayersInWindow, AnOverlayOfAnotherTimeHasNoShadowsUnlessAskedFor) {
    open_with_hours({"--overlay-opacity", "0.4", "--stamp", "date"});
    EXPECT_FALSE(scene()["overlay"]["cast_shadows"].get<bool>());
    expect_picture_is_its_capture();
    const image::Image8 without = display_.screen();
    program_.reset();
    std::filesystem::remove(folder_ / "relevo-1.png");
    std::filesystem::remove(folder_ / "captured.png");
    open_with_hours({"--overlay-opacity", "0.4", "--stamp", "date", "--overlay-shadows"});
    EXPECT_GT(count_other(without, display_.screen(), kGroundPixels), 5000);
}

// The panel: order, shadows, hidden and removed layers are those of the scene that is saved.
TEST_F(LayersInWindow, AreSwitchedMovedAndRemovedInThePanel) {
    open_with_hours({"--overlay-opacity", "0.4", "--enable", "contours"});
    constexpr int kSwitch = 19, kDown = 301, kRemove = 325;
    constexpr int kFirst = 251, kSecond = 326, kShadows = 398;  // rows
    const auto saved = [&](const std::function<bool(const nlohmann::json&)>& holds) {
        return wait([&] { return holds(scene()); });
    };
    ASSERT_TRUE(changes([&] { click(40, kShadows); }, 0.005));
    EXPECT_TRUE(saved([](const auto& s) { return s["overlay"]["cast_shadows"] == true; }));
    ASSERT_TRUE(changes([&] { click(kDown, kFirst); }, 0.005));
    EXPECT_TRUE(saved([](const auto& s) {
        return s["effects"]["order"] == nlohmann::json({"contours", "overlay"});
    }));
    act({"key", "ctrl+z"});
    EXPECT_TRUE(saved([](const auto& s) { return !s["effects"].contains("order"); }));
    ASSERT_TRUE(settles());
    ASSERT_TRUE(changes([&] { click(kSwitch, kSecond); }));
    EXPECT_TRUE(saved([](const auto& s) { return !s.contains("overlay"); }));
    ASSERT_TRUE(changes([&] { click(kSwitch, kSecond); }));
    EXPECT_TRUE(saved([](const auto& s) { return s.contains("overlay"); }));
    ASSERT_TRUE(changes([&] { click(kRemove, kFirst); }, 0.005));
    EXPECT_TRUE(saved([](const auto& s) {
        return !s["effects"].contains("enable") && !s["effects"].contains("disable");
    }));
    // Only the overlay is left, in the first row.
    ASSERT_TRUE(changes([&] { click(kRemove, kFirst); }));
    EXPECT_TRUE(saved([](const auto& s) { return !s.contains("overlay"); }));
}

TEST_F(LayersInWindow, HaveTheSettingsOfTheirEffects) {
    open({dem_, "--only", "contours"});
    click(60, 300);
    ASSERT_TRUE(settles());
    click(152, 375);  // heights on the lines
    EXPECT_TRUE(wait([&] {
        return scene()["effects"].dump().find("contours.") != std::string::npos;
    })) << scene().dump();
}

// A panel that scrolls below a resting cursor changes no value.
TEST_F(LayersInWindow, TheWheelMovesASliderToWhichTheCursorWasMoved) {
    open({dem_, "--only", "contours"});
    click(60, 300);
    ASSERT_TRUE(settles());
    const auto values = [&] { return scene()["effects"].value("set", nlohmann::json()).dump(); };
    const std::string before = values();
    act({"mousemove", "60", "323"});  // on the name of the row
    act({"click", "--repeat", "3", "--delay", "100", "5"});
    ASSERT_TRUE(settles());
    EXPECT_EQ(values(), before);
    act({"click", "--repeat", "9", "--delay", "100", "4"});  // the panel is back
    ASSERT_TRUE(settles());
    act({"mousemove", "220", "323"});
    ASSERT_TRUE(settles(3));
    act({"click", "--repeat", "2", "--delay", "150", "4"});
    EXPECT_TRUE(wait([&] {
        return scene()["effects"].dump().find("contours.interval_m") != std::string::npos;
    })) << scene().dump();
    act({"mousemove", "900", "500", "key", "ctrl+z", "key", "ctrl+z"});
    EXPECT_TRUE(wait([&] { return values() == before; }));
}

// What the window's picture shows of a choice is what a capture of the saved scene shows.
TEST_F(LayersInWindow, InAnotherOrderAreThoseOfACapture) {
    open_with_hours({"--overlay-opacity", "0.7", "--enable", "contours", "--order",
                     "contours,overlay", "--overlay-light", "lit", "--stamp", "date"});
    expect_picture_is_its_capture();
}

}  // namespace
}  // namespace relevo
