#include <cmath>
#include <cstddef>

#include "support/gpu_snippet.h"
#include "support/support.h"

namespace relevo::test_swiss {
namespace {

/// Shading of slopes of 1 that face the north, the north-east and so on.
std::vector<glm::vec4> shadings(test::GpuSnippet& gpu) {
    return gpu.run(
        "float faces = radians(45.0 * float(x));\n"
        "result = vec4(swiss_shading(-vec2(sin(faces), cos(faces))));",
        8, 1);
}

TEST(Swiss, LevelGroundHasTheColourOfItsHeight) {
    test::GpuSnippet gpu("swiss");
    EXPECT_NEAR(gpu.run("result = vec4(swiss_shading(vec2(0.0)));", 1, 1)[0].x, 0, 1e-5);
}

TEST(Swiss, LightComesFromTheNorthWest) {
    test::GpuSnippet gpu("swiss");
    const auto found = shadings(gpu);
    for (std::size_t k = 0; k < 8; ++k) {
        EXPECT_LE(found[k].x, found[7].x) << k;  // the north-west is the brightest
        EXPECT_GE(found[k].x, found[3].x) << k;  // the south-east the darkest
    }
    EXPECT_NEAR(found[0].x, found[6].x, 1e-4);  // north and west are alike
    EXPECT_GT(found[7].x, 0.08);
    EXPECT_LT(found[3].x, -0.4);
    EXPECT_GT(found[3].x, -0.9);  // the rest of the sky lights the shade
}

TEST(Swiss, LightTurnsWithItsAzimuth) {
    test::GpuSnippet gpu("swiss");
    const auto before = shadings(gpu);
    gpu.values().set("swiss.light", "45");
    const auto turned = shadings(gpu);
    for (std::size_t k = 0; k < 8; ++k)
        EXPECT_NEAR(turned[(k + 2) % 8].x, before[k].x, 1e-4) << k;
}

TEST(Swiss, HeightsGoFromTheFirstColourToTheLast) {
    test::GpuSnippet gpu("swiss");
    gpu.values().set("swiss.low_m", "500");
    gpu.values().set("swiss.high_m", "1500");
    const auto found = gpu.run(
        "float unit = swiss_unit(250.0 + 250.0 * float(x));\n"
        "result = vec4(distance(swiss_land_colour(unit), swiss_land[0]),\n"
        "              distance(swiss_land_colour(unit), swiss_land[swiss_lands - 1]), unit, 0.0);",
        7, 1);
    EXPECT_EQ(found[0].x, 0);
    EXPECT_EQ(found[1].x, 0);
    EXPECT_NEAR(found[3].z, 0.5, 1e-6);
    EXPECT_EQ(found[5].y, 0);
    EXPECT_EQ(found[6].y, 0);
}

TEST(Swiss, WhatEarlierEffectsDrewStaysOnTop) {
    test::GpuSnippet gpu("swiss");
    const glm::vec4 over = gpu.run(
        "vec4 over = vec4(0.2, 0.0, 0.0, 0.25);\n"
        "result = swiss_below(over, vec3(0.8));",
        1, 1)[0];
    EXPECT_NEAR(over.x, 0.2 + 0.75 * 0.8, 1e-6);
    EXPECT_NEAR(over.y, 0.75 * 0.8, 1e-6);
    EXPECT_NEAR(over.w, 1, 1e-6);
}

}  // namespace
}  // namespace relevo::test_swiss
