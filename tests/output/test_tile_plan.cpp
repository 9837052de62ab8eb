#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "dem/fixture.h"
#include "output/tile_plan.h"
#include "support/support.h"

namespace relevo::output::test_tile_plan {
namespace {

namespace fs = std::filesystem;

dem::Grid grid(int columns, int rows) {
    return {columns, rows, dem::Affine{500000, 10, 0, 5200000, 0, -10},
            geo::Crs::parse("EPSG:32632", "test")};
}

TEST(TilePlan, TilesCoverAWindowOnceOnTheGridOfTheDem) {
    const dem::Grid dem = grid(1000, 700);
    const dem::Window window{130, 90, 500, 333};
    Array2d<int> covered(1000, 700, 0);
    std::set<std::string> names;
    for (const PlannedTile& tile : tiles_of(dem, window, 256)) {
        names.insert(tile.name);
        for (int row = tile.window.row; row < tile.window.end_row(); ++row)
            for (int column = tile.window.column; column < tile.window.end_column(); ++column) {
                ++covered.at(column, row);
                EXPECT_EQ(column / 256, tile.window.column / 256);
                EXPECT_EQ(row / 256, tile.window.row / 256);
            }
    }
    for (int row = 0; row < 700; ++row)
        for (int column = 0; column < 1000; ++column)
            ASSERT_EQ(covered.at(column, row), !common(window, {column, row, 1, 1}).is_empty());
    EXPECT_EQ(names,
              (std::set<std::string>{"r0001_c0001.tif", "r0001_c0002.tif", "r0001_c0003.tif",
                                     "r0002_c0001.tif", "r0002_c0002.tif", "r0002_c0003.tif"}));
    EXPECT_EQ(test::error_of([] {
                  tiles_of(grid(1 << 22, 1 << 22), {0, 0, 1 << 22, 1 << 22}, 64);
              }),
              "exit 3: --tiles: 64: makes 4294967296 tiles of a DEM of 4194304 x 4194304 posts; "
              "expected at most 10000000");
}

/// A row of an index, of 100 x 100 posts of grid() from a column and row on.
std::string index_row(const std::string& location, int column, int row) {
    const double west = 499995 + 10.0 * column, north = 5200005 - 10.0 * row;
    return fmt::format(
        R"({{"type": "Feature", "properties": {{"location": "{0}"}}, "geometry": {{"type": )"
        R"("Polygon", "coordinates": [[[{1}, {2}], [{3}, {2}], [{3}, {4}], [{1}, {4}], [{1}, {2}]]]}}}})",
        location, west, north, west + 1000, north - 1000);
}

// Districts that share a tile each have it in their own archive.
TEST(TilePlan, TilesOfAnIndexWithTheSamePostsAreMadeOnce) {
    const fs::path path = test::scratch_dir("index") / "index.geojson";
    std::ofstream(path)
        << R"({"type": "FeatureCollection", "crs": {"type": "name", "properties": {"name": )"
        << R"("urn:ogc:def:crs:EPSG::32632"}}, "features": [)" << index_row("one/a.tif", 0, 0)
        << ',' << index_row("two/a.tif", 0, 0) << ',' << index_row("two/b.tif", 100, 0) << ','
        << index_row("three/c.tif", 50, 0) << ',' << index_row("three/b.tif", 100, 0) << "]}";
    const std::vector<PlannedTile> expected{
        {"a.tif", {0, 0, 100, 100}}, {"b.tif", {100, 0, 100, 100}}, {"c.tif", {50, 0, 100, 100}}};
    EXPECT_EQ(tiles_of_index(grid(1000, 700), {0, 0, 1000, 700}, path.string()), expected);
}

TEST(TilePlan, SharesAreContiguousAndDifferByOneAtMost) {
    for (const std::size_t count : {0u, 1u, 16u, 17u, 1000u})
        for (const std::size_t shares : {1u, 2u, 7u, 20u}) {
            std::size_t next = 0, least = count, most = 0;
            for (std::size_t k = 1; k <= shares; ++k) {
                const auto [first, end] = share_of(count, k, shares);
                EXPECT_EQ(first, next);
                next = end;
                least = std::min(least, end - first), most = std::max(most, end - first);
            }
            EXPECT_EQ(next, count);
            EXPECT_LE(most - least, 1u);
        }
}

TEST(TilePlan, IsReadAsItWasWritten) {
    const fs::path folder = test::scratch_dir("out");
    EXPECT_FALSE(read_plan(folder));
    const TilePlan plan{.command = "sun hours --date=2026-06-21",
                        .digest = "d1",
                        .dems = {"a \"b\".tif"},
                        .grid = grid(1000, 700),
                        .statistics = {.min_m = 12.3F,
                                       .max_m = 4567.89F,
                                       .valid = 699'000,
                                       .holes = 1000,
                                       .outliers = 2},
                        .stamp = "s",
                        .tiles = tiles_of(grid(1000, 700), {0, 0, 1000, 700}, 300)};
    write_plan(folder, plan);
    const auto read = read_plan(folder);
    ASSERT_TRUE(read);
    EXPECT_EQ(read->command, plan.command);
    EXPECT_EQ(read->digest, plan.digest);
    EXPECT_EQ(read->dems, plan.dems);
    EXPECT_EQ(read->grid.affine(), plan.grid.affine());
    EXPECT_EQ(read->grid.crs().code(), "EPSG:32632");
    EXPECT_EQ(read->statistics, plan.statistics);
    EXPECT_EQ(read->tiles, plan.tiles);
    std::ofstream(folder / kPlanFile) << "{}";
    EXPECT_NE(test::error_of([&] { read_plan(folder); }).find("is no plan of relevo"),
              std::string::npos);
    std::ofstream(folder / kPlanFile) << "{\"relevo_plan\": 1, \"command\": 3}";
    EXPECT_NE(test::error_of([&] { read_plan(folder); }).find("is damaged"), std::string::npos);
}

TEST(TilePlan, NumbersThatNoPlanHasAreDamage) {
    const fs::path folder = test::scratch_dir();
    const auto message = [&](const std::string& columns, const std::string& window) {
        std::ofstream(folder / kPlanFile) << fmt::format(
            R"({{"relevo_plan": 1, "command": "c", "digest": "d", "dem": {{"files": ["a.tif"],
                "size": [{}, 20], "geotransform": [500000, 10, 0, 5200000, 0, -10],
                "crs": "EPSG:32632", "lowest_m": 1, "highest_m": 2, "posts_with_height": 200,
                "voids": 0, "outliers": 0, "content": "ff", "tiles": 0,
                "missing": {{"count": 0, "first": []}}, "broken": {{"count": 0, "first": []}},
                "stamp": "s"}}, "tiles": [["r0001_c0001.tif", {}]]}})",
            columns, window);
        return test::error_of([&] { read_plan(folder); });
    };
    const std::string damaged = "exit 3: plan: " + (folder / kPlanFile).string() +
                                ": is damaged; remove it, and plan again";
    EXPECT_EQ(message("10", "[0, 0, 10, 20]"), "no error");
    for (const char* const columns : {"0", "-1", "1e300", "4294967306", "18446744073709551615"})
        EXPECT_EQ(message(columns, "[0, 0, 10, 20]"), damaged) << columns;
    for (const char* const window : {"[0, 0, 11, 20]", "[-1, 0, 10, 20]", "[0, 19, 10, 2]",
                                     "[0, 0, 0, 20]", "[2147483647, 0, 2147483647, 20]", "[0, 0]"})
        EXPECT_EQ(message("10", window), damaged) << window;
}

TEST(TilePlan, PostsThatAreKnownAreThoseOfTheDem) {
    test::Raster raster;
    raster.columns = 900;
    raster.rows = 1300;
    raster.nodata = -1;
    raster.value = [](int column, int row, int) {
        return column < 40 ? -1.0 : 100 + column * 0.25 + (row * 37) % 100;
    };
    const fs::path folder = test::scratch_dir("out");
    const std::string path = test::write_raster(folder / "dem.tif", raster);
    dem::LoadOptions options;
    options.memory = MemoryBudget::of_posts(1 << 18);
    const std::vector<std::string> paths{path};
    const dem::Posts read = dem::Posts::load(paths, options);
    write_posts_facts(folder, read);
    const TilePlan plan{.command = "",
                        .digest = "",
                        .dems = paths,
                        .grid = read.grid(),
                        .statistics = read.about().statistics,
                        .stamp = "",
                        .tiles = {}};
    const auto facts = read_posts_facts(folder, plan);
    ASSERT_TRUE(facts);
    const dem::Posts known = dem::Posts::load(paths, options, &*facts);
    EXPECT_EQ(known.about().statistics, read.about().statistics);
    EXPECT_EQ(known.thinning(), 3);
    for (int row = 0; row < 1300; row += 7)
        for (int column = 0; column < 900; column += 7) {
            const float a = known.thinned_m(column, row), b = read.thinned_m(column, row);
            ASSERT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << column << " " << row;
            ASSERT_EQ(known.is_outside(column, row), read.is_outside(column, row));
            EXPECT_GE(known.bound_m(column, column, row, row),
                      read.bound_m(column, column, row, row));
        }
    EXPECT_EQ(known.height_at(555.5, 1000.5), read.height_at(555.5, 1000.5));
    // Of another DEM.
    raster.rows = 2000;
    const std::vector<std::string> other{test::write_raster(folder / "other.tif", raster)};
    EXPECT_NE(test::error_of([&] {
                  dem::Posts::load(other, options, &*facts);
              }).find("is of another DEM"),
              std::string::npos);
}

}  // namespace
}  // namespace relevo::output::test_tile_plan
