#include <filesystem>
#include <fstream>
#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "scene/job.h"
#include "scene/name_template.h"
#include "sun/event_time.h"
#include "support/support.h"

namespace relevo::scene {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class JobFile : public testing::Test {
  protected:
    std::filesystem::path write(const std::string& text,
                                const std::string& name = "job.json") const {
        std::ofstream(dir_ / name) << text;
        return dir_ / name;
    }
    /// A job with these members behind what each needs.
    static std::string with(const std::string& members) {
        return "{\"format\": 1, \"dem\": {\"files\": [\"alps.tif\"]},\n" + members + "}";
    }
    /// Clocks of Greenwich, events at noon. Sunsets do not happen in December.
    static sun::ParsedTime resolve(const Scene& scene) {
        if (scene.time.at.empty()) return {};
        if (!sun::is_event_time(scene.time.at)) return sun::parse_time(scene.time.at, sun::Zone());
        const sun::EventTime event = sun::parse_event_time(scene.time.at);
        const std::string date = event.date ? sun::to_string(*event.date) : scene.time.date;
        if (date.substr(5, 2) == "12" && event.event == sun::EventKind::Sunset)
            bad_input("sun: no sunset on " + date);
        return sun::parse_time(date + "T12:00Z");
    }
    std::vector<Shot> shots(const std::string& members, std::size_t most = 1000) const {
        return shots_of(read_job(write(with(members))), resolve, most).shots;
    }
    std::vector<std::string> names(const std::string& members) const {
        std::vector<std::string> result;
        for (const Shot& shot : shots(members))
            result.push_back(shot.output.lexically_relative(dir_).string());
        return result;
    }
    std::string error(const std::string& text, std::size_t most = 1000) const {
        const std::string message =
            test::error_of([&] { shots_of(read_job(write(text)), resolve, most); });
        const std::string begin = fmt::format("exit 3: job: {}:", (dir_ / "job.json").string());
        return message.starts_with(begin) ? message.substr(begin.size()) : "!" + message;
    }

    std::filesystem::path dir_ = test::scratch_dir("job");
};

TEST_F(JobFile, AScenesFileIsAJobOfOnePicture) {
    EXPECT_THAT(names("\"time\": {\"at\": \"2026-06-21T18:30Z\"}"),
                ElementsAre("alps_20260621T1830_0001.png"));
}

TEST_F(JobFile, ARangeOfTimesHasBothEnds) {
    EXPECT_THAT(names("\"time\": {\"at\": \"0:00\", \"date\": \"2026-06-21\"},"
                      "\"sweep\": [{\"times\": {\"from\": \"6:00\", \"to\": \"07:00\", \"step\": "
                      "\"20min\"}}], \"output\": \"{time:%d_%H%M}.png\""),
                ElementsAre("21_0600.png", "21_0620.png", "21_0640.png", "21_0700.png"));
}

TEST_F(JobFile, DatesTakeTheTimeOfTheScene) {
    const char* const dates =
        "\"sweep\": [{\"dates\": [\"2026-03-20\", \"2026-06-21\"]}],"
        "\"output\": \"{time:%Y-%m-%dT%H%M}.png\"";
    EXPECT_THAT(names(std::string("\"time\": {\"at\": \"2025-01-01T18:30\"},") + dates),
                ElementsAre("2026-03-20T1830.png", "2026-06-21T1830.png"));
    EXPECT_THAT(names(std::string("\"time\": {\"at\": \"6:15\"},") + dates),
                ElementsAre("2026-03-20T0615.png", "2026-06-21T0615.png"));
    EXPECT_THAT(names(std::string("\"time\": {\"at\": \"sunset-30min\"},") + dates),
                ElementsAre("2026-03-20T1200.png", "2026-06-21T1200.png"));
}

TEST_F(JobFile, DatesComeBeforeTheTimesOfEach) {
    EXPECT_THAT(names("\"sweep\": [{\"dates\": {\"from\": \"2026-03-20\", \"to\": \"2026-03-24\", "
                      "\"step\": 3}}, {\"times\": [\"6:00\", \"18:00\"]}], \"output\": "
                      "\"{time:%d_%H}.png\""),
                ElementsAre("20_06.png", "20_18.png", "23_06.png", "23_18.png"));
}

TEST_F(JobFile, AxesAreProductsUnlessTheyAreZipped) {
    const std::string sweep =
        "\"sweep\": [{\"cameras\": [{\"name\": \"a\", \"fov\": 20}, {\"fov\": 60}]},"
        "{\"set\": \"haze.density\", \"from\": 0.1, \"to\": 0.3, \"step\": 0.2}],"
        "\"output\": \"{camera}_{haze.density}.png\"";
    EXPECT_THAT(names(sweep), ElementsAre("a_0.1.png", "a_0.3.png", "2_0.1.png", "2_0.3.png"));
    EXPECT_THAT(names(sweep + ", \"combine\": \"zip\""), ElementsAre("a_0.1.png", "2_0.3.png"));
    const std::vector<Shot> drawn = shots(sweep);
    EXPECT_NEAR(degrees(drawn[0].scene.view.fov_y_rad), 20, 1e-9);
    EXPECT_EQ(drawn[1].scene.effects.settings.front().text, "0.3");
}

TEST_F(JobFile, ShotsChangeTheSceneAndGoWithEachOfTheSweep) {
    const std::vector<Shot> drawn = shots(
        "\"picture\": {\"size\": [640, 512], \"exposure\": 1},"
        "\"shots\": [{\"name\": \"small\", \"picture\": {\"size\": [64, 48]}}, "
        "{\"camera\": {\"eye\": [46, 8]}, \"effects\": {\"disable\": [\"sky\"]}}],"
        "\"sweep\": [{\"effects\": [{\"enable\": [\"wet\"]}, {\"only\": []}]}],"
        "\"output\": \"{shot}_{effects}.png\"");
    ASSERT_EQ(drawn.size(), 4u);
    EXPECT_EQ(drawn[0].output.filename(), "small_wet.png");
    EXPECT_EQ(drawn[0].scene.width_px, 64);
    EXPECT_EQ(drawn[0].scene.exposure_ev, 1);
    EXPECT_EQ(drawn[2].output.filename(), "2_wet.png");
    EXPECT_EQ(drawn[2].scene.width_px, 640);
    EXPECT_TRUE(drawn[2].scene.view.eye);
    EXPECT_THAT(drawn[2].scene.effects.switches.disable, ElementsAre("sky"));
    EXPECT_THAT(drawn[2].scene.effects.switches.enable, ElementsAre("wet"));
    EXPECT_EQ(drawn[3].output.filename(), "2_none.png");
    EXPECT_TRUE(drawn[3].scene.effects.switches.only->empty());
}

TEST_F(JobFile, TheEyeIsAtEachSiteAndSoAreEvents) {
    write("name,lat,lon\nhut/1,46.5,8.25\n,46.6,8.5\n", "huts.csv");
    const std::vector<Shot> drawn = shots(
        "\"time\": {\"at\": \"sunset\", \"date\": \"2026-06-21\"},"
        "\"camera\": {\"fov\": 60}, \"sweep\": [{\"sites\": {\"file\": \"huts.csv\", "
        "\"heading\": 90}}, {\"cameras\": [{\"pitch\": 5}]}], \"output\": \"{site}.png\"");
    ASSERT_EQ(drawn.size(), 2u);
    EXPECT_EQ(drawn[0].output.filename(), "hut-1.png");
    EXPECT_EQ(drawn[1].output.filename(), "2.png");
    const View& view = drawn[1].scene.view;
    EXPECT_NEAR(degrees(view.eye->place.lat_rad), 46.6, 1e-12);
    EXPECT_TRUE(view.eye->above_ground);
    EXPECT_EQ(view.heading_deg, 90);
    EXPECT_EQ(view.pitch_deg, 5);
    EXPECT_NEAR(degrees(view.fov_y_rad), 60, 1e-12);
    EXPECT_EQ(drawn[0].scene.time.at, "sunset@46.5,8.25");
}

TEST_F(JobFile, ASceneOfAFileMayBeginIt) {
    write(
        "{\"format\": 1, \"dem\": {\"files\": [\"b.tif\"]}, \"exaggeration\": 2, \"refraction\": "
        "\"none\"}",
        "view.json");
    const Job job =
        read_job(write("{\"format\": 1, \"scene\": \"view.json\", \"refraction\": \"standard\"}"),
                 [](Scene& scene) { scene.width_px = 99; });
    EXPECT_THAT(job.scene.dems, ElementsAre((dir_ / "b.tif").string()));
    EXPECT_EQ(job.scene.exaggeration, 2);
    EXPECT_EQ(job.scene.refraction, "standard");
    EXPECT_EQ(job.scene.width_px, 99);
}

TEST_F(JobFile, MistakesNameTheirPlace) {
    EXPECT_THAT(error("{\"format\": 1,"), HasSubstr("1: syntax error while parsing"));
    EXPECT_EQ(error("{\"format\": 1}"), "1: expected a member \"dem\"");
    EXPECT_EQ(error(with("\"shots\": [{}, {\"camera\": {\"fov\": 500}}]")),
              "2: shots[1].camera.fov: expected a number in [0.1, 170] but got 500");
    EXPECT_EQ(error(with("\"shots\": [{\"camera\": {\"orbit\": {\"zom\": 2}}}]")),
              "2: shots[0].camera.orbit.zom: no such key; did you mean \"zoom\"?");
    EXPECT_EQ(error(with("\"sweeep\": []")), "2: sweeep: no such key; did you mean \"sweep\"?");
    EXPECT_EQ(error(with("\"sweep\": [{\"camera\": []}]")),
              "2: sweep[0].camera: no such key; did you mean \"cameras\"?");
    EXPECT_EQ(error(with("\"sweep\": [{}]")),
              "2: sweep[0]: expected one of times, dates, cameras, sites, effects, set, orbit and "
              "flight");
    EXPECT_EQ(error(with("\"sweep\": [{\"times\": [], \"dates\": []}]")),
              "2: sweep[0]: expected one axis but got 2; each has braces of its own");
    EXPECT_EQ(error(with("\"sweep\": [{\"times\": 7}]")),
              "2: sweep[0].times: expected an object but got 7");
    EXPECT_EQ(error(with("\"sweep\": [{\"times\": [\"sunsett\"]}]")),
              "2: sweep[0].times[0]: sunsett: no such event as \"sunsett\"; did you mean sunset?");
    EXPECT_EQ(error(with("\"sweep\": [{\"times\": {\"from\": \"6:00\", \"to\": \"7:00\", \"step\": "
                         "\"0min\"}}]")),
              "2: sweep[0].times.step: expected a duration such as 15min, 1h30min or 45s, or "
              "minutes alone, but got \"0min\"");
    EXPECT_EQ(error(with("\"sweep\": [{\"set\": \"haze.density\", \"values\": [{}]}]")),
              "2: sweep[0].values: expected a number, true or false, a text or a list of numbers "
              "but got an object");
}

TEST_F(JobFile, SweepsThatSayNothingAreRefused) {
    EXPECT_EQ(error(with("\"sweep\": []")), "2: sweep: expected axes but the list is empty");
    EXPECT_EQ(error(with("\"sweep\": [{\"cameras\": []}]")),
              "2: sweep[0].cameras: expected values but the list is empty");
    EXPECT_EQ(error(with("\"sweep\": [{\"dates\": {\"from\": \"2026-02-01\", \"to\": "
                         "\"2026-01-01\", \"at\": \"noon\"}}]")),
              "2: sweep[0].dates.to: expected a day from 2026-02-01 on but got 2026-01-01");
    EXPECT_EQ(error(with("\"sweep\": [{\"set\": \"a.b\", \"from\": 1, \"to\": 0, \"step\": 1}]")),
              "2: sweep[0].to: expected 1 or more but got 0");
    EXPECT_EQ(error(with("\"sweep\": [{\"cameras\": [{}, {}]}, {\"effects\": [{}]}],"
                         "\"combine\": \"zip\"")),
              "2: sweep[1].effects: expected 2 values, as sweep[0].cameras has, but got 1; "
              "\"combine\": \"zip\" takes axes of one length");
    EXPECT_EQ(error(with("\"sweep\": [{\"dates\": [\"2026-01-01\"]}]")),
              " dates need a time of day or an event; add \"at\" to them, or time.at");
}

TEST_F(JobFile, AMillionPicturesAreRefusedBeforeTheyAreDrawnUp) {
    EXPECT_EQ(error(with("\"time\": {\"at\": \"2026-01-01T00:00Z\"},"
                         "\"sweep\": [{\"set\": \"a.b\", \"from\": 1, \"to\": 1000, \"step\": 1},"
                         "{\"set\": \"a.c\", \"from\": 1, \"to\": 1000, \"step\": 1}]"),
                    100000),
              " the job has 1000000 pictures, more than 100000; add --yes to allow them");
    EXPECT_THAT(
        error(with("\"time\": {\"at\": \"0:00\", \"date\": \"2026-01-01\"}, \"sweep\": "
                   "[{\"times\": {\"from\": \"0:00\", \"to\": \"23:59\", \"step\": \"1s\"}}]"),
              1000),
        HasSubstr("the job has 86341 or more pictures, more than 1000; add --yes"));
}

TEST_F(JobFile, AFileNamedTwiceIsRefused) {
    EXPECT_EQ(error(with("\"time\": {\"at\": \"2026-01-01T00:00Z\"},"
                         "\"sweep\": [{\"cameras\": [{}, {}]}], \"output\": \"a.png\"")),
              fmt::format("2: output: \"a.png\" names {} twice, for pictures 1 and 2; add {{n}} or "
                          "another field that differs",
                          (dir_ / "a.png").string()));
    EXPECT_EQ(
        error(with("\"output\": \"{camra}.png\", \"sweep\": [{\"cameras\": [{}]}]")),
        "2: output: expected one of {dem}, {n}, {time}, {camera} but got {camra}; did you mean "
        "{camera}?");
    EXPECT_EQ(error(with("\"output\": \"{n:x}.png\"")),
              "2: output: expected a width such as {n:04} but got {n:x}");
    EXPECT_EQ(error(with("\"output\": \"{n.png\"")),
              "2: output: expected a } behind \"{n.png\"; a brace itself is {{");
}

TEST_F(JobFile, EventsThatDoNotHappenLeaveTheirPictureOut) {
    const Shots drawn =
        shots_of(read_job(write(with("\"sweep\": [{\"dates\": {\"from\": \"2026-11-30\", \"to\": "
                                     "\"2026-12-01\", \"at\": \"sunset\"}}]"))),
                 resolve, 10);
    ASSERT_EQ(drawn.shots.size(), 1u);
    EXPECT_EQ(drawn.shots[0].number, 1u);
    EXPECT_THAT(drawn.left_out, ElementsAre("sun: no sunset on 2026-12-01"));
    EXPECT_EQ(
        error(with("\"sweep\": [{\"dates\": {\"from\": \"2026-12-01\", \"to\": "
                   "\"2026-12-02\", \"at\": \"sunset\"}}]")),
        " no picture is left: none of its events happens; the first: sun: no sunset on 2026-12-01");
}

TEST(NameTemplate, HasTheLocalTimeOfItsZone) {
    const NameParts parts{7,
                          "alps",
                          sun::parse_time("2026-06-21T22:30Z").utc,
                          sun::Zone::named("Europe/Zurich"),
                          {{"site", "a/b:c"}}};
    EXPECT_EQ(NameTemplate("{dem}_{time:%Y%m%dT%H%M}_{n:04}.png", {}).name(parts),
              "alps_20260622T0030_0007.png");
    EXPECT_EQ(NameTemplate("{{{site}}}/{time:%a %j %z}", {"site"}).name(parts),
              "{a-b-c}/Mon 173 +0200");
}

/// The keys of an object of a schema.
std::set<std::string> keys_of(const nlohmann::json& object) {
    std::set<std::string> keys;
    for (const auto& [key, value] : object.at("properties").items())
        keys.insert(key);
    return keys;
}

/// What a reader says that there is, of an object with a key that there is not.
std::set<std::string> keys_known(const std::string& message) {
    std::set<std::string> keys;
    const std::string_view begin = "no such key; there are ";
    const std::size_t at = message.find(begin);
    if (at == std::string::npos) return {message};
    for (const std::string& key : split(message.substr(at + begin.size()), ','))
        keys.insert(std::string(trimmed(key)));
    return keys;
}

TEST_F(JobFile, TheSchemasKnowTheKeysThatTheReadersKnow) {
    const auto read = [](const char* name) {
        return nlohmann::json::parse(read_text(test::source_dir() / "docs" / name, "test"));
    };
    const nlohmann::json scene = read("scene.schema.json"), job = read("job.schema.json");
    const std::string no_key = "\"qqqqqqqqqqqqqqqqqqqq\": 1";
    const auto of_scene = [&](const std::string& text) {
        return keys_known(test::error_of([&] { read_scene(write(text)); }));
    };
    const auto of_job = [&](const std::string& members) {
        return keys_known(test::error_of([&] { read_job(write(with(members))); }));
    };
    const std::string dem = "\"dem\": {\"files\": [\"a.tif\"]}";
    EXPECT_EQ(of_scene("{\"format\": 1," + dem + "," + no_key + "}"), keys_of(scene));
    EXPECT_EQ(of_scene("{\"format\": 1, \"dem\": {\"files\": [\"a\"]," + no_key + "}}"),
              keys_of(scene["$defs"]["dem"]));
    for (const auto& [part, needed] : {std::pair("time", "\"at\": \"2026-06-21T12:00Z\","),
                                       std::pair("effects", ""), std::pair("picture", "")})
        EXPECT_EQ(of_scene(fmt::format("{{\"format\": 1,{},\"{}\": {{{}{}}}}}", dem, part, needed,
                                       no_key)),
                  keys_of(scene["$defs"][part]));
    EXPECT_EQ(of_scene("{\"format\": 1," + dem + ",\"camera\": {\"orbit\": {" + no_key + "}}}"),
              keys_of(scene["$defs"]["orbit"]));
    // Of an eye that looks along a heading, and of one that looks at a place.
    std::set<std::string> camera =
        of_scene("{\"format\": 1," + dem + ",\"camera\": {\"eye\": [46, 8]," + no_key + "}}");
    camera.merge(of_scene("{\"format\": 1," + dem +
                          ",\"camera\": {\"eye\": [46, 8], \"look_at\": [46, 9]," + no_key + "}}"));
    EXPECT_EQ(camera, keys_of(scene["$defs"]["camera"]));

    EXPECT_EQ(of_job(no_key), keys_of(job));
    EXPECT_EQ(of_job("\"shots\": [{" + no_key + "}]"), keys_of(job["$defs"]["shot"]));
    std::set<std::string> axis = of_job("\"sweep\": [{" + no_key + "}]");
    axis.merge(of_job("\"sweep\": [{\"set\": \"a.b\", \"values\": [1]," + no_key + "}]"));
    EXPECT_EQ(axis, keys_of(job["$defs"]["axis"]));
    EXPECT_EQ(of_job("\"sweep\": [{\"times\": {\"from\": \"6:00\", \"to\": \"7:00\", \"step\": "
                     "\"1h\"," +
                     no_key + "}}]"),
              keys_of(job["$defs"]["times"]["anyOf"][1]));
    std::set<std::string> dates =
        of_job("\"sweep\": [{\"dates\": {\"year\": 2026," + no_key + "}}]");
    dates.merge(
        of_job("\"sweep\": [{\"dates\": {\"from\": \"2026-01-01\", \"to\": \"2026-01-02\"," +
               no_key + "}}]"));
    EXPECT_EQ(dates, keys_of(job["$defs"]["dates"]["anyOf"][1]));
    std::set<std::string> sites =
        of_job("\"sweep\": [{\"sites\": {\"file\": \"a.csv\"," + no_key + "}}]");
    EXPECT_EQ(sites, keys_of(job["$defs"]["sites"]));
    EXPECT_EQ(of_job("\"film\": {" + no_key + "}"), keys_of(job["$defs"]["film"]));
    EXPECT_EQ(of_job("\"sweep\": [{\"orbit\": {" + no_key + "}}]"), keys_of(job["$defs"]["orbit"]));
    write("lat,lon\n46,8\n46.1,8\n", "line.csv");
    std::set<std::string> flight =
        of_job("\"sweep\": [{\"flight\": {\"along\": \"line.csv\"," + no_key + "}}]");
    const std::string views = "\"views\": [{\"eye\": [46, 8]}, {\"eye\": [46, 9]}],";
    flight.merge(of_job("\"sweep\": [{\"flight\": {" + views + no_key + "}}]"));
    EXPECT_EQ(flight, keys_of(job["$defs"]["flight"]));
}

// --- Films

TEST_F(JobFile, AFilmIsOneFile) {
    const std::string times =
        "\"sweep\": [{\"times\": [\"2026-06-21T06:00Z\", "
        "\"2026-06-21T07:00Z\"]}],";
    EXPECT_THAT(names(times + "\"output\": \"{dem}.mp4\""), ElementsAre("alps.mp4", "alps.mp4"));
    const Job webp = read_job(write(with(times + "\"output\": \"a.webp\", \"film\": {}")));
    EXPECT_TRUE(webp.is_film());
    EXPECT_FALSE(read_job(write(with(times + "\"output\": \"{n}.webp\""))).is_film());
    // The frames of a film as pictures.
    EXPECT_FALSE(read_job(write(with(times + "\"output\": \"{n}.png\", \"film\": {}"))).is_film());
    EXPECT_EQ(error(with(times + "\"output\": \"{n}.mp4\"")),
              "2: output: a film is one file but \"{n}.mp4\" names 1.mp4 and 2.mp4; remove what "
              "differs between its frames");
    EXPECT_EQ(error(with("\"film\": {\"fps\": 0}")),
              "2: film.fps: expected a number in [0.1, 240] but got 0");
}

TEST_F(JobFile, RangesByTheNumberOfFrames) {
    const auto times = shots(
        "\"sweep\": [{\"times\": {\"from\": \"2026-06-21T06:00Z\", \"to\": "
        "\"2026-06-21T07:00Z\", \"frames\": 5}}]");
    ASSERT_EQ(times.size(), 5u);
    EXPECT_EQ(sun::to_iso(times[1].utc), "2026-06-21T06:15:00Z");
    EXPECT_EQ(sun::to_iso(times[4].utc), "2026-06-21T07:00:00Z");
    const auto seconds = shots(
        "\"film\": {\"fps\": 24}, \"sweep\": [{\"times\": {\"from\": "
        "\"2026-06-21T06:00Z\", \"to\": \"2026-06-21T07:00Z\", "
        "\"duration_s\": 2.5}}]");
    EXPECT_EQ(seconds.size(), 60u);
    const auto dates = shots(
        "\"sweep\": [{\"dates\": {\"from\": \"2026-01-01\", \"to\": "
        "\"2026-01-31\", \"frames\": 4, \"at\": \"12:00\"}}]");
    ASSERT_EQ(dates.size(), 4u);
    EXPECT_EQ(sun::to_iso(dates[1].utc), "2026-01-11T12:00:00Z");
    EXPECT_EQ(sun::to_iso(dates[3].utc), "2026-01-31T12:00:00Z");
    const auto values = shots(
        "\"sweep\": [{\"set\": \"haze.density\", \"from\": 0.2, \"to\": 0, "
        "\"frames\": 3}]");
    ASSERT_EQ(values.size(), 3u);
    EXPECT_EQ(values[1].names.at("haze.density"), "0.1");
    EXPECT_EQ(values[2].names.at("haze.density"), "0");
}

TEST_F(JobFile, NumbersOfFramesThatAreNone) {
    const auto of = [&](const std::string& member) {
        return error(with("\"sweep\": [{\"orbit\": {" + member + "}}]"));
    };
    EXPECT_EQ(of("\"frames\": 0"),
              "2: sweep[0].orbit.frames: expected a whole number in [1, 1000000] but got 0");
    EXPECT_EQ(of("\"frames\": 1e7"),
              "2: sweep[0].orbit.frames: expected a whole number in [1, 1000000] but got 10000000");
    EXPECT_EQ(of("\"duration_s\": 1e5"),
              "2: sweep[0].orbit.duration_s: expected at most 1000000 frames but got 3000000");
    EXPECT_EQ(of("\"duration_s\": 1, \"frames\": 30"),
              "2: sweep[0].orbit.duration_s: expected frames or a duration but got both");
    EXPECT_THAT(error(with("\"sweep\": [{\"orbit\": {\"frames\": 5000}}]")),
                HasSubstr("the job has 5000 pictures, more than 1000; add --yes"));
}

/// Flat ground at 500 m around 46, 8.
MotionGround plain(const Scene& scene) {
    const geo::LocalFrame frame(geo::geodetic_deg(46, 8));
    MotionGround ground{.height_m = [](const geo::Geodetic&) { return 500.0; }, .frame = frame};
    for (const double x : {-5000., 5000.})
        for (const double y : {-5000., 5000.})
            ground.points.push_back({x, y, 500});
    ground.camera = [ground, settled = scene.view](View view) {
        view.orbit.azimuth_deg = view.orbit.azimuth_deg.value_or(200);
        view.orbit.elevation_deg = view.orbit.elevation_deg.value_or(30);
        return make_camera(view, ground.height_m, ground.frame, {ground.points, {}}, 1, 1);
    };
    return ground;
}

TEST_F(JobFile, CamerasMoveWhileTimePasses) {
    write("lat,lon\n46,8\n46.02,8.02\n", "line.csv");
    const auto moving = [&](const std::string& axis, const std::string& more = "") {
        const Job job = read_job(write(
            with("\"combine\": \"zip\", \"sweep\": [{\"times\": {\"from\": \"2026-06-21T06:00Z\", "
                 "\"to\": \"2026-06-21T07:00Z\", \"frames\": 31}}, {" +
                 axis + "}], \"output\": \"{camera}.png\"" + more)));
        return shots_of(job, resolve, 1000, plain).shots;
    };
    for (const std::string axis :
         {"\"orbit\": {\"frames\": 31, \"ease\": true}",
          "\"flight\": {\"along\": \"line.csv\", \"frames\": 31}",
          "\"flight\": {\"views\": [{\"eye\": [46, 8, 900]}, {\"orbit\": {\"azimuth\": 90}}], "
          "\"frames\": 31}"}) {
        const std::vector<Shot> shots = moving(axis);
        ASSERT_EQ(shots.size(), 31u) << axis;
        EXPECT_EQ(shots[1].output.filename(), "0002.png");
        EXPECT_EQ(sun::to_iso(shots[15].utc), "2026-06-21T06:30:00Z");
        ASSERT_TRUE(shots[15].scene.view.eye) << axis;
        EXPECT_NE(shots[15].scene.view.eye->place, shots[16].scene.view.eye->place);
    }
    // 2711 m at 100 m/s, at rest at both ends.
    EXPECT_THAT(
        test::error_of(
            [&] { moving("\"flight\": {\"along\": \"line.csv\", \"speed_m_s\": 100}"); }),
        HasSubstr("sweep[1].flight: expected 31 values, as sweep[0].times has, but got 1016; "
                  "\"combine\": \"zip\" takes axes of one length"));
}

TEST_F(JobFile, FlightsThatAreNone) {
    write("lat,lon\n46,8\n46,8\n", "same.csv");
    write("lat,lon\n46,8\n", "one.csv");
    write("lat,lon\n46,8\nnan,9\n", "nan.csv");
    const auto of = [&](const std::string& members) {
        return error(with("\"sweep\": [{\"flight\": {" + members + "}}]"));
    };
    EXPECT_EQ(
        of("\"along\": \"same.csv\""),
        "2: sweep[0].flight.along: expected two different places or more but got the same one "
        "again");
    EXPECT_THAT(of("\"along\": \"one.csv\""), HasSubstr("one.csv"));
    EXPECT_THAT(of("\"along\": \"nan.csv\""), HasSubstr("nan.csv"));
    EXPECT_EQ(of("\"frames\": 3"), "2: sweep[0].flight: expected a member \"along\"");
    EXPECT_EQ(of("\"views\": [{\"eye\": [46, 8]}]"),
              "2: sweep[0].flight.views: expected two cameras or more but got 1");
    EXPECT_THAT(of("\"views\": [], \"along\": \"same.csv\""), HasSubstr("but got both"));
}

}  // namespace
}  // namespace relevo::scene
