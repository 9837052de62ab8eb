#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "base/text.h"
#include "base/units.h"
#include "scene/scene.h"
#include "support/support.h"

namespace relevo::scene {
namespace {

class SceneFile : public testing::Test {
  protected:
    std::filesystem::path write(const std::string& text) const {
        std::ofstream(dir_ / "scene.json") << text;
        return dir_ / "scene.json";
    }
    std::string error(const std::string& text) const {
        const std::string message = test::error_of([&] { read_scene(write(text)); });
        const std::string begin = fmt::format("exit 3: scene: {}:", (dir_ / "scene.json").string());
        return message.starts_with(begin) ? message.substr(begin.size()) : "!" + message;
    }
    /// A scene with these members behind what each needs.
    static std::string with(const std::string& members) {
        return "{\"format\": 1, \"dem\": {\"files\": [\"a.tif\"]},\n" + members + "}";
    }

    std::filesystem::path dir_ = test::scratch_dir("scene");
};

TEST_F(SceneFile, HasDefaultsForAllButTheDem) {
    const Scene scene = read_scene(write("{\"format\": 1, \"dem\": {\"files\": [\"a.tif\"]}}"));
    const Scene plain;
    EXPECT_THAT(scene.dems, testing::ElementsAre((dir_ / "a.tif").string()));
    EXPECT_EQ(scene.width_px, plain.width_px);
    EXPECT_EQ(scene.height_px, plain.height_px);
    EXPECT_EQ(scene.refraction, "standard");
    EXPECT_EQ(scene.view.orbit.azimuth_deg, plain.view.orbit.azimuth_deg);
    EXPECT_EQ(scene.pixel_error, plain.pixel_error);
    EXPECT_EQ(scene.dem.memory.mib(), plain.dem.memory.mib());
    EXPECT_FALSE(scene.view.eye);
    EXPECT_FALSE(scene.effects.switches.only);
}

TEST_F(SceneFile, OrbitsAreAerialWithoutAngles) {
    const auto is_aerial = [&](const std::string& orbit) {
        return read_scene(write(with("\"camera\": {\"orbit\": {" + orbit + "}}")))
            .view.orbit.aerial;
    };
    EXPECT_TRUE(is_aerial(""));
    EXPECT_TRUE(is_aerial("\"zoom\": 2"));
    EXPECT_TRUE(is_aerial("\"azimuth\": 170, \"elevation\": 20, \"aerial\": true"));
    EXPECT_FALSE(is_aerial("\"azimuth\": 170"));
    EXPECT_FALSE(is_aerial("\"elevation\": 20"));
    EXPECT_FALSE(is_aerial("\"aerial\": false"));
    std::ofstream(dir_ / "a.tif") << "";
    Scene scene;
    scene.dems = {(dir_ / "a.tif").string()};
    for (const bool aerial : {false, true})
        for (const bool has_angle : {false, true}) {
            scene.view.orbit = {.aerial = aerial};
            if (has_angle) scene.view.orbit.azimuth_deg = 170;
            const std::string text = scene_text(scene, dir_);
            EXPECT_EQ(read_scene(write(text)).view.orbit.aerial, aerial) << text;
        }
}

TEST_F(SceneFile, ComesBackAsItWasWritten) {
    std::ofstream(dir_ / "a.tif") << "";
    std::ofstream(dir_ / "winter.json") << "";
    Scene scene;
    scene.dems = {(dir_ / "a.tif").string(), "/vsizip/b.zip/b.tif"};
    scene.dem.crs = "EPSG:32632";
    scene.dem.band = 2;
    scene.dem.unit = "ft";
    scene.dem.nodata = -9999;
    scene.dem.encoding = dem::Encoding::Terrarium;
    scene.dem.bounds = dem::Bounds{8, 46, 9, 47};
    scene.dem.memory = MemoryBudget::of_mib(77);
    scene.time = {"sunset-30min", "2026-06-21", "Europe/Zurich"};
    scene.refraction = "saemundsson";
    scene.backdrop = Backdrop::Studio;
    scene.view.eye = Standpoint{geo::geodetic_deg(46.97, 8.03, 2), true};
    scene.view.look_at = Standpoint{geo::geodetic_deg(46.5, 8.1, 4000), false};
    scene.view.fov_y_rad = radians(35.0);
    scene.exaggeration = 1.5;
    scene.effects.switches.only = std::vector<std::string>{"sky", "haze"};
    scene.effects.switches.disable = {"wet"};
    scene.effects.presets = {"paper", (dir_ / "winter.json").string()};
    scene.effects.settings = {{"haze.density", "0.5"}, {"sea.colour", "0,0.1,0.2"}};
    scene.width_px = 640;
    scene.height_px = 512;
    scene.exposure_ev = -1.5;
    scene.ev100 = -2;
    scene.pixel_error = 2;
    const std::string text = scene_text(scene, dir_);
    EXPECT_EQ(text.find(dir_.string()), std::string::npos) << text;
    const Scene back = read_scene(write(text));
    EXPECT_EQ(scene_text(back, dir_), text);
    EXPECT_THAT(back.dems, testing::ElementsAre((dir_ / "a.tif").string(), "/vsizip/b.zip/b.tif"));
    EXPECT_EQ(back.dem.nodata, -9999);
    EXPECT_EQ(back.dem.bounds, scene.dem.bounds);
    EXPECT_EQ(back.dem.memory.mib(), 77);
    EXPECT_EQ(back.time.date, "2026-06-21");
    EXPECT_EQ(back.view.eye->place.lat_rad, radians(46.97));  // to the last bit
    EXPECT_TRUE(back.view.eye->above_ground);
    EXPECT_EQ(back.view.look_at->place.height_m, 4000);
    EXPECT_FALSE(back.view.look_at->above_ground);
    EXPECT_EQ(back.view.fov_y_rad, radians(35.0));
    EXPECT_THAT(*back.effects.switches.only, testing::ElementsAre("sky", "haze"));
    EXPECT_THAT(back.effects.presets,
                testing::ElementsAre("paper", (dir_ / "winter.json").string()));
    ASSERT_EQ(back.effects.settings.size(), 2u);
    EXPECT_EQ(back.effects.settings[1].text, "0,0.1,0.2");
    EXPECT_EQ(back.effects.settings[1].folder, dir_.string());
}

TEST_F(SceneFile, StampsComeBackAsTheyWereWritten) {
    Scene scene;
    scene.dems = {"/vsizip/b.zip/b.tif"};
    EXPECT_EQ(scene_text(scene, dir_).find("stamps"), std::string::npos);
    scene.stamps.legend = false;
    scene.stamps.scale = scene.stamps.graticule = scene.stamps.attribution = true;
    scene.stamps.title_text = "The valley";
    scene.stamps.attribution_text = "Land Tirol - data.tirol.gv.at";
    const Scene back = read_scene(write(scene_text(scene, dir_)));
    EXPECT_EQ(back.stamps, scene.stamps);
    const auto shown = [&](const std::string& list) {
        return read_scene(write(with("\"stamps\": {\"show\": " + list + "}"))).stamps;
    };
    const Stamps all = shown("[\"all\"]");
    EXPECT_TRUE(all.title && all.scale && all.north && all.graticule && all.date && all.sun);
    EXPECT_FALSE(all.attribution);  // nobody said the words for it
    EXPECT_EQ(shown("[\"none\"]"), Stamps());
    EXPECT_TRUE(shown("[\"north\"]").north);
}

TEST_F(SceneFile, StampsThatAreNoneAreRefused) {
    EXPECT_EQ(error(with("\"stamps\": {\"show\": [\"scael\"]}")),
              "2: stamps.show: scael: expected all, none, or words of legend, title, scale, north, "
              "graticule, date, sun, exaggeration, attribution");
    EXPECT_EQ(error(with("\"stamps\": {\"show\": [\"attribution\"]}")),
              "2: stamps.attribution: expected the words that name the data's source, which show "
              "asks for");
    EXPECT_EQ(error(with("\"stamps\": {\"titel\": \"x\"}")),
              "2: stamps.titel: no such key; did you mean \"title\"?");
}

TEST_F(SceneFile, MistakesNameTheirPlace) {
    EXPECT_EQ(error("{\n"),
              "2: syntax error while parsing object key - unexpected end of input; "
              "expected string literal");
    EXPECT_EQ(error("[]"), "1: expected an object but got a list");
    EXPECT_EQ(error("{}"), "1: expected a member \"format\"");
    EXPECT_EQ(error("{\"format\": 2}"),
              "1: format: expected 1, the format that this program reads, but got 2");
    EXPECT_EQ(error("{\"format\": 1}"), "1: expected a member \"dem\"");
    EXPECT_EQ(error("{\"format\": 1, \"dem\": {}}"), "1: dem.files: expected a list of DEMs");
    EXPECT_EQ(error(with("\"camra\": {}")), "2: camra: no such key; did you mean \"camera\"?");
    EXPECT_EQ(error(with("\"camera\": {\"fov\": 500}")),
              "2: camera.fov: expected a number in [0.1, 170] but got 500");
    EXPECT_EQ(error(with("\"camera\": {\"fov\": 40, \"focal_length\": 50}")),
              "2: camera.focal_length: expected it or fov but got both");
    EXPECT_EQ(error(with("\"camera\": {\"orbit\": {}, \"eye\": [46, 8]}")),
              "2: camera.eye: expected an orbit or an eye but got both");
    EXPECT_EQ(error(with("\"camera\": {\"eye\": [96, 8]}")),
              "2: camera.eye: expected a latitude of -90 to 90 and a longitude of -360 to 360 but "
              "got 96 and 8");
    EXPECT_EQ(error(with("\"camera\": {\"eye\": [46]}")),
              "2: camera.eye: expected latitude, longitude and perhaps a height but got a list");
    EXPECT_EQ(error(with("\"camera\": {\"orbit\": {\"zoom\": 0}}")),
              "2: camera.orbit.zoom: expected a number in [0.001, 1000000] but got 0");
    EXPECT_EQ(error(with("\"picture\": {\"size\": [0, 10]}")),
              "2: picture.size: expected 1 to 65536 but got 0");
    EXPECT_EQ(error(with("\"time\": {}")), "2: time: expected a member \"at\"");
    EXPECT_EQ(
        error(with("\"time\": {\"at\": \"noonish\"}")),
        "2: time.at: noonish: no such event as \"noonish\", expected one of sunrise, sunset, noon, "
        "midnight, civil-dawn, civil-dusk, nautical-dawn, nautical-dusk, astronomical-dawn, "
        "astronomical-dusk, first-light, last-light");
    EXPECT_EQ(error(with("\"time\": {\"at\": \"2026-06-21T12:00\", \"zone\": \"Europe/Zurch\"}")),
              "2: time.zone: Europe/Zurch: no such time zone; did you mean Europe/Zurich?");
    // A zone of the place is not known yet, all the rest is.
    for (const char* const zone : {"", ", \"zone\": \"auto\"", ", \"zone\": \"solar\""}) {
        const auto at = [&](const std::string& time) {
            return error(with("\"time\": {\"at\": \"" + time + "\"" + zone + "}"));
        };
        EXPECT_EQ(at("2026-06-21T12:61"),
                  "2: time.at: 2026-06-21T12:61: no such minute, expected minute 0 to 59 but got "
                  "61");
        EXPECT_EQ(at("noon"), "2: time.at: noon: no date; write 2026-06-21 noon or pass --date");
    }
    EXPECT_EQ(error(with("\"time\": {\"at\": \"2026-06-21T12:00+01:00\", \"zone\": "
                         "\"Europe/Zurich\"}")),
              "2: time.at: 2026-06-21T12:00+01:00: offset +01:00 contradicts Europe/Zurich, "
              "expected +02:00 (CEST); use only one of them");
    EXPECT_EQ(error(with("\"time\": {\"at\": \"noon\",\n\"date\": \"June\"}")),
              "3: time.date: June: not a date, expected YYYY-MM-DD such as 2026-06-21");
    EXPECT_EQ(error(with("\"time\": {\"at\": \"2026-06-21T12:00Z\", \"date\": \"2026-06-21\"}")),
              "2: time.date: needs an event in time.at, such as sunset-30min");
    EXPECT_EQ(error(with("\"refraction\": \"some\"")),
              "2: refraction: expected one of standard, saemundsson, none but got \"some\"");
    EXPECT_EQ(error(with("\"effects\": {\"set\": {\"haze.density\": null}}")),
              "2: effects.set: haze.density: expected a number, true or false, a text or a list of "
              "numbers but got null");
    EXPECT_EQ(error("{\"format\": 1, \"dem\": {\"files\": [\"a\"], \"nodata\": true}}"),
              "1: dem.nodata: expected a number or \"none\" but got true");
    EXPECT_EQ(error("{\"format\": 1, \"dem\": {\"files\": [\"a\"], \"bounds\": [1, 2, 3]}}"),
              "1: dem.bounds: expected west, south, east, north in degrees but got a list");
}

TEST_F(SceneFile, ATimeMayLeaveItsZoneToThePlace) {
    const auto time_of = [&](const std::string& time) {
        return read_scene(
                   write(R"({"format": 1, "dem": {"files": ["a"]}, "time": {)" + time + "}}"))
            .time;
    };
    for (const std::string zone : {"", "auto", "solar"}) {
        const std::string words = zone.empty() ? "" : ", \"zone\": \"" + zone + "\"";
        EXPECT_EQ(time_of("\"at\": \"2026-06-21T12:00\"" + words).zone, zone);
        EXPECT_EQ(time_of("\"at\": \"2026-06-21T12:00-05:00\"" + words).zone, zone);
        EXPECT_EQ(time_of("\"at\": \"2026-06-21 sunset\"" + words).zone, zone);
        EXPECT_EQ(time_of(R"("at": "sunset", "date": "2026-06-21")" + words).zone, zone);
    }
}

TEST_F(SceneFile, TheDocumentsExampleIsOne) {
    const std::string page = read_text(test::source_dir() / "docs/scene.md", "test");
    const std::string fence = "```json scene.json\n";
    const std::size_t begin = page.find(fence) + fence.size();
    const Scene scene = read_scene(write(page.substr(begin, page.find("```", begin) - begin)));
    EXPECT_EQ(scene.time.zone, "Europe/Zurich");
    EXPECT_EQ(scene.effects.settings.at(0).address, "layering.texture_m");
}

}  // namespace
}  // namespace relevo::scene
