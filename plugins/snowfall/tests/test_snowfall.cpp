#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/gpu_snippet.h"

namespace relevo::test_snowfall {
namespace {

constexpr int kSide = 256;
constexpr double kPixel_rad = 0.8 / kSide;  // of a view of 46 degrees

/// What flakes cover of a view to the north, a number a pixel.
/// @param seconds   of the fall
std::vector<glm::vec4> flakes(test::GpuSnippet& gpu, double seconds, int layer) {
    gpu.frame().seconds = static_cast<float>(seconds);
    return gpu.run(fmt::format("vec3 d = normalize(vec3((vec2(x, y) - 127.5) * {:.9f}, 1.0).xzy);\n"
                               "result = vec4(snowfall_flake({}, d, {:.9f}));",
                               kPixel_rad, layer, kPixel_rad),
                   kSide, kSide);
}

double sum(const std::vector<glm::vec4>& picture) {
    double total = 0;
    for (const glm::vec4& pixel : picture)
        total += double{pixel.x};
    return total;
}

TEST(Snowfall, TransmittanceAtTheVisibilityIsKoschmieders) {
    test::GpuSnippet gpu("snowfall");
    gpu.values().set("snowfall.visibility_m", "2000");
    const auto found = gpu.run("result = vec4(snowfall_transmittance(float(x) * 2000.0));", 2, 1);
    EXPECT_NEAR(found[0].x, 1, 1e-6);
    EXPECT_NEAR(found[1].x, 0.02, 1e-4);
}

TEST(Snowfall, FlakesFallByTheirSpeed) {
    test::GpuSnippet gpu("snowfall");
    gpu.values().set("snowfall.wind_mps", "0");
    gpu.values().set("snowfall.fall_mps", "1");
    gpu.values().set("snowfall.shutter_s", "0");
    constexpr int kLayer = 3;
    const double distance_m = 0.7 * std::pow(1.45, kLayer);
    const auto before = flakes(gpu, 0, kLayer);
    // So long that flakes straight ahead fall by 12 pixels.
    const auto after = flakes(gpu, 12 * kPixel_rad * distance_m, kLayer);
    double kept = 0, moved = 0;
    for (int y = 100; y < 156; ++y)
        for (int x = 100; x < 156; ++x) {
            const auto at = static_cast<std::size_t>(y * kSide + x);
            kept += double{before[at].x * after[at].x};
            moved += double{before[at].x * after[at - 12 * kSide].x};
        }
    EXPECT_GT(moved, 3 * kept);
    EXPECT_GT(moved, 0.02);
}

TEST(Snowfall, TheShutterDrawsFlakesOutAndKeepsTheirLight) {
    test::GpuSnippet gpu("snowfall");
    gpu.values().set("snowfall.wind_mps", "0");
    for (const int layer : {2, 5, 8}) {
        gpu.values().set("snowfall.shutter_s", "0");
        const auto still = flakes(gpu, 1, layer);
        gpu.values().set("snowfall.shutter_s", "0.01");
        const auto drawn_out = flakes(gpu, 1, layer);
        EXPECT_GT(sum(still), 0.5) << layer;
        EXPECT_NEAR(sum(drawn_out), sum(still), 0.35 * sum(still)) << layer;
        EXPECT_NE(still, drawn_out);
    }
}

TEST(Snowfall, TheNumberOfFlakesFollowsItsFactor) {
    test::GpuSnippet gpu("snowfall");
    gpu.values().set("snowfall.flakes", "0");
    EXPECT_EQ(sum(flakes(gpu, 1, 4)), 0);
    gpu.values().set("snowfall.flakes", "0.5");
    const double half = sum(flakes(gpu, 1, 4));
    gpu.values().set("snowfall.flakes", "1");
    EXPECT_NEAR(half, 0.5 * sum(flakes(gpu, 1, 4)), 0.2 * sum(flakes(gpu, 1, 4)));
}

}  // namespace
}  // namespace relevo::test_snowfall
