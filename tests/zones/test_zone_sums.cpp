// Values of rasters by zone: closed forms, other CRSs, weights, and polygons that are none.

#include <cmath>
#include <fstream>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>

#include "base/units.h"
#include "dem/fixture.h"
#include "geo/ellipsoid.h"
#include "support/support.h"
#include "zones/zone_package.h"
#include "zones/zone_sums.h"

namespace relevo::zones::test_zone_sums {
namespace {

using test::folder;
using test::Raster;
using test::write_raster;
using testing::HasSubstr;

std::string text_of(const std::vector<Ring>& rings) {
    std::vector<std::string> parts;
    for (const Ring& ring : rings) {
        std::vector<std::string> corners;
        for (std::size_t i = 0; i <= ring.size(); ++i)
            corners.push_back(
                fmt::format("[{:.12f},{:.12f}]", ring[i % ring.size()].x, ring[i % ring.size()].y));
        parts.push_back(fmt::format("[{}]", fmt::join(corners, ",")));
    }
    return fmt::format(R"({{"type":"Polygon","coordinates":[{}]}})", fmt::join(parts, ","));
}

/// Writes a GeoJSON of geometries, each with a field `name`: z0, z1, ...
std::string write_zones(const std::string& name, const std::vector<std::string>& geometries,
                        const std::string& crs = "urn:ogc:def:crs:EPSG::32632") {
    const std::string path = (folder() / name).string();
    std::vector<std::string> features;
    for (const std::string& geometry : geometries)
        features.push_back(
            fmt::format(R"({{"type":"Feature","properties":{{"name":"z{}"}},"geometry":{}}})",
                        features.size(), geometry));
    std::ofstream(path) << fmt::format(
        R"({{"type":"FeatureCollection","crs":{{"type":"name","properties":{{"name":"{}"}}}},)"
        R"("features":[{}]}})",
        crs, fmt::join(features, ","));
    return path;
}

std::vector<ZoneRow> rows_of(const std::string& zones, const std::string& raster,
                             const SumOptions& options = {}) {
    return sum_zones(read_zones(zones, "name"), raster, options).front();
}

Ring box(double left, double low, double right, double high) {
    return {{left, low}, {right, low}, {right, high}, {left, high}};
}

/// 40 x 30 cells of 30 m from (500000, 5200000); values are columns + 100 x rows.
Raster slope() {
    return {.columns = 40, .rows = 30, .value = [](int column, int row, int) {
                return column + 100.0 * row;
            }};
}

TEST(ZoneSums, CountCellsByTheirShares) {
    const std::string raster = write_raster(folder() / "slope.tif", slope());
    // Two and a half cells wide, one high, from the middle of cell (3, 4) on.
    const std::string zones = write_zones(
        "one.geojson",
        {text_of({box(500000 + 3.5 * 30, 5200000 - 5 * 30, 500000 + 6 * 30, 5200000 - 4 * 30)})});
    const ZoneRow row = rows_of(zones, raster, {.weights = {}, .above = 404})[0];
    EXPECT_EQ(row.fault, "");
    EXPECT_EQ(row.cells, 3);
    EXPECT_NEAR(row.area_m2, 2.5 * 900, 1e-6);
    EXPECT_NEAR(row.area_valid_m2, 2.5 * 900, 1e-6);
    const double mean = (0.5 * 403 + 404 + 405) / 2.5;
    EXPECT_NEAR(row.mean, mean, 1e-6 * mean);
    EXPECT_NEAR(row.integral, mean * 2250, 1e-6 * mean * 2250);
    EXPECT_EQ(row.min, 403);
    EXPECT_EQ(row.max, 405);
    EXPECT_NEAR(row.share_above, 0.4, 1e-9);
    EXPECT_TRUE(std::isnan(rows_of(zones, raster)[0].share_above));
}

TEST(ZoneSums, CellsWithoutAValueCountForNothing) {
    Raster holes = slope();
    holes.nodata = 404;
    holes.scale = 2;
    holes.offset = 1;
    const std::string zones = write_zones(
        "holes.geojson",
        {text_of({box(500000 + 3 * 30, 5200000 - 5 * 30, 500000 + 6 * 30, 5200000 - 4 * 30)}),
         text_of(
             {box(500000 + 4.1 * 30, 5200000 - 4.9 * 30, 500000 + 4.9 * 30, 5200000 - 4.2 * 30)})});
    const auto rows = rows_of(zones, write_raster(folder() / "holes.tif", holes));
    EXPECT_NEAR(rows[0].cells, 2, 1e-9);
    EXPECT_NEAR(rows[0].area_m2, 2700, 1e-6);
    EXPECT_NEAR(rows[0].area_valid_m2, 1800, 1e-6);
    EXPECT_NEAR(rows[0].mean, 2 * 404 + 1, 1e-9);
    EXPECT_THAT(rows[1].fault, HasSubstr("no cell with a value"));
}

TEST(ZoneSums, OfATurnedRasterFollowTheCells) {
    // Turned by 30 degrees: the integral of a constant is it times the area, in any position.
    Raster turned = slope();
    const double c = 20 * std::cos(kPi / 6), s = 20 * std::sin(kPi / 6);
    turned.geotransform = {{500000, c, s, 5200000, s, -c}};
    turned.value = [](int, int, int) { return 7; };
    const Ring ring{{500200, 5199990}, {500420, 5200020}, {500300, 5199800}};
    const ZoneRow row = rows_of(write_zones("turned.geojson", {text_of({ring})}),
                                write_raster(folder() / "turned.tif", turned))[0];
    const double area_m2 = 0.5 * std::abs(220.0 * -190 - 30.0 * 100);
    EXPECT_NEAR(row.area_m2, area_m2, 1e-6 * area_m2);
    EXPECT_NEAR(row.area_valid_m2, area_m2, 1e-6 * area_m2);
    EXPECT_NEAR(row.integral, 7 * area_m2, 1e-6 * 7 * area_m2);
}

/// Of the ellipsoid between the equator and a latitude, for a radian of longitude [m2].
double zone_m2(double lat_deg) {
    const double e = std::sqrt(geo::kFlattening * (2 - geo::kFlattening));
    const double b = geo::kEquatorialRadius_m * (1 - geo::kFlattening);
    const double sine = std::sin(radians(lat_deg));
    return b * b / 2 *
           (sine / (1 - e * e * sine * sine) + std::log((1 + e * sine) / (1 - e * sine)) / (2 * e));
}

TEST(ZoneSums, InDegreesWeighByTheEllipsoid) {
    const Raster degrees{.columns = 60,
                         .rows = 80,
                         .geotransform = {{10, 0.25, 0, 60, 0, -0.25}},
                         .crs = "EPSG:4326",
                         .value = [](int, int row, int) { return row < 40 ? 1.0 : 2.0; }};
    const std::string raster = write_raster(folder() / "degrees.tif", degrees);
    // From 45 to 55 degrees north, the values change at 50. The second one counts longitudes
    // otherwise.
    const std::string zones =
        write_zones("degrees.geojson",
                    {text_of({box(12.1, 45, 17.3, 55)}), text_of({box(-347.9, 45, -342.7, 55)})},
                    "urn:ogc:def:crs:OGC:1.3:CRS84");
    const double wide = radians(5.2), north = wide * (zone_m2(55) - zone_m2(50)),
                 south = wide * (zone_m2(50) - zone_m2(45));
    for (const ZoneRow& row : rows_of(zones, raster)) {
        EXPECT_NEAR(row.area_m2, north + south, 1e-6 * (north + south));
        EXPECT_NEAR(row.area_valid_m2, north + south, 1e-4 * (north + south));
        EXPECT_NEAR(row.mean, (north + 2 * south) / (north + south), 1e-5);
    }
    const ZoneRow alike = rows_of(zones, raster, {.weights = Weights::Crs, .above = {}})[0];
    EXPECT_NEAR(alike.mean, 1.5, 1e-9);
    EXPECT_NEAR(alike.area_m2, north + south, 1e-6 * (north + south));
}

TEST(ZoneSums, OfAnotherCrsFollowItsStraightLines) {
    const std::string raster = write_raster(folder() / "utm.tif", slope());
    const geo::Crs utm = geo::Crs::parse("EPSG:32632", "test");
    const Ring corners{{500100, 5199200}, {501050, 5199250}, {500700, 5199900}};
    Ring dense;  // straight in UTM
    for (std::size_t i = 0; i < corners.size(); ++i)
        for (int k = 0; k < 500; ++k) {
            const glm::dvec2 at =
                corners[i] + k / 500.0 * (corners[(i + 1) % corners.size()] - corners[i]);
            const geo::Geodetic place = utm.to_geodetic(at.x, at.y);
            dense.push_back({degrees(place.lon_rad), degrees(place.lat_rad)});
        }
    const ZoneRow there = rows_of(write_zones("utm.geojson", {text_of({corners})}), raster)[0];
    const ZoneRow here =
        rows_of(write_zones("lonlat.geojson", {text_of({dense})}, "urn:ogc:def:crs:OGC:1.3:CRS84"),
                raster)[0];
    EXPECT_NEAR(here.area_m2, there.area_m2, 1e-6 * there.area_m2);
    EXPECT_NEAR(here.mean, there.mean, 1e-6 * there.mean);
    // UTM's scale is 0.9996 on this meridian.
    const ZoneRow ground = rows_of(write_zones("ground.geojson", {text_of({corners})}), raster,
                                   {.weights = Weights::Ellipsoid, .above = {}})[0];
    EXPECT_NEAR(ground.area_m2, there.area_m2 / (0.9996 * 0.9996), 1e-6 * there.area_m2);
    EXPECT_NEAR(ground.area_valid_m2, ground.area_m2, 1e-6 * ground.area_m2);
}

TEST(ZoneSums, LinesThatAnotherCrsBendsAreFollowed) {
    Raster coarse = slope();
    coarse.columns = coarse.rows = 90;
    coarse.geotransform = {{480000, 1000, 0, 5240000, 0, -1000}};
    const std::string raster = write_raster(folder() / "bent.tif", coarse);
    const Ring corners = box(8.9, 46.6, 9.8, 47.2);
    Ring dense;
    for (std::size_t i = 0; i < corners.size(); ++i)
        for (int k = 0; k < 300; ++k)
            dense.push_back(corners[i] + k / 300.0 * (corners[(i + 1) % 4] - corners[i]));
    const auto rows = rows_of(write_zones("bent.geojson", {text_of({corners}), text_of({dense})},
                                          "urn:ogc:def:crs:OGC:1.3:CRS84"),
                              raster);
    EXPECT_NEAR(rows[0].area_m2, rows[1].area_m2, 1e-6 * rows[1].area_m2);
    EXPECT_NEAR(rows[0].mean, rows[1].mean, 1e-6 * rows[1].mean);
}

TEST(ZoneSums, NameWhatIsNoPolygonAndGoOn) {
    const std::string raster = write_raster(folder() / "named.tif", slope());
    const std::string zones = write_zones(
        "named.geojson", {R"({"type":"Point","coordinates":[500100,5199900]})", "null",
                          text_of({box(0, 0, 100, 100)}),
                          text_of({{{500100, 5199900}, {500200, 5199800}, {500150, 5199850}}}),
                          text_of({box(500300, 5199500, 500600, 5199800)})});
    const auto rows = rows_of(zones, raster);
    EXPECT_THAT(rows[0].fault, HasSubstr("no polygon"));
    EXPECT_THAT(rows[1].fault, HasSubstr("no geometry"));
    EXPECT_THAT(rows[2].fault, HasSubstr("outside of the raster"));
    EXPECT_NEAR(rows[2].area_m2, 1e4, 1e-6);
    EXPECT_THAT(rows[3].fault, HasSubstr("without area"));
    EXPECT_EQ(rows[4].fault, "");
    EXPECT_EQ(rows[4].cells, 110);
    EXPECT_THAT(test::error_of([&] { read_zones(zones, "nam"); }), HasSubstr("which has name"));
    EXPECT_THAT(test::error_of([&] { read_zones(raster, ""); }), HasSubstr("no polygons"));
}

TEST(ZoneSums, AZoneThatIsReadInPartsIsTheSame) {
    const Raster wide{.columns = 1500, .rows = 1400, .value = [](int column, int row, int) {
                          return column % 7 + row % 5;
                      }};
    const std::string raster = write_raster(folder() / "wide.tif", wide);
    const double left = 500000, top = 5200000;
    const ZoneRow row =
        rows_of(write_zones("wide.geojson",
                            {text_of({box(left, top - 1400 * 30.0, left + 1500 * 30.0, top)})}),
                raster)[0];
    double sum = 0;
    for (int y = 0; y < 1400; ++y)
        for (int x = 0; x < 1500; ++x)
            sum += x % 7 + y % 5;
    EXPECT_EQ(row.cells, 2.1e6);
    EXPECT_NEAR(row.mean, sum / 2.1e6, 1e-9);
}

}  // namespace
}  // namespace relevo::zones::test_zone_sums
