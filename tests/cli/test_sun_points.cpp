#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "cli/program.h"
#include "support/support.h"

namespace relevo::test::test_sun_points {
namespace {

using nlohmann::json;

constexpr const char* kPlaces[] = {"36.30,-84.24", "40,-84", "36.35,-84.25", "36.25,-84.3"};

std::string file(const std::string& name, const std::string& text) {
    static const std::filesystem::path folder = scratch_dir("points");
    const std::filesystem::path path = folder / name;
    std::ofstream(path, std::ios::binary) << text;
    return path.string();
}

std::string points_csv() {
    return file("points.csv",
                "name,lat,lon\n\"Low; \"\"valley\"\"\",36.30,-84.24\nFar,40,-84\n,36.35,-84.25\n"
                "Caf\xc3\xa9,36.25,-84.3\n");
}

std::vector<std::string> with(std::vector<std::string> arguments,
                              const std::vector<std::string>& more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

/// The verbs that take points, with all that they need but a place.
std::vector<std::vector<std::string>> verbs() {
    return {{"sun", "position", "--time", "2026-02-10T12:00"},
            {"sun", "day", "--date", "2026-02-10"},
            {"sun", "plane", "--date", "2026-02-10", "--by", "day"},
            {"sun", "day", bundled_dem(), "--from", "2026-02-10", "--to", "2026-02-11"},
            {"sun", "horizon", bundled_dem(), "--step", "10"},
            {"sun", "when", bundled_dem(), "--over", "36.38,-84.27", "--tolerance", "2", "--from",
             "2026-05-01", "--to", "2026-05-31"},
            {"moon", "when", bundled_dem(), "--over", "36.38,-84.27", "--tolerance", "2", "--from",
             "2026-05-01", "--to", "2026-05-31"}};
}

TEST(SunPoints, EachHasTheFiguresThatTheVerbGivesForItAlone) {
    for (const std::vector<std::string>& verb : verbs()) {
        SCOPED_TRACE(fmt::format("{}", fmt::join(verb, " ")));
        const bool terrain = verb[2] == bundled_dem();
        const Result run = relevo(with(verb, {"--points", points_csv(), "--json"}));
        EXPECT_EQ(run.status, terrain ? 3 : 0) << run.err;
        const json records = json::parse(run.out);
        ASSERT_EQ(records.size(), 4U);
        const char* names[] = {"Low; \"valley\"", "Far", "3", "Caf\xc3\xa9"};
        for (std::size_t i = 0; i < 4; ++i) {
            json record = records[i];
            EXPECT_EQ(record["name"], names[i]);
            EXPECT_EQ(fmt::format("{}", record["lat_deg"].get<double>()),
                      fmt::format("{}", *parse_number(split(kPlaces[i], ',')[0])));
            for (const char* key : {"name", "lat_deg", "lon_deg"})
                record.erase(key);
            const Result alone = relevo(with(verb, {"--at", kPlaces[i], "--json", "-q"}));
            if (alone.status == 0) {
                EXPECT_EQ(record, json::parse(alone.out)) << kPlaces[i];
            } else {
                EXPECT_EQ(alone.err, "relevo: error: " + record["error"].get<std::string>() + "\n");
                EXPECT_EQ(record.size(), 2U);  // and schema
            }
        }
        EXPECT_EQ(records[1].contains("error"), terrain);
    }
}

/// Lines of a CSV without remarks.
std::vector<std::string> rows_of(const std::string& text) {
    std::vector<std::string> rows;
    for (const std::string& line : split(text, '\n'))
        if (!line.empty() && line[0] != '#') rows.push_back(line);
    return rows;
}

TEST(SunPoints, CsvHasTheRowsOfTheVerbBetweenThePlaceAndTheError) {
    for (const std::vector<std::string>& verb : verbs()) {
        SCOPED_TRACE(fmt::format("{}", fmt::join(verb, " ")));
        const bool terrain = verb[2] == bundled_dem();
        const std::vector<std::string> rows =
            rows_of(relevo(with(verb, {"--points", points_csv()})).out);
        const std::vector<std::string> alone =
            rows_of(relevo(with(verb, {"--at", kPlaces[0], "--csv"})).out);
        ASSERT_GE(rows.size(), alone.size());
        const bool holes = rows[0].find("not_known") != std::string::npos;  // columns of them
        EXPECT_EQ(rows[0], "name,at_lat_deg,at_lon_deg," + alone[0] +
                               (holes ? ",not_known,not_known_h" : "") + ",error");
        for (std::size_t i = 1; i < alone.size(); ++i)
            EXPECT_EQ(rows[i], "\"Low; \"\"valley\"\"\",36.3,-84.24," + alone[i] +
                                   (holes ? ",,0.0000" : "") + ",");
        const std::size_t far = alone.size();
        EXPECT_TRUE(rows[far].starts_with("Far,40,-84,")) << rows[far];
        EXPECT_EQ(rows[far].ends_with("\""), terrain);
        // Every row has as many fields, but for those in quotes.
        const auto fields = split(rows[0], ',').size();
        if (terrain) {
            EXPECT_EQ(split(rows[far].substr(0, rows[far].find('"')), ',').size(), fields);
        }
    }
}

TEST(SunPoints, AFailureIsToldOnceAndTheFileIsWhole) {
    const std::string out = (scratch_dir("out") / "days.json").string();
    const std::string points = points_csv();
    const Result run = relevo(
        {"sun", "day", bundled_dem(), "--points", points, "--date", "2026-02-10", "-o", out});
    EXPECT_EQ(run.status, 3);
    EXPECT_EQ(run.out, "");
    // No word of progress where nobody watches.
    EXPECT_EQ(run.err,
              "relevo: times are local times of each point; --tz sets another zone\nrelevo: "
              "warning: 2 of 4 points: mountains outside the DEM could change the result; --at for "
              "one of them says where, --highest bounds them\nrelevo: error: --points: " +
                  points +
                  ": 1 of 4 points have no figures; the first, \"Far\": horizon: 40,-84: "
                  "outside of the DEM, expected a point within latitudes 36.1600 to 36.4458 and "
                  "longitudes -84.4133 to -84.0783\n");
    EXPECT_EQ(json::parse(read_text(out, "test")).size(), 4U);
    const Result fine = relevo(
        {"-q", "sun", "day", "--points", points, "--date", "2026-02-10", "-o", out, "--overwrite"});
    EXPECT_EQ(fine.status, 0);
    EXPECT_EQ(fine.err, "");
}

TEST(SunPoints, ManyComeOutInTheOrderOfTheFile) {
    std::string text = "id,lat,lon\n";
    for (int i = 0; i < 300; ++i)
        text += fmt::format("p{},{},{}\n", i, 36.2 + 0.0007 * i, -84.3 + 0.0005 * i);
    const Result run = relevo({"sun", "horizon", bundled_dem(), "--points", file("many.csv", text),
                               "--step", "90", "--json", "-q"});
    ASSERT_EQ(run.status, 0) << run.err;
    const json records = json::parse(run.out);
    ASSERT_EQ(records.size(), 300U);
    for (std::size_t i = 0; i < 300; ++i)
        EXPECT_EQ(records[i]["name"], fmt::format("p{}", i));
}

TEST(SunPoints, GpxAndGeoJsonAreTakenToo) {
    const std::string gpx =
        file("a.gpx",
             "<gpx version=\"1.1\" creator=\"t\"><wpt lat=\"36.3\" lon=\"-84.24\"><ele>9999</ele>"
             "<name>Hut</name></wpt></gpx>");
    const std::string geojson = file(
        "a.geojson",
        R"({"type":"Feature","properties":{"name":"Hut"},"geometry":{"type":"Point","coordinates":[-84.24,36.3,9999]}})");
    const std::vector<std::string> verb{"-q",     "sun",        "day",    bundled_dem(),
                                        "--date", "2026-02-10", "--json", "--points"};
    const json alone = json::parse(relevo({"sun", "day", bundled_dem(), "--at", "36.3,-84.24",
                                           "--date", "2026-02-10", "--json"})
                                       .out)["days"];
    const std::string track =
        file("track.gpx",
             "<gpx version=\"1.1\" creator=\"t\"><trk><trkseg><trkpt lat=\"36.3\" lon=\"-84.24\">"
             "<name>Hut</name></trkpt></trkseg></trk></gpx>");
    for (const std::string& path : {gpx, track, geojson}) {
        const json records = json::parse(relevo(with(verb, {path})).out);
        ASSERT_EQ(records.size(), 1U);
        EXPECT_EQ(records[0]["name"], "Hut");
        EXPECT_EQ(records[0]["days"], alone) << path;
    }
}

TEST(SunPoints, HeightsOfACsvAreThoseOfTheEye) {
    const std::string points =
        file("heights.csv", "lat,lon,height\n36.3,-84.24,30agl\n36.3,-84.24,600\n36.3,-84.24,9\n");
    const Result run = relevo(
        {"-q", "sun", "horizon", bundled_dem(), "--points", points, "--step", "90", "--json"});
    EXPECT_EQ(run.status, 3);
    const json records = json::parse(run.out);
    EXPECT_EQ(records[0]["eye_m"], 584);
    EXPECT_EQ(records[1]["eye_m"], 600);
    EXPECT_NE(records[2]["error"].get<std::string>().find("under the ground"), std::string::npos);
}

TEST(SunPoints, WhatIsMissingOrWrongIsSaid) {
    const std::string points = points_csv(), dem = bundled_dem();
    expect_failure({"sun", "day", "--date", "2026-02-10"}, 2,
                   "--at: missing; pass --at 46.55,8.56, or --points FILE for many places");
    expect_failure({"sun", "position", "--time", "2026-02-10T12:00Z"}, 2,
                   "--at: missing; pass --at 46.55,8.56, or --points FILE for many places");
    expect_failure({"sun", "day", "--points", points}, 2,
                   "--date: missing; pass --date 2026-06-21, --from and --to, or --year 2026");
    expect_failure(
        {"sun", "day", "--points", points, "--date", "2026-02-10", "-o", file("a", "") + ".svg"}, 2,
        "--points: a drawing is of one place; pass -o with a name that ends in csv, "
        "json");
    expect_failure({"sun", "horizon", dem, "--points", points, "--format", "pvgis"}, 2,
                   "--points: a file for pvgis is of one place; pass --at");
    expect_failure({"sun", "day", "--at", "1,2", "--date", "2026-02-10", "--points-crs", "EPSG:1"},
                   2, "--points-crs: needs --points");
    expect_failure(
        {"sun", "day", "--points", points, "--date", "2026-02-10", "-o", points, "--overwrite"}, 3,
        fmt::format("-o: {0}: is the file of points {0}, which would be overwritten; give the "
                    "result another name",
                    points));
    EXPECT_EQ(
        relevo({"sun", "day", "--at", "1,2", "--points", points, "--date", "2026-02-10"}).status,
        2);
}

TEST(SunHorizonFormats, AreWrittenAsTheirProgramsReadThem) {
    const std::vector<std::string> verb{"-q",          "sun",  "horizon",
                                        bundled_dem(), "--at", "36.30,-84.24"};
    const json table = json::parse(relevo(with(verb, {"--step", "1", "--json"})).out);
    const auto height_deg = [&](int azimuth_deg) {
        return table["horizon"][static_cast<std::size_t>(azimuth_deg)]["horizon_deg"].get<double>();
    };
    const std::vector<std::string> pvlib =
        split(relevo(with(verb, {"--format", "pvlib"})).out, '\n');
    ASSERT_EQ(pvlib.size(), 362U);
    EXPECT_EQ(pvlib[1 + 180], fmt::format("180,{:.4f}", height_deg(180)));
    EXPECT_EQ(pvlib[1 + 90], fmt::format("90,{:.4f}", height_deg(90)));
    EXPECT_LT(height_deg(90), 0);
    const std::vector<std::string> pvgis =
        split(relevo(with(verb, {"--format", "pvgis"})).out, '\n');
    ASSERT_EQ(pvgis.size(), 361U);
    EXPECT_EQ(pvgis[180], fmt::format("{:.3f}", height_deg(180)));
    EXPECT_EQ(pvgis[90], "0.000");
    const std::vector<std::string> pvsyst =
        split(relevo(with(verb, {"--format", "pvsyst"})).out, '\n');
    ASSERT_EQ(pvsyst.size(), 123U);
    EXPECT_EQ(pvsyst[2 + 60], fmt::format("0 {:.2f}", height_deg(180)));
    EXPECT_EQ(pvsyst[2 + 30], "-90 0.00");
    EXPECT_EQ(pvsyst[2 + 90], fmt::format("90 {:.2f}", height_deg(270)));
}

TEST(SunHorizonFormats, GoIntoFilesByTheirEnding) {
    const std::vector<std::string> verb{"-q",          "sun",  "horizon",
                                        bundled_dem(), "--at", "36.30,-84.24"};
    const auto written = [&](const std::string& name, const std::vector<std::string>& more) {
        const std::string path = (scratch_dir("formats") / name).string();
        const Result run = relevo(with(with(verb, {"-o", path}), more));
        EXPECT_EQ(run.status, 0) << run.err;
        EXPECT_EQ(run.out, "");
        return read_text(path, "test");
    };
    EXPECT_EQ(written("a.hor", {}), relevo(with(verb, {"--format", "pvsyst"})).out);
    EXPECT_EQ(written("b.txt", {}), relevo(with(verb, {"--format", "pvgis"})).out);
    EXPECT_EQ(written("c.csv", {"--format", "pvlib"}),
              relevo(with(verb, {"--format", "pvlib"})).out);
    EXPECT_EQ(written("d.csv", {"--step", "1"}),
              relevo(with(verb, {"--format", "csv", "--step", "1"})).out);
    for (const std::vector<std::string>& wrong :
         {std::vector<std::string>{"--json"}, {"-o", "a.svg"}, {"-o", "a.json"}})
        expect_failure(with(with(verb, {"--format", "pvgis"}), wrong), 2,
                       "--format: applies to tables; pass -o with a name that ends in csv, hor, "
                       "txt, or none for standard output");
}

}  // namespace
}  // namespace relevo::test::test_sun_points
