#include <cstdlib>
#include <filesystem>

#include "cli/program.h"
#include "image/image.h"
#include "support/support.h"

namespace relevo::test::test_sea {
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
    // Some 600 where the drawn floor counts as the surface; 47 where a smooth, pale shore lies on
    // the foot of steep ground, which has shadows of its own.
    EXPECT_LE(differing, 70);
}

TEST(SeaPicture, IsLevelAndInTheSamePlacesWithVertexNormals) {
    if (!std::filesystem::exists(source_dir() / "plugins/sea"))
        GTEST_SKIP() << "the plugin sea is not there";
    // Sounds narrower than the posts' normals are wide, over a floor that leans.
    const std::filesystem::path dir = scratch_dir("sea_vertex");
    const auto take = [&](const std::string& normals) {
        const Result run =
            relevo({"-q", "capture", (source_dir() / "data/dem/vancouver-island.tif").string(),
                    "-o", (dir / "taken.png").string(), "--overwrite", "--size", "320x240",
                    "--view", "top", "--set", "terrain.normal=" + normals, "--set",
                    "sea.floor=hidden", "--time", "2026-06-21T09:00-07:00"});
        EXPECT_EQ(run.status, 0) << run.err;
        return image::read(dir / "taken.png");
    };
    const image::Image8 fragment = take("fragment"), vertex = take("vertex");
    int water = 0, differing = 0;
    for (int y = 0; y < fragment.height; ++y)
        for (int x = 0; x < fragment.width; ++x) {
            if (fragment.at(x, y, 2) < fragment.at(x, y, 0) + 30) continue;
            ++water;
            for (int c = 0; c < 3; ++c)
                differing += std::abs(fragment.at(x, y, c) - vertex.at(x, y, c)) > 2;
        }
    EXPECT_GT(water, 20000);
    // 10 000 and more where water is what lies at 0 or below, or where it leans as its floor.
    EXPECT_LE(differing, 60);
}

}  // namespace
}  // namespace relevo::test::test_sea
