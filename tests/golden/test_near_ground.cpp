#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "image/image.h"
#include "support/support.h"

namespace relevo::test::test_near_ground {
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

/// A picture of the bundled DEM with so much relief between its posts.
struct Taken {
    image::Image8 picture;
    nlohmann::json sidecar;
    std::string said;
};
Taken take(const std::string& relief, std::vector<std::string> view) {
    const std::filesystem::path picture = scratch_dir("near_relief") / "taken.png";
    std::vector<std::string> words{"capture",     bundled_dem(),
                                   "-o",          picture.string(),
                                   "--overwrite", "--audit",
                                   "--time",      "2026-06-21T17:00-04:00",
                                   "--set",       "bump.relief=" + relief};
    words.insert(words.end(), view.begin(), view.end());
    if (std::ranges::find(view, "--size") == view.end())
        words.insert(words.end(), {"--size", "300x200"});
    const Result run = relevo(words);
    EXPECT_EQ(run.status, 0) << run.err;
    std::ifstream sidecar(picture.string() + ".json");
    return {image::read(picture), nlohmann::json::parse(sidecar), run.err};
}

double mean(const image::Image8& picture) {
    double sum = 0;
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < 3 * picture.width; ++x)
            sum += std::pow(picture.row(y)[x] / 255.0, 2.2) / (3 * picture.width * picture.height);
    return sum;
}

/// Root mean square of the steps between pixels that lie five apart, in counts.
double steps(const image::Image8& picture) {
    double sum = 0;
    int count = 0;
    for (int y = 0; y < picture.height; ++y)
        for (int x = 15; x < 3 * picture.width; ++x, ++count)
            sum += std::pow(picture.row(y)[x] - picture.row(y)[x - 15], 2);
    return std::sqrt(sum / count);
}

constexpr const char* kSaid =
    "relevo: bump: gullies and roughness between the posts are synthetic detail";

TEST(NearGround, HasReliefBelowThePostsAndTheLightOfTheDem) {
    if (!std::filesystem::exists(source_dir() / "plugins/bump"))
        GTEST_SKIP() << "the plugin bump is not there";
    // Without what else there is to see of plain ground.
    const auto from = [](const char* eye) {
        return std::vector<std::string>{"--eye",        eye,
                                        "--heading",    "250",
                                        "--pitch",      "-50",
                                        "--set",        "cover.trees=none",
                                        "--set",        "cover.grain=0",
                                        "--set",        "bump.strength=0",
                                        "--land-cover", "none"};
    };
    const Taken smooth = take("0", from("36.30,-84.24,80agl")),
                rough = take("1", from("36.30,-84.24,80agl"));
    // Light over many gullies.
    const double whole = mean(take("0", from("36.30,-84.24,400agl")).picture),
                 cut = mean(take("1", from("36.30,-84.24,400agl")).picture);
    fmt::print(
        "[ accuracy ] steps {:.2f} without and {:.2f} with relief, mean light {:.4f} and "
        "{:.4f}\n",
        steps(smooth.picture), steps(rough.picture), whole, cut);
    EXPECT_GT(steps(rough.picture), 1.2 * steps(smooth.picture));
    EXPECT_NEAR(cut / whole, 1, 0.03);
    // It is said, and figures know nothing of it.
    EXPECT_EQ(smooth.said.find(kSaid), std::string::npos);
    EXPECT_NE(rough.said.find(kSaid), std::string::npos) << rough.said;
    EXPECT_EQ(rough.sidecar.at("audit"), smooth.sidecar.at("audit"));
}

TEST(NearGround, BlocksAndMapsHaveNoInventedRelief) {
    if (!std::filesystem::exists(source_dir() / "plugins/bump"))
        GTEST_SKIP() << "the plugin bump is not there";
    using Words = std::vector<std::string>;
    for (const Words& view :
         {Words{"--view", "whole"}, Words{"--view", "top"}, Words{"--ortho", "--size", "1600x1600"},
          Words{"--eye", "36.30,-84.24,80agl", "--preset", "slope"},
          Words{"--eye", "36.30,-84.24,80agl", "--preset", "aspect"}}) {
        const Taken without = take("0", view), with = take("4", view);
        EXPECT_EQ(without.picture.values, with.picture.values) << (view.empty() ? "" : view.back());
        EXPECT_EQ(with.said.find(kSaid), std::string::npos);
    }
}

}  // namespace
}  // namespace relevo::test::test_near_ground
