// Figures that are made part by part.
#include <cmath>
#include <filesystem>
#include <span>

#include <gtest/gtest.h>

#include "base/output_file.h"
#include "dem/fixture.h"
#include "figure/run.h"
#include "figure/shadow.h"
#include "overlay/band_over.h"
#include "sun/zone.h"
#include "support/support.h"

namespace relevo::session::test_raster_parts {
namespace {

TEST(SunRasterParts, AFileHasTheVoidsOfAllOfItsParts) {
    const auto is_void = [](int column, int row) {
        for (const auto& [x, y] : {std::pair{50, 50}, {500, 100}, {100, 500}})
            if (column >= x && column < x + 5 && row >= y && row < y + 5) return true;
        return false;
    };
    test::Raster raster;
    raster.columns = raster.rows = 600;
    raster.nodata = -9999;
    raster.value = [&](int column, int row, int) {
        return is_void(column, row) ? -9999.0 : 100 + 20 * std::sin(column * 0.1) + 0.1 * row;
    };
    const std::filesystem::path folder = test::scratch_dir("sun_raster");
    const std::string dem = test::write_raster(folder / "dem.tif", raster);
    const dem::Posts posts = dem::Posts::load(
        std::span(&dem, 1), {.memory = MemoryBudget::of_posts(std::int64_t{1} << 16)});
    ASSERT_FALSE(posts.in_memory());
    const std::filesystem::path written = folder / "mask.tif";
    OutputFile file(written, /*overwrite=*/true, "test");
    figure::Shadow mask;
    mask.suns = {figure::sun_over_middle(posts, sun::parse_time("2026-03-20T17:15:00Z").utc,
                                         mask.refraction)};
    figure::write_raster(file, mask, posts, MemoryBudget::of_posts(std::int64_t{1} << 16), "test");
    file.finish();
    EXPECT_EQ(overlay::band_metadata(written.string(), 1).at("HOLES"), "75");
}

TEST(SunRasterParts, AreWholeBlocksHoweverLittleMemoryThereIs) {
    EXPECT_EQ(figure::raster_parts({0, 0, 1300, 600}, 5000).size(), 6U);
}

TEST(SunRasterParts, HoldEachPostOnceWhateverTheShape) {
    for (const dem::Window& window :
         {dem::Window{0, 0, 2300, 200}, {7, 3, 100, 1500}, {5, 900, 513, 512}, {0, 0, 30, 20}})
        for (const std::int64_t most : {std::int64_t{300000}, std::int64_t{1100000}}) {
            Array2d<std::uint8_t> held(window.columns, window.rows);
            for (const dem::Window& part : figure::raster_parts(window, most)) {
                ASSERT_GE(part.column, window.column);
                ASSERT_GE(part.row, window.row);
                ASSERT_LE(part.column + part.columns, window.column + window.columns);
                ASSERT_LE(part.row + part.rows, window.row + window.rows);
                EXPECT_LE(std::int64_t{part.columns} * part.rows, most);
                for (int row = 0; row < part.rows; ++row)
                    for (int column = 0; column < part.columns; ++column)
                        ++held.at(part.column - window.column + column,
                                  part.row - window.row + row);
            }
            for (const std::uint8_t times : held)
                ASSERT_EQ(times, 1);
        }
}

}  // namespace
}  // namespace relevo::session::test_raster_parts
