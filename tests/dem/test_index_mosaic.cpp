#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <malloc.h>

#include "base/log.h"
#include "dem/fixture.h"
#include "dem/index_fixture.h"
#include "dem/load.h"
#include "dem/window_index.h"
#include "support/support.h"

namespace relevo::dem::test_index_mosaic {
namespace {

using test::error_of;
using test::folder;
using test::IndexLayer;
using test::IndexRow;
using test::Raster;
using test::row_of;
using test::write_index;
using test::write_raster;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;
using Paths = std::vector<std::string>;

double rough_m(int column, int row) {
    return 400 + (column * 37 + row * 91) % 211 + 0.37 * column;
}

/// A tile of rough ground by its first column and row, with a void here and there.
Raster tile(int column, int row, int columns, int rows, double more_m = 0) {
    Raster raster;
    raster.columns = columns;
    raster.rows = rows;
    raster.nodata = -1;
    raster.geotransform = {{500000 + 30.0 * column, 30, 0, 5200000 - 30.0 * row, 0, -30}};
    raster.value = [=](int c, int r, int) {
        return (c * 5 + r * 3) % 17 == 0 ? -1.0 : rough_m(column + c, row + r) + more_m;
    };
    return raster;
}

/// Tiles that meet, and two that lie over others.
Paths tiles() {
    Paths paths;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            paths.push_back(write_raster(folder() / fmt::format("t{}_{}.tif", column, row),
                                         tile(25 * column, 20 * row, 25, 20)));
    paths.push_back(write_raster(folder() / "over.tif", tile(15, 10, 30, 25, 1000)));
    paths.push_back(write_raster(folder() / "over_that.tif", tile(40, 20, 9, 9, 2000)));
    return paths;
}

std::vector<IndexRow> rows_of(const Paths& paths) {
    std::vector<IndexRow> rows;
    for (const std::string& path : paths)
        rows.push_back(row_of(path));
    return rows;
}

std::string index_of(const Paths& paths, const std::string& name = "index.gpkg") {
    return write_index(folder() / name, "GPKG", rows_of(paths));
}

/// Expects the same bits in windows of all kinds, as stored and as means.
void expect_same(const Source& a, const Source& b, unsigned seed = 1) {
    ASSERT_EQ(a.grid().columns(), b.grid().columns());
    ASSERT_EQ(a.grid().rows(), b.grid().rows());
    ASSERT_EQ(a.grid().affine(), b.grid().affine());
    std::mt19937 random(seed);
    const auto number = [&](int low, int high) {
        return std::uniform_int_distribution<int>(low, high)(random);
    };
    for (int i = 0; i < 60; ++i) {
        Window w{0, 0, a.grid().columns(), a.grid().rows()};
        if (i > 3) {
            w.column = number(0, w.columns - 1);
            w.row = number(0, w.rows - 1);
            w.columns = number(1, w.columns - w.column);
            w.rows = number(1, w.rows - w.row);
        }
        const int columns = i % 2 == 0 ? w.columns : number(1, w.columns);
        const int rows = i % 2 == 0 ? w.rows : number(1, w.rows);
        const Array2d<float> from_a = a.read(w, columns, rows), from_b = b.read(w, columns, rows);
        ASSERT_EQ(std::memcmp(from_a.data(), from_b.data(), from_a.size() * sizeof(float)), 0)
            << fmt::format("{},{} {} x {} as {} x {}", w.column, w.row, w.columns, w.rows, columns,
                           rows);
    }
}

/// The box in another CRS around the corners of one.
std::array<double, 4> box_in(const std::array<double, 4>& box, const geo::Crs& from,
                             const geo::Crs& to) {
    std::array<double, 4> around = {1e9, 1e9, -1e9, -1e9};
    for (const double x : {box[0], box[2]})
        for (const double y : {box[1], box[3]}) {
            const glm::dvec2 at = to.from_geodetic(from.to_geodetic(x, y));
            around = {std::min(around[0], at.x), std::min(around[1], at.y),
                      std::max(around[2], at.x), std::max(around[3], at.y)};
        }
    return around;
}

TEST(WindowIndex, FindsWhatALoopFinds) {
    std::mt19937 random(7);
    const auto number = [&](int low, int high) {
        return std::uniform_int_distribution<int>(low, high)(random);
    };
    for (int round = 0; round < 20; ++round) {
        std::vector<Window> windows;
        for (int i = number(1, 300); i > 0; --i)
            windows.push_back({number(-500, 5000), number(-50, 900), number(1, i % 50 ? 60 : 6000),
                               number(1, 60)});
        const WindowIndex index(windows);
        for (int k = 0; k < 50; ++k) {
            const Window asked{number(-900, 6000), number(-90, 1000), number(1, 900),
                               number(1, 90)};
            std::vector<int> expected;
            for (std::size_t i = 0; i < windows.size(); ++i)
                if (!common(windows[i], asked).is_empty()) expected.push_back(static_cast<int>(i));
            ASSERT_EQ(index.within(asked), expected);
        }
    }
    EXPECT_THAT(WindowIndex().within({0, 0, 9, 9}), IsEmpty());
}

TEST(IndexMosaic, IsTheMosaicOfItsTilesBitForBit) {
    const Paths paths = tiles();
    expect_same(Source::open(index_of(paths)), Source::open(paths));
    // Also cropped, and in another order.
    LoadOptions options;
    options.crop = "9.002,46.942,9.03,46.95";
    expect_same(Source::open(index_of(paths), options), Source::open(paths, options), 2);
    const Paths reversed(paths.rbegin(), paths.rend());
    expect_same(Source::open(index_of(reversed, "reversed.gpkg")), Source::open(reversed), 3);
}

TEST(IndexMosaic, TilesOfAnotherZoneAndSpacingAreWarpedAsInAListOfFiles) {
    Paths paths = tiles();
    Raster coarse = tile(0, 0, 20, 12);
    coarse.geotransform = {{503000, 47, 0, 5199000, 0, -47}};
    paths.push_back(write_raster(folder() / "coarse.tif", coarse));
    Raster zone33 = tile(0, 0, 40, 30);
    zone33.crs = "EPSG:32633";
    zone33.geotransform = {{46500, 30, 0, 5217500, 0, -30}};
    paths.push_back(write_raster(folder() / "zone33.tif", zone33));
    std::vector<IndexRow> rows = rows_of(paths);
    rows.back().crs = "EPSG:32633";
    rows.back().extent = box_in(rows.back().extent, geo::Crs::parse("EPSG:32633", "test"),
                                geo::Crs::parse("EPSG:32632", "test"));
    const Source index = Source::open(write_index(folder() / "i.gpkg", "GPKG", rows));
    const Source files = Source::open(paths);
    // The outline of the tile in the other zone is a post wider.
    const glm::dvec2 shift = files.grid().affine().inverse(index.grid().affine()(0, 0));
    const Window all{0, 0, files.grid().columns(), files.grid().rows()};
    const Window same{static_cast<int>(std::lround(-shift.x)),
                      static_cast<int>(std::lround(-shift.y)), all.columns, all.rows};
    const Array2d<float> a = files.read(all, all.columns, all.rows);
    const Array2d<float> b = index.read(same, all.columns, all.rows);
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)), 0);
    EXPECT_THAT(index.tiles().differing.first,
                ElementsAre("coarse (cells of 47 x 47)", "zone33 (CRS EPSG:32633)"));
}

TEST(IndexMosaic, AStacCollectionIsTheMosaicOfItsTiles) {
    Paths paths = tiles();
    std::string items;
    for (const std::string& path : paths) {
        const std::array<double, 4> e = row_of(path).extent;
        items += fmt::format(
            R"({}{{"type": "Feature", "stac_version": "1.1.0", "id": "x", "properties": {{"proj:code": "EPSG:32632", "proj:shape": [{}, {}], "proj:transform": [30, 0, {}, 0, -30, {}]}}, "assets": {{"data": {{"href": "{}", "roles": ["data"]}}}}}})",
            items.empty() ? "" : ", ", (e[3] - e[1]) / 30, (e[2] - e[0]) / 30, e[0], e[3],
            std::filesystem::path(path).filename().string());
    }
    std::ofstream(folder() / "c.json")
        << R"({"type": "FeatureCollection", "features": [)" << items << "]}";
    expect_same(Source::open((folder() / "c.json").string()), Source::open(paths));
}

TEST(IndexMosaic, AnIndexInDegreesOfTilesInMetresIsThere) {
    const Paths paths = tiles();
    const Source files = Source::open(paths);
    std::vector<IndexRow> rows;
    const geo::Crs utm = geo::Crs::parse("EPSG:32632", "test");
    for (IndexRow row : rows_of(paths)) {
        row.extent = box_in(row.extent, utm, geo::Crs());
        rows.push_back(row);
    }
    IndexLayer degrees;
    degrees.crs = "EPSG:4326";
    const Source index = Source::open(write_index(folder() / "d.gpkg", "GPKG", rows, degrees));
    const glm::dvec2 shift = index.grid().affine().inverse(files.grid().affine()(0, 0));
    const Window all{0, 0, files.grid().columns(), files.grid().rows()};
    const Window same{static_cast<int>(std::lround(shift.x)),
                      static_cast<int>(std::lround(shift.y)), all.columns, all.rows};
    EXPECT_NEAR(shift.x, std::lround(shift.x), 1e-6);
    const Array2d<float> a = files.read(all, all.columns, all.rows);
    const Array2d<float> b = index.read(same, all.columns, all.rows);
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)), 0);
}

TEST(IndexMosaic, MissingAndBrokenTilesAreVoidsAndNamed) {
    Paths paths = tiles();
    const std::string index = index_of(paths);
    std::filesystem::remove(paths[5]);
    test::cut_short(paths[6], 30);
    std::filesystem::remove(paths[9]);
    std::filesystem::create_directory(paths[9]);
    std::filesystem::remove(paths[1]);
    std::ofstream(paths[1]).close();
    Paths left;
    for (std::size_t i = 0; i < paths.size(); ++i)
        if (i != 5 && i != 6 && i != 9 && i != 1) left.push_back(paths[i]);
    const Source source = Source::open(index);
    expect_same(source, Source::open(left));
    const TileReport report = source.tiles();
    EXPECT_EQ(report.tiles, 14);
    EXPECT_EQ(report.opened, 10);
    EXPECT_THAT(report.missing.first, ElementsAre("t1_1"));
    EXPECT_THAT(report.broken.first, ElementsAre(StartsWith("t1_0 (" + paths[1] + ": "),
                                                 StartsWith("t2_1 (" + paths[6] + ": "),
                                                 StartsWith("t1_2 (" + paths[9] + ": ")));
    std::vector<std::string> warned;
    log::set_sink([&](log::Level level, std::string_view text) {
        if (level == log::Level::Warning) warned.emplace_back(text);
    });
    const Heightfield field = load(source, MemoryBudget::of_posts(1 << 20));
    log::set_sink({});
    ASSERT_EQ(warned.size(), 2u);
    EXPECT_EQ(warned[0], index + ": 1 (t1_1) of 14 tiles are missing: their posts are voids");
    EXPECT_THAT(warned[1], StartsWith(index + ": 3 (t1_0 ("));
    EXPECT_GT(field.about.statistics.holes, 4 * 20 * 25 / 2);
    EXPECT_EQ(field.about.tiles.missing.count, 1);
}

TEST(IndexMosaic, OpensOneTileAndTheOthersWhereTheyAreRead) {
    const Paths paths = tiles();
    const std::string index = index_of(paths);
    const Source source = Source::open(index);
    EXPECT_EQ(source.tiles().opened, 1);
    EXPECT_EQ(source.description().files, Paths{index});
    EXPECT_EQ(source.description().path, index);
    source.read({80, 45, 5, 5}, 5, 5);
    EXPECT_EQ(source.tiles().opened, 2);
    source.read({0, 0, 100, 60}, 10, 6);
    EXPECT_EQ(source.tiles().opened, 14);
}

TEST(IndexMosaic, SeveralThreadsReadTheSame) {
    const Paths paths = tiles();
    const Source files = Source::open(paths);
    const Window all{0, 0, 100, 60};
    const Array2d<float> expected = files.read(all, 100, 60);
    for (int round = 0; round < 5; ++round) {
        const Source source = Source::open(index_of(paths, fmt::format("i{}.gpkg", round)));
        std::vector<int> wrong(6);
        std::vector<std::thread> threads;
        for (int& one : wrong)
            threads.emplace_back([&] {
                const Array2d<float> read = source.read(all, 100, 60);
                one = std::memcmp(read.data(), expected.data(), read.size() * sizeof(float)) != 0;
            });
        for (std::thread& thread : threads)
            thread.join();
        EXPECT_THAT(wrong, testing::Each(0));
    }
}

TEST(IndexMosaic, TilesUnlikeTheFirstAreReadAsTheySayAndNamed) {
    Paths paths{write_raster(folder() / "a.tif", tile(0, 0, 10, 8))};
    Raster feet = tile(10, 0, 10, 8);
    feet.unit = "ft";
    feet.nodata = -5;
    feet.value = [](int, int, int) { return 1000.0; };
    paths.push_back(write_raster(folder() / "b.tif", feet));
    const Source source = Source::open(index_of(paths));
    EXPECT_NEAR(source.read({15, 3, 1, 1}, 1, 1).at(0, 0), 304.8, 1e-3);
    EXPECT_THAT(source.tiles().differing.first, ElementsAre("b (heights in ft, nodata -5)"));
}

TEST(IndexMosaic, OverlappingTilesThatDisagreeAreNamed) {
    const Source source = Source::open(index_of(tiles()));
    EXPECT_EQ(source.tiles().stepped.count, 0);
    std::vector<std::string> said;
    log::set_sink([&](log::Level, std::string_view text) { said.emplace_back(text); });
    load(source, MemoryBudget::of_posts(1 << 20));
    log::set_sink({});
    EXPECT_THAT(said, testing::Contains(HasSubstr(
                          ": 2 (over (by up to 1000 m), over_that (by up to 2000 m)) of 14 tiles "
                          "differ in height from the tiles below; the later one is on top")));
}

TEST(IndexMosaic, ATileIsReadOnlyInsideOfItsOutline) {
    const Paths paths{write_raster(folder() / "a.tif", tile(0, 0, 20, 20)),
                      write_raster(folder() / "b.tif", tile(20, 0, 20, 20)),
                      write_raster(folder() / "c.tif", tile(40, 0, 20, 20))};
    std::vector<IndexRow> rows = rows_of(paths);
    rows[1].extent[2] -= 300;   // half of b
    rows[2].extent[1] -= 3000;  // c is said to be elsewhere
    rows[2].extent[3] -= 3000;
    const Source source = Source::open(write_index(folder() / "i.gpkg", "GPKG", rows));
    ASSERT_EQ(source.grid().columns(), 60);
    ASSERT_EQ(source.grid().rows(), 120);
    const Array2d<float> read = source.read({0, 0, 60, 20}, 60, 20);
    const Array2d<float> whole = Source::open(paths).read();
    for (int row = 0; row < 20; ++row)
        for (int column = 0; column < 60; ++column)
            if (column < 30)
                EXPECT_TRUE(read.at(column, row) == whole.at(column, row) ||
                            std::isnan(whole.at(column, row)));
            else
                EXPECT_TRUE(std::isnan(read.at(column, row))) << column << " " << row;
    const Array2d<float> means = source.read({0, 0, 60, 20}, 15, 5);  // 28 to 31 end at 30
    for (int row = 0; row < 5; ++row)
        for (int column = 0; column < 15; ++column) {
            double sum = 0, count = 0;
            for (int r = 4 * row; r < 4 * row + 4; ++r)
                for (int c = 4 * column; c < 4 * column + 4; ++c)
                    if (const float height = read.at(c, r); !std::isnan(height)) {
                        sum += height;
                        ++count;
                    }
            if (count >= 8)
                EXPECT_NEAR(means.at(column, row), sum / count, 1e-3) << column << " " << row;
            else
                EXPECT_TRUE(std::isnan(means.at(column, row))) << column << " " << row;
        }
    source.read({40, 100, 20, 20}, 20, 20);
    EXPECT_THAT(source.tiles().differing.first,
                ElementsAre("b (reaches beyond its outline in the index, where it is not read)",
                            "c (lies elsewhere than the index says, so it is a void)"));
}

// Whoever knows what the DEM's highest post is must not be left with less ground.
TEST(IndexMosaic, ATileThatGoesOnceAllHeightsAreKnownIsAnError) {
    const Paths paths = tiles();
    const std::string index = index_of(paths);
    const auto read_all = [](const Source& source) { source.read(); };
    {
        const Source source = Source::open(index);
        source.allow_voids(0);
        read_all(source);
    }
    std::filesystem::resize_file(paths[5], 100);
    std::filesystem::remove(paths[7]);
    const Source as_found = Source::open(index);
    Description about = as_found.description();
    about.statistics = statistics(as_found.read());
    report_heights(as_found, about, std::nullopt);
    EXPECT_EQ(about.tiles.missing.count + about.tiles.broken.count, 2);
    read_all(as_found);  // as it was
    for (const int voids : {0, 1}) {
        const Source source = Source::open(index);
        source.allow_voids(voids);
        EXPECT_THAT(error_of([&] { read_all(source); }), HasSubstr("can no longer be read, "));
    }
}

std::string refusal(const std::string& index) {
    const std::string message = error_of([&] { Source::open(index); });
    const std::string start = "exit 3: " + index + ": ";
    return message.starts_with(start) ? message.substr(start.size()) : message;
}

TEST(IndexMosaic, AnIndexOfNothingIsRefused) {
    const std::array<double, 4> at = {500000, 5199000, 501000, 5200000};
    const std::string gone =
        write_index(folder() / "gone.gpkg", "GPKG", {{"a.tif", at}, {"b.tif", at}});
    EXPECT_EQ(refusal(gone), "none of its 2 tiles is there, the first is " +
                                 (folder() / "a.tif").string() +
                                 "; \"location\" counts from the folder of the index");
    const std::string itself = write_index(folder() / "self.gpkg", "GPKG", {{"self.gpkg", at}});
    EXPECT_EQ(refusal(itself), "none of its tiles can be opened (1 of 1 tried): " + itself +
                                   ": the index itself, expected a raster");
    // Two that name each other.
    const std::string one = write_index(folder() / "one.gpkg", "GPKG", {{"two.gpkg", at}});
    const std::string two = write_index(folder() / "two.gpkg", "GPKG", {{"one.gpkg", at}});
    EXPECT_EQ(refusal(one), "none of its tiles can be opened (1 of 1 tried): " + two +
                                ": an index of tiles, expected a raster");
}

TEST(IndexMosaic, AnIndexOfOtherPlacesIsRefused) {
    const Paths paths{write_raster(folder() / "a.tif", tile(0, 0, 20, 20))};
    IndexLayer zone33;
    zone33.crs = "EPSG:32633";
    const std::string wrong = write_index(folder() / "wrong.gpkg", "GPKG", rows_of(paths), zone33);
    EXPECT_THAT(refusal(wrong), StartsWith("says that a is at "));
    EXPECT_THAT(refusal(wrong),
                HasSubstr("but its file is at 500000,5199400,500600,5200000 (WGS 84 "
                          "/ UTM zone 32N); the index is of other files, or names "
                          "a wrong CRS"));
    // Without a CRS, that of its tiles holds.
    IndexLayer none;
    none.crs = "";
    EXPECT_EQ(refusal(write_index(folder() / "none.gpkg", "GPKG", rows_of(paths), none)),
              "no error");
}

TEST(IndexMosaic, TilesOnTheNetAreOfNamesOnTheCommandLine) {
    const std::array<double, 4> at = {500000, 5199000, 501000, 5200000};
    const std::string index =
        write_index(folder() / "net.gpkg", "GPKG", {{"https://example.org/a.tif", at}});
    EXPECT_EQ(
        refusal(index),
        "its tiles are on the net ('/vsicurl/https://example.org/a.tif'), which is asked only "
        "by a name on the command line; name the index itself there (/vsicurl/https://...), "
        "or fetch the tiles and write their paths into \"location\"");
}

TEST(IndexMosaic, FilesBesideAnIndexAreJoinedWithItsTiles) {
    const Paths paths = tiles();
    const std::string beside = write_raster(folder() / "beside.tif", tile(100, 0, 30, 20));
    Paths all = paths;
    all.push_back(beside);
    const Paths named{index_of(paths), beside};
    const Source source = Source::open(named);
    expect_same(source, Source::open(all));
    EXPECT_EQ(source.description().files, named);
    EXPECT_EQ(source.description().assumptions.front(),
              "15 files are joined; where they overlap, the one named last is on top");
    LoadOptions options;
    options.bounds = Bounds{1, 2, 3, 4};
    EXPECT_EQ(error_of([&] { Source::open(named[0], options); }),
              "exit 2: --bounds: it says where one file is, but an index has its own");
}

/// Bytes that the process has taken from the heap.
std::size_t heap_bytes() {
    const struct mallinfo2 info = mallinfo2();
    return info.uordblks + info.hblkhd;
}

TEST(IndexMosaic, AHundredThousandTilesOpenInThreeSecondsAndLittleMemory) {
    constexpr int kSide = 316;
    const std::string first = write_raster(folder() / "t_0_0.tif", tile(0, 0, 10, 10));
    std::vector<IndexRow> rows;
    for (int row = 0; row < kSide; ++row)
        for (int column = 0; column < kSide; ++column) {
            const double west = 500000 + 300.0 * column, north = 5200000 - 300.0 * row;
            rows.push_back({fmt::format("a/folder/of/some/length/t_{}_{}.tif", column, row),
                            {west, north - 300, west + 300, north}});
        }
    rows.front().location = first;
    const std::string index = write_index(folder() / "i.gpkg", "GPKG", rows);
    using Clock = std::chrono::steady_clock;
    Source::open(first);  // GDAL and PROJ are loaded
    const std::size_t before = heap_bytes();
    const auto began = Clock::now();
    const Source source = Source::open(index);
    const double took_s = std::chrono::duration<double>(Clock::now() - began).count();
    const double each = double(heap_bytes() - before) / double(rows.size());
    fmt::print("[ measured ] {} tiles opened in {:.2f} s, {:.0f} bytes each\n", rows.size(), took_s,
               each);
    EXPECT_LT(took_s, 3);
    EXPECT_LT(each, 1024);
    EXPECT_EQ(source.tiles().opened, 1);
    EXPECT_EQ(source.grid().columns(), 10 * kSide);
    // A window costs what is in it.
    const auto read = Clock::now();
    for (int i = 0; i < 1000; ++i)
        source.read({3 * i, 3 * i, 20, 20}, 20, 20);
    EXPECT_LT(std::chrono::duration<double>(Clock::now() - read).count(), 3);
}

TEST(IndexMosaic, AFolderIsItsRastersWithoutTheirIndex) {
    const Paths paths = tiles();
    const Source before = Source::open(folder().string());
    index_of(paths);
    expect_same(Source::open(folder().string()), before);
}

TEST(IndexMosaic, OfSeveralFilesTheFirstErrorIsSaid) {
    Paths paths = tiles();
    for (const std::size_t i : {2, 7, 11})
        std::filesystem::remove(paths[i]);
    for (int round = 0; round < 10; ++round)
        EXPECT_THAT(error_of([&] { Source::open(paths); }), StartsWith("exit 3: " + paths[2]));
}

}  // namespace
}  // namespace relevo::dem::test_index_mosaic
