// Lens, exposure, exaggeration and zone of the window, and places by their names.
#include <fstream>

#include <gmock/gmock.h>

#include "base/units.h"
#include "sun/moon.h"
#include "sun/time.h"
#include "viewer/find_sheet.h"
#include "viewer/navigation.h"
#include "window/viewer_fixture.h"

namespace relevo::test_view_panel {
namespace {

TEST(FindNames, AreThoseOfTheFilesThatAreShown) {
    const auto file = test::scratch_dir() / "summits.csv";
    std::ofstream(file) << "name,lat,lon\nGrosser Bettelwurf,47.34,11.52\nBettelwurfhuette,47.33,"
                           "11.53\nHafelekar,47.31,11.39\n";
    scene::Effects effects;
    effects.settings = {{"labels.file", file.string()}};
    const auto names = [&](const char* text) {
        std::vector<std::string> found;
        const auto model = viewer::EffectsModel::of(effects);
        for (const viewer::FoundPlace& place : viewer::find_names(text, *model, 10))
            found.push_back(place.name);
        return found;
    };
    EXPECT_THAT(names("bettel"), testing::IsEmpty());  // the effect is off
    effects.switches.enable = {"labels"};
    EXPECT_THAT(names("bettel"), testing::ElementsAre("Bettelwurfhuette", "Grosser Bettelwurf"));
    EXPECT_THAT(names(" HAFEL "), testing::ElementsAre("Hafelekar"));
    EXPECT_THAT(names(""), testing::IsEmpty());
    effects.settings = {{"labels.file", "/missing.csv"}};
    EXPECT_THAT(names("bettel"), testing::IsEmpty());
}

TEST(FindSheet, SaysWhereAPlaceIs) {
    const dem::Grid grid(101, 101, {179.5, 0.01, 0, 0.5, 0, -0.01},
                         geo::Crs::parse("EPSG:4326", "test"));
    EXPECT_EQ(viewer::way_text(geo::geodetic_deg(0, -179.8), grid),
              "22.3 km E of the DEM's middle");
    EXPECT_EQ(viewer::way_text(geo::geodetic_deg(-1, 180), grid), "110.6 km S, outside the DEM");
}

TEST_F(Viewer, GoesToAPlaceByItsName) {
    std::ofstream(folder_ / "own.csv")
        << "name,lat,lon\nOwn one,36.2,-84.1\nOwn two,36.42,-84.35\n";
    open({dem_, "--only", "labels", "--set", "labels.file=" + (folder_ / "own.csv").string(),
          "--time", "2026-06-21T18:00:00Z"});
    const auto distance_m = [&](double lat_deg, double lon_deg) {
        const nlohmann::json camera = resting_scene()["camera"];
        return geo::geodesic(geo::geodetic_deg(camera["eye"][0], camera["eye"][1]),
                             geo::geodetic_deg(lat_deg, lon_deg))
            .distance_m;
    };
    const auto find = [&](const char* name, const std::vector<std::string>& keys) {
        act({"key", "ctrl+f"});
        ASSERT_TRUE(settles(3));
        act({"type", "--delay", "60", name});
        for (const std::string& key : keys) {
            ASSERT_TRUE(settles(3));
            act({"key", key});
        }
        ASSERT_TRUE(settles());
    };
    ASSERT_GT(distance_m(36.218, -84.155), 20e3);
    find("rocky top", {"Return"});
    EXPECT_LT(distance_m(36.218, -84.155), 14e3);
    find("innsbruck", {"Return"});  // outside the DEM
    EXPECT_LT(distance_m(36.218, -84.155), 14e3);
    find("own", {"Down", "Return"});  // the second row
    EXPECT_LT(distance_m(36.42, -84.35), 14e3);
}

TEST_F(Viewer, GoesOnWithoutItsNames) {
    const std::filesystem::path share = folder_ / "share",
                                built = test::build_dir() / "share/relevo";
    std::filesystem::create_directories(share / "data/names");
    for (const char* const folder : {"", "data"})
        for (const auto& entry : std::filesystem::directory_iterator(built / folder))
            if (!std::filesystem::exists(share / folder / entry.path().filename()))
                std::filesystem::create_symlink(std::filesystem::canonical(entry),
                                                share / folder / entry.path().filename());
    std::ofstream(share / "data/names/places.tsv.gz") << "cut";
    environment_ = {"RELEVO_SHARE=" + share.string()};
    open({dem_, "--only", "--time", "2026-06-21T18:00:00Z"});
    const nlohmann::json before = resting_scene()["camera"];
    act({"key", "ctrl+f"});
    ASSERT_TRUE(settles(3));
    act({"type", "--delay", "60", "rocky top"});
    act({"key", "Return", "ctrl+a"});
    EXPECT_TRUE(settles());
    act({"type", "--delay", "60", "36.3,-84.2"});
    act({"key", "Return"});
    EXPECT_TRUE(settles());
    EXPECT_NE(resting_scene()["camera"], before);
}

TEST(EffectsModel, KnowsWhatAViewDoesNotShow) {
    using testing::Contains, testing::Not;
    scene::Effects effects;
    const auto all = viewer::EffectsModel::of(effects);
    EXPECT_THAT(all->unseen_outside, Contains("haze"));
    EXPECT_THAT(all->unseen_within, Not(Contains("haze")));
    EXPECT_THAT(all->unseen_within, Contains("block"));
    EXPECT_THAT(all->unseen_outside, Not(Contains("block")));
    effects.switches.disable = {"block"};  // then there is air everywhere
    EXPECT_THAT(viewer::EffectsModel::of(effects)->unseen_outside, Not(Contains("haze")));
}

TEST_F(Viewer, LooksToTheMoon) {
    const std::string at = "2026-06-29T04:00:00Z";  // a day before it is full, in the evening
    open({dem_, "--only", "--time", at});
    act({"key", "l"});
    ASSERT_TRUE(settles());
    const nlohmann::json camera = resting_scene()["camera"];
    const sun::MoonPosition moon =
        sun::moon_position(sun::parse_time(at).utc,
                           geo::geodetic_deg(camera["eye"][0], camera["eye"][1], camera["eye"][2]));
    ASSERT_GT(degrees(moon.elevation_rad), 10);
    // In the middle of what the side panel, the menu and the time bar leave free.
    const double pitch = radians(camera["pitch"].get<double>());
    const double right = moon.azimuth_rad - radians(camera["heading"].get<double>());
    const double level = std::cos(moon.elevation_rad), up = std::sin(moon.elevation_rad);
    const double ahead = level * std::cos(right) * std::cos(pitch) + up * std::sin(pitch);
    const double above = up * std::cos(pitch) - level * std::cos(right) * std::sin(pitch);
    const double tan_y = std::tan(radians(camera["fov"].get<double>()) / 2);
    EXPECT_NEAR(level * std::sin(right) / ahead / (tan_y * 1.6), 360.0 / 1280, 0.002);
    EXPECT_NEAR(above / ahead / tan_y, (44 - 22) / 800.0, 0.01);  // and refraction
}

/// With the panel View open.
class ViewPanel : public Viewer {
  protected:
    void open_panel() { open_panel_of({dem_}); }
    void open_panel_of(std::vector<std::string> words) {
        words.insert(words.end(), {"--only", "--time", "2026-06-21T18:00:00Z"});
        open(words);
        // The heading below Sun.
        act({"mousemove", "190", "173", "click", "1"});
        act({"mousemove", "900", "60"});
        ASSERT_TRUE(settles());
    }
    /// Drags a slider of the panel. @param y  of its row
    void slide(int y, int from_x, int to_x) { drag(1, from_x, y, to_x - from_x, 0); }
    static constexpr int kLens = 199, kExposure = 251, kHeights = 277, kZone = 303, kSurface = 355;
};

TEST_F(ViewPanel, LensExposureAndHeightsAreThoseOfTheScene) {
    open_panel();
    const nlohmann::json before = scene();
    slide(kLens, 100, 200);
    EXPECT_LT(resting_scene()["camera"]["fov"].get<double>(),
              before["camera"]["fov"].get<double>() - 3);
    const image::Image8 dark = display_.screen();
    slide(kExposure, 130, 200);
    EXPECT_GT(resting_scene()["picture"]["exposure"].get<double>(), 0.5);
    EXPECT_TRUE(
        wait([&] { return test::brightness(display_.screen()) > test::brightness(dark) + 5; }));
    const nlohmann::json flat = resting_scene();
    slide(kHeights, 80, 200);
    ASSERT_TRUE(wait([&] { return resting_scene()["exaggeration"].get<double>() > 1.5; }));
    ASSERT_TRUE(settles());
    // The eye is where it was over the ground: heights in scenes are not exaggerated.
    const nlohmann::json high = resting_scene();
    for (int i = 0; i < 2; ++i)
        EXPECT_NEAR(high["camera"]["eye"][i].get<double>(), flat["camera"]["eye"][i].get<double>(),
                    1e-6);
    EXPECT_NEAR(high["camera"]["eye"][2].get<double>(), flat["camera"]["eye"][2].get<double>(), 1);
    // Back by undo, with the same eye.
    act({"key", "ctrl+z"});
    ASSERT_TRUE(wait([&] { return resting_scene()["exaggeration"].get<double>() == 1; }));
    EXPECT_NEAR(resting_scene()["camera"]["eye"][2].get<double>(),
                flat["camera"]["eye"][2].get<double>(), 1);
}

TEST_F(ViewPanel, TimesAreShownInAnotherZone) {
    open_panel();
    act({"mousemove", "150", std::to_string(kZone), "click", "1"});
    act({"type", "--delay", "60", "Asia/Tokyo"});
    act({"key", "Return"});
    ASSERT_TRUE(settles());  // until then keys are text
    nlohmann::json now;
    EXPECT_TRUE(wait([&] {
        now = scene();
        return now["time"]["at"].get<std::string>().ends_with("+09:00");
    })) << now;
}

/// A field with a house, at posts two metres apart.
TEST_F(ViewPanel, HousesInTheHeightsAreDrawnAndTakenBack) {
    std::ofstream asc(folder_ / "roofs.asc");
    asc << "ncols 120\nnrows 120\nxllcorner 680000\nyllcorner 5237000\ncellsize 2\n";
    for (int row = 0; row < 120; ++row)
        for (int column = 0; column < 120; ++column)
            asc << (row > 40 && row < 60 && column > 50 && column < 60 ? 612 : 600)
                << (column == 119 ? "\n" : " ");
    asc.close();
    open_panel_of({(folder_ / "roofs.asc").string(), "--crs", "EPSG:32632"});
    const auto is_on = [&] { return scene().value("surface", false); };
    EXPECT_FALSE(is_on());
    act({"mousemove", "18", std::to_string(kSurface), "click", "1"});
    EXPECT_TRUE(wait(is_on));
    ASSERT_TRUE(settles());
    act({"mousemove", "900", "500", "key", "ctrl+z"});
    EXPECT_TRUE(wait([&] { return !is_on(); }));
}

TEST_F(Viewer, KeysReachMenusAndPanelsAndGoBackToTheScene) {
    open({dem_, "--only", "--time", "2026-06-21T18:00:00Z"});
    const auto press = [&](const char* key) {
        act({"key", key});
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
    };
    const double heading_deg = scene()["camera"]["heading"];
    ASSERT_GT(heading_deg, 1);
    // The second item of the third menu: north up.
    for (const char* key : {"F10", "Right", "Right", "Down", "Down", "space"})
        press(key);
    const auto is_north = [&] {
        return std::abs(scene()["camera"]["heading"].get<double>()) < 1e-6;
    };
    EXPECT_TRUE(wait(is_north));
    press("Escape");
    // In the panels arrows do not move the camera; afterwards they do.
    press("F6");
    for (int i = 0; i < 3; ++i)
        press("Left");
    EXPECT_TRUE(is_north());
    press("Escape");
    press("Left");
    EXPECT_TRUE(wait([&] { return !is_north(); }));
}

/// Esc closes the list, menu or calendar that is open, and nothing else.
TEST_F(Viewer, EscClosesMenusListsAndTheCalendar) {
    open({dem_, "--only", "--time", "2026-06-21T18:00:00Z"});
    const auto press = [&](std::vector<std::string> keys) {
        act(keys);
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
    };
    const nlohmann::json before = scene();
    const auto is_closed_again = [&](const glm::ivec4& area, const glm::ivec2& at,
                                     const char* button) {
        press({"mousemove", "700", "700"});
        ASSERT_TRUE(settles());
        const image::Image8 shown = display_.screen();
        ASSERT_TRUE(changes_in(area, [&] {
            press({"mousemove", std::to_string(at.x), std::to_string(at.y), "click", button});
            press({"mousemove", "700", "700"});
        }));
        press({"key", "Escape"});
        EXPECT_TRUE(wait([&] { return count_other(shown, display_.screen(), area) < 30; }));
    };
    is_closed_again({150, 560, 200, 180}, {210, 783}, "1");  // the calendar of the date
    // A list of the export sheet: the sheet stays for the next Esc.
    const glm::ivec4 sheet{300, 150, 300, 260};
    const image::Image8 without = display_.screen();
    press({"key", "ctrl+p"});
    is_closed_again(sheet, {420, 192}, "1");
    EXPECT_GT(count_other(without, display_.screen(), sheet), 1000);
    press({"key", "Escape"});
    EXPECT_TRUE(wait([&] { return count_other(without, display_.screen(), sheet) < 30; }));
    EXPECT_EQ(scene()["time"], before["time"]);
}

}  // namespace
}  // namespace relevo::test_view_panel
