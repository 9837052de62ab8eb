#include <cmath>

#include <nlohmann/json.hpp>

#include "base/units.h"
#include "dem/fixture.h"
#include "dem/load.h"
#include "dem/summary.h"
#include "support/support.h"

namespace relevo::dem::test_summary {
namespace {

Summary of(const char* name, const test::Raster& raster) {
    static const std::filesystem::path dir = test::scratch_dir("dem_summary");
    return summarize(load(test::write_raster(dir / name, raster)));
}

test::Raster alps() {
    test::Raster raster;
    raster.columns = 101;
    raster.rows = 51;
    raster.type = "Int16";
    raster.nodata = -9999;
    raster.value = [](int column, int row, int) {
        return column == 0 && row == 0 ? -9999.0 : 1000.0 + column + 2 * row;
    };
    return raster;
}

TEST(Summary, JsonHasTheKeysOfTheContract) {
    const nlohmann::json json = nlohmann::json::parse(to_json(of("alps.tif", alps())));
    EXPECT_EQ(json["driver"], "GTiff");
    EXPECT_EQ(json["size"], nlohmann::json({101, 51}));
    EXPECT_EQ(json["crs"], "EPSG:32632");
    EXPECT_NEAR(json["center"]["lat_deg"].get<double>(), 46.946, 0.001);
    EXPECT_NEAR(json["center"]["lon_deg"].get<double>(), 9.02, 0.001);
    EXPECT_NEAR(json["extent_m"][0].get<double>(), 3000 / 0.9996, 1);
    EXPECT_NEAR(json["extent_m"][1].get<double>(), 1500 / 0.9996, 1);
    EXPECT_NEAR(json["post_spacing_m"][0].get<double>(), 30 / 0.9996, 0.001);
    EXPECT_NEAR(json["post_spacing_m"][1].get<double>(), 30 / 0.9996, 0.001);
    EXPECT_EQ(json["elevation_m"], nlohmann::json({{"min", 1001.0}, {"max", 1200.0}}));
    EXPECT_DOUBLE_EQ(json["nodata_share"].get<double>(), 1.0 / (101 * 51));
    EXPECT_EQ(json["nodata"], -9999);
    EXPECT_EQ(json["unit"], "m");
    EXPECT_EQ(json["unit_source"], "assumed");
    EXPECT_EQ(json["vertical_datum"], nullptr);
    EXPECT_EQ(json["outliers"], 0);
    EXPECT_EQ(json["band"], 1);
    EXPECT_EQ(json["bands"], 1);
    EXPECT_EQ(json["data_type"], "Int16");
    EXPECT_EQ(json["crs_name"], "WGS 84 / UTM zone 32N");
    EXPECT_EQ(json["assumptions"].size(), 2);
    EXPECT_TRUE(json["path"].get<std::string>().ends_with("alps.tif"));
}

TEST(Summary, CrsWithoutACodeIsWktThatLoadsAgain) {
    test::Raster raster = alps();
    raster.crs = "+proj=tmerc +lat_0=0 +lon_0=9.5 +k=0.9996 +x_0=500000 +datum=WGS84";
    const Summary summary = of("custom.tif", raster);
    EXPECT_EQ(summary.crs_name, "Transverse Mercator on WGS 84");
    const geo::Crs again = geo::Crs::parse(summary.crs, "test");
    const geo::Geodetic expected =
        geo::Crs::parse("EPSG:32632", "test").to_geodetic(510000, 5200000);
    const geo::Geodetic found = again.to_geodetic(510000, 5200000);
    EXPECT_DOUBLE_EQ(found.lat_rad, expected.lat_rad);
    EXPECT_NEAR(degrees(found.lon_rad - expected.lon_rad), 0.5, 1e-12);
}

TEST(Summary, NodataIsANumberOrNullAndATextBesides) {
    test::Raster raster = alps();
    raster.type = "Float32";
    raster.nodata = std::nan("");
    raster.value = [](int column, int, int) { return column == 0 ? std::nan("") : 5.0; };
    const nlohmann::json json = nlohmann::json::parse(to_json(of("nan.tif", raster)));
    EXPECT_EQ(json["nodata"], nullptr);
    EXPECT_EQ(json["nodata_text"], "nan");
    raster.nodata.reset();
    const nlohmann::json none = nlohmann::json::parse(to_json(of("none.tif", raster)));
    EXPECT_EQ(none["nodata"], nullptr);
    EXPECT_EQ(none["nodata_text"], nullptr);
    raster.nodata = -3.4028234663852886e38;
    const nlohmann::json number = nlohmann::json::parse(to_json(of("number.tif", raster)));
    EXPECT_EQ(number["nodata"], -3.4028234663852886e38);
    EXPECT_EQ(number["nodata_text"], "-3.4028235e+38");
}

TEST(Summary, SaysHowHolesWereFound) {
    const auto holes = [](const char* name, const test::Raster& raster) {
        const Summary summary = of(name, raster);
        const std::string text = to_text(summary);
        const std::size_t at = text.find("voids      ") + 11;
        return text.substr(at, text.find('\n', at) - at) + " " +
               nlohmann::json::parse(to_json(summary))["holes_by"].dump();
    };
    test::Raster raster = alps();
    raster.columns = raster.rows = 20;
    const auto height = [](int column, int row) { return 1000.0 + column + 2 * row; };
    raster.value = [=](int c, int r, int) { return c == 0 ? -9999.0 : height(c, r); };
    EXPECT_EQ(holes("declared.tif", raster), "5 % (nodata -9999) [\"nodata\"]");
    raster.nodata.reset();
    EXPECT_EQ(holes("found.tif", raster), "5 % (nodata -9999, not declared) [\"found\"]");
    raster.type = "Float32";
    raster.value = [=](int c, int r, int) { return c == 0 ? -3e38 : height(c, r); };
    EXPECT_EQ(holes("large.tif", raster), "5 % (too large for heights, not declared) [\"found\"]");
    raster.value = [=](int c, int r, int) { return c == 0 ? std::nan("") : height(c, r); };
    EXPECT_EQ(holes("nan.tif", raster), "5 % (NaN) []");
    raster.value = [=](int c, int r, int) { return height(c, r); };
    EXPECT_EQ(holes("whole.tif", raster), "0 % []");
    raster.mask = [](int column, int) { return column > 0; };
    EXPECT_EQ(holes("mask.tif", raster), "5 % (mask) [\"mask\"]");
    raster.mask = {};
    raster.bands = 2;
    raster.options = {"ALPHA=YES"};
    raster.value = [=](int c, int r, int band) { return band == 1 ? height(c, r) : c > 0; };
    EXPECT_EQ(holes("alpha.tif", raster), "5 % (alpha band 2) [\"alpha\"]");
}

TEST(Summary, OfATurnedGridHasItsSides) {
    test::Raster raster = alps();
    // Turned by 30 degrees, 3000 m by 1500 m.
    raster.geotransform = {{500000, 25.98076211, 15, 5200000, 15, -25.98076211}};
    const Summary summary = of("turned.tif", raster);
    const nlohmann::json json = nlohmann::json::parse(to_json(summary));
    EXPECT_NEAR(json["side_m"][0].get<double>(), 3000 / 0.9996, 1);
    EXPECT_NEAR(json["side_m"][1].get<double>(), 1500 / 0.9996, 1);
    EXPECT_NEAR(json["row_azimuth_deg"].get<double>(), 60, 0.05);
    // The box around it, as ever: 3000 cos 30 + 1500 sin 30 and the other way round.
    EXPECT_NEAR(json["extent_m"][0].get<double>(), 3348 / 0.9996, 2);
    EXPECT_NEAR(json["extent_m"][1].get<double>(), 2799 / 0.9996, 2);
    EXPECT_NE(to_text(summary).find("extent     3349 m east, 2800 m north; sides 3001 m x 1501 m, "
                                    "rows run towards 60.0 degrees\n"),
              std::string::npos)
        << to_text(summary);
    // Rows that run to the south are along the box all the same.
    raster.geotransform = {{500000, 0, 30, 5200000, -30, 0}};
    EXPECT_EQ(to_text(of("quarter.tif", raster)).find("sides"), std::string::npos);
}

TEST(Summary, TextForPeople) {
    Summary summary = of("text.tif", alps());
    summary.path = "text.tif";
    EXPECT_EQ(to_text(summary),
              "file       text.tif\nformat     GTiff, Int16\nposts      101 x 51\ncrs        "
              "EPSG:32632 (WGS 84 / UTM zone 32N)\ncenter     46.94664 N 9.01991 E (UTM 32N 501515 "
              "E 5199235 N, MGRS 32TNS0151499235)\nextent     3002 m east, 1501 m north\nspacing   "
              " 30.01 m x 30.01 m\nheights    1001.0 to 1200.0 m\nvoids      0.01941 % (nodata "
              "-9999)\nunit       m (assumed)\nabove      unknown\nassumed    heights are taken as "
              "metres: the file names no unit; --unit sets another\nassumed    heights are taken "
              "as ellipsoidal: the file names no vertical datum\n");
}

}  // namespace
}  // namespace relevo::dem::test_summary
