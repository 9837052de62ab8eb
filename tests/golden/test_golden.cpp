#include <cstdlib>
#include <filesystem>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "cli/program.h"
#include "image/image.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::test::test_golden {
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

/// In arguments of scenes: the DEM, and the folder of the tests' data.
constexpr std::string_view kDem = "DEM:", kData = "DATA:";

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
        for (std::string& argument : scene.arguments) {
            if (const auto at = argument.find(kDem); at != std::string::npos)
                argument.replace(at, kDem.size(), bundled_dem());
            if (const auto at = argument.find(kData); at != std::string::npos)
                argument.replace(at, kData.size(), (source_dir() / "tests/data").string());
        }
        scenes.push_back(std::move(scene));
    }
    return scenes;
}

/// Whether pictures are drawn on the device on which the goldens were made.
bool on_references() {
    return gl_device() == "software";
}

class Golden : public testing::TestWithParam<Scene> {
  protected:
    void SetUp() override {
        for (const std::string& plugin : GetParam().plugins)
            if (!std::filesystem::exists(source_dir() / "plugins" / plugin))
                GTEST_SKIP() << "the plugin " << plugin << " is not there";
    }

    /// Takes the scene's picture. @returns the device's name
    std::string take(const std::vector<std::string>& environment = {}) const {
        const Scene& scene = GetParam();
        const std::filesystem::path timings = taken_.parent_path() / "timings.json";
        std::vector<std::string> arguments{
            "-q",        "capture",    bundled_dem(),    "--device",
            gl_device(), "-o",         taken_.string(),  "--size",
            "240x160",   "--timings",  timings.string(), "--pixel-error",
            "2",         "--overwrite"};
        arguments.push_back("--only");
        arguments.push_back(fmt::format("{}", fmt::join(scene.plugins, ",")));
        arguments.insert(arguments.end(), scene.arguments.begin(), scene.arguments.end());
        const Result run = relevo(arguments, environment);
        EXPECT_EQ(run.status, 0) << "goldens are taken on the software device: " << run.err;
        return run.status == 0 ? nlohmann::json::parse(read_text(timings, "test"))["device"] : "";
    }

    void expect_golden() const {
        const image::Image8 expected = image::read(golden_), found = image::read(taken_);
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
        fmt::print("[ golden   ] {}: {:.4f} % off by more than 1/255, worst {}\n", GetParam().name,
                   100 * share, worst);
        EXPECT_LE(share, 0.0002) << taken_ << " against " << golden_;
        EXPECT_LE(worst, 4) << taken_ << " against " << golden_;
    }

    const std::filesystem::path golden_ = golden_dir() / (GetParam().name + ".png");
    const std::filesystem::path taken_ = scratch_dir() / "taken.png";
};

/// With RELEVO_WRITE_GOLDENS=1 in the environment the pictures are written instead of compared, and
/// the tests count as skipped.
TEST_P(Golden, IsThePictureThatWasLookedAt) {
    const std::string device = take();
    ASSERT_TRUE(!on_references() || device.find("llvmpipe") != std::string::npos)
        << "goldens are Mesa's llvmpipe's, but the software device is " << device;
    if (std::getenv("RELEVO_WRITE_GOLDENS")) {
        // Without its scene, which has paths of this machine.
        std::filesystem::remove(golden_);
        image::write(golden_, image::read(taken_));
        GTEST_SKIP() << "written, not compared: " << golden_;
    }
    expect_golden();
}

/// The Vulkan driver that draws on the processor.
std::optional<std::filesystem::path> lavapipe() {
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator("/usr/share/vulkan/icd.d", none))
        if (entry.path().filename().string().starts_with("lvp_icd")) return entry.path();
    return std::nullopt;
}

class GoldenOverVulkan : public Golden {};

/// Mesa's zink makes SPIR-V of the programs and Vulkan's commands of the calls, so that compiler,
/// synchronisation and state are others than llvmpipe's. What is undefined shows.
TEST_P(GoldenOverVulkan, IsThePictureThatWasLookedAt) {
    if (!on_references()) GTEST_SKIP() << "RELEVO_TEST_DEVICE names another device";
    const auto driver = lavapipe();
    if (!driver) GTEST_SKIP() << "no Vulkan driver on the processor (mesa-vulkan-drivers) is there";
    const std::string device = take(
        {"LIBGL_ALWAYS_SOFTWARE=1", "GALLIUM_DRIVER=zink", "VK_ICD_FILENAMES=" + driver->string()});
    ASSERT_TRUE(device.starts_with("zink")) << device;
    expect_golden();
}

INSTANTIATE_TEST_SUITE_P(Scenes, Golden, testing::ValuesIn(read_scenes()),
                         [](const auto& scene) { return scene.param.name; });
INSTANTIATE_TEST_SUITE_P(Scenes, GoldenOverVulkan, testing::ValuesIn(read_scenes()),
                         [](const auto& scene) { return scene.param.name; });

}  // namespace
}  // namespace relevo::test::test_golden
