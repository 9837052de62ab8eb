#include <cmath>

#include <gmock/gmock.h>

#include "base/units.h"
#include "dem/fixture.h"
#include "dem/load.h"
#include "dem/survey.h"
#include "support/support.h"

// Rasters that are not all on the Earth.

namespace relevo::dem::test_earth {
namespace {

using test::Raster;
using test::write_raster;

using test::folder;

std::string refusal(const std::string& path) {
    const std::string message = test::error_of([&] { load(path); });
    const std::string begin = "exit 3: " + path + ": ";
    return message.starts_with(begin) ? message.substr(begin.size()) : "!" + message;
}

/// The globe in a square of so many posts, half of it in an orthographic one.
Raster globe(const char* crs, double half_width_m, double half_height_m, int columns, int rows) {
    Raster raster;
    raster.crs = crs;
    raster.columns = columns;
    raster.rows = rows;
    raster.geotransform = {{-half_width_m, 2 * half_width_m / columns, 0, half_height_m, 0,
                            -2 * half_height_m / rows}};
    raster.value = [](int, int, int) { return 100.0; };
    return raster;
}

TEST(OffTheGlobe, CornersOfAMapOfTheWorldAreHoles) {
    const struct {
        const char* name;
        Raster raster;
        double share;  // of the box that the globe is in
    } cases[] = {
        {"mollweide.tif", globe("ESRI:54009", 18040096, 9020048, 256, 128), kPi / 4},
        {"orthographic.tif",
         globe("+proj=ortho +lat_0=47 +lon_0=11 +R=6371000", 6371000, 6371000, 128, 128), kPi / 4}};
    for (const auto& c : cases) {
        const std::string path = write_raster(folder() / c.name, c.raster);
        const Heightfield f = load(path);
        EXPECT_TRUE(std::isnan(f.height_m.at(0, 0))) << c.name;
        EXPECT_EQ(f.height_m.at(f.grid.columns() / 2, f.grid.rows() / 2), 100) << c.name;
        EXPECT_NEAR(1 - f.about.statistics.nodata_share(), c.share, 0.01) << c.name;
        EXPECT_THAT(f.about.guesses.back(), testing::HasSubstr("of its posts are not on the Earth"))
            << c.name;
        // Every post with a height has a place.
        for (int row = 0; row < f.grid.rows(); ++row)
            for (int column = 0; column < f.grid.columns(); ++column)
                ASSERT_EQ(std::isnan(f.height_m.at(column, row)),
                          !std::isfinite(f.grid.place(column, row).lat_rad))
                    << c.name << column << " " << row;
        // So it is of means, and of all posts one by one.
        const Source source = Source::open(path);
        const Heightfield means = load(source, MemoryBudget::of_posts(64 * 32));
        EXPECT_GT(means.reduction, 1);
        EXPECT_NEAR(1 - means.about.statistics.nodata_share(), c.share, 0.02) << c.name;
        EXPECT_EQ(survey(source, 1 << 18).statistics, f.about.statistics) << c.name;
    }
}

TEST(OffTheGlobe, RowsBeyondAPoleAreHoles) {
    Raster raster;
    raster.crs = "EPSG:4326";
    raster.columns = 36;
    raster.rows = 20;
    raster.geotransform = {{-180, 10, 0, 95, 0, -10}};  // posts at 90, 80, ... -100
    const Heightfield f = load(write_raster(folder() / "pole.tif", raster));
    EXPECT_EQ(f.height_m.at(3, 0), 103);
    EXPECT_EQ(f.height_m.at(3, 18), 283);
    EXPECT_TRUE(std::isnan(f.height_m.at(3, 19)));
    EXPECT_EQ(f.about.statistics.holes, 36);
}

TEST(OffTheGlobe, WhatHasNoGroundIsRefusedByName) {
    constexpr const char* kRemedy =
        "; pass the right one with --crs EPSG:n, or bring it to degrees with gdalwarp -t_srs "
        "EPSG:4326";
    Raster huge;
    huge.crs = "EPSG:4326";
    huge.columns = huge.rows = 2;
    huge.geotransform = {{-1000, 1000, 0, 1000, 0, -1000}};
    EXPECT_EQ(refusal(write_raster(folder() / "huge.tif", huge)),
              std::string("none of its posts is on the Earth in WGS 84") + kRemedy);
    huge.columns = huge.rows = 3;
    huge.geotransform = {{-1500, 1000, 0, 1500, 0, -1000}};
    EXPECT_EQ(
        refusal(write_raster(folder() / "middle.tif", huge)),
        std::string("cells so large that the centre has no neighbour on the Earth in WGS 84") +
            kRemedy);
}

TEST(OffTheGlobe, GridsOnTheEarthHaveNoSuchHoles) {
    for (const char* name : {"utm.tif", "degrees.tif"}) {
        Raster raster;
        if (name[0] == 'd') {
            raster.crs = "EPSG:4326";
            raster.columns = 361;
            raster.rows = 181;
            raster.geotransform = {{-180.5, 1, 0, 90.5, 0, -1}};  // posts on both poles
        }
        const Source source = Source::open(write_raster(folder() / name, raster));
        EXPECT_EQ(source.grid().share_on_earth(), 1) << name;
    }
}

}  // namespace
}  // namespace relevo::dem::test_earth
