#include <filesystem>
#include <limits>

#include <fmt/format.h>
#include <glm/vec2.hpp>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "base/units.h"
#include "cli/program.h"
#include "dem/fixture.h"
#include "geo/crs.h"
#include "image/image.h"
#include "support/support.h"

namespace relevo::test::test_sun_verbs {
namespace {

using nlohmann::json;

const std::string kNewYork = "America/New_York";
const std::string kValley = "36.30,-84.24";  // in the bundled DEM

std::filesystem::path dir() {
    static const std::filesystem::path folder = scratch_dir("cli_sun");
    return folder;
}
std::string out(const std::string& name) {
    return (dir() / name).string();
}

json json_of(std::vector<std::string> arguments) {
    arguments.emplace_back("--json");
    const Result run = relevo(arguments);
    EXPECT_EQ(run.status, 0) << run.err;
    return of_one_day(json::parse(run.out));
}

/// Seconds of the day of a time in JSON.
double time_of_day_s(const json& utc) {
    const std::string text = utc.get<std::string>().substr(11);
    return 3600 * *parse_number(text.substr(0, 2)) + 60 * *parse_number(text.substr(3, 2)) +
           *parse_number(text.substr(6, 6));
}

TEST(SunDayVerb, PrintsTheMinutesOfTheNavalObservatory) {
    // U.S. Naval Observatory, tables for 2020, Anchorage (tests/data/sun/usno_riseset.csv); the day
    // is that of UTC.
    struct Case {
        const char *date, *key;
        double hour, minute;
    };
    for (const Case& c :
         {Case{"2020-01-01", "sunrise_utc", 19, 14}, Case{"2020-05-13", "sunrise_utc", 13, 16},
          Case{"2020-07-02", "sunset_utc", 7, 38}, Case{"2020-11-14", "sunset_utc", 1, 25}}) {
        const json day = json_of(
            {"sun", "day", "--at", "61.216667,-149.866667", "--date", c.date, "--tz", "UTC"});
        EXPECT_NEAR(time_of_day_s(day[c.key]), 3600 * c.hour + 60 * c.minute, 60) << c.date;
    }
    const json day = json_of({"sun", "day", "--at", "61.216667,-149.866667", "--date", "2020-06-20",
                              "--tz", "America/Anchorage"});
    EXPECT_EQ(day["definition"],
              "sunrise and sunset: centre of the sun 50 arc-minutes below the horizon, without "
              "refraction (U.S. Naval Observatory)");
    EXPECT_EQ(day["polar"], nullptr);
    EXPECT_EQ(day["nautical_dawn_utc"], nullptr);  // the nights are too bright
    EXPECT_EQ(day["date"], "2020-06-20");
    EXPECT_EQ(day["zone"], "America/Anchorage");
    // U.S. Naval Observatory: 21:44, rounded.
    EXPECT_NEAR(time_of_day_s(day["seasons"][0]["june_solstice_utc"]), 21 * 3600 + 44 * 60, 60);
    for (const char* key :
         {"place", "twilight_definition", "astronomical_dawn_utc", "civil_dawn_utc", "transit_utc",
          "civil_dusk_utc", "nautical_dusk_utc", "astronomical_dusk_utc", "lower_transit_utc",
          "golden_hour", "blue_hour", "events"})
        EXPECT_TRUE(day.contains(key)) << key;
    EXPECT_FALSE(day.contains("direct_sun"));
}

TEST(SunDayVerb, SaysPolarDayAndNight) {
    const std::vector<std::string> there{
        "sun", "day", "--at", "78.22,15.65", "--tz", "Arctic/Longyearbyen", "--date"};
    const auto on = [&](const char* date) {
        std::vector<std::string> arguments = there;
        arguments.emplace_back(date);
        return arguments;
    };
    const json summer = json_of(on("2026-06-21")), winter = json_of(on("2026-12-21"));
    EXPECT_EQ(summer["polar"], "day");
    EXPECT_EQ(summer["sunrise_utc"], nullptr);
    EXPECT_EQ(summer["day_length_h"], 24);
    EXPECT_EQ(winter["polar"], "night");
    EXPECT_EQ(winter["day_length_h"], 0);
    EXPECT_NE(relevo(on("2026-06-21")).out.find("polar day           the sun stays up all day\n"),
              std::string::npos);
    const std::string text = relevo(on("2026-12-21")).out;
    EXPECT_NE(text.find("polar night         the sun stays down all day\n"), std::string::npos);
    EXPECT_NE(text.find("civil twilight      none, the sun's centre stays more than 6 degrees down "
                        "all day\n"),
              std::string::npos);
    EXPECT_NE(text.find("golden hour         none\n"), std::string::npos);
}

TEST(SunDayVerb, OptionsOfTheDefinitionAreTakenAndSaid) {
    const auto day = [](std::vector<std::string> options) {
        std::vector<std::string> arguments{"sun",    "day",        "--at", "46.95,7.44,560",
                                           "--date", "2026-03-20", "--tz", "Europe/Zurich"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return json_of(arguments);
    };
    const json usno = day({});
    const json limb = day({"--limb", "center", "--no-refraction"});
    EXPECT_EQ(limb["definition"],
              "sunrise and sunset: centre of the sun on the horizon, no refraction");
    // The centre at 0 instead of -50 arc-minutes: 50 / (15 cos 46.95) minutes of time later, about.
    EXPECT_GT(limb["sunrise_utc"], usno["sunrise_utc"]);
    EXPECT_NEAR(usno["day_length_h"].get<double>() - limb["day_length_h"].get<double>(),
                2 * 50.0 / 60 / 15 / 0.6826, 0.005);
    EXPECT_EQ(day({"--eye-height", "100", "--refraction", "saemundsson"})["definition"],
              "sunrise and sunset: upper limb of the sun on the horizon as seen from 100 m above "
              "it (dip 17.60 arc-minutes), Saemundsson's refraction, 1010 hPa, 10 C");
    EXPECT_EQ(day({"--dip", "0.5", "--no-refraction", "--limb", "lower"})["definition"],
              "sunrise and sunset: lower limb of the sun on the horizon 30.00 arc-minutes below "
              "the level one, no refraction");
}

TEST(SunDayVerb, AYearIsATableWithItsSeasons) {
    const json year =
        json_of({"sun", "day", "--at", "46.95,7.44", "--year", "2024", "--tz", "Europe/Zurich"});
    ASSERT_EQ(year["days"].size(), 366U);
    EXPECT_EQ(year["days"][59]["date"], "2024-02-29");
    EXPECT_EQ(year["seasons"].size(), 1U);
    const Result csv = relevo({"sun", "day", "--at", "46.95,7.44", "--from", "2024-02-28", "--to",
                               "2024-03-01", "--tz", "Europe/Zurich", "--csv"});
    const std::vector<std::string> lines = split(csv.out, '\n');
    ASSERT_EQ(lines.size(), 7U) << csv.out;  // two remarks, a header, three days, an empty end
    EXPECT_TRUE(lines[0].starts_with("# sunrise and sunset: centre of the sun 50 arc-minutes"));
    EXPECT_EQ(lines[2],
              "date,polar,astronomical_dawn,nautical_dawn,civil_dawn,sunrise,transit,sunset,"
              "civil_dusk,nautical_dusk,astronomical_dusk,lower_transit,day_length_h,golden_hour,"
              "blue_hour");
    EXPECT_TRUE(lines[4].starts_with("2024-02-29,,2024-02-29T05:"));
    const std::vector<std::string> row = split(lines[4], ',');
    EXPECT_EQ(row.size(), split(lines[2], ',').size());
    EXPECT_TRUE(row[5].ends_with("+01:00"));
    const std::string text =
        relevo({"sun", "day", "--at", "46.95,7.44", "--year", "2024", "--tz", "Europe/Zurich"}).out;
    for (const char* line :
         {"March equinox       2024-03-20T04:06", "June solstice       2024-06-20T22:5",
          "December solstice   2024-12-21T10:"})
        EXPECT_NE(text.find(line), std::string::npos) << line;
}

TEST(SunDayVerb, StandsDirectLightBesideTheFlatHorizon) {
    const std::vector<std::string> arguments{
        "sun", "day", bundled_dem(), "--at", kValley, "--date", "2026-12-21", "--tz", kNewYork};
    const json day = json_of(arguments);
    ASSERT_GE(day["direct_sun"].size(), 1U);
    const json& first = day["direct_sun"][0];
    EXPECT_GT(first["first_utc"], day["sunrise_utc"]);
    EXPECT_LT(day["direct_sun_h"].get<double>(), day["day_length_h"].get<double>());
    EXPECT_TRUE(day["light_definition"].get<std::string>().starts_with(
        "direct light: centre of the sun over the terrain horizon, refraction integrated"));
    EXPECT_TRUE(day["horizon_definition"].get<std::string>().find("k = 0.13") != std::string::npos);
    // The same with the upper limb is longer, by some minutes.
    std::vector<std::string> limb = arguments;
    limb.insert(limb.end(), {"--limb", "upper"});
    EXPECT_GT(json_of(limb)["direct_sun_h"], day["direct_sun_h"]);
    EXPECT_NE(relevo(arguments).out.find("direct sun          0"), std::string::npos);
}

TEST(SunHorizonVerb, WritesEveryFormat) {
    const std::vector<std::string> verb{"sun",   "horizon", bundled_dem(), "--at",
                                        kValley, "-q",      "-o"};
    const auto write = [&](const std::string& name, std::vector<std::string> options) {
        std::vector<std::string> arguments = verb;
        arguments.push_back(out(name));
        arguments.insert(arguments.end(), options.begin(), options.end());
        const Result run = relevo(arguments);
        EXPECT_EQ(run.status, 0) << run.err;
        EXPECT_EQ(run.out, "");
    };
    write("h.csv", {"--step", "1"});
    const Csv csv = read_csv(out("h.csv"));
    EXPECT_EQ(csv.header, (std::vector<std::string>{"azimuth_deg", "horizon_deg", "distance_m",
                                                    "lat_deg", "lon_deg", "height_m"}));
    ASSERT_EQ(csv.rows.size(), 360U);
    write("h.json", {"--step", "1"});
    const json object = json::parse(read_text(out("h.json"), "test"));
    ASSERT_EQ(object["horizon"].size(), 360U);
    for (const int i : {0, 90, 251}) {
        const auto k = static_cast<std::size_t>(i);
        EXPECT_EQ(object["horizon"][k]["azimuth_deg"], i);
        EXPECT_NEAR(object["horizon"][k]["horizon_deg"].get<double>(),
                    *parse_number(csv.rows[k][1]), 1e-5);
    }
    for (const char* key : {"place", "eye_m", "definition", "open_sectors"})
        EXPECT_TRUE(object.contains(key)) << key;
    write("h.svg", {"--date", "2026-12-21", "--tz", kNewYork, "--name", "The valley"});
    const std::string svg = read_text(out("h.svg"), "test");
    EXPECT_TRUE(svg.starts_with("<svg xmlns="));
    EXPECT_TRUE(svg.ends_with("</svg>\n"));
    EXPECT_NE(svg.find("<title>The valley: horizon and path of the sun, 21 December 2026</title>"),
              std::string::npos);
    write("h.png", {"--year", "2026", "--tz", kNewYork, "--scale", "0.5"});
    EXPECT_EQ(image::read(out("h.png")).width, 750);
    write("plain.png", {});  // the landscape alone
}

TEST(SunHorizonVerb, WarnsWhereTheRidgeMayLieBeyondTheDem) {
    const Result near_edge =
        relevo({"sun", "horizon", bundled_dem(), "--at", "36.30,-84.40", "--csv"});
    EXPECT_EQ(near_edge.status, 0);
    EXPECT_TRUE(
        near_edge.err.starts_with("relevo: warning: mountains of up to 1076 m (the DEM's highest "
                                  "post) outside the DEM could raise the horizon: above "))
        << near_edge.err;
    // Directions less than five degrees apart are one for a reader, not for a program.
    const Result broken =
        relevo({"sun", "horizon", bundled_dem(), "--at", "36.30,-84.30", "--json"});
    EXPECT_EQ(json::parse(broken.out)["open_sectors"].size(), 4U);
    EXPECT_EQ(
        broken.err,
        "relevo: warning: mountains of up to 1076 m (the DEM's highest post) outside the DEM could "
        "raise the horizon: above 1037 m from azimuth 301 (WNW) to 307 (NW) as far as 14 km away, "
        "where the DEM reaches "
        "11.9 km, and above 786 m from azimuth 328 (NNW) to 347 (NNW) as far as 57 km away, where "
        "the DEM reaches 16.6 km; those of up to 8850 m (the Earth's highest) as far as 329 km; "
        "use a larger DEM or --surroundings, or bound them with --highest\n");
    const Result low = relevo(
        {"sun", "horizon", bundled_dem(), "--at", "36.30,-84.40", "--csv", "--highest", "200"});
    EXPECT_EQ(low.err, "");
}

TEST(SunHorizonVerb, TakesTerrestrialRefractionAndTheEye) {
    const auto north = [](std::vector<std::string> options) {
        std::vector<std::string> arguments{"sun",   "horizon", bundled_dem(), "--at",
                                           kValley, "--step",  "90",          "-q"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return json_of(arguments);
    };
    const json plain = north({});
    EXPECT_EQ(plain["eye_m"], plain["place"]["height_m"]);
    const json raised = north({"--eye-height", "20"});
    EXPECT_NEAR(raised["eye_m"].get<double>() - plain["eye_m"].get<double>(), 20, 1e-9);
    EXPECT_LT(raised["horizon"][0]["horizon_deg"], plain["horizon"][0]["horizon_deg"]);
    EXPECT_GT(north({"-k", "0.3"})["horizon"][0]["horizon_deg"],
              plain["horizon"][0]["horizon_deg"]);
}

TEST(SunCarpetVerb, IsTheSameAsPictureTableAndObject) {
    const std::vector<std::string> verb{"sun", "carpet", bundled_dem(), "--at", kValley,
                                        "-q",  "--year", "2026",        "--tz", kNewYork};
    const auto with = [&](std::vector<std::string> options) {
        std::vector<std::string> arguments = verb;
        arguments.insert(arguments.end(), options.begin(), options.end());
        return arguments;
    };
    const json object = json_of(with({"--step", "1h"}));
    ASSERT_EQ(object["days"].size(), 365U);
    ASSERT_EQ(object["months"].size(), 12U);
    double months_h = 0;
    for (const json& month : object["months"])
        months_h += month["direct_sun_h"].get<double>();
    EXPECT_NEAR(months_h, object["direct_sun_h"].get<double>(), 1e-6);
    EXPECT_LT(object["direct_sun_h"], object["level_horizon_h"]);
    EXPECT_EQ(relevo(with({"--step", "1h", "-o", out("c.csv")})).status, 0);
    const Csv csv = read_csv(out("c.csv"));
    ASSERT_EQ(csv.rows.size(), 365U);
    EXPECT_EQ(csv.header.size(), 3U + 24U);
    EXPECT_EQ(csv.header[3], "00:30:00");
    EXPECT_EQ(csv.rows[171][csv.column("12:30:00")], "lit");
    EXPECT_EQ(csv.rows[171][csv.column("00:30:00")], "night");
    EXPECT_EQ(relevo(with({"-o", out("c.png"), "--scale", "1"})).status, 0);
    EXPECT_EQ(image::read(out("c.png")).width, 1160);
    EXPECT_EQ(image::read_metadata(out("c.png")).at("Title"), "Direct sun through 2026");
    EXPECT_EQ(relevo(with({"-o", out("c.svg")})).status, 0);
}

TEST(SunWhenVerb, FindsTheSunOverASummit) {
    // Cross Mountain, 1076 m, from the valley east of it: the sun sets behind it in spring and
    // autumn.
    const std::vector<std::string> arguments{"sun",
                                             "when",
                                             bundled_dem(),
                                             "--at",
                                             "36.2,-84.15",
                                             "--over",
                                             "36.1983,-84.2306",
                                             "--year",
                                             "2026",
                                             "--tz",
                                             kNewYork,
                                             "-q",
                                             "--summit-radius",
                                             "500"};
    const json found = json_of(arguments);
    EXPECT_EQ(found["target"]["height_m"], 1076);
    ASSERT_GE(found["passages"].size(), 2U);
    for (const json& p : found["passages"]) {
        EXPECT_LE(p["separation_deg"].get<double>(), 0.5);
        EXPECT_NEAR(p["azimuth_deg"].get<double>(), found["sight"]["azimuth_deg"].get<double>(), 1);
        const json there = json_of(
            {"sun", "position", "--at", "36.2,-84.15,300", "--time", p["utc"].get<std::string>()});
        EXPECT_NEAR(there["azimuth_deg"].get<double>(), p["azimuth_deg"].get<double>(), 0.001);
    }
    const Result csv = relevo([&] {
        std::vector<std::string> a = arguments;
        a.emplace_back("--csv");
        return a;
    }());
    EXPECT_EQ(split(csv.out, '\n').size(), found["passages"].size() + 4);
}

TEST(SunVerbs, SayTheShapeOfTheirJson) {
    const std::vector<std::string> at{"--at", kValley};
    struct Case {
        std::vector<std::string> verb;
        std::string schema;
    };
    for (const Case& c :
         {Case{{"sun", "position", "--time", "2026-06-21T12:00Z"}, "relevo-sun-position-1"},
          Case{{"moon", "position", "--time", "2026-06-21T12:00Z"}, "relevo-moon-position-1"},
          Case{{"sun", "day", bundled_dem(), "--date", "2026-06-21"}, "relevo-sun-day-1"},
          Case{{"moon", "day", "--date", "2026-06-21"}, "relevo-moon-day-1"},
          Case{{"sun", "eclipses", "--year", "2026"}, "relevo-sun-eclipses-1"},
          Case{{"sun", "horizon", bundled_dem()}, "relevo-sun-horizon-1"},
          Case{{"sun", "plane", "--year", "2026", "--by", "year"}, "relevo-sun-plane-1"},
          Case{{"sun", "carpet", bundled_dem(), "--year", "2026", "--step", "1h"},
               "relevo-sun-carpet-1"}}) {
        std::vector<std::string> arguments = c.verb;
        arguments.insert(arguments.end(), at.begin(), at.end());
        arguments.insert(arguments.end(), {"--json", "-q"});
        const Result run = relevo(arguments);
        ASSERT_EQ(run.status, 0) << run.err;
        EXPECT_TRUE(run.out.starts_with("{\n  \"schema\": \"" + c.schema + "\"")) << run.out;
    }
}

TEST(SunDayVerb, OfOneDayIsAListOfOneWithFirstAndLastSun) {
    const std::vector<std::string> arguments{"sun",    "day",    bundled_dem(), "--at",
                                             kValley,  "--date", "2026-12-21",  "--tz",
                                             kNewYork, "-q"};
    const auto with = [&](const std::string& more) {
        std::vector<std::string> all = arguments;
        all.push_back(more);
        return relevo(all).out;
    };
    const json days = json::parse(with("--json"))["days"];
    ASSERT_EQ(days.size(), 1U);
    EXPECT_EQ(days[0]["date"], "2026-12-21");
    EXPECT_EQ(days[0]["first_sun_utc"], days[0]["direct_sun"].front()["first_utc"]);
    EXPECT_EQ(days[0]["last_sun_utc"], days[0]["direct_sun"].back()["last_utc"]);
    EXPECT_NEAR(days[0]["minutes"].get<double>(), 60 * days[0]["direct_sun_h"].get<double>(), 1e-9);
    const std::string csv = with("--csv");
    EXPECT_NE(csv.find(",direct_sun,direct_sun_h,first_sun,last_sun,minutes\n"), csv.npos) << csv;
    // The same place in UTM zone 16.
    std::vector<std::string> utm = arguments;
    const auto comma = kValley.find(',');
    const geo::Geodetic place{radians(std::stod(kValley.substr(0, comma))),
                              radians(std::stod(kValley.substr(comma + 1))), 0};
    const glm::dvec2 at = geo::Crs::parse("EPSG:32616", "test").from_geodetic(place);
    utm[4] = fmt::format("{:.4f},{:.4f}", at.x, at.y);
    utm.insert(utm.end(), {"--at-crs", "EPSG:32616", "--json"});
    EXPECT_NEAR(json::parse(relevo(utm).out)["days"][0]["minutes"].get<double>(),
                days[0]["minutes"].get<double>(), 1e-3);
}

TEST(SunVerbs, WriteAsManyFilesAsAreNamed) {
    const auto run = [](const std::vector<std::string>& names) {
        std::vector<std::string> arguments{"sun",   "day",    bundled_dem(), "--at",
                                           kValley, "--date", "2026-12-21",  "-q"};
        for (const std::string& name : names) {
            arguments.emplace_back("-o");
            arguments.push_back(out(name));
        }
        return relevo(arguments);
    };
    ASSERT_EQ(run({"three.csv", "three.json", "three.svg"}).status, 0);
    EXPECT_EQ(json::parse(read_text(out("three.json"), "test"))["days"].size(), 1U);
    EXPECT_NE(read_text(out("three.csv"), "test").find("direct_sun_h"), std::string::npos);
    EXPECT_NE(read_text(out("three.svg"), "test").find("<svg"), std::string::npos);
    // None appears where one cannot.
    EXPECT_EQ(run({"four.csv", "three.json"}).status, 3);
    EXPECT_FALSE(std::filesystem::exists(out("four.csv")));
    EXPECT_EQ(run({"five.csv", "five.csv"}).status, 2);
    EXPECT_EQ(run({"six.csv", "six.tif"}).status, 2);
    EXPECT_FALSE(std::filesystem::exists(out("six.csv")));
}

TEST(EventTimes, AreTakenWhereATimeIs) {
    const json day = json_of(
        {"sun", "day", "--at", "46.55,8.56", "--date", "2026-06-21", "--tz", "Europe/Zurich"});
    const auto position = [](const std::string& time) {
        return json_of({"sun", "position", "--at", "46.55,8.56", "--time", time, "--date",
                        "2026-06-21", "--tz", "Europe/Zurich"});
    };
    EXPECT_EQ(position("sunrise@46.55,8.56")["utc"], day["sunrise_utc"]);
    EXPECT_NEAR(position("sunrise@46.55,8.56")["elevation_deg"].get<double>(), -50.0 / 60, 1e-4);
    EXPECT_EQ(position("noon@46.55,8.56")["utc"], day["transit_utc"]);
    const json before = position("sunset-30min@46.55,8.56");
    EXPECT_GT(before["elevation_deg"].get<double>(), 3);
    EXPECT_LT(before["elevation_deg"].get<double>(), 5);

    // Without a place: that of --at, or the middle of the DEM.
    EXPECT_EQ(position("noon")["utc"], day["transit_utc"]);
    const std::vector<std::string> on{"--date", "2026-06-21", "--tz", kNewYork, "-q"};
    const auto with = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), on.begin(), on.end());
        return arguments;
    };
    const auto over_dem = [&](const std::string& time) {
        return json_of(with({"info", bundled_dem(), "--json", "--time", time}));
    };
    const json valley = json_of(with({"sun", "day", bundled_dem(), "--at", kValley}));
    EXPECT_EQ(over_dem("sunset@" + kValley)["sun"]["utc"].get<std::string>().substr(0, 16),
              valley["sunset_utc"].get<std::string>().substr(0, 16));
    const json about = over_dem("first-light");
    const std::string middle = std::to_string(about["center"]["lat_deg"].get<double>()) + "," +
                               std::to_string(about["center"]["lon_deg"].get<double>());
    const std::string first =
        json_of(with({"sun", "day", bundled_dem(), "--at", middle}))["direct_sun"][0]["first_utc"]
            .get<std::string>()
            .substr(0, 16);
    EXPECT_EQ(about["sun"]["utc"].get<std::string>().substr(0, 16), first);
    const std::string picture = out("event.png");
    const Result run = relevo(with({"capture", bundled_dem(), "-o", picture, "--size", "64x48",
                                    "--only", "", "--time", "first-light", "--overwrite"}));
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_NE(image::read_metadata(picture).at("Description").find(first), std::string::npos);
}

TEST(BadSunInput, EachHasItsMessage) {
    const auto day = [](std::vector<std::string> options) {
        std::vector<std::string> arguments{"sun", "day", "--at", "46.95,7.44"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return arguments;
    };
    expect_failure(day({"--from", "2026-06-22", "--to", "2026-06-21", "--tz", "Europe/Zurich"}), 3,
                   "--from 2026-06-22 --to 2026-06-21: ends before it begins, expected the earlier "
                   "day first");
    expect_failure(day({"--year", "2101", "--tz", "UTC"}), 3,
                   "--year: 2101: sun and moon are computed for the years 1900 to 2100");
    expect_failure(day({"--date", "1899-12-31", "--tz", "UTC"}), 3,
                   "date: 1899-12-31: sun and moon are computed for the years 1900 to 2100, "
                   "but got 1899");
    expect_failure(day({"--date", "2026-02-30", "--tz", "UTC"}), 3,
                   "date: 2026-02-30: no such date, expected day 1 to 28 of 2026-02 but got 30");
    expect_failure(day({"--tz", "UTC"}), 2,
                   "--date: missing; pass --date 2026-06-21, --from and --to, or --year 2026");
    expect_failure(day({"--date", "2026-06-21", "--year", "2026", "--tz", "UTC"}), 2,
                   "--date, --from with --to, and --year exclude each other; use one");
    expect_failure(day({"--from", "2026-06-21", "--tz", "UTC"}), 2, "--from needs --to");
    expect_failure(
        day({"--date", "2011-12-30", "--tz", "Pacific/Apia"}), 3,
        "time zone: 2011-12-30: there was no such day in Pacific/Apia, its clocks skipped it");
    expect_failure(day({"--date", "2026-06-21", "--tz", "UTC", "-o", out("x.pdf")}), 2,
                   "-o: " + out("x.pdf") +
                       ": no format that this command writes, expected a name that ends in svg, "
                       "png, csv, json");
    expect_failure(day({"--date", "2026-06-21", "--tz", "UTC", "--dip", "1", "--eye-height", "3"}),
                   2, "--dip and --eye-height exclude each other; use one");
    expect_failure({"sun", "day", "--at", "46.95,7.44,2agl", "--date", "2026-06-21", "--tz", "UTC"},
                   2, "--at: a height above the ground needs a DEM; give one above sea level");
}

TEST(BadSunInput, PointsOutsideOfTheDemOrInItsHoles) {
    expect_failure({"sun", "horizon", bundled_dem(), "--at", "47,11"}, 3,
                   "horizon: 47,11: outside of the DEM, expected a point within latitudes "
                   "36.1600 to 36.4458 and longitudes -84.4133 to -84.0783");
    Raster holed;
    holed.columns = holed.rows = 20;
    holed.value = [](int column, int row, int) {
        return column == 10 && row == 10 ? std::numeric_limits<double>::quiet_NaN() : 500.0;
    };
    const std::string path = write_raster(dir() / "holed.tif", holed);
    const json about = json_of({"info", path});
    const std::string center = std::to_string(about["center"]["lat_deg"].get<double>()) + "," +
                               std::to_string(about["center"]["lon_deg"].get<double>());
    const Result run = relevo({"sun", "horizon", path, "--at", center});
    EXPECT_EQ(run.status, 3);
    EXPECT_NE(run.err.find(": the point is in a void of the DEM; a post with a height is at "),
              std::string::npos)
        << run.err;
}

TEST(BadSunInput, UnknownEventsAndDatesOfThem) {
    const auto at_time = [](const std::string& time, std::vector<std::string> options) {
        std::vector<std::string> arguments{"sun", "position", "--at", "46.95,7.44", "--time", time};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return arguments;
    };
    expect_failure(at_time("sunrize@46.95,7.44", {"--date", "2026-06-21", "--tz", "UTC"}), 3,
                   "time: sunrize@46.95,7.44: no such event as \"sunrize\"; did "
                   "you mean sunrise?");
    expect_failure(at_time("sunrise@46.95,7.44", {"--tz", "UTC"}), 3,
                   "time: sunrise@46.95,7.44: no date; write 2026-06-21 "
                   "sunrise@46.95,7.44 or pass --date");
    expect_failure(
        at_time("first-light@46.95,7.44", {"--date", "2026-06-21", "--tz", "UTC"}), 3,
        "time: first-light@46.95,7.44: first and last light depend on the terrain; name a DEM");
    expect_failure(at_time("2026-06-21T12:00Z", {"--date", "2026-06-21"}), 2,
                   "--date: needs an event in --time, such as sunrise@46.55,8.56; write a time of "
                   "day as 2026-06-21T18:30");
    expect_failure(
        {"sun", "carpet", bundled_dem(), "--at", kValley, "--year", "1850", "--tz", "UTC"}, 3,
        "--year: 1850: sun and moon are computed for the years 1900 to 2100");
    expect_failure(
        {"sun", "carpet", bundled_dem(), "--at", kValley, "--year", "2026", "--tz", "UTC", "--step",
         "7min"},
        3, "carpet: step 420 s: does not divide a day, expected a divisor of 86400 s, such as 600");
    expect_failure({"sun", "when", bundled_dem(), "--at", kValley, "--over", "47,11", "--year",
                    "2026", "--tz", "UTC"},
                   3,
                   "horizon: 47,11: outside of the DEM, expected a point within latitudes "
                   "36.1600 to 36.4458 and longitudes -84.4133 to -84.0783");
}

}  // namespace
}  // namespace relevo::test::test_sun_verbs
