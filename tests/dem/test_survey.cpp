#include <cmath>
#include <fstream>
#include <limits>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "dem/fixture.h"
#include "dem/load.h"
#include "dem/summary.h"
#include "dem/survey.h"
#include "support/support.h"

namespace relevo::dem::test_survey {
namespace {

using test::Raster;
using test::write_raster;

using test::folder;

/// Rough ground with holes, spikes in many places, and the lowest and the highest post alone.
Raster rough(int columns, int rows) {
    Raster raster;
    raster.columns = columns;
    raster.rows = rows;
    raster.nodata = -9999;
    raster.value = [=](int c, int r, int) {
        if (c == columns - 1 && r == rows / 3) return 4321.0;
        if (c == 7 && r == rows - 1) return -87.0;
        if (c % 97 == 50 && r % 89 == 40) return -9999.0;
        return 1000 + 300 * std::sin(0.1 * c) * std::cos(0.07 * r) +
               ((c * 31 + r * 17) % 4099 == 5 ? 900 : 0);
    };
    return raster;
}

void expect_as_in_memory(const std::string& path, std::int64_t max_posts) {
    const Heightfield field = load(path);
    const Spikes spikes = find_spikes(field.height_m, field.grid.post_spacing_m());
    const Survey found = survey(Source::open(path), max_posts);
    EXPECT_EQ(found.statistics, field.about.statistics);
    EXPECT_EQ(found.spikes.count, spikes.count);
    EXPECT_EQ(found.spikes.limit_m, spikes.limit_m);
    EXPECT_EQ(found.spikes.worst_m, spikes.worst_m);
    EXPECT_EQ(found.spikes.worst_column, spikes.worst_column);
    EXPECT_EQ(found.spikes.worst_row, spikes.worst_row);
    const auto collar = find_collar(field.height_m);
    ASSERT_EQ(found.collar.has_value(), collar.has_value());
    if (collar) {
        EXPECT_EQ(found.collar->height_m, collar->height_m);
        EXPECT_EQ(found.collar->step_m, collar->step_m);
    }
}

TEST(Survey, IsThatOfAllPostsWhateverMemoryHolds) {
    // Bands of rows; strips of columns; tiles.
    expect_as_in_memory(write_raster(folder() / "bands.tif", rough(700, 900)), 1 << 18);
    expect_as_in_memory(write_raster(folder() / "all.tif", rough(700, 900)), 1 << 28);
    Raster wide = rough(5000, 130);
    wide.options = {"TILED=YES", "COMPRESS=DEFLATE"};
    expect_as_in_memory(write_raster(folder() / "strips.tif", wide), 1 << 18);
    Raster narrow = rough(3, 100'000);
    expect_as_in_memory(write_raster(folder() / "narrow.tif", narrow), 1 << 18);
    Raster small = rough(100, 2);
    expect_as_in_memory(write_raster(folder() / "small.tif", small), 1 << 18);
}

TEST(Survey, FindsAFrameInPieces) {
    Raster framed = rough(5000, 130);
    framed.options = {"TILED=YES"};
    framed.nodata.reset();
    framed.value = [](int c, int r, int) {
        return c < 40 || r < 5 || c >= 4960 || r >= 125 ? 0.0 : 50.0 + (c + r) % 30;
    };
    expect_as_in_memory(write_raster(folder() / "framed.tif", framed), 1 << 18);
}

TEST(Survey, OfSeveralFilesWithAGapBetweenThem) {
    Raster east = rough(300, 200);
    east.geotransform = {{500000 + 30.0 * 2000, 30, 0, 5200000 - 30.0 * 1500, 0, -30}};
    const std::vector<std::string> paths{write_raster(folder() / "west.tif", rough(300, 200)),
                                         write_raster(folder() / "east.tif", east)};
    const Heightfield field = load(paths);
    const Survey found = survey(Source::open(paths), 1 << 18);
    EXPECT_EQ(found.statistics, field.about.statistics);
    EXPECT_EQ(found.spikes.count, find_spikes(field.height_m, field.grid.post_spacing_m()).count);
}

TEST(Survey, SummaryIsOfTheFileWhateverMemoryHolds) {
    const std::string path = write_raster(folder() / "summary.tif", rough(1200, 640));
    const std::string whole = to_json(summarize(load(path)));
    EXPECT_EQ(to_json(summarize(Source::open(path), 1 << 18)), whole);
    EXPECT_THAT(whole, testing::HasSubstr("\"max\": 4321.0"));
}

/// A GeoTIFF that stores 4 of 200 000 x 200 000 posts, or so.
std::string sparse(const char* name, std::optional<double> nodata) {
    Raster raster;
    raster.type = "Int16";
    raster.crs = "EPSG:4326";
    raster.columns = raster.rows = 200'000;
    raster.geotransform = {{0, 0.0001, 0, 20, 0, -0.0001}};
    raster.nodata = nodata;
    raster.options = {"TILED=YES", "SPARSE_OK=YES", "BLOCKXSIZE=1024", "BLOCKYSIZE=1024",
                      "COMPRESS=DEFLATE"};
    return test::write_sparse_raster(folder() / name, raster, {{123'456, 77'777, 321}});
}

TEST(Survey, WhatAFileDoesNotStoreIsNotRead) {
    const Source holes = Source::open(sparse("holes.tif", -9999));
    const Survey found = survey(holes, 1 << 24);
    EXPECT_EQ(found.statistics.valid, 1);
    EXPECT_EQ(found.statistics.holes, 200'000LL * 200'000 - 1);
    EXPECT_EQ(found.statistics.max_m, 321);
    EXPECT_EQ(holes.read({123'455, 77'777, 3, 1}, 3, 1).at(1, 0), 321);
    EXPECT_TRUE(std::isnan(holes.read({123'455, 77'777, 3, 1}, 3, 1).at(0, 0)));

    const Source zeros = Source::open(sparse("zeros.tif", std::nullopt), {.no_nodata = true});
    EXPECT_EQ(survey(zeros, 1 << 24).statistics, (Statistics{0, 321, 200'000LL * 200'000, 0, 0}));
    const Heightfield means = load(zeros, MemoryBudget::of_posts(1 << 20));
    EXPECT_EQ(means.reduction, 256);
    EXPECT_FLOAT_EQ(means.about.statistics.max_m, 321.0F / 65536);
    EXPECT_EQ(means.about.statistics.holes, 0);
}

TEST(Survey, AVirtualRasterOfNothingIsSoon) {
    const std::filesystem::path path = folder() / "nothing.vrt";
    std::ofstream(path)
        << "<VRTDataset rasterXSize=\"2147483647\" rasterYSize=\"2147483647\"><SRS>EPSG:4326</SRS>"
           "<GeoTransform>0,0.00000001,0,1,0,-0.00000001</GeoTransform>"
           "<VRTRasterBand dataType=\"Float32\" band=\"1\"/></VRTDataset>";
    const Survey found = survey(Source::open(path.string()), 1 << 24);
    EXPECT_EQ(found.statistics.valid, 2147483647LL * 2147483647LL);
    EXPECT_EQ(found.statistics.max_m, 0);
}

TEST(Survey, WhatAFileCannotHoldIsRefused) {
    const std::string tile = write_raster(folder() / "tile.tif", {});
    const std::filesystem::path path = folder() / "promise.vrt";
    std::ofstream(path)
        << "<VRTDataset rasterXSize=\"2147483647\" rasterYSize=\"4000\"><SRS>EPSG:4326</SRS>"
           "<GeoTransform>0,0.00000001,0,1,0,-0.00000001</GeoTransform>"
           "<VRTRasterBand dataType=\"Float32\" band=\"1\"><SimpleSource><SourceFilename>"
        << tile
        << "</SourceFilename><SourceBand>1</SourceBand><SrcRect xOff=\"0\" yOff=\"0\" xSize=\"6\" "
           "ySize=\"4\"/><DstRect xOff=\"0\" yOff=\"0\" xSize=\"2147483647\" ySize=\"4000\"/>"
           "</SimpleSource></VRTRasterBand></VRTDataset>";
    EXPECT_THAT(test::error_of([&] { Source::open(path.string()); }),
                testing::MatchesRegex(
                    "exit 3: " + path.string() +
                    ": claims 2147483647 x 4000 posts, too many for [0-9]+ bytes of files"));
}

TEST(Survey, BlocksLargerThanMemoryAreRefused) {
    Raster raster;
    raster.type = "Float32";
    raster.columns = 30'000'000;
    raster.rows = 2;
    raster.geotransform = {{0, 1e-7, 0, 1, 0, -1e-7}};
    raster.crs = "EPSG:4326";
    raster.options = {"SPARSE_OK=YES", "BLOCKYSIZE=1"};
    const std::string path =
        test::write_sparse_raster(folder() / "long_rows.tif", raster, {{5, 1, 7}});
    EXPECT_EQ(
        test::error_of([&] { Source::open(path, {.memory = MemoryBudget::of_posts(64 << 18)}); }),
        "exit 3: " + path +
            ": is stored in blocks of 30000000 x 1 posts, 114 MiB each, expected at most 64 "
            "MiB; pass --memory 344, or make tiles of them with gdal_translate -co TILED=YES");
    const Source source = Source::open(path, {.memory = MemoryBudget::of_posts(120 << 18)});
    EXPECT_EQ(survey(source, 120 << 18).statistics.max_m, 7);
    EXPECT_EQ(
        test::error_of([&] { load(source, MemoryBudget::of_posts(120 << 18)); }),
        "exit 3: " + path +
            ": 30000000 x 2 posts, expected at most 4194304 a side; crop it with gdal_translate");
    // Means would need four rows or more.
    raster.columns = 4'000'000;
    const std::string narrow =
        test::write_sparse_raster(folder() / "narrow.tif", raster, {{5, 1, 7}});
    const Source long_rows = Source::open(narrow);
    const auto refusal = [&](const MemoryBudget& memory) {
        return test::error_of([&] { load(long_rows, memory); });
    };
    const auto expected = [&](int mib) {
        return fmt::format(
            "exit 3: {}: 4000000 x 2 posts are too narrow to be averaged; pass "
            "--memory {} or more, or crop it with gdal_translate",
            narrow, mib);
    };
    EXPECT_EQ(refusal(MemoryBudget::of_mib(60)), expected(92));
    EXPECT_EQ(refusal(MemoryBudget::of_mib(91)), expected(92));
    EXPECT_EQ(refusal(MemoryBudget::of_mib(92)), "no error");
    // Pictures need more, because they hold more of each post.
    const auto pictures = [](int mib) { return MemoryBudget::of_mib(mib).for_pictures(); };
    EXPECT_EQ(refusal(pictures(92)), expected(254));
    EXPECT_EQ(refusal(pictures(254 - 1)), expected(254));
    EXPECT_EQ(refusal(pictures(254)), "no error");
}

}  // namespace
}  // namespace relevo::dem::test_survey
