#include <cmath>
#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "cli/program.h"
#include "cli/raster.h"
#include "dem/fixture.h"
#include "dem/index_fixture.h"
#include "support/support.h"

/// What plans say of tiles with --halo, and of a DEM of which most tiles are missing.
namespace relevo::test::test_plan_halo {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Words = std::vector<std::string>;

double hill_m(int column, int row) {
    return 500 + 300 * std::sin(column / 170.0) * std::cos(row / 130.0) + (column * 7 + row) % 11;
}

std::string wide_hills(const fs::path& where) {
    Raster raster;
    raster.columns = raster.rows = 1600;
    raster.options = {"COMPRESS=LZW"};
    raster.geotransform = {{500000, 5, 0, 5300000, 0, -5}};
    raster.value = [](int column, int row, int) { return hill_m(column, row); };
    return write_raster(where / "hills.tif", raster);
}

/// A number after some words.
double number_after(const std::string& words, const std::string& text) {
    std::smatch found;
    return std::regex_search(text, found, std::regex(words + " +(?:some )?([0-9.e+-]+)"))
               ? std::stod(found[1])
               : std::nan("");
}

Words hours_of(const std::string& dem, const fs::path& folder, const Words& more) {
    Words words{"sun",  "hours", dem,       "--from", "2026-06-01", "--to",         "2026-06-05",
                "--tz", "UTC",   "--tiles", "600",    "-o",         folder.string()};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

Words planned(Words words) {
    words.insert(words.begin(), "plan");
    return words;
}

TEST(PlanOfAHalo, MemoryIsNoLessThanATaskTakes) {
    const fs::path where = scratch_dir("memory");
    const std::string dem = wide_hills(where);
    for (const Words& memory : {Words{"--memory", "48"}, Words{"--memory", "200"}}) {
        Words more{"--halo", "2", "--clip", "503000,5295500,504500,5297000"};
        more.insert(more.end(), memory.begin(), memory.end());
        const fs::path folder = where / memory[1];
        const Result plan = relevo(planned(hours_of(dem, folder, more)));
        ASSERT_EQ(plan.status, 0) << plan.err;
        const Measured task = measured(hours_of(dem, folder, more));
        ASSERT_EQ(task.run.status, 0) << task.run.err;
        const double mib = number_after("memory", plan.out);
        fmt::print("[ memory   ] {} MiB: a task takes {} MiB, its plan says {}\n", memory[1],
                   task.peak_mib, mib);
        EXPECT_LE(task.peak_mib, mib);
        EXPECT_GE(task.peak_mib, 0.25 * mib);
    }
}

TEST(PlanOfAHalo, ATileThatDoesNotFitIntoMemoryWithItsHaloIsRefused) {
    const fs::path where = scratch_dir("room");
    const std::string dem = wide_hills(where);
    const Result run = relevo(hours_of(dem, where / "out", {"--halo", "5", "--memory", "16"}));
    EXPECT_EQ(run.status, 2);
    EXPECT_THAT(run.err, HasSubstr("relevo: error: --halo: 5: a tile with its halo has 1600 x 1600 "
                                   "posts, half of what --memory has room for is "));
    const double enough = number_after("or --memory", run.err);
    EXPECT_EQ(relevo(planned(hours_of(dem, where / "out",
                                      {"--halo", "5", "--memory", fmt::format("{}", enough)})))
                  .status,
              0);
    EXPECT_EQ(relevo(planned(hours_of(dem, where / "out",
                                      {"--halo", "5", "--memory", fmt::format("{}", enough - 2)})))
                  .status,
              2);
}

/// Of 8 x 8 tiles those at the north-western corner are there.
TEST(Plan, OfACountryOfWhichAFewTilesAreThereIsOfThese) {
    const fs::path where = scratch_dir("part");
    std::vector<IndexRow> rows;
    for (int i = 0; i < 64; ++i) {
        const int column = i % 8, row = i / 8;
        Raster raster;
        raster.columns = raster.rows = 200;
        raster.geotransform = {{500000 + 1000.0 * column, 5, 0, 5300000 - 1000.0 * row, 0, -5}};
        raster.value = [=](int c, int r, int) { return hill_m(200 * column + c, 200 * row + r); };
        const std::string path =
            write_raster(where / fmt::format("t{}_{}.tif", column, row), raster);
        rows.push_back(row_of(path));
    }
    const std::string index = write_index(where / "index.gpkg", "GPKG", rows);
    const auto hours = [&](const std::string& folder) {
        const Result plan = relevo({"plan", "sun", "hours", index, "--year", "2026", "--tiles",
                                    index, "-o", (where / folder).string()});
        EXPECT_EQ(plan.status, 0) << plan.err;
        EXPECT_THAT(plan.out,
                    HasSubstr("tiles               64 of " + index + ", 0 there already\n"));
        fmt::print("{}", plan.out);
        return std::pair(plan.out, number_after("computing", plan.out));
    };
    const double of_all = hours("all").second;
    for (int i = 0; i < 64; ++i)
        if (i % 8 > 2 || i / 8 > 2) fs::remove(rows[static_cast<std::size_t>(i)].location);
    const auto [text, of_some] = hours("some");
    EXPECT_THAT(text,
                HasSubstr("voids               55 of 64 tiles of the DEM are missing or broken\n"));
    // Not of voids, which take next to nothing; other programs may have had the processors.
    EXPECT_GT(of_some, of_all / 20);
}

}  // namespace
}  // namespace relevo::test::test_plan_halo
