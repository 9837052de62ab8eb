#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "cli/program.h"
#include "cli/raster.h"
#include "dem/fixture.h"
#include "dem/index_fixture.h"
#include "support/support.h"

namespace relevo::test::test_tile_index {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// Nine tiles of hills, and their index.
struct Country {
    std::filesystem::path dir = scratch_dir("country");
    std::vector<std::string> tiles;
    std::string index;

    Country() {
        std::vector<IndexRow> rows;
        for (int i = 0; i < 9; ++i) {
            const int column = 32 * (i % 3), row = 32 * (i / 3);
            Raster raster;
            raster.columns = raster.rows = 32;
            raster.nodata = -1;
            raster.geotransform = {{500000 + 30.0 * column, 30, 0, 5200000 - 30.0 * row, 0, -30}};
            raster.value = [=](int c, int r, int) {
                return 900 + 200 * std::sin(0.1 * (column + c)) * std::cos(0.13 * (row + r));
            };
            tiles.push_back(write_raster(dir / fmt::format("t{}.tif", i), raster));
            rows.push_back(row_of(tiles.back()));
            rows.back().location = fmt::format("t{}.tif", i);
        }
        index = write_index(dir / "index.gpkg", "GPKG", rows);
    }
};

TEST(TileIndexVerb, InfoCountsTheTilesAndNamesTheMissing) {
    const Country country;
    std::filesystem::remove(country.tiles[4]);
    cut_short(country.tiles[7], 50);
    const Result run = relevo({"info", country.index});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_THAT(run.out, StartsWith("file       " + country.index +
                                    "\nformat     GTiff, Float32\ntiles      9, 1 missing, 1 "
                                    "broken\nposts      96 x 96\n"));
    EXPECT_THAT(run.out, HasSubstr("\nvoids      22.22 %"));
    EXPECT_THAT(run.out, HasSubstr("assumed    9 tiles of an index (GPKG) are joined; where they "
                                   "overlap, the later one is on top\n"));
    EXPECT_THAT(run.err, StartsWith("relevo: warning: " + country.index +
                                    ": 1 (t4) of 9 tiles are missing: their posts are voids\n"
                                    "relevo: warning: " +
                                    country.index + ": 1 (t7 (" + country.tiles[7] + ": "));
    const Result json = relevo({"-q", "info", country.index, "--json"});
    ASSERT_EQ(json.status, 0) << json.err;
    const nlohmann::json said = nlohmann::json::parse(json.out);
    EXPECT_EQ(said["files"], nlohmann::json{country.index});
    EXPECT_EQ(said["file_count"], 1);
    EXPECT_EQ(said["tiles"]["count"], 9);
    EXPECT_EQ(said["tiles"]["missing"], 1);
    EXPECT_EQ(said["tiles"]["missing_names"], nlohmann::json{"t4"});
    EXPECT_EQ(said["tiles"]["broken"], 1);
    EXPECT_TRUE(
        nlohmann::json::parse(relevo({"-q", "info", country.tiles[0], "--json"}).out)["tiles"]
            .is_null());
}

TEST(TileIndexVerb, AFigureOverMissingTilesSaysSo) {
    const Country country;
    std::filesystem::remove(country.tiles[0]);
    const std::string result = (country.dir / "hours.tif").string();
    const Result run = relevo(
        {"sun", "hours", country.index, "--date", "2026-06-21", "--step", "60", "-o", result});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("relevo: warning: " + country.index +
                                   ": 1 (t0) of 9 tiles are missing: their posts are voids\n"));
    const Dataset dataset = opened(result);
    ASSERT_TRUE(dataset);
    EXPECT_STREQ(dataset->GetMetadataItem("TILES_MISSING"), "1 (t0) of 9");
    EXPECT_EQ(dataset->GetMetadataItem("TILES_BROKEN"), nullptr);
}

TEST(TileIndexVerb, APictureOfAnIndexIsThatOfItsTiles) {
    const Country country;
    const auto drawn = [&](const std::vector<std::string>& dems, const std::string& name) {
        std::vector<std::string> words{"-q", "capture"};
        words.insert(words.end(), dems.begin(), dems.end());
        const std::string picture = (country.dir / name).string();
        words.insert(words.end(), {"-o", picture, "--size", "160x120", "--time",
                                   "2026-06-21T10:00Z", "--view", "az=210,el=30"});
        const Result run = relevo(words);
        EXPECT_EQ(run.status, 0) << run.err;
        return picture;
    };
    const std::string index = drawn({country.index}, "index.png");
    const std::string files = drawn(country.tiles, "files.png");
    EXPECT_EQ(relevo({"compare", index, files}).status, 0);
    // It can be made again from its record, which is short.
    const std::string again = (country.dir / "again.png").string();
    const Result run = relevo({"capture", "--from", index, "-o", again});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(relevo({"compare", index, again}).status, 0);
}

TEST(TileIndexVerb, APictureIsOldOnceATileHasChanged) {
    const Country country;
    std::ofstream(country.dir / "job.json")
        << R"({"format": 1, "dem": {"files": ["index.gpkg"]}, "picture": {"size": [64, 48]}, )"
           R"("time": {"at": "2026-06-21T10:00Z"}, "shots": [{}], "output": "p.png", )"
           R"("camera": {"orbit": {"azimuth": 180, "elevation": 35}}})";
    const auto resumed = [&] {
        return relevo({"run", (country.dir / "job.json").string(), "--resume"});
    };
    const Result first = resumed();
    ASSERT_EQ(first.status, 0) << first.err;
    EXPECT_THAT(resumed().err, HasSubstr("0 pictures in 0 s; 1 were there already"));
    Raster other;
    other.columns = other.rows = 32;
    other.geotransform = {{500000, 30, 0, 5200000, 0, -30}};
    write_raster(country.tiles[0], other);
    const Result changed = resumed();
    EXPECT_EQ(changed.status, 3);
    EXPECT_THAT(changed.err, HasSubstr((country.dir / "p.png").string() + ": the DEM has changed"));
}

TEST(TileIndexVerb, WhatIsNoIndexHasItsMessage) {
    const std::filesystem::path dir = scratch_dir("no_index");
    IndexLayer layer;
    layer.field = "file";
    const std::string path = write_index(dir / "polygons.gpkg", "GPKG",
                                         {{"a.tif", {500000, 5199000, 501000, 5200000}}}, layer);
    expect_failure({"info", path}, 3,
                   path +
                       ": polygons without a field \"location\", which an index of tiles has; "
                       "their fields are file");
    const std::string gone =
        write_index(dir / "gone.gpkg", "GPKG", {{"a.tif", {500000, 5199000, 501000, 5200000}}});
    expect_failure({"capture", gone, "-o", (dir / "p.png").string()}, 3,
                   gone + ": none of its 1 tiles is there, the first is " +
                       (dir / "a.tif").string() +
                       "; \"location\" counts from the folder of the index");
    EXPECT_FALSE(std::filesystem::exists(dir / "p.png"));
}

TEST(TileIndexVerb, TilesOfAnIndexThatNeedsACrsAreStampedAndProtected) {
    const Country country;
    std::vector<IndexRow> rows;
    for (const std::string& tile : country.tiles)
        rows.push_back(row_of(tile));
    IndexLayer degrees;
    degrees.crs = "EPSG:4326";  // of metres
    const std::string index = write_index(country.dir / "wrong.gpkg", "GPKG", rows, degrees);
    const std::vector<std::string> words{"sun", "sky-view", index, "--crs", "EPSG:32632", "-o"};
    const auto with = [&](const std::vector<std::string>& more) {
        std::vector<std::string> all = words;
        all.insert(all.end(), more.begin(), more.end());
        return relevo(all);
    };
    const Result replaced = with({country.tiles[3], "--overwrite"});
    EXPECT_EQ(replaced.status, 3);
    EXPECT_THAT(replaced.err, HasSubstr(country.tiles[3] + ": is a file that the DEM is read"));
    // The tiles that are made are those of the index, with its --crs, too.
    const std::string folder = (country.dir / "out").string();
    const auto stamp = [&] {
        return nlohmann::json::parse(read_text(folder + "/plan.json", "test"))["dem"]["stamp"];
    };
    const Result first = with({folder, "--tiles", index, "--directions", "4"});
    ASSERT_EQ(first.status, 0) << first.err;
    EXPECT_TRUE(std::filesystem::exists(folder + "/t8.tif"));
    const auto before = stamp();
    std::filesystem::last_write_time(country.tiles[8], {});
    const Result second = with({folder, "--tiles", index, "--directions", "4", "--overwrite"});
    ASSERT_EQ(second.status, 0) << second.err;
    EXPECT_NE(stamp(), before);
}

TEST(TileIndexVerb, AResultDoesNotReplaceATile) {
    const Country country;
    const Result run = relevo({"sun", "hours", country.index, "--date", "2026-06-21", "-o",
                               country.tiles[3], "--overwrite"});
    EXPECT_EQ(run.status, 3);
    EXPECT_THAT(run.err, HasSubstr(country.tiles[3] + ": is a file that the DEM is read from, "));
}

}  // namespace
}  // namespace relevo::test::test_tile_index
