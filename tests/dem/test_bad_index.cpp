// Indexes that name what no index should.
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "dem/fixture.h"
#include "dem/index_fixture.h"
#include "dem/source.h"
#include "support/support.h"

namespace relevo::dem::test_bad_index {
namespace {

using test::error_of;
using test::folder;
using test::IndexRow;
using test::Raster;
using test::row_of;
using test::write_index;
using test::write_raster;
using testing::ElementsAre;
using testing::StartsWith;

constexpr std::array<double, 4> kAt = {500000, 5199880, 500180, 5200000};

/// A virtual raster of 6 x 4 posts.
std::string write_vrt(const std::string& name, const std::string& source, double west) {
    std::ofstream(folder() / name) << fmt::format(
        R"(<VRTDataset rasterXSize="6" rasterYSize="4"><SRS>EPSG:32632</SRS>)"
        R"(<GeoTransform>{}, 30, 0, 5200000, 0, -30</GeoTransform>)"
        R"(<VRTRasterBand dataType="Float32" band="1"><SimpleSource>)"
        R"(<SourceFilename relativeToVRT="1">{}</SourceFilename><SourceBand>1</SourceBand>)"
        R"(</SimpleSource></VRTRasterBand></VRTDataset>)",
        west, source);
    return (folder() / name).string();
}

std::string refusal(const std::string& index) {
    const std::string message = error_of([&] { Source::open(index).read(); });
    const std::string start = "exit 3: " + index + ": ";
    return message.starts_with(start) ? message.substr(start.size()) : message;
}

TEST(BadIndex, AVirtualRasterThatNamesTheIndexOrItselfIsABrokenTile) {
    const std::string good = write_raster(folder() / "good.tif", Raster());
    const std::string self = write_vrt("self.vrt", "self.vrt", 500180);
    const std::string back = write_vrt("back.vrt", "i.gpkg", 500360);
    const IndexRow of_self{self, {500180, 5199880, 500360, 5200000}};
    const IndexRow of_back{back, {500360, 5199880, 500540, 5200000}};
    const Source source =
        Source::open(write_index(folder() / "i.gpkg", "GPKG", {row_of(good), of_self, of_back}));
    const Array2d<float> read = source.read();
    EXPECT_EQ(read.at(0, 0), 100);
    EXPECT_TRUE(std::isnan(read.at(6, 0)));
    EXPECT_TRUE(std::isnan(read.at(12, 0)));
    EXPECT_THAT(
        source.tiles().broken.first,
        ElementsAre("self (" + self + ": a virtual raster that is made of itself, by way of '" +
                        self + "')",
                    StartsWith("back (" + back + ": its heights cannot be read, ")));
    EXPECT_EQ(refusal(write_index(folder() / "alone.gpkg", "GPKG", {of_self})),
              "none of its tiles can be opened (1 of 1 tried): " + self +
                  ": a virtual raster that is made of itself, by way of '" + self + "'");
}

// PROJ takes 10 ms for each.
TEST(BadIndex, ThousandsOfReferenceSystemsAreRefused) {
    std::vector<IndexRow> rows;
    for (int i = 0; i < 20'000; ++i)
        rows.push_back({fmt::format("{}.tif", i), kAt,
                        fmt::format("+proj=tmerc +lon_0=9 +x_0={} +ellps=WGS84 +type=crs", i)});
    const std::string index = write_index(folder() / "i.gpkg", "GPKG", rows);
    const std::clock_t began = std::clock();  // of the processor: other work costs none of it
    EXPECT_EQ(refusal(index),
              "an index of tiles in more than 256 different coordinate reference systems; cut it "
              "up, for example with ogr2ogr -where");
    EXPECT_LT(std::clock() - began, 10 * CLOCKS_PER_SEC);
}

TEST(BadIndex, LongitudesOfAnotherTurnAreTheSamePlace) {
    Raster raster;
    raster.crs = "EPSG:4326";
    raster.columns = raster.rows = 10;
    raster.geotransform = {{-84.41375, 0.01, 0, 36.44625, 0, -0.01}};
    raster.value = [](int column, int row, int) { return column + 100.0 * row; };
    IndexRow row = row_of(write_raster(folder() / "west.tif", raster));
    row.extent[0] += 360;
    row.extent[2] += 360;
    const std::string index =
        write_index(folder() / "turn.gpkg", "GPKG", {row}, {.crs = "EPSG:4326"});
    const Source source = Source::open(index);
    EXPECT_EQ(source.grid().columns(), 10);
    EXPECT_EQ(source.read({0, 0, 10, 10}, 10, 10).at(3, 2), 203);
    EXPECT_EQ(source.tiles().missing.count, 0);
}

}  // namespace
}  // namespace relevo::dem::test_bad_index
