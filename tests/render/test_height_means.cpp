// Generalised heights of a DEM, as shaders read them.

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>

#include "base/units.h"
#include "light/fields.h"
#include "render/ground_light.h"
#include "render/height_means.h"
#include "support/gpu_snippet.h"
#include "support/support.h"

namespace relevo::render::test_height_means {
namespace {

constexpr int kColumns = 96, kRows = 80;

/// Ground with posts 20 m apart, on the device.
struct Ground {
    test::GpuSnippet gpu{"", "lib/height_means.glsl"};
    dem::Heightfield field;
    HeightMeans means{field};

    explicit Ground(const std::function<double(int, int)>& height_m)
        : field(test::field_of(kColumns, kRows, {500000, 20, 0, 640, 0, -20}, "EPSG:32631",
                               height_m)) {
        means.update(gpu.frame());
        gpu.frame().light_axes = {0.05F, 0, 0, -0.05F};
        gpu.bind(kHeightMeansTexture, *means.texture());
    }
};

TEST(HeightMeans, APlaneIsItselfOnEveryLevel) {
    Ground ground([](int column, int row) { return 300 + 4.0 * column - 2.0 * row; });
    const auto found = ground.gpu.run(
        "vec2 post = vec2(40.3, 35.8) + vec2(0.37, 0.21) * float(x);\n"
        "vec3 mean = height_mean(post, y);\n"
        "result = vec4(mean.x - (300.0 + 4.0 * post.x - 2.0 * post.y), mean.yz, 0.0);",
        8, 4);
    for (const glm::vec4& each : found) {
        EXPECT_NEAR(each.x, 0, 1e-3);
        EXPECT_NEAR(each.y, 4, 1e-4);
        EXPECT_NEAR(each.z, -2, 1e-4);
    }
}

TEST(HeightMeans, SlopesAreToTheEastAndTheNorth) {
    Ground ground([](int column, int row) { return 300 + 4.0 * column - 2.0 * row; });
    const glm::vec4 slope = ground.gpu.run(
        "result = vec4(height_mean_slope(height_mean(vec2(40.0), 1).yz), 0.0, 0.0);", 1, 1)[0];
    EXPECT_NEAR(slope.x, 0.2, 1e-5);
    EXPECT_NEAR(slope.y, 0.1, 1e-5);
}

TEST(HeightMeans, EachLevelSmoothsTwiceAsFar) {
    // Waves of 32 posts: a Gaussian of 0.65 x 2^level posts leaves exp(-(2 pi 0.65 2^level / 32)^2
    // / 2).
    Ground ground([](int column, int) { return 100 * std::cos(column * kPi / 16); });
    for (int level = 0; level < 4; ++level) {
        const double sigma = 0.65 * (1 << level) * kPi / 16;
        const glm::vec4 found = ground.gpu.run(
            "result = vec4(height_mean(vec2(64.0), " + std::to_string(level) + ").x);", 1, 1)[0];
        EXPECT_NEAR(found.x, 100 * std::exp(-sigma * sigma / 2), 3) << level;
    }
}

TEST(HeightMeans, NeighbouringPixelsMayReadDifferentLevels) {
    Ground ground([](int column, int row) { return 3.0 * column * row; });
    const auto together =
        ground.gpu.run("result = vec4(height_mean(vec2(40.0, 30.0), (x + y) % 4), 0.0);", 8, 8);
    for (int level = 0; level < 4; ++level) {
        const glm::vec4 alone = ground.gpu.run(
            "result = vec4(height_mean(vec2(40.0, 30.0), " + std::to_string(level) + "), 0.0);", 1,
            1)[0];
        for (int k = 0; k < 64; ++k)
            if ((k % 8 + k / 8) % 4 == level) {
                EXPECT_NEAR(together[static_cast<std::size_t>(k)].x, alone.x, 1e-2) << k;
            }
    }
}

TEST(HeightMeans, VoidsHaveTheHeightOfTheGroundAround) {
    Ground ground([](int column, int row) {
        return std::hypot(column - 48, row - 40) < 9 ? std::numeric_limits<double>::quiet_NaN()
                                                     : 700.0;
    });
    for (int level = 0; level < 6; ++level) {
        const glm::vec4 mean = ground.gpu.run(
            "result = vec4(height_mean(vec2(48.0, 40.0), " + std::to_string(level) + "), 0.0);", 1,
            1)[0];
        EXPECT_NEAR(mean.x, 700, 1e-3) << level;
        EXPECT_NEAR(mean.y, 0, 1e-3) << level;
    }
}

TEST(HeightMeans, VoidsMeetTheGroundAroundWithoutStepsAndAreAsRough) {
    const auto hills_m = [](int column, int row) {
        return 500 + 30 * std::sin(column * 0.9) * std::cos(row * 0.7) + 2.0 * column;
    };
    Ground ground([&](int column, int row) {
        return column > 47 ? std::numeric_limits<double>::quiet_NaN() : hills_m(column, row);
    });
    const auto rises_m = [&](int first, int last) {  // along rows, mean of the absolute values
        double sum = 0;
        for (int column = first; column < last; ++column)
            for (const glm::vec4& each :
                 ground.gpu.run("vec2 post = vec2(" + std::to_string(column) +
                                    ", y);\nresult = vec4(height_of_texel(post + vec2(1.0, 0.0)) - "
                                    "height_of_texel(post));",
                                1, kRows))
                sum += std::abs(each.x);
        return sum / (last - first) / kRows;
    };
    const double known_m = rises_m(30, 46), border_m = rises_m(47, 48), filled_m = rises_m(60, 80);
    EXPECT_LT(border_m, 2 * known_m);
    EXPECT_GT(filled_m, 0.4 * known_m);
    EXPECT_LT(filled_m, 2 * known_m);
}

TEST(HeightMeans, GentleGroundIsExaggeratedMoreThanSteepGround) {
    const auto exaggeration = [](double rise_m) {
        Ground ground([&](int column, int) { return rise_m * column; });
        return ground.gpu.run("result = vec4(height_mean_exaggeration());", 1, 1)[0].x;
    };
    EXPECT_NEAR(exaggeration(20), 1, 1e-6);  // 45 degrees
    EXPECT_NEAR(exaggeration(4), std::pow(0.5 / 0.2, 0.9), 1e-3);
    EXPECT_NEAR(exaggeration(0.02), 6, 1e-6);
}

TEST(HeightMeans, LightLeavesWhatTheyWrite) {
    Ground ground([](int column, int) { return 4.0 * column; });
    FrameBlock block = ground.gpu.frame();
    const geo::LocalFrame frame(ground.field.grid.center());
    GroundLight(ground.field, frame).describe(block);
    EXPECT_EQ(block.light_grid.z, 1);
    EXPECT_NEAR(block.light_map.y, 0.2, 1e-4);
    EXPECT_NEAR(block.light_axes.x, 0.05, 1e-3);
}

}  // namespace
}  // namespace relevo::render::test_height_means
