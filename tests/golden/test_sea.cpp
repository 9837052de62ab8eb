#include <cstdlib>
#include <filesystem>

#include "cli/program.h"
#include "image/image.h"
#include "support/support.h"

namespace relevo::test {
namespace {

TEST(SeaPicture, HasNoShadowsOfItsFloorAtNoon) {
    for (const char* plugin : {"layering", "sea", "vsm"})
        if (!std::filesystem::exists(source_dir() / "plugins" / plugin))
            GTEST_SKIP() << "the plugin " << plugin << " is not there";
    // Vancouver Island and 1400 m of sea beside it, the sun 64 degrees high on gentle land.
    const std::filesystem::path dir = scratch_dir("sea");
    const auto take = [&](const char* name, const char* only) {
        const Result run =
            relevo({"-q", "capture", (source_dir() / "data/dem/vancouver-island.tif").string(),
                    "-o", (dir / name).string(), "--overwrite", "--size", "480x384", "--only", only,
                    "--view", "az=200,el=35,zoom=1.5", "--time", "2026-06-21T13:00-07:00"});
        EXPECT_EQ(run.status, 0) << run.err;
        return image::read(dir / name);
    };
    const image::Image8 without = take("without.png", "layering,sea");
    const image::Image8 with = take("with.png", "layering,sea,vsm");
    int differing = 0;
    for (std::size_t i = 0; i < with.values.size(); ++i)
        differing += std::abs(with.values[i] - without.values[i]) > 5;
    // Some 600 where the drawn floor counts as the surface; 14 where a smooth shore lies on the
    // foot of steep ground, which has shadows of its own.
    EXPECT_LE(differing, 30);
}

}  // namespace
}  // namespace relevo::test
