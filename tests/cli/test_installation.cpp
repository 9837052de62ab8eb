#include <filesystem>

#include "cli/program.h"
#include "image/image.h"
#include "support/support.h"

namespace relevo::test::test_installation {
namespace {

TEST(Installation, TakesTheSamePictureFromWhereverItLies) {
    const std::filesystem::path dir = scratch_dir("cli_installation");
    std::filesystem::remove_all(dir);
    const Result install = run(
        RELEVO_CMAKE, {"--install", build_dir().string(), "--prefix", (dir / "first").string()});
    ASSERT_EQ(install.status, 0) << install.err;
    std::filesystem::rename(dir / "first", dir / "moved");

    const std::filesystem::path dem = dir / "moved/share/relevo/data/dem/jacksboro.tif";
    const auto take = [&](const std::filesystem::path& program, const char* name) {
        const std::filesystem::path path = dir / name;
        const Result taken = run(program, {"-q", "capture", dem.string(), "-o", path.string(),
                                           "--size", "160x120", "--preset", "paper"});
        EXPECT_EQ(taken.status, 0) << taken.err;
        EXPECT_EQ(taken.err, "");
        return image::read(path);
    };
    const image::Image8 installed = take(dir / "moved/bin/relevo", "installed.png");
    const image::Image8 built = take(build_dir() / "bin/relevo", "built.png");
    EXPECT_EQ(image::compare(installed, built).worst, 0);
    // So does the map of time zones.
    const Result zone = run(dir / "moved/bin/relevo", {"sun", "position", "--at", "46.95,7.44",
                                                       "--time", "2026-06-21T12:00"});
    EXPECT_EQ(zone.status, 0);
    EXPECT_EQ(zone.err, "relevo: time zone Europe/Zurich of the place; --tz sets another\n");
    std::filesystem::remove_all(dir / "moved");  // 70 MB
}

}  // namespace
}  // namespace relevo::test::test_installation
