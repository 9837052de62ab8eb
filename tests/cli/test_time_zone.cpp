#include <filesystem>
#include <fstream>

#include <nlohmann/json.hpp>

#include "base/text.h"
#include "cli/program.h"
#include "image/image.h"
#include "support/support.h"

// --tz auto, solar, and none at all.
namespace relevo::test::test_time_zone {
namespace {

using nlohmann::json;
using Words = std::vector<std::string>;

const std::string kNewYork = "America/New_York";
const std::string kValley = "36.30,-84.24";  // in the bundled DEM

std::filesystem::path dir() {
    static const std::filesystem::path folder = scratch_dir("cli_time_zone");
    return folder;
}

Words joined(Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

std::string notice_of(const std::string& zone) {
    return "relevo: time zone " + zone + " of the place; --tz sets another\n";
}

/// A run says on standard output what it says with the zone named, and what it has assumed on
/// standard error.
void expect_zone_of_the_place(const Words& arguments, const std::string& zone) {
    const Result named = relevo(joined(arguments, {"--tz", zone}));
    EXPECT_EQ(named.status, 0) << named.err;
    EXPECT_EQ(named.err.find("time zone"), std::string::npos) << named.err;
    for (const Words& words : {Words{}, Words{"--tz", "auto"}}) {
        const Result run = relevo(joined(arguments, words));
        EXPECT_EQ(run.out, named.out);
        EXPECT_EQ(run.err, notice_of(zone) + named.err);
        const Result quiet = relevo(joined(joined({"-q"}, arguments), words));
        EXPECT_EQ(quiet.err.find("time zone"), std::string::npos) << quiet.err;
    }
    const json object = json::parse(relevo(joined(arguments, {"--json"})).out);
    json expected = json::parse(relevo(joined(arguments, {"--tz", zone, "--json"})).out);
    EXPECT_FALSE(expected.contains("assumptions"));
    expected["assumptions"] = {"time zone " + zone + " of the place"};
    EXPECT_EQ(object, expected);
}

TEST(TimeZone, OfThePlaceIsTheDefaultOfEveryVerbOfTheSun) {
    expect_zone_of_the_place(
        {"sun", "position", "--at", "47.2692,11.4041", "--time", "2026-06-21T12:00"},
        "Europe/Vienna");
    expect_zone_of_the_place(
        {"sun", "position", "--at", "47.2692,11.4041", "--time", "sunset", "--date", "2026-06-21"},
        "Europe/Vienna");
    expect_zone_of_the_place({"sun", "day", "--at", "-45.031,168.663", "--date", "2026-06-21"},
                             "Pacific/Auckland");
    expect_zone_of_the_place(
        {"sun", "day", "--at", kValley, "--from", "2026-10-31", "--to", "2026-11-02"}, kNewYork);
    expect_zone_of_the_place({"sun", "day", bundled_dem(), "--at", kValley, "--date", "2026-12-21"},
                             kNewYork);
    expect_zone_of_the_place(
        {"sun", "carpet", bundled_dem(), "--at", kValley, "--year", "2026", "--step", "1h"},
        kNewYork);
    expect_zone_of_the_place({"sun", "when", bundled_dem(), "--at", "36.2,-84.15", "--over",
                              "36.1983,-84.2306", "--from", "2026-03-01", "--to", "2026-04-30"},
                             kNewYork);
    // An event that names its place happens there, by the clocks there.
    expect_zone_of_the_place(
        {"sun", "position", "--at", kValley, "--time", "2026-06-21 sunrise@46.55,8.56"},
        "Europe/Zurich");
}

TEST(TimeZone, OfThePlaceIsThatOfPanoramas) {
    const auto panorama = [](const Words& words, const std::string& err) {
        const std::string path = (dir() / "horizon.svg").string();
        const Result run =
            relevo(joined({"sun", "horizon", bundled_dem(), "--at", kValley, "--date", "2026-12-21",
                           "--highest", "0", "-o", path, "--overwrite", "--step", "1"},
                          words));
        EXPECT_EQ(run.status, 0) << run.err;
        EXPECT_EQ(run.err, err);
        return read_text(path, "test");
    };
    const std::string named = panorama({"--tz", kNewYork}, "");
    EXPECT_EQ(panorama({}, notice_of(kNewYork)), named);
    EXPECT_NE(named.find(kNewYork), std::string::npos);
    EXPECT_NE(panorama({"--tz", "solar"}, "").find("LMT-05:36:58"), std::string::npos);
}

TEST(TimeZone, OfTheDemsMiddleIsTheDefaultOfItsVerbs) {
    const Words info{"info", bundled_dem(), "--time", "2026-06-21T18:30"};
    const Result named = relevo(joined(info, {"--tz", kNewYork}));
    const Result run = relevo(info);
    EXPECT_EQ(run.out, named.out);
    EXPECT_EQ(run.err, notice_of(kNewYork) + named.err);
    const json object = json::parse(relevo(joined(info, {"--json"})).out);
    EXPECT_EQ(object["assumptions"].back(), "time zone America/New_York of the place");
    EXPECT_EQ(object["sun"]["utc"], "2026-06-21T22:30:00Z");

    const auto taken_at = [](const Words& words, const std::string& notice) {
        const std::string path = (dir() / "picture.png").string();
        const Result taken = relevo(joined(
            {"capture", bundled_dem(), "-o", path, "--overwrite", "--size", "64x48", "--only", ""},
            words));
        EXPECT_EQ(taken.status, 0) << taken.err;
        EXPECT_TRUE(notice.empty() ? taken.err.find("time zone") == std::string::npos
                                   : taken.err.starts_with(notice))
            << taken.err;
        return split(image::read_metadata(path).at("Description"), ';').at(1);
    };
    const Words evening{"--time", "2026-06-21T18:30"};
    EXPECT_EQ(taken_at(evening, notice_of(kNewYork)), " 2026-06-21T22:30:00Z");
    // The camera may stand in another zone.
    EXPECT_EQ(taken_at(joined(evening, {"--eye", "36.3,-86.5,5000", "--look-at", "36.3,-84.2"}),
                       notice_of(kNewYork)),
              " 2026-06-21T22:30:00Z");
    EXPECT_EQ(taken_at(joined(evening, {"--tz", "solar"}), ""), " 2026-06-22T00:06:59Z");
    EXPECT_EQ(taken_at(joined(evening, {"--tz", "+02:00"}), ""), " 2026-06-21T16:30:00Z");
    EXPECT_EQ(taken_at({"--time", "2026-06-21T18:30+02:00"}, ""), " 2026-06-21T16:30:00Z");
    EXPECT_EQ(taken_at({"--time", "noon", "--date", "2026-06-21"}, notice_of(kNewYork)),
              taken_at({"--time", "noon", "--date", "2026-06-21", "--tz", kNewYork}, ""));
    EXPECT_EQ(
        taken_at({"--time", "2026-06-21 noon@-45.031,168.663"}, notice_of("Pacific/Auckland")),
        taken_at({"--time", "2026-06-21 noon@-45.031,168.663", "--tz", "Pacific/Auckland"}, ""));
}

TEST(TimeZone, OfASceneIsThatOfTheDemsMiddleUnlessItNamesOne) {
    const auto taken_at = [](const std::string& time, const Words& words) {
        const std::filesystem::path scene = dir() / "scene.json", picture = dir() / "scene.png";
        std::ofstream(scene) << R"({"format": 1, "dem": {"files": [)" << json(bundled_dem())
                             << R"(]}, "effects": {"only": []}, "picture": {"size": [64, 48]}, )"
                             << "\"time\": " << time << "}";
        const Result run = relevo(joined(
            {"capture", "--scene", scene.string(), "-o", picture.string(), "--overwrite"}, words));
        EXPECT_EQ(run.status, 0) << run.err;
        return split(image::read_metadata(picture).at("Description"), ';').at(1);
    };
    EXPECT_EQ(taken_at(R"({"at": "2026-06-21T18:30"})", {}), " 2026-06-21T22:30:00Z");
    EXPECT_EQ(taken_at(R"({"at": "2026-06-21T18:30", "zone": "auto"})", {}),
              " 2026-06-21T22:30:00Z");
    EXPECT_EQ(taken_at(R"({"at": "2026-06-21T18:30", "zone": "solar"})", {}),
              " 2026-06-22T00:06:59Z");
    EXPECT_EQ(taken_at(R"({"at": "2026-06-21T18:30", "zone": "Europe/Zurich"})", {}),
              " 2026-06-21T16:30:00Z");
    EXPECT_EQ(taken_at(R"({"at": "2026-06-21T18:30+02:00", "zone": "auto"})", {}),
              " 2026-06-21T16:30:00Z");

    // What is saved is what was asked for, and gives the same moment again.
    const std::string saved = (dir() / "saved.json").string();
    taken_at(R"({"at": "2026-06-21T18:30", "zone": "solar"})",
             {"--time", "2026-01-02T10:00", "--save-scene", saved});
    const json time = json::parse(read_text(saved, "test"))["time"];
    EXPECT_EQ(time, (json{{"at", "2026-01-02T10:00"}}));
    EXPECT_EQ(taken_at(time.dump(), {}), " 2026-01-02T15:00:00Z");
}

TEST(TimeZone, SolarIsTheMeridiansMeanTime) {
    const Words day{"sun", "day", "--at", "47.2692,11.4041", "--date", "2026-11-03"};
    const Result run = relevo(joined(day, {"--tz", "solar"}));
    EXPECT_EQ(run.err, "");
    EXPECT_NE(run.out.find("2026-11-03, LMT+00:45:37\n"), std::string::npos) << run.out;
    // The equation of time is 16 min 26 s that day (The Astronomical Almanac).
    EXPECT_NE(run.out.find("transit             2026-11-03T11:43:3"), std::string::npos) << run.out;
    EXPECT_EQ(json::parse(relevo(joined(day, {"--tz", "solar", "--json"})).out)["zone"],
              "LMT+00:45:37");
    const Result shown = relevo(
        {"sun", "position", "--at", "0,-90", "--time", "2026-06-21T18:30Z", "--tz", "solar"});
    EXPECT_NE(shown.out.find("2026-06-21T12:30:00-06:00"), std::string::npos) << shown.out;
    expect_failure(
        {"sun", "position", "--at", "0,-90", "--time", "2026-06-21T18:30+01:00", "--tz", "solar"},
        3,
        "time: 2026-06-21T18:30+01:00: offset +01:00 contradicts LMT-06:00, expected -06:00 (LMT); "
        "use only one of them");
}

TEST(TimeZone, IsLookedUpOnlyWhereOneIsNeeded) {
    const Words nowhere{"RELEVO_SHARE=" + (dir() / "nowhere").string()};
    const Words position{"sun", "position", "--at", "46.95,7.44", "--time"};
    for (const Words& words : {Words{"2026-06-21T18:30Z"}, Words{"2026-06-21T18:30+02:00"},
                               Words{"2026-06-21T18:30+02:00", "--tz", "auto"},
                               Words{"2026-06-21T18:30", "--tz", "Europe/Zurich"}, Words{"now"},
                               Words{"2026-06-21T18:30", "--tz", "solar"}}) {
        const Result run = relevo(joined(position, words), nowhere);
        EXPECT_EQ(run.status, 0) << words.front();
        EXPECT_EQ(run.err, "") << words.front();
    }
    const Result missing = relevo(joined(position, {"2026-06-21T18:30"}), nowhere);
    EXPECT_EQ(missing.status, 3);
    EXPECT_EQ(missing.out, "");
    EXPECT_EQ(missing.err, "relevo: error: time zone: " +
                               (dir() / "nowhere/data/timezones/timezones.bin").string() +
                               ": cannot be read, No such file or directory; install Relevo "
                               "again, or pass --tz Europe/Zurich\n");
}

TEST(TimeZone, ThatTheComputerLacksIsTheHourOfTheLongitudeAndAWarning) {
    const std::filesystem::path share = dir() / "share";
    std::filesystem::create_directories(share / "data/timezones");
    // A map of one cell, as tools/make_time_zones.py writes it.
    std::ofstream(share / "data/timezones/timezones.bin", std::ios::binary)
        << "relevo time zones 1\n1 1 1\nMars/Olympus\n"
        << std::string("\1\0\1\0\xf3\x93\x4c\x74\xdb\x25\x3e\xe5", 12);
    const Words share_here{"RELEVO_SHARE=" + share.string()};
    const Result run = relevo(
        {"-q", "sun", "position", "--at", "46.55,8.56", "--time", "2026-06-21T12:00"}, share_here);
    EXPECT_EQ(run.status, 0);
    EXPECT_NE(run.out.find("2026-06-21T12:00:00+01:00"), std::string::npos) << run.out;
    EXPECT_TRUE(
        run.err.starts_with("relevo: warning: time zone +01:00, by longitude only: the time zone "
                            "database of this computer (version "))
        << run.err;
    EXPECT_TRUE(run.err.ends_with(") has no Mars/Olympus; --tz sets another\n")) << run.err;
}

}  // namespace
}  // namespace relevo::test::test_time_zone
