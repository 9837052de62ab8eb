#include <algorithm>
#include <filesystem>

#include "cli/program.h"
#include "image/image.h"
#include "support/support.h"

namespace relevo::test {
namespace {

TEST(NearGround, ChangesWithoutStepsFromPixelToPixel) {
    if (!std::filesystem::exists(source_dir() / "plugins/layering"))
        GTEST_SKIP() << "the plugin layering is not there";
    // 60 m above the ground, straight down, with nothing but its broad patches: a texture of 8 bits
    // that pushed them about made steps of up to 8 here.
    const std::filesystem::path picture = scratch_dir("near_ground") / "taken.png";
    const Result run = relevo({"-q",
                               "capture",
                               bundled_dem(),
                               "-o",
                               picture.string(),
                               "--size",
                               "240x160",
                               "--eye",
                               "36.30,-84.24,60agl",
                               "--heading",
                               "0",
                               "--pitch",
                               "-89",
                               "--only",
                               "layering",
                               "--set",
                               "layering.texture_m=100000",
                               "--set",
                               "layering.patch_m=1000000,5300,67000",
                               "--time",
                               "2026-06-21T12:00-05:00"});
    ASSERT_EQ(run.status, 0) << run.err;
    const image::Image8 taken = image::read(picture);
    int worst = 0;
    for (int y = 0; y < taken.height; ++y)
        for (int x = 3; x < 3 * taken.width; ++x)
            worst = std::max(worst, std::abs(taken.row(y)[x] - taken.row(y)[x - 3]));
    EXPECT_GT(worst, 0);  // there is something to see
    EXPECT_LE(worst, 3);
}

}  // namespace
}  // namespace relevo::test
