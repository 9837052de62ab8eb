#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "base/units.h"
#include "dem/fixture.h"
#include "overlay/band_over.h"
#include "support/support.h"

namespace relevo::overlay::test_band_over {
namespace {

using test::error_of;
using test::folder;
using test::Raster;
using test::write_raster;

/// A DEM of 41 x 31 posts in UTM.
dem::Grid grid() {
    return {41, 31, {500015, 30, 0, 5199985, 0, -30}, geo::Crs::parse("EPSG:32632", "test")};
}

TEST(BandOver, OnTheDemsOwnGridHasEveryValueAsItIsStored) {
    const std::string path = write_raster(folder() / "same.tif",
                                          {.columns = 41, .rows = 31, .nodata = 107, .unit = "h"});
    const BandOver over = read_band_over(grid(), path, 1);
    ASSERT_EQ(over.values.width(), 41);
    ASSERT_EQ(over.values.height(), 31);
    for (int row = 0; row < 31; ++row)
        for (int column = 0; column < 41; ++column) {
            const float stored = static_cast<float>(100 + column + 10 * row);
            if (stored == 107)
                EXPECT_TRUE(std::isnan(over.values.at(column, row)));
            else
                EXPECT_NEAR(over.values.at(column, row), stored, 1e-4);
        }
    EXPECT_EQ(over.unit, "h");
    EXPECT_FALSE(over.whole);
}

TEST(BandOver, OfAnotherCrsLiesAtItsPlaces) {
    // Degrees around the DEM, with the longitude as value.
    const double west = 8.99, north = 46.96, step = 0.0005;
    const std::string path =
        write_raster(folder() / "degrees.tif",
                     {.columns = 120,
                      .rows = 120,
                      .geotransform = {{west, step, 0, north, 0, -step}},
                      .crs = "EPSG:4326",
                      .value = [=](int column, int, int) { return west + (column + 0.5) * step; }});
    const dem::Grid dem = grid();
    const BandOver over = read_band_over(dem, path, 1);
    double worst = 0;
    int count = 0;
    for (int row = 0; row < 31; ++row)
        for (int column = 0; column < 41; ++column) {
            const float found = over.values.at(column, row);
            if (std::isnan(found)) continue;
            ++count;
            worst =
                std::max(worst, std::abs(double{found} - degrees(dem.place(column, row).lon_rad)));
        }
    EXPECT_EQ(count, 41 * 31);
    // A float of 9 degrees has steps of 1e-6.
    fmt::print("[ accuracy ] longitudes read from a raster in degrees: worst {:.2g} degrees\n",
               worst);
    EXPECT_LT(worst, 3e-6);
}

TEST(BandOver, ClassesAreNeverMixed) {
    const std::string path = write_raster(
        folder() / "classes.tif",
        {.type = "Byte",
         .columns = 10,
         .rows = 8,
         .geotransform = {{500000, 123, 0, 5200000, 0, -117}},
         .value = [](int column, int row, int) { return column % 2 == row % 2 ? 10 : 200; }});
    const BandOver over = read_band_over(grid(), path, 1);
    EXPECT_TRUE(over.whole);
    for (const float value : over.values)
        EXPECT_TRUE(value == 10 || value == 200) << value;
}

TEST(BandOver, WhereTheRasterDoesNotReachThereIsNoValue) {
    const std::string path = write_raster(
        folder() / "part.tif",
        {.columns = 10, .rows = 31, .geotransform = {{500000, 30, 0, 5200000, 0, -30}}});
    const BandOver over = read_band_over(grid(), path, 1);
    EXPECT_FALSE(std::isnan(over.values.at(9, 5)));
    EXPECT_TRUE(std::isnan(over.values.at(11, 5)));
}

/// A raster of the whole Earth in degrees, whose value is the longitude's cosine times 100 plus the
/// latitude: the same on both sides of 180 degrees.
std::string write_earth(const char* name, double west_deg) {
    return write_raster(folder() / name, {.columns = 720,
                                          .rows = 360,
                                          .geotransform = {{west_deg, 0.5, 0, 90, 0, -0.5}},
                                          .crs = "EPSG:4326",
                                          .value = [=](int column, int row, int) {
                                              const double lon_deg = west_deg + (column + 0.5) / 2;
                                              return 100 * std::cos(radians(lon_deg)) + 90 -
                                                     (row + 0.5) / 2;
                                          }});
}

/// How far values are from that formula, all over a DEM.
double worst_off(const dem::Grid& dem, const std::string& path) {
    const BandOver over = read_band_over(dem, path, 1);
    double worst = 0;
    for (int row = 0; row < dem.rows(); ++row)
        for (int column = 0; column < dem.columns(); ++column) {
            const geo::Geodetic at = dem.place(column, row);
            const double off =
                over.values.at(column, row) - (100 * std::cos(at.lon_rad) + degrees(at.lat_rad));
            worst = std::isnan(off) ? 1e9 : std::max(worst, std::abs(off));
        }
    return worst;
}

// A cell is 0.5 degrees: 0.9 of a value by the longitude, of which linear interpolation loses
// 0.0010; and 0.05 cells 0.044.
constexpr double kMostOff = 0.05;

TEST(BandOver, AcrossTheDateLineEveryPostHasTheValueOfItsPlace) {
    const std::string greenwich = write_earth("greenwich.tif", -180),
                      pacific = write_earth("pacific.tif", 0);
    // Degrees that go on past 180, and UTM and Mercator on both sides of it.
    const std::vector<dem::Grid> dems{
        {200, 100, {170.05, 0.1, 0, 5.05, 0, -0.1}, geo::Crs::parse("EPSG:4326", "test")},
        {200, 100, {-189.95, 0.1, 0, 5.05, 0, -0.1}, geo::Crs::parse("EPSG:4326", "test")},
        {120, 90, {600000, 5000, 0, 6200000, 0, -5000}, geo::Crs::parse("EPSG:32660", "test")},
        {200, 90, {19500000, 5000, 0, 800000, 0, -5000}, geo::Crs::parse("EPSG:3857", "test")},
    };
    for (const dem::Grid& dem : dems)
        for (const std::string& raster : {greenwich, pacific})
            EXPECT_LT(worst_off(dem, raster), kMostOff) << dem.crs().name() << " on " << raster;
}

TEST(BandOver, ARasterOfTheDemsOwnGridLiesOnItAcrossTheDateLine) {
    Raster own;
    own.columns = 200;
    own.rows = 90;
    own.geotransform = {{19500000 - 2500, 5000, 0, 800000 + 2500, 0, -5000}};
    own.crs = "EPSG:3857";
    own.value = [](int column, int row, int) { return 1000.0 * row + column; };
    const std::string path = write_raster(folder() / "own.tif", own);
    const dem::Grid dem(200, 90, {19500000, 5000, 0, 800000, 0, -5000},
                        geo::Crs::parse("EPSG:3857", "test"));
    const BandOver over = read_band_over(dem, path, 1);
    int wrong = 0;
    for (int row = 0; row < 90; ++row)
        for (int column = 0; column < 200; ++column)
            wrong += !(std::abs(over.values.at(column, row) - (1000.0 * row + column)) < 0.01);
    EXPECT_EQ(wrong, 0);
}

TEST(BandOver, AroundAPoleEveryPostHasTheValueOfItsPlace) {
    const std::string earth = write_earth("earth.tif", -180);
    const dem::Grid arctic(161, 161, {-400000, 5000, 0, 400000, 0, -5000},
                           geo::Crs::parse("EPSG:3413", "test"));
    const BandOver over = read_band_over(arctic, earth, 1);
    int wrong = 0;
    for (int row = 0; row < 161; ++row)
        for (int column = 0; column < 161; ++column) {
            const geo::Geodetic at = arctic.place(column, row);
            const double true_value = 100 * std::cos(at.lon_rad) + degrees(at.lat_rad);
            // Within the last row of cells the pole has no cell of its own.
            if (degrees(at.lat_rad) > 89.7) continue;
            // Near the pole cells are narrower than the posts are apart, which counts then.
            const double cells = std::max(1.0, 5e3 / (55.6e3 * std::cos(at.lat_rad)));
            wrong += !(std::abs(over.values.at(column, row) - true_value) < kMostOff * cells);
        }
    EXPECT_EQ(wrong, 0) << "of " << 161 * 161 << " posts";
}

TEST(BandOver, WhatItCannotReadIsRefused) {
    const std::string far =
        write_raster(folder() / "far.tif", {.geotransform = {{600000, 30, 0, 5200000, 0, -30}}});
    EXPECT_EQ(
        error_of([&] { read_band_over(grid(), far, 1); }),
        "exit 3: " + far +
            ": the raster does not cover this DEM; it is at latitude 46.945 to 46.946, longitude "
            "10.314 to 10.316, the DEM at latitude 46.945 to 46.954, longitude 9.000 to 9.016");
    const dem::Grid arctic(161, 161, {-400000, 5000, 0, 400000, 0, -5000},
                           geo::Crs::parse("EPSG:3413", "test"));
    EXPECT_THAT(error_of([&] { read_band_over(arctic, far, 1); }),
                testing::EndsWith("the DEM at latitude 84.749 to 90.000, all longitudes"));
    const std::string empty = write_raster(
        folder() / "empty.tif",
        {.columns = 41, .rows = 31, .nodata = 7, .value = [](int, int, int) { return 7.0; }});
    EXPECT_EQ(error_of([&] { read_band_over(grid(), empty, 1); }),
              "exit 3: " + empty + ": the raster has no value anywhere on this DEM");
    EXPECT_EQ(error_of([&] { read_band_over(grid(), far, 2); }),
              "exit 3: " + far + ": band 2: expected 1 to 1");
    const std::string nowhere =
        write_raster(folder() / "nowhere.tif", {.geotransform = {}, .crs = ""});
    EXPECT_EQ(error_of([&] { read_band_over(grid(), nowhere, 1); }),
              "exit 3: " + nowhere +
                  ": the raster has no georeference, its place on the ground is unknown; add one "
                  "with gdal_translate -a_srs EPSG:n -a_ullr W N E S");
}

}  // namespace
}  // namespace relevo::overlay::test_band_over
