#include <algorithm>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "cli/program.h"
#include "support/support.h"

namespace relevo::test::test_sun_along {
namespace {

using nlohmann::json;

std::string file(const std::string& name, const std::string& text) {
    static const std::filesystem::path folder = scratch_dir("along");
    const std::filesystem::path path = folder / name;
    std::ofstream(path, std::ios::binary) << text;
    return path.string();
}

std::string walk_csv() {
    return file("walk.csv", "lat,lon\n36.30,-84.24\n36.32,-84.25\n36.34,-84.27\n36.36,-84.26\n");
}

/// A track of a point each 20 minutes, from 7:00 in winter on.
std::string walk_gpx() {
    return file("walk.gpx",
                "<gpx version=\"1.1\" creator=\"t\"><trk><name>Cross Mountain</name><trkseg>"
                "<trkpt lat=\"36.30\" lon=\"-84.24\"><time>2026-02-10T12:00:00Z</time></trkpt>"
                "<trkpt lat=\"36.31\" lon=\"-84.24\"><time>2026-02-10T12:20:00Z</time></trkpt>"
                "<trkpt lat=\"36.31\" lon=\"-84.24\"><time>2026-02-10T12:40:00Z</time></trkpt>"
                "<trkpt lat=\"36.32\" lon=\"-84.25\"><time>2026-02-10T13:30:00Z</time></trkpt>"
                "</trkseg></trk></gpx>");
}

std::vector<std::string> along(const std::string& track, std::vector<std::string> more) {
    std::vector<std::string> arguments{"sun", "along", bundled_dem(), track};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

json json_of(const std::string& track, std::vector<std::string> more) {
    more.emplace_back("--json");
    const Result run = relevo(along(track, more));
    EXPECT_EQ(run.status, 0) << run.err;
    return json::parse(run.out);
}

/// A GPX track with a point at each of these times, to the north.
std::string track_at(const std::vector<std::string>& times) {
    std::string text = "<gpx version=\"1.1\" creator=\"t\"><trk><trkseg>";
    for (std::size_t i = 0; i < times.size(); ++i)
        text += fmt::format("<trkpt lat=\"{}\" lon=\"-84.24\"><time>2026-02-10T{}Z</time></trkpt>",
                            36.30 + 0.001 * static_cast<double>(i), times[i]);
    return file("times.gpx", text + "</trkseg></trk></gpx>");
}

TEST(SunAlongVerb, KeepsFractionsOfASecond) {
    const json quick = json_of(track_at({"16:00:00.100", "16:00:00.350"}), {});
    EXPECT_NEAR(quick["duration_h"].get<double>() * 3600, 0.25, 1e-6);
    // Points within one second are in order, and have one time if their fractions are not.
    const json mixed =
        json_of(track_at({"16:00:00.207", "16:00:00.107", "16:00:20.5", "16:00:20.1"}), {});
    EXPECT_NEAR(mixed["duration_h"].get<double>() * 3600, 20.293, 1e-6);
    const auto error = [](const std::string& track) { return relevo(along(track, {})).err; };
    EXPECT_NE(
        error(track_at({"16:00:01.25", "16:00:00.2"}))
            .find("its time, 2026-02-10T16:00:00.200000Z, is before that of the point before, "
                  "2026-02-10T16:00:01.250000Z; expected times in order\n"),
        std::string::npos);
    EXPECT_NE(
        error(track_at({"16:00:09", "16:00:00"})).find("its time, 2026-02-10T16:00:00Z, is before"),
        std::string::npos);
    const std::string same = (source_dir() / "tests/data/cases/gpx/same_time.gpx").string();
    EXPECT_NE(error(same).find("relevo: error: sun along: " + same +
                               ": all points are within one second, from "
                               "2026-06-01T15:00:00.107000Z to 2026-06-01T15:00:00.207000Z; "
                               "expected times that increase\n"),
              std::string::npos)
        << error(same);
}

TEST(SunAlongVerb, SpeaksJsonAsDocumented) {
    const json walk = json_of(walk_csv(), {"--start", "2026-02-10T07:20", "--speed", "5"});
    EXPECT_EQ(walk["zone"], "America/New_York");
    EXPECT_EQ(walk["assumptions"], json{"time zone America/New_York of the place"});
    EXPECT_NEAR(walk["length_m"].get<double>(), 7643, 1);
    EXPECT_NEAR(walk["duration_h"].get<double>(), walk["length_m"].get<double>() / 5000, 1e-6);
    EXPECT_LE(walk["spacing_m"].get<double>(), 75);
    for (const char* key : {"name", "definition", "refraction", "step_s"})
        EXPECT_TRUE(walk.contains(key)) << key;
    double time = 0, length = 0, hours = 0;
    for (const char* light : {"sun", "terrain", "night", "not_known"}) {
        time += walk[light]["time_share"].get<double>();
        length += walk[light]["length_share"].get<double>();
        hours += walk[light]["duration_h"].get<double>();
        double stretches_m = 0;
        for (const json& stretch : walk["stretches"])
            if (stretch["light"] == light)
                stretches_m += stretch["to"]["distance_m"].get<double>() -
                               stretch["from"]["distance_m"].get<double>();
        EXPECT_NEAR(walk[light]["length_m"].get<double>(), stretches_m, 1e-6) << light;
    }
    EXPECT_NEAR(time, 1, 1e-6);
    EXPECT_NEAR(length, 1, 1e-6);
    EXPECT_NEAR(hours, walk["duration_h"].get<double>(), 1e-6);
    ASSERT_GE(walk["stretches"].size(), 5U);
    EXPECT_EQ(walk["stretches"][0]["light"], "night");
    EXPECT_EQ(walk["stretches"][0]["from"]["utc"], "2026-02-10T12:20:00.000Z");
    EXPECT_EQ(walk["stretches"][0]["from"]["local"], "2026-02-10T07:20:00-05:00");
    EXPECT_EQ(walk["stretches"][0]["from"]["lat_deg"], 36.3);
    EXPECT_EQ(walk["stretches"].back()["to"]["lon_deg"], -84.26);
}

TEST(SunAlongVerb, TextAndCsvSayTheSame) {
    const std::vector<std::string> when{"--start", "2026-02-10T07:20", "--speed", "5"};
    const json walk = json_of(walk_csv(), when);
    const Result text = relevo(along(walk_csv(), when));
    ASSERT_EQ(text.status, 0) << text.err;
    EXPECT_TRUE(text.out.starts_with(
        "track               7.64 km, 4 points\n"
        "walk                2026-02-10T07:20:00-05:00 to 2026-02-10T08:51:43-05:00  (1:31:43), "
        "America/New_York\n\nsun "))
        << text.out;
    const std::string csv = file("out.csv", "");
    std::vector<std::string> more = when;
    more.insert(more.end(), {"-o", csv, "--overwrite"});
    const Result written = relevo(along(walk_csv(), more));
    EXPECT_EQ(written.out, "");
    const Csv table = read_csv(csv);
    EXPECT_EQ(fmt::format("{}", fmt::join(table.header, ",")),
              "light,from_time,to_time,from_km,to_km,from_lat_deg,from_lon_deg,to_lat_deg,"
              "to_lon_deg");
    ASSERT_EQ(table.rows.size(), walk["stretches"].size());
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        const json& stretch = walk["stretches"][i];
        EXPECT_EQ(table.rows[i][0], stretch["light"]);
        EXPECT_EQ(table.rows[i][1], stretch["from"]["local"]);
        EXPECT_NEAR(*parse_number(table.rows[i][3]),
                    stretch["from"]["distance_m"].get<double>() / 1000, 1e-4);
        const std::string line = fmt::format(
            "{} to {}{:10.3f} to {:8.3f} km  ", table.rows[i][1].substr(11, 8),
            table.rows[i][2].substr(11, 8), stretch["from"]["distance_m"].get<double>() / 1000,
            stretch["to"]["distance_m"].get<double>() / 1000);
        EXPECT_NE(text.out.find(line), std::string::npos) << line;
    }
}

TEST(SunAlongVerb, ATrackHasTimesOfItsOwn) {
    const json own = json_of(walk_gpx(), {});
    EXPECT_EQ(own["name"], "Cross Mountain");
    EXPECT_EQ(own["stretches"][0]["from"]["utc"], "2026-02-10T12:00:00.000Z");
    EXPECT_EQ(own["stretches"].back()["to"]["utc"], "2026-02-10T13:30:00.000Z");
    // At another time it goes at its own pace, and at another speed from its own time on.
    const json later = json_of(walk_gpx(), {"--start", "2026-06-21T12:00Z"});
    EXPECT_EQ(later["stretches"].back()["to"]["utc"], "2026-06-21T13:30:00.000Z");
    const json faster = json_of(walk_gpx(), {"--speed", "10"});
    EXPECT_EQ(faster["stretches"][0]["from"]["utc"], "2026-02-10T12:00:00.000Z");
    EXPECT_NEAR(faster["duration_h"].get<double>(), faster["length_m"].get<double>() / 10000, 1e-6);
    const json both = json_of(walk_gpx(), {"--start", "2026-02-10T12:00Z", "--speed", "10"});
    EXPECT_EQ(both["sun"], faster["sun"]);
    // Times of a CSV without an offset are read by the clocks of the place.
    const json csv = json_of(file("times.csv",
                                  "lat,lon,time\n36.30,-84.24,2026-02-10T07:00\n"
                                  "36.32,-84.25,2026-02-10T08:00\n"),
                             {});
    EXPECT_EQ(csv["stretches"][0]["from"]["utc"], "2026-02-10T12:00:00.000Z");
}

TEST(SunAlongVerb, HoursOfTheClockHaveAllOfTheWalk) {
    const std::vector<std::string> when{"--start", "2026-02-10T07:20", "--speed", "3"};
    const json whole = json_of(walk_csv(), when);
    std::vector<std::string> hourly = when;
    hourly.insert(hourly.end(), {"--by", "hour"});
    const json hours = json_of(walk_csv(), hourly)["hours"];
    ASSERT_GE(hours.size(), 2U);
    EXPECT_EQ(hours[0]["time"], "2026-02-10T07:00:00-05:00");
    EXPECT_EQ(hours[1]["time"], "2026-02-10T08:00:00-05:00");
    double first_min = 0;
    for (const char* const light : {"sun", "terrain", "night", "not_known"}) {
        double sum_min = 0;
        for (const json& hour : hours)
            sum_min += hour[std::string(light) + "_min"].get<double>();
        EXPECT_NEAR(sum_min, 60 * whole[light]["duration_h"].get<double>(), 1e-4) << light;
        first_min += hours[0][std::string(light) + "_min"].get<double>();
    }
    EXPECT_NEAR(first_min, 40, 1e-4);
}

TEST(SunAlongVerb, StartsAtAnEventOfItsFirstPoint) {
    const json day = json::parse(relevo({"sun", "day", bundled_dem(), "--at", "36.30,-84.24",
                                         "--date", "2026-02-10", "--json"})
                                     .out)["days"][0];
    const json rise = json_of(walk_csv(), {"--start", "2026-02-10 sunrise", "--speed", "20"});
    EXPECT_EQ(rise["stretches"][0]["from"]["utc"], day["sunrise_utc"]);
    const json light = json_of(walk_csv(), {"--start", "2026-02-10 first-light", "--speed", "20"});
    EXPECT_EQ(light["stretches"][0]["from"]["utc"], day["direct_sun"][0]["first_utc"]);
}

TEST(SunAlongVerb, GeoJsonAndMapCoordinatesAreTheSameWalk) {
    const std::vector<std::string> when{"--start", "2026-02-10T07:20", "--speed", "5"};
    const json csv = json_of(walk_csv(), when);
    const json line = json_of(
        file(
            "walk.geojson",
            R"({"type":"LineString","coordinates":[[-84.24,36.30],[-84.25,36.32],[-84.27,36.34],[-84.26,36.36]]})"),
        when);
    EXPECT_EQ(line["stretches"], csv["stretches"]);
    std::vector<std::string> with_crs = when;
    with_crs.insert(with_crs.end(), {"--points-crs", "EPSG:4326"});
    EXPECT_EQ(json_of(file("walk_xy.csv",
                           "x,y\n-84.24,36.30\n-84.25,36.32\n-84.27,36.34\n-84.26,36.36\n"),
                      with_crs)["stretches"],
              csv["stretches"]);
}

// 07:20 in New York in winter is 12:20 UTC, however a track writes it.
TEST(SunAlongVerb, AnOffsetOfATracksTimesCountsWhateverTheZone) {
    for (const auto& [first, last] : std::initializer_list<std::pair<const char*, const char*>>{
             {"2026-02-10T17:50:00+05:30", "2026-02-10T18:50:00+0530"},
             {"2026-02-10T04:20:00-0800", "2026-02-10T05:20:00-08"},
             {"2026-02-10 12:20:00Z", "2026-02-10t13:20:00z"},
             {"2026-02-10T12:20:00", "2026-02-10T13:20:00"}}) {
        const std::string track = file(
            "offset.gpx", fmt::format("<gpx><trk><trkseg>"
                                      "<trkpt lat=\"36.30\" lon=\"-84.24\"><time>{}</time></trkpt>"
                                      "<trkpt lat=\"36.31\" lon=\"-84.24\"><time>{}</time></trkpt>"
                                      "</trkseg></trk></gpx>",
                                      first, last));
        const json walk = json_of(track, {});
        EXPECT_EQ(walk["stretches"][0]["from"]["local"], "2026-02-10T07:20:00-05:00") << first;
        EXPECT_NEAR(walk["duration_h"].get<double>(), 1, 1e-9) << last;
    }
}

TEST(SunAlongVerb, WhatIsMissingOrWrongIsSaid) {
    const std::string csv = walk_csv(), gpx = walk_gpx();
    const std::string help = "; see relevo sun along --help";
    expect_failure({"sun", "along", bundled_dem()}, 2,
                   "TRACK: missing; name the DEM first, then a GPX, GeoJSON or CSV, as in relevo "
                   "sun along dem.tif walk.gpx");
    expect_failure(along(csv, {}), 2,
                   fmt::format("--start: missing, as {} has no times; pass --start "
                               "2026-06-21T09:00 --speed 4",
                               csv));
    expect_failure(
        along(csv, {"--start", "2026-02-10T12:00Z"}), 2,
        fmt::format("--speed: missing, as {} has no times; pass --speed 4, in km/h", csv));
    for (const char* speed : {"0", "-3", "nan", "1e9"})
        expect_failure(
            along(csv, {"--start", "2026-02-10T12:00Z", std::string("--speed=") + speed}), 2,
            fmt::format("--speed: expected 0.01 to 1000 but got {}{}", speed, help));
    expect_failure(
        along(csv, {"--start", "2026-02-10T12:00Z", "--speed", "4", "--track", "2"}), 3,
        fmt::format("sun along: {}: --track 2, expected 1 to 1: the file has that many", csv));
    const std::string some =
        file("some.csv", "lat,lon,time\n36.30,-84.24,2026-02-10T12:00Z\n36.31,-84.24,\n");
    expect_failure(
        {"-q", "sun", "along", bundled_dem(), some}, 3,
        fmt::format("sun along: {}: line 3: a point without a time, where others have one; "
                    "pass --start and --speed",
                    some));
    const std::string back = file("back.csv",
                                  "lat,lon,time\n36.30,-84.24,2026-02-10T12:00Z\n"
                                  "36.31,-84.24,2026-02-10T11:00Z\n");
    expect_failure({"-q", "sun", "along", bundled_dem(), back}, 3,
                   fmt::format("sun along: {}: line 3: its time, 2026-02-10T11:00:00Z, is before "
                               "that of the point before, 2026-02-10T12:00:00Z; expected times in "
                               "order",
                               back));
    const std::string odd = file("odd.csv",
                                 "lat,lon,time\n36.30,-84.24,2026-02-10T12:00Z\n"
                                 "36.31,-84.24,noonish\n");
    const Result run = relevo({"-q", "sun", "along", bundled_dem(), odd});
    EXPECT_EQ(run.status, 3);
    EXPECT_TRUE(run.err.starts_with("relevo: error: sun along: " + odd + ": line 3: ")) << run.err;
    EXPECT_NE(run.err.find("noonish"), std::string::npos) << run.err;
    const std::string off = file("off.csv", "lat,lon\n36.30,-84.24\n36.30,-84.00\n");
    expect_failure(along(off, {"--start", "2026-02-10T12:00Z", "--speed", "4"}), 3,
                   "walk: km 14.527 to 21.557 of 21.557 km: outside of the DEM, up to 7.04 "
                   "km beyond its edge; take a DEM that has all of the way, or cut the track");
    expect_failure(along(gpx, {"-o", gpx, "--overwrite"}), 2,
                   fmt::format("-o: {}: no format that this command writes, expected a name that "
                               "ends in csv, json",
                               gpx));
    expect_failure(
        along(csv, {"--start", "2026-02-10T12:00Z", "--speed", "4", "-o", csv, "--overwrite"}), 3,
        fmt::format(
            "-o: {0}: is the track {0}, which would be overwritten; give the result another name",
            csv));
}

}  // namespace
}  // namespace relevo::test::test_sun_along
