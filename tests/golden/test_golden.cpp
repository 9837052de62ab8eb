#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "cli/program.h"
#include "image/image.h"
#include "support/support.h"

namespace relevo::test {
namespace {

/// A picture that is kept, and how it is taken.
struct Scene {
    std::string name;
    std::vector<std::string> plugins;
    std::vector<std::string> arguments;
};

void PrintTo(const Scene& scene, std::ostream* out) {
    *out << scene.name;
}

std::filesystem::path golden_dir() {
    return source_dir() / "tests/golden";
}

std::vector<Scene> read_scenes() {
    const auto json = nlohmann::json::parse(read_text(golden_dir() / "scenes.json", "test"));
    std::vector<Scene> scenes;
    for (const auto& entry : json["scenes"]) {
        Scene scene{entry["name"], entry["plugins"], {}};
        scene.arguments = json["views"][entry["view"].get<std::string>()];
        const std::vector<std::string> more = entry.value("more", std::vector<std::string>{});
        scene.arguments.insert(scene.arguments.end(), more.begin(), more.end());
        scenes.push_back(std::move(scene));
    }
    return scenes;
}

class Golden : public testing::TestWithParam<Scene> {};

/// With RELEVO_WRITE_GOLDENS=1 in the environment the pictures are written instead of compared, and
/// the tests count as skipped.
TEST_P(Golden, IsThePictureThatWasLookedAt) {
    const Scene& scene = GetParam();
    for (const std::string& plugin : scene.plugins)
        if (!std::filesystem::exists(source_dir() / "plugins" / plugin))
            GTEST_SKIP() << "the plugin " << plugin << " is not there";
    const std::filesystem::path golden = golden_dir() / (scene.name + ".png");
    const std::filesystem::path dir = scratch_dir();
    const std::filesystem::path taken = dir / "taken.png", timings = dir / "timings.json";
    std::vector<std::string> arguments{
        "-q",     "capture", bundled_dem(), "--device",       "software",      "-o", taken.string(),
        "--size", "240x160", "--timings",   timings.string(), "--pixel-error", "2",  "--overwrite"};
    arguments.push_back("--only");
    arguments.push_back(fmt::format("{}", fmt::join(scene.plugins, ",")));
    arguments.insert(arguments.end(), scene.arguments.begin(), scene.arguments.end());
    const Result run = relevo(arguments);
    ASSERT_EQ(run.status, 0) << "goldens are taken on the software device: " << run.err;
    const std::string device = nlohmann::json::parse(read_text(timings, "test"))["device"];
    ASSERT_NE(device.find("llvmpipe"), std::string::npos)
        << "goldens are Mesa's llvmpipe's, but the software device is " << device;
    if (std::getenv("RELEVO_WRITE_GOLDENS")) {
        // Without its scene, which has paths of this machine.
        std::filesystem::remove(golden);
        image::write(golden, image::read(taken));
        GTEST_SKIP() << "written, not compared: " << golden;
    }
    const image::Image8 expected = image::read(golden), found = image::read(taken);
    ASSERT_EQ(found.width, expected.width);
    ASSERT_EQ(found.height, expected.height);
    std::size_t off = 0;
    int worst = 0;
    for (std::size_t i = 0; i < found.values.size(); ++i) {
        const int difference = std::abs(found.values[i] - expected.values[i]);
        off += difference > 1;
        worst = std::max(worst, difference);
    }
    const double share = static_cast<double>(off) / static_cast<double>(found.values.size());
    EXPECT_LE(share, 0.0002) << taken << " against " << golden;
    EXPECT_LE(worst, 3) << taken << " against " << golden;
}

INSTANTIATE_TEST_SUITE_P(Scenes, Golden, testing::ValuesIn(read_scenes()),
                         [](const auto& scene) { return scene.param.name; });

}  // namespace
}  // namespace relevo::test
