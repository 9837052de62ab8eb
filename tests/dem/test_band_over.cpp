#include <cmath>

#include <fmt/format.h>

#include "base/units.h"
#include "dem/band_over.h"
#include "dem/fixture.h"
#include "support/support.h"

namespace relevo::dem {
namespace {

using test::error_of;
using test::folder;
using test::Raster;
using test::write_raster;

/// A DEM of 41 x 31 posts in UTM.
Grid grid() {
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
    const Grid dem = grid();
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

TEST(BandOver, WhatItCannotReadIsRefused) {
    const std::string far =
        write_raster(folder() / "far.tif", {.geotransform = {{600000, 30, 0, 5200000, 0, -30}}});
    EXPECT_EQ(error_of([&] { read_band_over(grid(), far, 1); }),
              "exit 3: " + far + ": has no value over the DEM, expected a raster that lies there");
    EXPECT_EQ(error_of([&] { read_band_over(grid(), far, 2); }),
              "exit 3: " + far + ": band 2: expected 1 to 1");
}

}  // namespace
}  // namespace relevo::dem
