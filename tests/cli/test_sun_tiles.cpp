#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <nlohmann/json.hpp>

#include "base/output_file.h"
#include "base/text.h"
#include "cli/hills.h"
#include "cli/program.h"
#include "cli/raster.h"
#include "dem/fixture.h"
#include "support/support.h"

/// Rasters of the sun as tiles in a folder, by one process or several.
namespace relevo::test::test_sun_tiles {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

Words joined(Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

/// The values of a raster's bands, one after the other.
std::vector<float> values_of(const std::string& path) {
    const Dataset dataset = opened(path);
    EXPECT_TRUE(dataset) << path;
    if (!dataset) return {};
    const int columns = dataset->GetRasterXSize(), rows = dataset->GetRasterYSize();
    const auto size = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    std::vector<float> values(size * static_cast<std::size_t>(dataset->GetRasterCount()));
    for (int band = 1; band <= dataset->GetRasterCount(); ++band)
        EXPECT_EQ(dataset->GetRasterBand(band)->RasterIO(
                      GF_Read, 0, 0, columns, rows,
                      values.data() + size * static_cast<std::size_t>(band - 1), columns, rows,
                      GDT_Float32, 0, 0),
                  CE_None);
    return values;
}

bool are_same(const std::vector<float>& a, const std::vector<float>& b) {
    return !a.empty() && a.size() == b.size() &&
           std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

/// Names and contents of a folder's tiles.
std::map<std::string, std::string> tiles_in(const fs::path& folder) {
    std::map<std::string, std::string> tiles;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().filename().string().starts_with("r0"))
            tiles[entry.path().filename()] = read_text(entry.path(), "test");
    return tiles;
}

/// Makes the tiles of a command in so many processes, one after the other.
void make_tiles(const Words& command, const fs::path& folder, int side, int shards) {
    for (int shard = 1; shard <= shards; ++shard) {
        const Result run = relevo(joined(joined({"-q", "sun"}, command),
                                         {"--tiles", std::to_string(side), "-o", folder.string(),
                                          "--shard", fmt::format("{}/{}", shard, shards)}));
        ASSERT_EQ(run.status, 0) << run.err;
    }
}

std::string merged(const fs::path& folder) {
    const std::string vrt = (folder / "all.vrt").string();
    const Result run = relevo({"-q", "merge", folder.string(), "-o", vrt, "--overwrite"});
    EXPECT_EQ(run.status, 0) << run.err;
    return vrt;
}

/// Tiles of a command over a DEM, of so many processes each time, against the raster in one piece.
void expect_tiles_equal_the_whole(const Words& command, int side, std::size_t count = 16,
                                  const std::vector<int>& processes = {3}) {
    const fs::path where = scratch_dir("tiles");
    const std::string whole = (where / "whole.tif").string();
    const Result run = relevo(joined(joined({"-q", "sun"}, command), {"-o", whole}));
    ASSERT_EQ(run.status, 0) << run.err;
    const std::vector<float> expected = values_of(whole);
    std::map<std::string, std::string> first;
    for (const int shards : processes) {
        const fs::path folder = where / fmt::format("in {}", shards);
        make_tiles(command, folder, side, shards);
        const auto tiles = tiles_in(folder);
        EXPECT_EQ(tiles.size(), count);
        EXPECT_TRUE(are_same(values_of(merged(folder)), expected)) << shards << " processes";
        if (first.empty()) first = tiles;
        EXPECT_TRUE(tiles == first) << shards << " processes";
    }
}

const Words kUtc{"--tz", "UTC"};
constexpr int kQuarter = 101;  // of 403 x 344 posts

TEST(SunTiles, HoursOfADayAreThoseOfTheWhole) {
    const auto hours = [](const char* date) {
        return joined({"hours", bundled_dem(), "--date", date, "--step", "20"}, kUtc);
    };
    expect_tiles_equal_the_whole(hours("2026-06-21"), kQuarter, 16, {1, 7});
    expect_tiles_equal_the_whole(hours("2026-12-21"), kQuarter);
}

TEST(SunTiles, HoursOfManyDaysAreThoseOfTheWhole) {
    expect_tiles_equal_the_whole(joined({"hours", bundled_dem(), "--from", "2026-11-01", "--to",
                                         "2027-02-08", "--bands", "hours,global"},
                                        kUtc),
                                 kQuarter);
}

TEST(SunTiles, ShadowsOfALowSunAreThoseOfTheWhole) {
    expect_tiles_equal_the_whole({"shadow", bundled_dem(), "--sun", "123,1.2", "--soft"}, kQuarter);
}

TEST(SunTiles, TheSkyViewIsThatOfTheWhole) {
    expect_tiles_equal_the_whole({"sky-view", bundled_dem(), "--directions", "12"}, kQuarter);
}

TEST(SunTiles, HorizonsAreThoseOfTheWhole) {
    expect_tiles_equal_the_whole({"horizons", bundled_dem(), "--directions", "3"}, kQuarter);
}

TEST(SunTiles, OfADemBeyondMemoryAreThoseOfTheWhole) {
    const std::string hills = write_hills(scratch_dir("dem") / "hills.tif",
                                          [](int column, int row) { return column + row < 200; });
    expect_tiles_equal_the_whole(joined({"hours", hills, "--memory", "1", "--date", "2026-12-21",
                                         "--step", "20", "--bands", "hours,first"},
                                        kUtc),
                                 176, 12);
    expect_tiles_equal_the_whole({"shadow", hills, "--memory", "1", "--sun", "260,-0.2"}, 176, 12,
                                 {1, 7});
    expect_tiles_equal_the_whole({"sky-view", hills, "--memory", "1", "--directions", "8"}, 176,
                                 12);
}

TEST(SunTiles, ATaskReadsOnlyGroundThatCanShade) {
    // The first task finds what all posts are; the others know it. So a file whose far rows have
    // been spoilt since is read without complaint, and named where it is needed.
    const fs::path where = scratch_dir("spoilt");
    Raster raster;
    raster.columns = 300;
    raster.rows = 4000;
    raster.options = {"COMPRESS=DEFLATE", "TILED=NO", "BLOCKYSIZE=8"};
    raster.value = [](int column, int row, int) { return 20 + (column * 7 + row * 13) % 10; };
    const std::string dem = write_raster(where / "long.tif", raster);
    const auto run = [&](int shard, const fs::path& folder) {
        return relevo({"-q", "sun", "shadow", dem, "--sun", "90,20", "--memory", "1", "--tiles",
                       "500", "-o", folder.string(), "--shard", fmt::format("{}/8", shard)});
    };
    const fs::path folder = where / "out";
    ASSERT_EQ(run(1, folder).status, 0);
    const auto time = fs::last_write_time(dem);
    const std::string bytes = read_text(dem, "test");
    // The last rows are at the end of the file.
    std::string spoilt = bytes;
    std::fill(spoilt.end() - 3000, spoilt.end(), '\x55');
    std::ofstream(dem, std::ios::binary) << spoilt;
    fs::last_write_time(dem, time);
    EXPECT_EQ(run(2, folder).status, 0);
    const Result last = run(8, folder);
    EXPECT_EQ(last.status, 3);
    EXPECT_NE(last.err.find("long.tif"), std::string::npos) << last.err;
}

/// Hills on a plain, in posts of 5 m: far ones are seen from everywhere.
std::string far_hills() {
    Raster raster;
    raster.columns = 1500;
    raster.rows = 1200;
    raster.geotransform = {{500000, 5, 0, 5300000, 0, -5}};
    raster.value = [](int column, int row, int) {
        const auto hill = [&](double x, double y, double up, double width) {
            const double dx = (column - x) / width, dy = (row - y) / width;
            return up * std::exp(-dx * dx - dy * dy);
        };
        return 400 + hill(150, 200, 500, 150) + hill(1350, 900, 600, 180) +
               hill(1300, 100, 400, 120) + hill(200, 1100, 450, 140) + hill(700, 1150, 300, 90) +
               40 * std::sin(column / 17.0) * std::sin(row / 23.0);
    };
    return write_raster(scratch_dir("dem") / "far.tif", raster);
}

/// How far values are off.
struct Off {
    double mean = 0;
    std::vector<double> sorted;

    Off(const std::string& name, std::vector<double> values) : sorted(std::move(values)) {
        std::ranges::sort(sorted);
        for (const double off : sorted)
            mean += off / static_cast<double>(sorted.size());
        fmt::print(
            "[ accuracy ] {} with far ground as means: mean {:.4f}, 99 % {:.3f}, 99.9 % "
            "{:.3f}, worst {:.3f}\n",
            name, mean, most_of_thousand(990), most_of_thousand(999), sorted.back());
    }
    double most_of_thousand(std::size_t share) const {
        return sorted[std::min(sorted.size() - 1, sorted.size() * share / 1000)];
    }
};

// The DEM is a folder of files that are called as the tiles are.
TEST(SunTiles, TheDemsOwnFilesAreNotReplaced) {
    const std::string folder = (scratch_dir() / "dem").string();
    fs::create_directories(folder);
    const std::string dem = folder + "/r0001_c0001.tif";
    fs::copy_file(bundled_dem(), dem);
    const Result run = relevo({"-q", "sun", "shadow", "--sun", "123,8", folder, "--tiles", "1000",
                               "-o", folder, "--overwrite"});
    EXPECT_EQ(run.status, 3) << run.err;
    EXPECT_NE(run.err.find("would be overwritten"), std::string::npos) << run.err;
    EXPECT_EQ(fs::file_size(dem), fs::file_size(bundled_dem()));
}

TEST(SunTiles, FarGroundAsMeansIsWithinItsBounds) {
    const std::string dem = far_hills();
    const fs::path where = scratch_dir("far");
    const Words window{"--clip", "503000,5296500,504500,5298000"};
    const auto apart = [&](const Words& command, const std::string& name) {
        const fs::path folder = where / name;
        const std::string whole = (where / (name + ".tif")).string();
        const Words all = joined(joined({"-q", "sun"}, command), joined({dem}, window));
        EXPECT_EQ(relevo(joined(all, {"-o", whole})).status, 0);
        const Result run = relevo(joined(
            all, {"-o", folder.string(), "--tiles", "300", "--halo", "1.5", "--memory", "64"}));
        EXPECT_EQ(run.status, 0) << run.err;
        const std::vector<float> expected = values_of(whole), found = values_of(merged(folder));
        EXPECT_EQ(found.size(), expected.size());
        std::vector<double> off;
        for (std::size_t i = 0; i < std::min(found.size(), expected.size()); ++i)
            off.push_back(std::abs(double{found[i]} - double{expected[i]}));
        return Off(name, std::move(off));
    };
    // A sweep over another grid differs, too, at single posts: 0.5 degrees and 3.5 minutes of a
    // day where this DEM begins some posts further on. Directions are within 0.1 degrees.
    const Off horizons = apart({"horizons", "--directions", "8"}, "horizons");
    EXPECT_LE(horizons.mean, 0.02);  // degrees
    EXPECT_LE(horizons.most_of_thousand(980), 0.1);
    EXPECT_GT(horizons.mean, 0);
    for (const char* date : {"2026-06-21", "2026-12-21"})
        EXPECT_LE(apart(joined({"hours", "--date", date, "--step", "10"}, kUtc), date)
                      .most_of_thousand(995),
                  3 / 60.0);
    EXPECT_LE(apart(joined({"hours", "--from", "2026-11-01", "--to", "2027-02-08"}, kUtc), "days")
                  .most_of_thousand(999),
              100 * 3 / 60.0);
    EXPECT_LE(apart({"sky-view"}, "sky").most_of_thousand(1000), 0.003);
    EXPECT_LE(apart({"shadow", "--sun", "123,6"}, "shadow").mean, 0.001);
    const Dataset tile = opened((where / "sky/r0002_c0003.tif").string());
    ASSERT_TRUE(tile);
    EXPECT_EQ(tile->GetMetadataItem("FAR_GROUND"),
              std::string("ground beyond 1.5 km of a tile is means of 2 x 2 posts"));
}

/// The tiles of a shadow, of which most tests need no more.
const Words kShadow{"shadow", "--sun", "123,8"};
Words shadow_of(const std::string& dem) {
    return joined(kShadow, {dem});
}
Words in_tiles(const Words& command, const fs::path& folder, const Words& more = {}) {
    return joined(joined(joined({"-q", "sun"}, command),
                         {"--tiles", std::to_string(kQuarter), "-o", folder.string()}),
                  more);
}

// A task that was requeued, and the one before it, which still runs.
TEST(SunTiles, TwoProcessesThatMakeTheSameTilesBothEndWell) {
    const fs::path folder = scratch_dir("two");
    const Words words = in_tiles(shadow_of(bundled_dem()), folder, {"--resume"});
    const Words line = joined({"-c", "\"$0\" \"$@\" & \"$0\" \"$@\"; one=$?; wait $! && exit $one",
                               (build_dir() / "bin/relevo").string()},
                              words);
    const Result both = run("/bin/sh", line);
    EXPECT_EQ(both.status, 0) << both.err;
    EXPECT_EQ(tiles_in(folder).size(), 16u);
    merged(folder);
}

TEST(SunTiles, WhatIsThereIsKeptAndWhatIsMissingIsMade) {
    const fs::path folder = scratch_dir("out");
    const Words command = shadow_of(bundled_dem());
    ASSERT_EQ(relevo(in_tiles(command, folder)).status, 0);
    const auto whole = tiles_in(folder);
    ASSERT_EQ(whole.size(), 16u);
    const fs::path gone = folder / "r0002_c0003.tif", cut = folder / "r0003_c0001.tif";
    fs::remove(gone);
    fs::resize_file(cut, fs::file_size(cut) / 2);
    const auto kept = fs::last_write_time(folder / "r0001_c0001.tif");
    const Result merge =
        relevo({"-q", "merge", folder.string(), "-o", (folder / "a.vrt").string()});
    EXPECT_EQ(merge.status, 1);
    EXPECT_NE(merge.err.find("r0002_c0003.tif: is missing"), std::string::npos) << merge.err;
    EXPECT_NE(merge.err.find("r0003_c0001.tif: cannot be read"), std::string::npos) << merge.err;
    EXPECT_NE(merge.err.find("merge: 2 of 16 tiles are missing or not whole"), std::string::npos)
        << merge.err;
    EXPECT_FALSE(fs::exists(folder / "a.vrt"));
    ASSERT_EQ(relevo(in_tiles(command, folder, {"--resume"})).status, 0);
    EXPECT_TRUE(tiles_in(folder) == whole);
    EXPECT_EQ(fs::last_write_time(folder / "r0001_c0001.tif"), kept);
    EXPECT_EQ(relevo({"-q", "merge", folder.string()}).status, 0);
}

TEST(SunTiles, NothingIsReplacedUnasked) {
    const fs::path folder = scratch_dir("out");
    const Words command = shadow_of(bundled_dem());
    ASSERT_EQ(relevo(in_tiles(command, folder)).status, 0);
    const auto error = [](const Result& run, int status) {
        EXPECT_EQ(run.status, status);
        return run.err;
    };
    const std::string first = printable((folder / "r0001_c0001.tif").string());
    EXPECT_EQ(error(relevo(in_tiles(command, folder)), 3),
              fmt::format("relevo: error: -o: {}: exists; pass --overwrite to replace it, or "
                          "--resume to make what is missing\n",
                          first));
    EXPECT_EQ(error(relevo(in_tiles({"sky-view", bundled_dem()}, folder, {"--resume"})), 3),
              fmt::format("relevo: error: -o: {}: is of another command, sun shadow --sun=123,8 "
                          "--tiles=101; use another folder, or --overwrite\n",
                          printable((folder / "plan.json").string())));
    // A tile of another command among those of this one.
    const fs::path other = scratch_dir("other");
    ASSERT_EQ(relevo(in_tiles({"shadow", bundled_dem(), "--sun", "9,8"}, other)).status, 0);
    fs::copy_file(other / "r0001_c0001.tif", folder / "r0001_c0001.tif",
                  fs::copy_options::overwrite_existing);
    EXPECT_EQ(error(relevo(in_tiles(command, folder, {"--resume"})), 3),
              fmt::format("relevo: error: -o: {}: is of another command, sun shadow --sun=9,8 "
                          "--tiles=101; pass --overwrite to replace it\n",
                          first));
    EXPECT_NE(error(relevo({"-q", "merge", folder.string()}), 1)
                  .find(first + ": is of another command, sun shadow --sun=9,8"),
              std::string::npos);
    EXPECT_EQ(error(relevo({"sun", "shadow", bundled_dem(), "--sun", "1,8", "-o",
                            (folder / "x.tif").string(), "--resume"}),
                    2),
              "relevo: error: --resume: needs --tiles\n");
    EXPECT_EQ(error(relevo({"-q", "merge", scratch_dir("empty").string()}), 3),
              fmt::format("relevo: error: merge: {}: has no plan.json; expected a folder that "
                          "--tiles has made\n",
                          printable(scratch_dir("empty").string())));
}

TEST(SunTiles, AChangedDemIsNoticed) {
    const fs::path where = scratch_dir("changed");
    const std::string dem = (where / "dem.tif").string();
    const auto write = [&](double step, double bump = 0) {
        Raster raster;
        raster.columns = raster.rows = 200;
        raster.value = [=](int column, int row, int) {
            return 100 + step * column + row + (column == 90 && row == 70 ? bump : 0);
        };
        write_raster(dem, raster);
    };
    write(1);
    const Words command = shadow_of(dem);
    const fs::path folder = where / "out";
    ASSERT_EQ(relevo(in_tiles(command, folder)).status, 0);
    write(1, 3);  // neither the lowest post nor the highest
    Result run = relevo(in_tiles(command, folder, {"--resume"}));
    EXPECT_EQ(run.status, 3);
    EXPECT_NE(run.err.find("is of another DEM"), std::string::npos) << run.err;
    write(2);
    run = relevo(in_tiles(command, folder, {"--resume"}));
    EXPECT_EQ(run.status, 3);
    EXPECT_NE(run.err.find("is of another DEM"), std::string::npos) << run.err;
}

TEST(SunTiles, TheMosaicHasTheGridOfTheWholeAndRelativeNames) {
    const fs::path folder = scratch_dir("out");
    ASSERT_EQ(relevo(in_tiles(shadow_of(bundled_dem()), folder)).status, 0);
    fs::remove(folder / "r0001_c0002.tif");
    const fs::path vrt = folder / "mosaic.vrt", stac = folder / "mosaic.json";
    const Result run = relevo({"-q", "merge", folder.string(), "-o", vrt.string(), "--stac",
                               stac.string(), "--allow-missing"});
    ASSERT_EQ(run.status, 0) << run.err;
    const std::string text = read_text(vrt, "test");
    EXPECT_NE(text.find("relativeToVRT=\"1\">r0001_c0001.tif<"), std::string::npos) << text;
    // The folder may go elsewhere.
    const fs::path moved = scratch_dir("moved") / "there";
    fs::rename(folder, moved);
    const Dataset whole = opened(bundled_dem()), mosaic = opened((moved / "mosaic.vrt").string());
    ASSERT_TRUE(mosaic);
    EXPECT_EQ(mosaic->GetRasterXSize(), whole->GetRasterXSize());
    EXPECT_EQ(mosaic->GetRasterYSize(), whole->GetRasterYSize());
    std::array<double, 6> expected{}, transform{};
    whole->GetGeoTransform(expected.data());
    mosaic->GetGeoTransform(transform.data());
    for (std::size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(transform[i], expected[i], 1e-9) << i;
    EXPECT_EQ(mosaic->GetRasterBand(1)->GetDescription(), std::string("direct sun"));
    const std::vector<float> values = values_of((moved / "mosaic.vrt").string());
    const auto at = [&](int column) { return values[static_cast<std::size_t>(column + 403 * 50)]; };
    EXPECT_NE(at(100), 255);
    EXPECT_EQ(at(101), 255);  // of the tile that is not there
    EXPECT_EQ(at(201), 255);
    EXPECT_NE(at(202), 255);
}

TEST(SunTiles, StacItemsSayWhereAndWhen) {
    const fs::path folder = scratch_dir("out");
    ASSERT_EQ(relevo(in_tiles({"hours", bundled_dem(), "--date", "2026-06-21", "--tz",
                               "America/New_York", "--step", "60"},
                              folder))
                  .status,
              0);
    const fs::path stac = scratch_dir("stac") / "items.json";
    ASSERT_EQ(relevo({"-q", "merge", folder.string(), "--stac", stac.string()}).status, 0);
    const auto json = nlohmann::json::parse(read_text(stac, "test"));
    ASSERT_EQ(json["features"].size(), 16u);
    const auto& item = json["features"][6];  // row 2, column 3
    EXPECT_EQ(item["id"], "r0002_c0003");
    EXPECT_EQ(item["stac_version"], "1.1.0");
    const auto& properties = item["properties"];
    EXPECT_EQ(properties["datetime"], nullptr);
    EXPECT_EQ(properties["start_datetime"], "2026-06-21T04:00:00Z");
    EXPECT_EQ(properties["end_datetime"], "2026-06-22T04:00:00Z");
    EXPECT_EQ(properties["proj:code"], "EPSG:4326");
    EXPECT_EQ(properties["proj:epsg"], 4326);
    EXPECT_EQ(properties["proj:shape"], nlohmann::json({101, 101}));
    const Dataset tile = opened((folder / "r0002_c0003.tif").string());
    std::array<double, 6> t{};
    tile->GetGeoTransform(t.data());
    const std::array<double, 6> transform = properties["proj:transform"];
    const std::array<double, 6> expected{t[1], t[2], t[0], t[4], t[5], t[3]};
    for (std::size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(transform[i], expected[i], 1e-9) << i;
    // RFC 7946: west, south, east, north; an outline counterclockwise.
    const std::array<double, 4> box = item["bbox"];
    EXPECT_NEAR(box[0], t[0], 1e-6);
    EXPECT_NEAR(box[1], t[3] + 101 * t[5], 1e-6);
    EXPECT_NEAR(box[2], t[0] + 101 * t[1], 1e-6);
    EXPECT_NEAR(box[3], t[3], 1e-6);
    const auto& ring = item["geometry"]["coordinates"][0];
    EXPECT_EQ(ring.front(), ring.back());
    double area = 0;
    for (std::size_t i = 0; i + 1 < ring.size(); ++i)
        area += ring[i][0].get<double>() * ring[i + 1][1].get<double>() -
                ring[i + 1][0].get<double>() * ring[i][1].get<double>();
    EXPECT_GT(area, 0);
    const auto& asset = item["assets"]["data"];
    EXPECT_EQ(asset["roles"], nlohmann::json({"data"}));
    EXPECT_EQ(asset["bands"][0]["name"], "sun hours");
    EXPECT_TRUE(fs::exists(stac.parent_path() / asset["href"].get<std::string>()));
    // GDAL's own reader of such collections, which in version 3.6 knows no relative names.
    ASSERT_EQ(relevo({"-q", "merge", folder.string(), "--stac", stac.string(), "--overwrite",
                      "--href-base", folder.string()})
                  .status,
              0);
    const Dataset mosaic = opened("STACIT:\"" + stac.string() + "\"");
    ASSERT_TRUE(mosaic);
    EXPECT_EQ(mosaic->GetRasterXSize(), 403);
    EXPECT_EQ(mosaic->GetRasterYSize(), 344);
}

}  // namespace
}  // namespace relevo::test::test_sun_tiles
