#include <cmath>
#include <filesystem>
#include <fstream>

#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal.h>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>

#include "base/text.h"
#include "base/units.h"
#include "dem/gdal_support.h"
#include "dem/lines.h"
#include "support/support.h"

namespace relevo::dem::test_lines {
namespace {

using test::error_of;

/// A grid of 1000 x 1000 posts of 30 m in UTM 32, its middle near 47 N, 9 E.
Grid utm() {
    return Grid(1000, 1000, {485000, 30, 0, 5220000, 0, -30},
                geo::Crs::parse("EPSG:32632", "test"));
}

/// 360 x 180 posts of the whole Earth.
Grid earth() {
    return Grid(360, 180, {-179.5, 1, 0, 89.5, 0, -1}, geo::Crs());
}

std::string write(const std::string& name, const std::string& text) {
    const std::filesystem::path file = test::scratch_dir("lines_" + name) / name;
    std::ofstream(file) << text;
    return file.string();
}

std::string geojson(const std::string& geometries) {
    return write("a.geojson", R"({"type": "FeatureCollection", "features": [)" + geometries + "]}");
}

std::string line(const std::string& coordinates, const std::string& properties = "{}") {
    return R"({"type": "Feature", "properties": )" + properties +
           R"(, "geometry": {"type": "LineString", "coordinates": )" + coordinates + "}}";
}

std::vector<PlacedLine> read(const std::string& path, const Grid& dem = utm(),
                             const std::string& attribute = "") {
    return read_lines(path, "tracks.file", attribute, dem);
}

TEST(LinesOfFiles, LieOnTheGrid) {
    const auto lines = read(geojson(line("[[8.9, 47.0], [9.0, 47.05], [9.1, 47.0]]")));
    ASSERT_EQ(lines.size(), 1U);
    const Grid grid = utm();
    EXPECT_LT(distance(lines[0].posts.front(), grid.post(geo::geodetic_deg(47, 8.9))), 1e-4);
    EXPECT_LT(distance(lines[0].posts.back(), grid.post(geo::geodetic_deg(47, 9.1))), 1e-4);
    const double length_m =
        geo::geodesic(geo::geodetic_deg(47, 8.9), geo::geodetic_deg(47.05, 9)).distance_m +
        geo::geodesic(geo::geodetic_deg(47.05, 9), geo::geodetic_deg(47, 9.1)).distance_m;
    EXPECT_NEAR(lines[0].along_m.back(), length_m, 1e-3);
    EXPECT_TRUE(std::isnan(lines[0].value));
}

TEST(LinesOfFiles, BendWhereTheGridDoes) {
    // A parallel is no straight line in UTM.
    const auto lines = read(geojson(line("[[8.85, 47.0], [9.15, 47.0]]")));
    ASSERT_EQ(lines.size(), 1U);
    const std::vector<glm::dvec2>& posts = lines[0].posts;
    EXPECT_GT(posts.size(), 8U);
    const Grid grid = utm();
    for (int i = 0; i <= 1000; ++i) {
        const glm::dvec2 on = grid.post(geo::geodetic_deg(47, 8.85 + 0.3 * i / 1000));
        double nearest = 1e30;
        for (std::size_t k = 0; k + 1 < posts.size(); ++k) {
            const glm::dvec2 way = posts[k + 1] - posts[k];
            const double t = glm::clamp(dot(on - posts[k], way) / dot(way, way), 0.0, 1.0);
            nearest = std::min(nearest, distance(on, posts[k] + t * way));
        }
        ASSERT_LT(nearest, 0.006) << i;
    }
}

TEST(LinesOfFiles, AreThoseOfPolygonsCollectionsAndSeveralParts) {
    const auto lines = read(
        geojson(
            R"({"type": "Feature", "properties": {"a": "3.5"}, "geometry": {"type": "Polygon", "coordinates":
           [[[9, 47], [9.1, 47], [9.1, 47.1], [9, 47]], [[9.05, 47.02], [9.06, 47.02], [9.06, 47.03], [9.05, 47.02]]]}},
           {"type": "Feature", "properties": {"a": 7}, "geometry": {"type": "GeometryCollection", "geometries": [
           {"type": "Point", "coordinates": [9, 47]},
           {"type": "MultiLineString", "coordinates": [[[9, 47], [9.01, 47]], [[9.02, 47], [9.03, 47]]]}]}})"),
        utm(), "a");
    ASSERT_EQ(lines.size(), 4U);
    EXPECT_EQ(lines[0].number, 0);
    EXPECT_EQ(lines[1].value, 3.5);
    EXPECT_EQ(lines[3].number, 1);
    EXPECT_EQ(lines[3].value, 7);
}

TEST(LinesOfFiles, AreTracksAndRoutesOfAGpx) {
    const std::string path =
        write("a.gpx",
              R"(<gpx version="1.1" creator="t" xmlns="http://www.topografix.com/GPX/1/1">
<wpt lat="47" lon="9"/><rte><rtept lat="47" lon="9"/><rtept lat="47.1" lon="9"/></rte>
<trk><trkseg><trkpt lat="47" lon="9"/><trkpt lat="47" lon="9.1"/></trkseg>
<trkseg><trkpt lat="47" lon="9.1"/><trkpt lat="47.1" lon="9.1"/></trkseg></trk></gpx>)");
    EXPECT_EQ(read(path).size(), 3U);
}

TEST(LinesOfFiles, AreInTheFilesOwnCrs) {
    prepare_gdal();
    const std::filesystem::path file = test::scratch_dir("lines_shp") / "a.shp";
    const GDALDatasetH dataset = GDALCreate(GDALGetDriverByName("ESRI Shapefile"), file.c_str(), 0,
                                            0, 0, GDT_Unknown, nullptr);
    const OGRSpatialReferenceH crs = OSRNewSpatialReference(nullptr);
    OSRImportFromEPSG(crs, 2056);  // Swiss grid
    const OGRLayerH layer = GDALDatasetCreateLayer(dataset, "a", crs, wkbLineString, nullptr);
    const OGRFeatureH feature = OGR_F_Create(OGR_L_GetLayerDefn(layer));
    const OGRGeometryH geometry = OGR_G_CreateGeometry(wkbLineString);
    OGR_G_AddPoint_2D(geometry, 2720000, 1205000);
    OGR_G_AddPoint_2D(geometry, 2725000, 1206000);
    OGR_F_SetGeometryDirectly(feature, geometry);
    ASSERT_EQ(OGR_L_CreateFeature(layer, feature), OGRERR_NONE);
    OGR_F_Destroy(feature);
    GDALClose(dataset);
    OSRRelease(crs);
    const auto lines = read(file.string());
    ASSERT_EQ(lines.size(), 1U);
    const geo::Geodetic place = geo::Crs::parse("EPSG:2056", "test").to_geodetic(2725000, 1206000);
    EXPECT_LT(distance(lines[0].posts.back(), utm().post(place)), 1e-3);

    std::filesystem::remove(std::filesystem::path(file).replace_extension("prj"));
    EXPECT_EQ(error_of([&] { read(file.string()); }),
              fmt::format("exit 3: tracks.file: {}: it names no coordinate system, its place on "
                          "the ground is unknown; add one with ogr2ogr -a_srs EPSG:n",
                          file.string()));
}

/// GDAL allocates a text for a system that it cannot write: a leak, which LeakSanitizer finds.
TEST(LinesOfFiles, OfASystemThatIsDamagedAreRefused) {
    prepare_gdal();
    const std::filesystem::path file = test::scratch_dir("lines_fgb") / "a.fgb";
    const GDALDatasetH dataset =
        GDALCreate(GDALGetDriverByName("FlatGeobuf"), file.c_str(), 0, 0, 0, GDT_Unknown, nullptr);
    const OGRSpatialReferenceH crs = OSRNewSpatialReference(nullptr);
    OSRImportFromProj4(crs, "+proj=tmerc +lon_0=9.5 +ellps=GRS80");
    const OGRLayerH layer = GDALDatasetCreateLayer(dataset, "a", crs, wkbLineString, nullptr);
    const OGRFeatureH feature = OGR_F_Create(OGR_L_GetLayerDefn(layer));
    const OGRGeometryH geometry = OGR_G_CreateGeometry(wkbLineString);
    OGR_G_AddPoint_2D(geometry, 0, 5200000);
    OGR_G_AddPoint_2D(geometry, 1000, 5200000);
    OGR_F_SetGeometryDirectly(feature, geometry);
    ASSERT_EQ(OGR_L_CreateFeature(layer, feature), OGRERR_NONE);
    OGR_F_Destroy(feature);
    GDALClose(dataset);
    OSRRelease(crs);
    EXPECT_EQ(error_of([&] { read(file.string()); }), "no error");

    std::string bytes = relevo::read_text(file, "test");
    const std::size_t at = bytes.find("PROJCRS[");
    ASSERT_NE(at, std::string::npos);
    std::ofstream(file, std::ios::binary) << bytes.replace(at, 4, "XXXX");
    EXPECT_THAT(error_of([&] { read(file.string()); }),
                testing::HasSubstr("names no coordinate system"));
}

TEST(LinesOfFiles, GoTheShorterWayAcrossTheDateLine) {
    const auto lines = read(geojson(line("[[178, 10], [-178, 10]]")), earth());
    // On both edges of the grid.
    ASSERT_EQ(lines.size(), 2U);
    for (const PlacedLine& l : lines)
        EXPECT_NEAR(std::abs(l.posts.back().x - l.posts.front().x), 4, 1e-6);
    EXPECT_NEAR(lines[0].along_m.back(), 438e3, 1e3);
}

TEST(LinesOfFiles, AroundTheWholeEarthStayOnTheGrid) {
    const auto lines =
        read(geojson(line("[[-170, 0], [-60, 20], [60, -20], [170, 0], [-170, 0]]")), earth());
    ASSERT_FALSE(lines.empty());
    for (const PlacedLine& l : lines)
        for (std::size_t i = 0; i + 1 < l.posts.size(); ++i)
            ASSERT_LT(distance(l.posts[i], l.posts[i + 1]), 100);
}

TEST(LinesOfFiles, FarFromTheDemAreOmitted) {
    EXPECT_TRUE(read(geojson(line("[[20, 47.0], [21, 47.05]]"))).empty());
}

TEST(LinesOfFiles, ThatCannotBeReadSayWhy) {
    const auto expect = [](const std::string& path, const std::string& what,
                           const std::string& attribute = "") {
        const std::string error = error_of([&] { read(path, utm(), attribute); });
        EXPECT_TRUE(error.starts_with("exit 3: tracks.file: ")) << error;
        EXPECT_NE(error.find(path), std::string::npos) << error;
        EXPECT_NE(error.find(what), std::string::npos) << error;
    };
    expect("/nowhere/a.gpx", "no such file");
    expect(write("a.txt", "hello\n"), "expected a vector file");
    expect((test::source_dir() / "data/dem/jacksboro.tif").string(), "expected a vector file");
    expect(test::scratch_dir("lines_folder").string(), "");
    expect(
        geojson(
            R"({"type": "Feature", "properties": {}, "geometry": {"type": "Point", "coordinates": [9, 47]}})"),
        "it has no lines, but points; expected lines, or polygons for their outlines");
    expect(geojson(""), "it has no lines; expected lines");
    expect(geojson(line("[[9, 47], [9, 48]]", R"({"speed": 3})")),
           "no line has the attribute \"sped\"; there are speed", "sped");
    expect(write("b.geojson", R"({"type": "FeatureCollection", "features": [)"), "");
    expect(write("b.gpx", "<gpx version=\"1.1\"><trk><trkseg><trkpt lat=\"47\" lon=\"9\"/>"), "");
}

}  // namespace
}  // namespace relevo::dem::test_lines
