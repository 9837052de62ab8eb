#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "base/units.h"
#include "dem/places.h"
#include "support/support.h"

namespace relevo::dem {
namespace {

using test::error_of;

std::string file(const std::string& name, const std::string& text) {
    const std::filesystem::path path = test::scratch_dir("places") / name;
    std::ofstream(path, std::ios::binary) << text;
    return path.string();
}

/// "name lat lon time" of each.
std::string text_of(const std::vector<NamedPlace>& places) {
    std::string text;
    for (const NamedPlace& p : places)
        text += fmt::format("[{}|{:.6g}|{:.6g}|{}]", p.name, degrees(p.at.place.lat_rad),
                            degrees(p.at.place.lon_rad), p.time);
    return text;
}

constexpr const char* kGpx = R"(<?xml version="1.0"?>
<gpx version="1.1" creator="test" xmlns="http://www.topografix.com/GPX/1/1">
<wpt lat="46.5" lon="8.5"><ele>2000</ele><name>Hut</name></wpt>
<wpt lat="-33.9" lon="18.4"><time>2026-02-10T08:00:00Z</time></wpt>
<rte><name>way</name><rtept lat="1" lon="2"/><rtept lat="1" lon="3"/></rte>
<trk><name>walk</name>
<trkseg><trkpt lat="46.5" lon="8.5"><ele>9</ele><time>2026-02-10T08:00:00.250Z</time></trkpt>
<trkpt lat="46.51" lon="8.5"><time>2026-02-10T10:30:00+01:30</time></trkpt></trkseg>
<trkseg><trkpt lat="46.52" lon="8.51"/></trkseg></trk>
</gpx>)";

TEST(Places, CsvColumnsAreFoundByTheirNames) {
    const std::string expected = "[A|46.5|8.5|][B, \"b\"|-33.9|-18.4|]";
    EXPECT_EQ(text_of(read_points(
                  file("a.csv", "name,lat,lon\nA,46.5,8.5\n\"B, \"\"b\"\"\",-33.9,-18.4\n"), "t")),
              expected);
    EXPECT_EQ(text_of(read_points(file("b.csv",
                                       "\xef\xbb\xbf# places\r\nLongitude;ID;LATITUDE\r\n8.5;A;46.5"
                                       "\r\n\r\n# no\r\n-18.4;\"B, \"\"b\"\"\";-33.9"),
                                  "t")),
              expected);
    EXPECT_EQ(
        text_of(read_points(file("c.csv", "LNG\tlat\ttime\n8.5\t46.5\t2026-02-10T09:00\n"), "t")),
        "[|46.5|8.5|2026-02-10T09:00]");
    const auto heights =
        read_points(file("d.csv", "lat,lon,height\n1,2,30\n1,2,5 agl\n1,2,\n"), "t");
    EXPECT_TRUE(heights[0].at.has_height && !heights[0].at.above_ground);
    EXPECT_EQ(heights[0].at.place.height_m, 30);
    EXPECT_TRUE(heights[1].at.above_ground);
    EXPECT_FALSE(heights[2].at.has_height);
}

TEST(Places, APlaceHasTheBitsThatTheCommandLineGivesIt) {
    const auto places = read_points(file("a.csv", "lat,lon\n47.2692,191.4041\n"), "t");
    EXPECT_EQ(places[0].at.place, geo::parse_place("47.2692, 191.4041", "t").place);
    const auto gpx = read_points(
        file("a.gpx",
             "<gpx version=\"1.1\" creator=\"t\"><wpt lat=\"47.2692\" lon=\"11.4041\"/></gpx>"),
        "t");
    EXPECT_EQ(gpx[0].at.place, geo::parse_place("47.2692,11.4041", "t").place);
}

TEST(Places, XAndYAreInTheCrsThatIsGiven) {
    const std::string path = file("utm.csv", "id,X,Y\nA,500000,5200000\n");
    // 500 km east in UTM is the central meridian, 9 degrees east in zone 32; the meridian's arc
    // from the equator is 5200 km / 0.9996.
    EXPECT_EQ(text_of(read_points(path, "t", "EPSG:32632")), "[A|46.9535|9|]");
    EXPECT_EQ(error_of([&] { read_points(path, "t"); }),
              fmt::format("exit 3: t: {}: columns x and y without a coordinate reference system; "
                          "pass --points-crs EPSG:n, or columns lat and lon in degrees",
                          path));
    const std::string far = file("far.csv", "x,y\n1e30,1e30\n");
    EXPECT_EQ(error_of([&] { read_points(far, "t", "EPSG:32632"); }),
              fmt::format("exit 3: t: {}: line 2: 1e+30,1e+30: no place on Earth in WGS 84 / UTM "
                          "zone 32N",
                          far));
}

TEST(Places, GpxHasWaypointsTracksAndRoutes) {
    const std::string path = file("a.gpx", kGpx);
    EXPECT_EQ(text_of(read_points(path, "t")), "[Hut|46.5|8.5|][|-33.9|18.4|]");
    const NamedLine track = read_line(path, "t");
    EXPECT_EQ(track.name, "walk");
    EXPECT_EQ(text_of(track.places),
              "[|46.5|8.5|2026-02-10T08:00:00.250+00:00][|46.51|8.5|2026-02-10T10:30:00.000+01:30]"
              "[|46.52|8.51|]");
    const NamedLine route = read_line(
        file("r.gpx",
             "<gpx version=\"1.1\" creator=\"t\"><rte><name>way</name><rtept lat=\"1\" lon=\"2\"/>"
             "<rtept lat=\"1\" lon=\"3\"/></rte></gpx>"),
        "t");
    EXPECT_EQ(route.name, "way");
    EXPECT_EQ(text_of(route.places), "[|1|2|][|1|3|]");
}

TEST(Places, GeoJsonHasPointsAndLines) {
    const std::string path = file("a.geojson", R"({"type":"FeatureCollection","features":[
{"type":"Feature","properties":{"name":"A"},"geometry":{"type":"Point","coordinates":[8.5,46.5,99]}},
{"type":"Feature","properties":{"name":"way"},"geometry":{"type":"MultiLineString","coordinates":[
[[8.5,46.5],[8.6,46.5]],[[8.7,46.5],[8.7,46.6]]]}},
{"type":"Feature","properties":{"name":"B"},"geometry":{"type":"MultiPoint","coordinates":[[1,2],[3,4]]}},
{"type":"Feature","properties":{},"geometry":null}]})");
    EXPECT_EQ(text_of(read_points(path, "t")), "[A|46.5|8.5|][B|2|1|][B|4|3|]");
    const NamedLine line = read_line(path, "t");
    EXPECT_EQ(line.name, "way");
    EXPECT_EQ(text_of(line.places), "[|46.5|8.5|][|46.5|8.6|][|46.5|8.7|][|46.6|8.7|]");
    // An old habit: coordinates of a CRS that the file names.
    const std::string utm = file("utm.json", R"({"type":"FeatureCollection",
"crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32632"}},"features":[{"type":
"Feature","properties":{},"geometry":{"type":"Point","coordinates":[500000,5200000]}}]})");
    EXPECT_EQ(text_of(read_points(utm, "t")), "[|46.9535|9|]");
}

TEST(Places, OneOfSeveralLinesIsNamedByItsNumber) {
    const std::string path = file(
        "two.gpx",
        "<gpx version=\"1.1\" creator=\"t\"><trk><name>a</name><trkseg><trkpt lat=\"1\" lon=\"2\"/>"
        "<trkpt lat=\"1\" lon=\"3\"/></trkseg></trk><trk><name>b</name><trkseg><trkpt lat=\"5\" "
        "lon=\"6\"/><trkpt lat=\"5\" lon=\"7\"/></trkseg></trk></gpx>");
    EXPECT_EQ(read_line(path, "t", {}, 2).name, "b");
    EXPECT_EQ(text_of(read_line(path, "t", {}, 1).places), "[|1|2|][|1|3|]");
    EXPECT_EQ(error_of([&] { read_line(path, "t"); }),
              fmt::format("exit 3: t: {}: 2 lines in it; select one with --track 1 to 2", path));
    EXPECT_EQ(
        error_of([&] { read_line(path, "t", {}, 3); }),
        fmt::format("exit 3: t: {}: --track 3, expected 1 to 2: the file has that many", path));
}

TEST(Places, WhatCannotBeUsedIsNamedByItsLine) {
    struct Case {
        const char *name, *text, *message;
    };
    for (
        const Case& c : {
            Case{"a.csv", "lat,lon\n1,2\nnan,2\n",
                 "line 3: nan,2: latitude, expected a number of degrees but got \"nan\""},
            {"b.csv", "lat,lon\n95,2\n",
             "line 2: 95,2: latitude, expected -90 to 90 degrees but got 95; latitude comes first, "
             "perhaps 2,95"},
            {"c.csv", "lat,lon\n1\n",
             "line 2: 1,: longitude, expected a number of degrees but got \"\""},
            {"d.csv", "46.5,8.5\n46.6,8.5\n",
             "no columns lat and lon, expected a first line that names them but got \"46.5,8.5\""},
            {"e.csv", "lat,lon\n", "no points, expected a line for each below the columns"},
            {"f.csv", "\n \n", "an empty file, expected a CSV, a GPX or a GeoJSON file"},
            {"g.gpx", "<gpx version=\"1.1\" creator=\"t\"><wpt lat=\"nan\" lon=\"3\"/></gpx>",
             "point 1: latitude nan, longitude 3: no place on Earth, expected -90 to 90 and -180 "
             "to 360 degrees"},
            {"h.gpx", "<gpx version=\"1.1\" creator=\"t\"></gpx>",
             "no waypoints (wpt); tracks and routes are for sun along"},
            {"i.json", "{\"type\":\"Point\",\"coordinates\":[1,1e99]}",
             "point 1: latitude 1e+99, longitude 1: no place on Earth, expected -90 to 90 and -180 "
             "to 360 degrees"},
        }) {
        const std::string path = file(c.name, c.text);
        EXPECT_EQ(error_of([&] { read_points(path, "t"); }),
                  fmt::format("exit 3: t: {}: {}", path, c.message));
    }
    const std::string cut = file("cut.gpx", std::string(kGpx).substr(0, 500));
    EXPECT_TRUE(error_of([&] {
                    read_line(cut, "t");
                }).starts_with(fmt::format("exit 3: t: {}: cannot be read as GPX, ", cut)));
    const std::string zero = file("zero.csv", std::string("lat,lon\n\0\0", 10));
    EXPECT_EQ(
        error_of([&] { read_points(zero, "t"); }),
        fmt::format("exit 3: t: {}: not a text, expected a CSV, a GPX or a GeoJSON file", zero));
    const std::string wide = file("wide.csv", std::string(200'000, 'a'));
    EXPECT_EQ(
        error_of([&] { read_points(wide, "t"); }),
        fmt::format("exit 3: t: {}: line 1 has more than 65536 bytes, expected a CSV, a GPX or "
                    "a GeoJSON file",
                    wide));
}

TEST(Places, AGeoJsonBeyondWhatMemoryHasRoomForIsRefused) {
    const std::string path =
        file("large.json", "{\"type\":\"Point\",\"coordinates\":[1,2]}" + std::string(600, ' '));
    std::filesystem::resize_file(path, (64 << 20) + 1);
    EXPECT_EQ(
        error_of([&] { read_points(path, "t"); }),
        fmt::format("exit 3: t: {}: a GeoJSON file of more than 64 MiB; make a CSV of it", path));
}

TEST(Places, ALineThatIsNoneIsSaid) {
    struct Case {
        const char *name, *text, *message;
    };
    for (const Case& c :
         {Case{"a.gpx", "<gpx version=\"1.1\" creator=\"t\"><wpt lat=\"1\" lon=\"3\"/></gpx>",
               "no line in it, expected a track or a route"},
          {"b.json", "{\"type\":\"Point\",\"coordinates\":[1,2]}",
           "no line in it, expected a LineString"},
          {"c.csv", "lat,lon\n1,2\n", "a line of 1 point, expected two or more"}}) {
        const std::string path = file(c.name, c.text);
        EXPECT_EQ(error_of([&] { read_line(path, "t"); }),
                  fmt::format("exit 3: t: {}: {}", path, c.message));
    }
}

TEST(Places, OnlyFilesOfThisMachineAreRead) {
    EXPECT_EQ(error_of([] { read_points("https://example.org/a.gpx", "t"); }),
              "exit 3: t: https://example.org/a.gpx: cannot be read, No such file or directory");
    EXPECT_EQ(error_of([] { read_points("/vsicurl/https://example.org/a.gpx", "t"); }),
              "exit 3: t: /vsicurl/https://example.org/a.gpx: cannot be read, No such file or "
              "directory");
    EXPECT_EQ(error_of([] { read_points("/dev/zero", "t"); }),
              "exit 3: t: /dev/zero: cannot be read, it is not a regular file");
    // A name that GDAL would take for the JSON itself is that of a file.
    const std::filesystem::path odd =
        test::scratch_dir("odd") / "{\"type\":\"Point\",\"coordinates\":[5,6]}";
    std::ofstream(odd) << "{\"type\":\"Point\",\"coordinates\":[1,2]}";
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(odd.parent_path());
    EXPECT_EQ(text_of(read_points(odd.filename().string(), "t")), "[|2|1|]");
    std::filesystem::current_path(before);
    // A virtual dataset, which could name the net, is not looked at by its driver.
    const std::string vrt =
        file("a.gpx",
             "<OGRVRTDataSource><OGRVRTLayer name=\"a\"><SrcDataSource>/etc/passwd</SrcDataSource>"
             "</OGRVRTLayer></OGRVRTDataSource>");
    EXPECT_TRUE(error_of([&] {
                    read_points(vrt, "t");
                }).starts_with(fmt::format("exit 3: t: {}: cannot be read as GPX, ", vrt)));
}

TEST(Places, MoreThanAMillionAreRefused) {
    const std::string path = file("many.csv", "");
    {
        std::ofstream out(path, std::ios::binary);
        out << "lat,lon\n";
        std::string rows;
        for (int i = 0; i < 10'000; ++i)
            rows += "1,2\n";
        for (int i = 0; i < 101; ++i)
            out << rows;
    }
    EXPECT_EQ(error_of([&] { read_line(path, "t"); }),
              fmt::format("exit 3: t: {}: more than 1000000 places; split the file", path));
}

}  // namespace
}  // namespace relevo::dem
