// The same ground under the same sun looks the same however wide the DEM is.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cli/program.h"
#include "dem/fixture.h"
#include "image/image.h"
#include "support/support.h"

namespace relevo::test::test_wide_dem {
namespace {

/// Flat ground around 46 N, 10 E, seen from 2 km above its middle by a low sun.
image::Image8 seen_on(double width_deg, double height_deg, const std::filesystem::path& folder) {
    constexpr int kColumns = 241, kRows = 161;
    Raster raster;
    raster.columns = kColumns;
    raster.rows = kRows;
    raster.crs = "EPSG:4326";
    const double dx = width_deg / (kColumns - 1), dy = height_deg / (kRows - 1);
    raster.geotransform = {10 - (kColumns / 2.0) * dx, dx, 0, 46 + (kRows / 2.0) * dy, 0, -dy};
    raster.value = [](int, int, int) { return 100.0; };
    const std::string dem = write_raster(folder / "dem.tif", raster);
    const std::string picture = (folder / "a.png").string();
    const Result run = relevo({"-q", "capture", dem, "-o", picture, "--overwrite", "--size",
                               "32x24", "--eye", "46,10,2100", "--heading", "90", "--pitch", "-60",
                               "--time", "2026-03-21T06:00Z", "--only", ""});
    EXPECT_EQ(run.status, 0) << run.err;
    return image::read(picture);
}

TEST(WideDem, HasTheLightOfASmallOne) {
    const std::filesystem::path folder = scratch_dir("wide_dem");
    const image::Image8 small = seen_on(1, 1, folder);
    for (const auto& [width_deg, height_deg] : {std::pair(20, 20), {60, 40}}) {
        const image::Image8 wide = seen_on(width_deg, height_deg, folder);
        int worst = 0;
        for (int y = 0; y < small.height; ++y)
            for (int i = 0; i < 3 * small.width; ++i)
                worst = std::max(worst, std::abs(small.row(y)[i] - wide.row(y)[i]));
        EXPECT_LE(worst, 2) << width_deg;
    }
}

/// The country beyond the near edge ends the air before it: rays go no further, below the DEM.
TEST(WideDem, HasCountryBeforeItsNearEdge) {
    if (!std::filesystem::exists(source_dir() / "plugins/shafts"))
        GTEST_SKIP() << "the plugin shafts is not there";
    const std::filesystem::path folder = scratch_dir("near_edge");
    const auto take = [&](const char* word) {
        const Result run =
            relevo({"-q", "capture", (source_dir() / "data/dem/vancouver-island.tif").string(),
                    "-o", (folder / "a.png").string(), "--overwrite", "--size", "640x360",
                    "--exaggerate", "3.4", word, "shafts"});
        EXPECT_EQ(run.status, 0) << run.err;
        return image::read(folder / "a.png");
    };
    const image::Image8 with = take("--enable"), without = take("--disable");
    int worst = 0;
    for (int y = 300; y < with.height; ++y)
        for (int i = 0; i < 3 * with.width; ++i)
            worst = std::max(worst, std::abs(with.row(y)[i] - without.row(y)[i]));
    EXPECT_LE(worst, 12);  // 183 where the lower right corner was black
}

}  // namespace
}  // namespace relevo::test::test_wide_dem
