// Files of all kinds that are opened in the window, and the sheet for DEMs that do not say enough.
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>

#include "base/error.h"
#include "base/units.h"
#include "effect/registry.h"
#include "viewer/crs_suggestions.h"
#include "viewer/file_kind.h"
#include "viewer/file_place.h"
#include "viewer/import_preview.h"
#include "viewer/window_words.h"
#include "window/viewer_fixture.h"

namespace relevo::test_open_files {
namespace {

using testing::HasSubstr;
using viewer::FileKind;

std::string write(const std::string& name, const std::string& text) {
    const auto path = test::scratch_dir() / name;
    std::ofstream(path, std::ios::binary) << text;
    return path.string();
}

/// A grid that rises to the north-west, without a CRS.
std::string grid_text(const std::string& nodata = "-9999") {
    std::string text =
        "ncols 40\nnrows 30\nxllcorner 450000\nyllcorner 400000\ncellsize 10\n"
        "NODATA_value " +
        nodata + "\n";
    for (int row = 0; row < 30; ++row)
        for (int column = 0; column < 40; ++column)
            text += fmt::format("{}{}", 1000 + 4 * (30 - row) + 4 * (40 - column),
                                column == 39 ? "\n" : " ");
    return text;
}

TEST(FileKind, ListsOfFilesHaveWhatCanBeOpened) {
    for (const char* const name : {"Walk.GPX", "a/huts.csv", "x.geojson", "scene.json", "p.jpg"})
        EXPECT_TRUE(viewer::is_name_of_layer(name)) << name;
    for (const char* const name : {"notes.txt", "gpx", "walk.gpx.part"})
        EXPECT_FALSE(viewer::is_name_of_layer(name)) << name;
}

TEST(FileKind, IsSeenInNameAndContents) {
    using viewer::kind_of_file;
    const std::string dem = (test::source_dir() / "data/dem/jacksboro.tif").string();
    EXPECT_EQ(kind_of_file(dem), FileKind::Dem);
    EXPECT_EQ(kind_of_file(write("grid.asc", grid_text())), FileKind::Dem);
    EXPECT_EQ(kind_of_file("/missing.tif"), FileKind::Dem);
    EXPECT_EQ(kind_of_file(write("no.tif", "nothing")), FileKind::Dem);
    EXPECT_EQ(kind_of_file(write("scene.json", R"({"format": 1, "dem": {"files": ["a"]}})")),
              FileKind::Scene);
    EXPECT_EQ(kind_of_file(write("job.json", R"({"format": 1, "sweep": []})")), FileKind::Job);
    const auto feature = [](const char* geometry) {
        return fmt::format(R"({{"type": "FeatureCollection", "features": [{{"type": "Feature",
            "geometry": {{"type": "{}", "coordinates": []}}, "properties": {{}}}}]}})",
                           geometry);
    };
    EXPECT_EQ(kind_of_file(write("huts.geojson", feature("Point"))), FileKind::Places);
    EXPECT_EQ(kind_of_file(write("way.json", feature("LineString"))), FileKind::Lines);
    const auto located = [](const char* geometry) {
        return fmt::format(R"({{"type": "FeatureCollection", "features": [{{"type": "Feature",
            "properties": {{"location": "a.tif"}}, "geometry": {{"type": "{}", "coordinates":
            [[[8, 46], [9, 46], [9, 47], [8, 46]]]}}}}]}})",
                           geometry);
    };
    EXPECT_EQ(kind_of_file(write("index.geojson", located("Polygon"))), FileKind::Dem);
    EXPECT_EQ(kind_of_file(write("towns.geojson", located("Point"))), FileKind::Places);
    EXPECT_EQ(kind_of_file(write("huts.csv", "name,lat,lon\n")), FileKind::Places);
    EXPECT_EQ(kind_of_file(write("huts.gpx", "<gpx><wpt lat='1' lon='2'/></gpx>")),
              FileKind::Places);
    EXPECT_EQ(kind_of_file(write("way.gpx", "<gpx><trk><trkseg><trkpt/></trkseg></trk></gpx>")),
              FileKind::Lines);
    // Files that lie.
    for (const char* odd : {R"({"type": "Feature", "geometry": {"type": null}})",
                            R"({"type": "Feature", "geometry": 7})", R"({"type": 7})", "[[[", "",
                            R"({"type": "FeatureCollection", "features": {"a": [1]}})"})
        kind_of_file(write("odd.json", odd));
    std::string deep;
    for (int i = 0; i < 100'000; ++i)
        deep += R"({"type":"Feature","geometry":)";
    EXPECT_EQ(kind_of_file(write("deep.json", deep + "7" + std::string(100'000, '}'))),
              FileKind::Lines);
    const auto picture = test::scratch_dir() / "plain.png";
    image::write(picture, image::Image8(8, 8, 3), {}, /*overwrite=*/true);
    EXPECT_EQ(kind_of_file(picture.string()), FileKind::Overlay);
    image::write(picture, image::Image8(8, 8, 3), {{"relevo:scene", "{}"}}, /*overwrite=*/true);
    EXPECT_EQ(kind_of_file(picture.string()), FileKind::Picture);
}

TEST(FileKind, EffectsForPlacesAndLinesAreFoundByWhatTheyDraw) {
    const effect::Registry registry = effect::Registry::load_installed();
    EXPECT_EQ(viewer::file_text_for(FileKind::Places, registry), "labels.file");
    EXPECT_EQ(viewer::file_text_for(FileKind::Lines, registry), "tracks.file");
    const effect::Registry none;
    EXPECT_EQ(viewer::file_text_for(FileKind::Lines, none), "");
}

TEST(ImportPreview, ShowsTheDemAsTheOptionsHaveItRead) {
    const std::string file = write("grid.asc", grid_text());
    const auto lacking = viewer::preview_of({{file}, {}, 64});
    EXPECT_THAT(lacking->error, HasSubstr("coordinate system"));
    EXPECT_TRUE(lacking->picture.values.empty());
    const auto shown = viewer::preview_of({{file}, {.crs = "EPSG:31287"}, 64});
    EXPECT_EQ(shown->error, "");
    EXPECT_THAT(shown->text, HasSubstr("40 x 30 posts, 0.393 x 0.293 km"));
    EXPECT_THAT(shown->text, HasSubstr("MGI / Austria Lambert"));
    EXPECT_THAT(shown->text, HasSubstr("heights 1008 to 1280 m"));
    // Slopes that fall to the south-east are dark under light from the north-west.
    const int middle = shown->picture.at(20, 15, 0);
    EXPECT_LT(middle, 160);
    const auto feet = viewer::preview_of({{file}, {.crs = "EPSG:31287", .unit = "ft"}, 64});
    EXPECT_THAT(feet->text, HasSubstr("heights 307 to 390 m"));
    // A void is transparent.
    const auto holed = viewer::preview_of({{file}, {.crs = "EPSG:31287", .nodata = 1280}, 64});
    EXPECT_EQ(holed->picture.at(0, 0, 3), 0);
    EXPECT_EQ(holed->picture.at(20, 15, 3), 255);
}

TEST(CrsSuggestions, AreThoseThatTheCoordinatesCanBeIn) {
    const std::string jacksboro = (test::source_dir() / "data/dem/jacksboro.tif").string();
    const auto codes = [&](const std::string& name, const char* corner, const std::string& other) {
        std::string text = grid_text();
        text.replace(text.find("xllcorner"), text.find("cellsize") - text.find("xllcorner"),
                     corner);
        std::vector<std::string> found;
        for (const auto& each : viewer::suggest_crs({{write(name, text)}}, {{other}}))
            found.push_back(each.crs.code);
        return found;
    };
    // UTM 16 N around Jacksboro.
    constexpr const char* kUtm = "xllcorner 740000\nyllcorner 4020000\n";
    EXPECT_THAT(codes("grid.asc", kUtm, jacksboro),
                testing::AllOf(testing::Contains("EPSG:32616"), testing::SizeIs(testing::Gt(3)),
                               testing::Not(testing::Contains("EPSG:4326"))));
    EXPECT_THAT(codes("grid.asc", kUtm, "/missing.tif"), testing::IsEmpty());
    // Not ETRS89 / UTM zone 32N (N-E), which differs by the order of axes alone.
    constexpr const char* kTyrol = "xllcorner 680000\nyllcorner 5235000\n";
    const std::string tyrol = test::scratch_dir("tyrol") / "N47E011.hgt";
    std::ofstream(tyrol, std::ios::binary) << std::string(2 * 1201 * 1201, '\1');
    EXPECT_THAT(codes("tyrol.asc", kTyrol, tyrol),
                testing::AllOf(testing::Contains("EPSG:25832"),
                               testing::Not(testing::Contains("EPSG:3044"))));
    // A code in the name, if the coordinates can be in it.
    EXPECT_THAT(codes("dgm_32632.asc", kUtm, "/missing.tif"), testing::ElementsAre("EPSG:32632"));
    EXPECT_THAT(codes("dgm_2056.asc", kUtm, "/missing.tif"), testing::IsEmpty());
    EXPECT_THAT(viewer::suggest_crs({{jacksboro}}, {}).size(), 1u);  // degrees
    EXPECT_THAT(viewer::suggest_crs({{write("no.tif", "nothing")}}, {}), testing::IsEmpty());
    EXPECT_THAT(viewer::where_text(geo::geodetic_deg(47.2627, 11.3945)),
                HasSubstr("near Innsbruck (AT), 47.26"));
}

TEST(FilePlace, IsOnTheDemOrOutside) {
    const dem::Grid dem =
        dem::Source::open((test::source_dir() / "data/dem/jacksboro.tif").string()).grid();
    const auto words = [&](FileKind kind, const std::string& file) {
        return viewer::words_of(viewer::place_of_file(kind, file, dem), kind, dem);
    };
    const std::string huts = write("huts.csv", "name,lat,lon\nTop,36.36,-84.23\nFar,47,11\n");
    EXPECT_THAT(words(FileKind::Places, huts),
                HasSubstr("1 of 2 places are on the DEM, around 6.49 km NNE"));
    EXPECT_EQ(words(FileKind::Places, write("far.csv", "name,lat,lon\nFar,47,11\n")),
              "outside the DEM");
    const auto way = [](const char* from, const char* to) {
        return fmt::format(
            "<gpx version='1.1' xmlns='http://www.topografix.com/GPX/1/1'><trk>"
            "<trkseg><trkpt {}/><trkpt {}/></trkseg></trk></gpx>",
            from, to);
    };
    EXPECT_THAT(words(FileKind::Lines,
                      write("way.gpx", way("lat='36.3' lon='-84.3'", "lat='36.36' lon='-84.23'"))),
                HasSubstr("on the DEM around"));
    EXPECT_EQ(
        words(FileKind::Lines, write("far.gpx", way("lat='47' lon='11'", "lat='47.1' lon='11.1'"))),
        "outside the DEM");
    EXPECT_THAT(words(FileKind::Overlay, (test::source_dir() / "data/dem/jacksboro.tif").string()),
                HasSubstr("on the DEM around"));
    // A map of half the world, of whose sampled places none is on the DEM.
    std::string half = grid_text();
    half.replace(half.find("xllcorner"), half.find("NODATA") - half.find("xllcorner"),
                 "xllcorner -180\nyllcorner -90\ncellsize 6\n");
    const std::string map = write("half.asc", half);
    std::ofstream(std::filesystem::path(map).replace_extension("prj"))
        << "GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137.0,"
           "298.257223563]],PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]]";
    EXPECT_THAT(words(FileKind::Overlay, map), HasSubstr("on the DEM around"));
}

/// The window with files that a desktop's dialog gives.
class OpenedFiles : public Viewer {
  protected:
    void SetUp() override {
        std::filesystem::create_directories(folder_ / "bin");
        std::ofstream(folder_ / "bin/zenity")
            << "#!/bin/sh\ncat '" << (folder_ / "choice").string() << "'\n";
        std::filesystem::permissions(folder_ / "bin/zenity", std::filesystem::perms::owner_all);
    }
    void choose(const std::string& file) {
        std::ofstream(folder_ / "choice") << file << "\n";
        act({"key", "ctrl+o"});
    }
    bool shows(const std::string& title) {
        return wait([&] { return program_->title().find(title) != std::string::npos; });
    }
    /// The scene when it fulfils a condition, or as it is in the end.
    nlohmann::json scene_with(const std::function<bool(const nlohmann::json&)>& holds) {
        nlohmann::json now;
        wait([&] { return holds(now = scene()); });
        return now;
    }
};

TEST_F(OpenedFiles, ADemWithoutACrsIsAskedForOne) {
    const auto grid = folder_ / "grid.asc";
    std::ofstream(grid) << grid_text();
    open({dem_, "--only"});
    constexpr glm::ivec4 kSheet{270, 160, 740, 480};
    ASSERT_TRUE(changes_in(kSheet, [&] { choose(grid.string()); }));
    ASSERT_TRUE(settles());
    EXPECT_THAT(program_->title(), HasSubstr("jacksboro.tif"));
    act({"mousemove", "420", "243", "click", "1"});
    act({"type", "--delay", "60", "EPSG:31287"});
    // The preview, then Open.
    constexpr glm::ivec4 kPreview{690, 250, 300, 150};
    ASSERT_TRUE(wait([&] {
        return count_near(display_.screen(), kPreview, {110, 110, 110}, 60) > 3000;
    }));
    act({"mousemove", "329", "616"});
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    act({"click", "1"});
    EXPECT_TRUE(shows("grid.asc"));
    ASSERT_TRUE(settles());
    EXPECT_EQ(scene()["dem"]["crs"], "EPSG:31287");
}

TEST_F(OpenedFiles, ADemOfTheCommandLineWithoutACrsIsAskedForOne) {
    const auto grid = folder_ / "grid.asc";
    std::ofstream(grid) << grid_text();
    constexpr glm::ivec4 kSheet{270, 160, 740, 480};
    const auto shows_sheet = [&] {
        return wait([&] {
            return count_near(display_.screen(), kSheet, {21, 23, 27}, 4) > 100'000;
        });
    };
    // Without an answer it ends as other commands do.
    start({grid.string(), "--only"});
    ASSERT_TRUE(shows_sheet()) << program_->output();
    act({"key", "Escape"});
    EXPECT_EQ(program_->status(), 3);
    EXPECT_THAT(program_->output(), HasSubstr("does not say its coordinate system; add --crs"));
    start({grid.string(), "--only"});
    ASSERT_TRUE(shows_sheet()) << program_->output();
    act({"mousemove", "420", "243", "click", "1"});
    act({"type", "--delay", "60", "31287"});
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    act({"key", "Return"});  // the first of those found
    constexpr glm::ivec4 kPreview{690, 230, 300, 150};
    ASSERT_TRUE(wait([&] {
        return count_near(display_.screen(), kPreview, {110, 110, 110}, 60) > 3000;
    }));
    act({"mousemove", "329", "616"});
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    act({"click", "1"});
    EXPECT_TRUE(shows("grid.asc"));
    ASSERT_TRUE(settles());
    EXPECT_EQ(scene()["dem"]["crs"], "EPSG:31287");
}

TEST_F(OpenedFiles, ReturnTakesASuggestedCrsAndOpens) {
    std::string text = grid_text();
    text.replace(text.find("xllcorner"), text.find("cellsize") - text.find("xllcorner"),
                 "xllcorner 740000\nyllcorner 4020000\n");
    const auto grid = folder_ / "grid.asc";
    std::ofstream(grid) << text;
    open({dem_, "--only"});
    constexpr glm::ivec4 kSheet{270, 160, 740, 480}, kPreview{690, 230, 300, 150};
    ASSERT_TRUE(changes_in(kSheet, [&] { choose(grid.string()); }));
    // The preview of the first suggestion, which is highlighted.
    ASSERT_TRUE(wait([&] {
        return count_near(display_.screen(), kPreview, {110, 110, 110}, 60) > 3000;
    }));
    // Edges that cannot be are only said.
    act({"mousemove", "420", "413", "click", "1"});
    act({"type", "--delay", "60", "1,2"});
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    act({"key", "--delay", "80", "BackSpace", "BackSpace", "BackSpace"});
    act({"mousemove", "420", "243", "click", "1"});
    for (int i = 0; i < 2; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(500));
        act({"key", "Return"});
    }
    EXPECT_TRUE(shows("grid.asc"));
    ASSERT_TRUE(settles());
    EXPECT_EQ(scene()["dem"]["crs"], "EPSG:32616");
}

TEST(WindowWords, NameFieldsInsteadOfOptions) {
    using viewer::window_words;
    EXPECT_EQ(window_words("does not say its coordinate system; add --crs, for example EPSG:1"),
              "does not say its coordinate system; enter the CRS, for example EPSG:1");
    EXPECT_EQ(window_words("a; --unit sets another; --band N selects another"),
              "a; the field Unit sets another; the field Band selects another");
    EXPECT_EQ(window_words("s.json: plugins of /p are not used; add --plugin-path /p, or --trust "
                           "for all"),
              "s.json: plugins of /p are not used; to use them start relevo --plugin-path /p");
    EXPECT_EQ(window_words("--memory 9"), "--memory 9");
}

TEST_F(OpenedFiles, ASceneAJobAndAPictureOpenTheirScene) {
    open({dem_, "--only", "--time", "2026-06-21T18:00:00Z", "--heading", "30", "--eye",
          "36.2,-84.3,3000"});
    const nlohmann::json first = scene();
    act({"key", "F12"});
    ASSERT_TRUE(wait([&] { return std::filesystem::exists(folder_ / "relevo-1.png"); }));
    const auto is_first = [&](const nlohmann::json& now) {
        return std::abs(now["camera"]["heading"].get<double>() - 30) < 1e-6 &&
               now["time"] == first["time"];
    };
    const auto leave = [&] {
        ASSERT_TRUE(settles());  // the image of the scene before stays until there is a new one
        ASSERT_TRUE(changes([&] { act({"key", "t"}); }));
        act({"key", "shift+bracketright"});
        ASSERT_FALSE(is_first(resting_scene()));
    };
    for (const char* file : {"relevo-1.json", "relevo-1.png"}) {
        leave();
        choose((folder_ / file).string());
        EXPECT_TRUE(is_first(scene_with(is_first))) << file;
    }
    leave();
    nlohmann::json job = first;
    job["sweep"] = {{{"times", {{"from", "06:00"}, {"to", "18:00"}, {"step", "1h"}}}}};
    std::ofstream(folder_ / "job.json") << job;
    choose((folder_ / "job.json").string());
    EXPECT_TRUE(is_first(scene_with(is_first)));
    // One that is broken is said and changes nothing.
    leave();
    const nlohmann::json before = resting_scene();
    std::ofstream(folder_ / "bad.json") << R"({"format": 1, "camera": 7})";
    ASSERT_TRUE(changes_in({400, 25, 700, 60}, [&] { choose((folder_ / "bad.json").string()); }));
    EXPECT_EQ(resting_scene(), before);
}

TEST_F(OpenedFiles, PlacesAndLinesSwitchOnTheirEffects) {
    open({dem_, "--only"});
    std::ofstream(folder_ / "places.csv") << "name,lat,lon\nTop,36.36,-84.23\n";
    std::ofstream(folder_ / "way.gpx")
        << "<gpx version='1.1' xmlns='http://www.topografix.com/GPX/1/1'><trk><trkseg>"
           "<trkpt lat='36.3' lon='-84.3'/><trkpt lat='36.36' lon='-84.23'/>"
           "</trkseg></trk></gpx>";
    choose((folder_ / "places.csv").string());
    nlohmann::json now = scene_with([](const nlohmann::json& scene) {
        return scene.dump().find("labels") != std::string::npos;
    });
    EXPECT_THAT(now["effects"].dump(), HasSubstr("places.csv"));
    choose((folder_ / "way.gpx").string());
    now = scene_with([](const nlohmann::json& scene) {
        return scene.dump().find("tracks") != std::string::npos;
    });
    EXPECT_THAT(now["effects"].dump(), HasSubstr("way.gpx"));
    // A step of undo.
    act({"key", "ctrl+z"});
    now = scene_with([](const nlohmann::json& scene) {
        return scene["effects"].dump().find("way.gpx") == std::string::npos;
    });
    EXPECT_THAT(now["effects"].dump(), HasSubstr("places.csv"));
}

TEST_F(OpenedFiles, ASceneRunsNoCodeThatTheUserHasNotNamed) {
    paint("radiance.r += 0.5;");
    open({dem_, "--only"});
    nlohmann::json named = scene();
    named["effects"]["plugin_path"] = {plugins_.string()};
    std::ofstream(folder_ / "named.json") << named;
    ASSERT_TRUE(changes_in({400, 25, 700, 60}, [&] { choose((folder_ / "named.json").string()); }));
    ASSERT_TRUE(settles());
    EXPECT_THAT(scene().dump(), testing::Not(HasSubstr("plugin_path")));
}

}  // namespace
}  // namespace relevo::test_open_files
