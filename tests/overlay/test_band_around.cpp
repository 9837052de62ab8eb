#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "base/units.h"
#include "dem/fixture.h"
#include "geo/local_frame.h"
#include "overlay/band_around.h"
#include "support/support.h"

namespace relevo::overlay::test_band_around {
namespace {

using test::error_of;
using test::folder;
using test::write_raster;

/// A DEM of 41 x 31 posts in UTM, 47 degrees north and 9 degrees east.
dem::Grid grid() {
    return {41, 31, {500015, 30, 0, 5199985, 0, -30}, geo::Crs::parse("EPSG:32632", "test")};
}

/// Degrees, with latitude + 2 * longitude as value.
std::string write_degrees(const char* name, double west, double north, double step_deg, int side) {
    return write_raster(folder() / name,
                        {.type = "Float64",
                         .columns = side,
                         .rows = side,
                         .geotransform = {{west, step_deg, 0, north, 0, -step_deg}},
                         .crs = "EPSG:4326",
                         .value = [=](int column, int row, int) {
                             return north - (row + 0.5) * step_deg +
                                    2 * (west + (column + 0.5) * step_deg);
                         }});
}

TEST(BandAround, HasEachValueAtItsPlaceFarAround) {
    const std::string path = write_degrees("far.tif", -1, 57, 0.25, 80);
    const ValuesAround around = read_band_around(grid(), path, 1);
    const geo::LocalFrame frame(grid().center());
    double worst = 0;
    for (int i = 0; i < 400; ++i) {
        const double far_m = 990.0 * i, azimuth = 2.4 * i;
        const glm::dvec2 place = far_m * glm::dvec2(std::sin(azimuth), std::cos(azimuth));
        // The point of the ellipsoid there, by a few steps downwards.
        glm::dvec3 local(place, 0);
        for (int k = 0; k < 20; ++k)
            local.z -= frame.to_geodetic(local).height_m;
        const geo::Geodetic at = frame.to_geodetic(local);
        ASSERT_NEAR(at.height_m, 0, 1e-3);
        worst = std::max(
            worst, std::abs(around.at(place) - degrees(at.lat_rad) - 2 * degrees(at.lon_rad)));
    }
    fmt::print("[ accuracy ] values 400 km around a DEM, cells of 0.25: worst {:.2g} cells\n",
               worst / 0.25 / 3);
    EXPECT_LT(worst, 0.03);
    EXPECT_TRUE(std::isnan(around.at({500'000, 0})));
}

TEST(BandAround, OfASmallRasterIsAsFineAsItsCells) {
    const std::string path = write_degrees("small.tif", 8.95, 47.05, 0.001, 120);
    const ValuesAround around = read_band_around(grid(), path, 1);
    // 0.001 degrees are 76 m along a parallel there and 111 m along a meridian.
    EXPECT_LE(around.step_m.x, 77);
    EXPECT_LE(around.step_m.y, 77);
    EXPECT_LT(around.values.width(), 1024);
    EXPECT_FALSE(std::isnan(around.at({0, 0})));
    EXPECT_TRUE(std::isnan(around.at({20'000, 0})));
}

TEST(BandAround, CellsWithoutAValueHaveNone) {
    const std::string path =
        write_raster(folder() / "voids.tif",
                     {.columns = 40,
                      .rows = 40,
                      .geotransform = {{495000, 300, 0, 5205000, 0, -300}},
                      .nodata = -1,
                      .value = [](int column, int, int) { return column < 17 ? -1.0 : 0.5; }});
    const ValuesAround around = read_band_around(grid(), path, 1);
    EXPECT_TRUE(std::isnan(around.at({-4000, 0})));
    EXPECT_FLOAT_EQ(around.at({2000, 0}), 0.5F);
}

TEST(BandAround, ElsewhereIsAnError) {
    const std::string far = write_degrees("elsewhere.tif", 40, 10, 0.1, 20);
    EXPECT_THAT(
        error_of([&] { read_band_around(grid(), far, 1); }),
        testing::AllOf(testing::StartsWith("exit 3: " + far + ": the raster does not cover"),
                       testing::HasSubstr("latitude 8")));
    // In reach, but not over the DEM.
    const std::string beside = write_degrees("beside.tif", 10, 48, 0.1, 20);
    EXPECT_THAT(error_of([&] { read_band_around(grid(), beside, 1); }),
                testing::StartsWith("exit 3: " + beside +
                                    ": the raster has no value over this DEM; it is at"));
}

TEST(BandAround, PlacesOverTheDemReachItsCorners) {
    const std::vector<glm::dvec2> places = places_over_dem(grid());
    EXPECT_EQ(places.size(), 33U * 33U);
    double most = 0;
    for (const glm::dvec2& place : places)
        most = std::max(most, glm::length(place));
    EXPECT_NEAR(most, std::hypot(600, 450), 2);
}

}  // namespace
}  // namespace relevo::overlay::test_band_around
