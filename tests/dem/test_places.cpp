#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "base/units.h"
#include "dem/places.h"
#include "support/support.h"

namespace relevo::dem::test_places {
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
    EXPECT_EQ(text_of(read_points(path, "t")), "[Hut|46.5|8.5|][|-33.9|18.4|2026-02-10T08:00:00Z]");
    const NamedLine track = read_line(path, "t");
    EXPECT_EQ(track.name, "walk");
    EXPECT_EQ(text_of(track.places),
              "[|46.5|8.5|2026-02-10T08:00:00.250Z][|46.51|8.5|2026-02-10T10:30:00+01:30]"
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
    for (const Case& c : {
             Case{"a.csv", "lat,lon\n1,2\nnan,2\n",
                  "line 3: nan,2: latitude, expected a number of degrees but got \"nan\""},
             {"b.csv", "lat,lon\n95,2\n",
              "line 2: 95,2: latitude, expected -90 to 90 degrees but got 95; latitude comes "
              "first, "
              "perhaps 2,95"},
             {"c.csv", "lat,lon\n1\n",
              "line 2: 1,: longitude, expected a number of degrees but got \"\""},
             {"d.csv", "46.5,8.5\n46.6,8.5\n",
              "no columns lat and lon, expected a first line that names them"},
             {"e.csv", "lat,lon\n", "no points, expected a line for each below the columns"},
             {"f.csv", "\n \n", "an empty file, expected a CSV, a GPX or a GeoJSON file"},
             {"g.gpx", "<gpx version=\"1.1\" creator=\"t\"><wpt lat=\"nan\" lon=\"3\"/></gpx>",
              "line 1: lat=\"nan\", expected degrees such as 46.91 or -33.9"},
             {"h.gpx", "<gpx version=\"1.1\" creator=\"t\"></gpx>",
              "no points, expected waypoints, a track or a route"},
             {"i.json", "{\"type\":\"Point\",\"coordinates\":[1,1e99]}",
              "line 1: latitude 1e+99, longitude 1: no place on Earth, expected -90 to 90 and -180 "
              "to 360 degrees"},
         }) {
        const std::string path = file(c.name, c.text);
        EXPECT_EQ(error_of([&] { read_points(path, "t"); }),
                  fmt::format("exit 3: t: {}: {}", path, c.message));
    }
    const std::string cut = file("cut.gpx", std::string(kGpx).substr(0, 500));
    EXPECT_TRUE(error_of([&] {
                    read_line(cut, "t");
                }).starts_with(fmt::format("exit 3: t: {}: line 8: no well-formed XML, ", cut)))
        << error_of([&] { read_line(cut, "t"); });
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

/// A track of a point on each of lines 2 to 4; the second one's attributes and time are given.
std::string track_of(const std::string& attributes, const std::string& time) {
    return "<gpx version=\"1.1\" creator=\"t\"><trk><trkseg>\n<trkpt lat=\"46\" lon=\"8\"/>\n"
           "<trkpt " +
           attributes + "><time>" + time +
           "</time></trkpt>\n<trkpt lat=\"46\" lon=\"9\"/>\n</trkseg></trk></gpx>";
}

// The schema's latitudeType is an xsd:decimal, which has a point and no letters.
TEST(Places, AGpxCoordinateIsReadAsWrittenOrRefusedWithItsLine) {
    struct Case {
        const char *attributes, *message;
    };
    for (const Case& c : {
             Case{"lat=\"46,91\" lon=\"8.05\"",
                  "line 3: lat=\"46,91\", expected degrees such as 46.91 or -33.9"},
             {"lat=\"46.91\" lon=\"8.05W\"",
              "line 3: lon=\"8.05W\", expected degrees such as 8.05 or -122.4"},
             {"lat=\"abc\" lon=\"8\"",
              "line 3: lat=\"abc\", expected degrees such as 46.91 or -33.9"},
             {"lat=\"46 54 36\" lon=\"8\"",
              "line 3: lat=\"46 54 36\", expected degrees such as 46.91 or -33.9"},
             {"lat=\"\" lon=\"8\"", "line 3: lat=\"\", expected degrees such as 46.91 or -33.9"},
             {"lon=\"8\"", "line 3: a point without lat, expected degrees such as lat=\"46.91\""},
             {"lat=\"8\"", "line 3: a point without lon, expected degrees such as lon=\"8.05\""},
             {"lat=\"146.91\" lon=\"8\"",
              "line 3: latitude 146.91, longitude 8: no place on Earth, expected -90 to 90 and "
              "-180 to 360 degrees; perhaps the two are swapped"},
             {"lat=\"46\" lon=\"361\"",
              "line 3: latitude 46, longitude 361: no place on Earth, expected -90 to 90 and -180 "
              "to 360 degrees"},
         }) {
        const std::string path = file("odd.gpx", track_of(c.attributes, ""));
        EXPECT_EQ(error_of([&] { read_line(path, "t"); }),
                  fmt::format("exit 3: t: {}: {}", path, c.message));
    }
    const std::string path = file("even.gpx", track_of("lon=' 188.05 '\nlat='+46.91'", ""));
    EXPECT_EQ(text_of(read_line(path, "t").places), "[|46|8|][|46.91|-171.95|][|46|9|]");
}

// GPX 1.1: "Date and time in are in Univeral Coordinated Time (UTC), not local time!"
TEST(Places, AGpxTimeKeepsItsOffsetAndIsUtcWithoutOne) {
    struct Case {
        const char *text, *expected;
    };
    for (const Case& c : {
             Case{"2026-02-10T12:00:00+0530", "2026-02-10T12:00:00+0530"},
             {"2026-02-10T12:00:00-0800", "2026-02-10T12:00:00-0800"},
             {"2026-02-10T12:00:00+05:30", "2026-02-10T12:00:00+05:30"},
             {"2026-02-10 12:00:00Z", "2026-02-10 12:00:00Z"},
             {"2026-02-10t12:00:00z", "2026-02-10t12:00:00z"},
             {"\n 2026-02-10T12:00:00 ", "2026-02-10T12:00:00Z"},
             {"yesterday", "yesterday"},
         }) {
        const NamedLine line =
            read_line(file("time.gpx", track_of("lat='46' lon='8.5'", c.text)), "t");
        EXPECT_EQ(line.places[1].time, c.expected);
        EXPECT_EQ(line.places[1].line, 3U);
    }
}

TEST(Places, AGpxOfExtensionsAndOldEncodingsIsRead) {
    const std::string path = file(
        "garmin.gpx",
        "<?xml version=\"1.0\" encoding=\"windows-1252\"?><!-- <wpt/> --><gpx xmlns:x=\"u\">"
        "<wpt lat=\"1\" lon=\"2\"><extensions><x:wpt lat=\"a\"><name>no</name></x:wpt></extensions>"
        "<name><![CDATA[Caf]]>\xe9 \x80</name><ele>,</ele></wpt></gpx>");
    EXPECT_EQ(text_of(read_points(path, "t")), "[Caf\xc3\xa9 \xe2\x82\xac|1|2|]");
}

std::string geojson_of(const std::string& crs, const std::string& geometry) {
    return "{\"type\":\"FeatureCollection\"," + crs +
           "\n\"features\":[{\"type\":\"Feature\",\"properties\":{\"name\":\"A\"},\n\"geometry\":" +
           geometry + "}]}";
}

TEST(Places, AGeoJsonThatCannotBeReadAsWrittenIsRefusedWithItsLine) {
    const std::string point = "{\"type\":\"Point\",\"coordinates\":[8.5,46.5]}";
    const auto crs = [](const std::string& value) { return "\n\"crs\":" + value + ","; };
    struct Case {
        std::string text, message;
    };
    const std::string no_name =
        "line 2: \"crs\" names no coordinate system; remove it if the coordinates are longitude "
        "and latitude on WGS 84, or write its EPSG code";
    for (const Case& c : {
             Case{geojson_of(crs("null"), point), no_name},
             {geojson_of(crs("{\"type\":\"link\",\"properties\":{\"href\":\"a.prj\"}}"), point),
              no_name},
             {geojson_of(crs("[1]"), point), no_name},
             {geojson_of(crs("{\"type\":\"name\",\"properties\":{\"name\":\"EPSG:99999\"}}"),
                         point),
              "line 2: \"crs\": EPSG:99999: not a coordinate reference system that PROJ knows, crs "
              "not found; write EPSG:n, WKT or a PROJ string"},
             {geojson_of("", "{\"type\":\"Point\",\"coordinates\":[\"8,5\",\"46,91\"]}"),
              "line 3: a coordinate, expected a number but got \"8,5\""},
             {geojson_of("", "{\"type\":\"Point\",\"coordinates\":[8,5,46,91]}"),
              "line 3: a position of 4 numbers, expected longitude, latitude and perhaps height, "
              "with decimal points"},
             {geojson_of("", "{\"type\":\"Point\",\"coordinates\":[8]}"),
              "line 3: a position of 1 number, expected longitude, latitude and perhaps height, "
              "with decimal points"},
             {geojson_of("", "{\"type\":\"Point\",\"coordinates\":[8,\nnull]}"),
              "line 4: a coordinate, expected a number but got null"},
             {geojson_of("", "{\"type\":\"Point\"}"), "line 3: a Point without coordinates"},
             {geojson_of("", "{\"type\":\"Point\",\"coordinates\":\"8 46\"}"),
              "line 3: coordinates that are no list of numbers"},
             {geojson_of("", "{\"type\":\"Point\",\"coordinates\":[[8,46]]}"),
              "line 3: coordinates that are none of a Point"},
             {geojson_of("", "{\"type\":\"Point\",\"coordinates\":[46.5,98.5]}"),
              "line 3: latitude 98.5, longitude 46.5: no place on Earth, expected -90 to 90 and "
              "-180 to 360 degrees; perhaps the two are swapped"},
             {"{\"type\":\"Topology\",\"objects\":{}}",
              "line 1: \"type\": \"Topology\", expected GeoJSON"},
             {"{\n\"a\":1}", "line 1: an object without \"type\", expected GeoJSON"},
         }) {
        const std::string path = file("odd.geojson", c.text);
        EXPECT_EQ(error_of([&] { read_points(path, "t"); }),
                  fmt::format("exit 3: t: {}: {}", path, c.message));
    }
    const std::string comma =
        file("comma.geojson", "{\"type\":\"Point\",\n\"coordinates\":[8,05]}");
    EXPECT_TRUE(error_of([&] {
                    read_points(comma, "t");
                }).starts_with(fmt::format("exit 3: t: {}: line 2: no well-formed JSON, ", comma)));
}

TEST(Places, AGeoJsonCrsThatIsKnownIsHonoured) {
    const std::string geometry = "{\"type\":\"Point\",\"coordinates\":[8.5,46.5]}";
    for (const char* crs :
         {"{\"type\":\"name\",\"properties\":{\"name\":\"urn:ogc:def:crs:OGC:1.3:CRS84\"}}",
          "{\"type\":\"name\",\"properties\":{\"name\":\"urn:ogc:def:crs:EPSG::4326\"}}",
          "{\"type\":\"EPSG\",\"properties\":{\"code\":4326}}"})
        EXPECT_EQ(
            text_of(read_points(
                file("crs.geojson", geojson_of(fmt::format("\"crs\":{},", crs), geometry)), "t")),
            "[A|46.5|8.5|]");
    // Also where it comes last, and of a measure.
    EXPECT_EQ(
        text_of(read_points(
            file("last.geojson",
                 "{\"features\":[{\"geometry\":{\"coordinates\":[500000,5200000,1.5,2],\"type\":"
                 "\"Point\"},\"id\":7,\"type\":\"Feature\"}],\"type\":\"FeatureCollection\","
                 "\"crs\":{\"type\":\"name\",\"properties\":{\"name\":\"EPSG:32632\"}}}"),
            "t")),
        "[7|46.9535|9|]");
}

TEST(Places, ADecimalCommaInACsvIsNoSeparatorInSilence) {
    struct Case {
        const char *text, *message;
    };
    for (const Case& c : {
             Case{"lat,lon\n46,91,8,05\n",
                  "line 2: 4 fields, but the first line names 2 columns; write decimal points, and "
                  "names with a ',' in quotes"},
             {"lat;lon\n46,91;8,05\n", "line 2: \"46,91\": write a decimal point, as in 46.91"},
             {"lat,lon\n46.91,\"8,05\"\n", "line 2: \"8,05\": write a decimal point, as in 8.05"},
             {"lat,lon\n46.91,8.05W\n",
              "line 2: 46.91,8.05W: longitude, expected a number of degrees but got \"8.05W\""},
         }) {
        const std::string path = file("comma.csv", c.text);
        EXPECT_EQ(error_of([&] { read_points(path, "t"); }),
                  fmt::format("exit 3: t: {}: {}", path, c.message));
    }
    EXPECT_EQ(text_of(read_points(file("ends.csv", "lat,lon\n46.91,8.05,,\n"), "t")),
              "[|46.91|8.05|]");
}

TEST(Places, ACrsIsForCsvAlone) {
    const std::string path = file("a.gpx", kGpx);
    EXPECT_EQ(error_of([&] { read_points(path, "t", "EPSG:2056"); }),
              fmt::format("exit 3: t: {}: --points-crs is for columns x and y of a CSV; GPX and "
                          "GeoJSON have their own",
                          path));
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
              "exit 2: 'https://example.org/a.gpx' is not a file of this machine; name it on the "
              "command line, or add --trust");
    EXPECT_EQ(error_of([] { read_points("/vsicurl/https://example.org/a.gpx", "t"); }),
              "exit 2: '/vsicurl/https://example.org/a.gpx' is not a file of this machine; name it "
              "on the command line, or add --trust");
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
    // A virtual dataset, which could name the net, is no GPX; nor are entities read.
    const std::string vrt =
        file("a.gpx",
             "<OGRVRTDataSource><OGRVRTLayer name=\"a\"><SrcDataSource>/etc/passwd</SrcDataSource>"
             "</OGRVRTLayer></OGRVRTDataSource>");
    EXPECT_EQ(error_of([&] { read_points(vrt, "t"); }),
              fmt::format("exit 3: t: {}: line 1: begins with <OGRVRTDataSource>, expected <gpx>; "
                          "export it as GPX, GeoJSON or CSV",
                          vrt));
    const std::string entity =
        file("e.gpx", "<!DOCTYPE gpx [<!ENTITY a SYSTEM \"/etc/passwd\">]><gpx>&a;</gpx>");
    EXPECT_EQ(error_of([&] { read_points(entity, "t"); }),
              fmt::format("exit 3: t: {}: line 1: it declares an entity", entity));
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
}  // namespace relevo::dem::test_places
