#include <cmath>

#include "support/gpu_snippet.h"
#include "support/support.h"

namespace relevo::test_agx {
namespace {

/// Colours for greys of `first` times 4^x, as the display gets them.
std::vector<glm::vec4> toned(test::GpuSnippet& gpu, const std::string& first, int count) {
    return gpu.run("vec3 c = " + first +
                       " * exp2(2.0 * float(x));\n"
                       "agx_on_tonemap(c);\n"
                       "result = vec4(pow(c, vec3(1.0 / 2.2)), 1.0);",
                   count, 1);
}

/// AgX's base look, without what suits landscapes.
void take_base(test::GpuSnippet& gpu) {
    gpu.values().set("agx.exposure", "0");
    gpu.values().set("agx.contrast", "1");
    gpu.values().set("agx.saturation", "1");
}

TEST(Agx, HasThePublishedCurve) {
    test::GpuSnippet gpu("agx");
    take_base(gpu);
    // B. Wrensch's polynomial for the same curve (Minimal AgX Implementation, 2023); it is said to
    // be off by 3.7e-6 in the mean square.
    const auto polynomial = [](double x) {
        return (((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x + 0.1191) * x -
               0.00232;
    };
    const int count = 8;
    const auto found = toned(gpu, "vec3(0.18 / 1024.0)", count);
    for (int i = 0; i < count; ++i) {
        const double x = 2.0 * i / 16.5;
        const glm::vec4& tone = found[static_cast<std::size_t>(i)];
        EXPECT_NEAR(tone.y, polynomial(x), 0.006) << i;
        EXPECT_NEAR(tone.x, tone.z, 2e-3) << i;  // greys stay grey
    }
    EXPECT_NEAR(found[5].y, 0.5, 1e-3);  // middle grey
}

TEST(Agx, FadesBrightColoursToWhiteAndNeverTurnsTheTones) {
    test::GpuSnippet gpu("agx");
    const int count = 9;
    const auto found = toned(gpu, "vec3(0.02, 0.005, 0.001)", count);
    double saturation = 1;
    for (std::size_t i = 3; i < count; ++i) {
        const double now = 1 - found[i].z / found[i].x;
        EXPECT_LT(now, saturation + 1e-6) << i;
        saturation = now;
        EXPECT_GE(found[i].x, found[i - 1].x - 1e-3) << i;
        EXPECT_GE(found[i].z, found[i - 1].z - 1e-3) << i;
    }
    EXPECT_LT(saturation, 0.05);
    EXPECT_GT(found[8].x, 0.98);
}

TEST(Agx, MakesAColourOfDarknessAndOfLightWithoutEnd) {
    test::GpuSnippet gpu("agx");
    const auto found = gpu.run(
        "vec3 c = x == 0 ? vec3(0.0) : x == 1 ? vec3(6e4, 0.0, 0.0) : vec3(-1.0, 0.5, 3e4);\n"
        "agx_on_tonemap(c);\n"
        "result = vec4(c, 1.0);",
        3, 1);
    for (const glm::vec4& colour : found)
        for (int i = 0; i < 3; ++i) {
            EXPECT_GE(colour[i], 0);
            EXPECT_LE(colour[i], 1);
        }
    EXPECT_NEAR(found[0].x, 0, 1e-6);
}

TEST(Agx, IsNeutralByDay) {
    test::GpuSnippet gpu("agx");
    gpu.values().set("agx.day_contrast", "0");
    gpu.values().set("agx.day_saturation", "0");
    const auto toned_at = [&](float sun_rad) {
        gpu.frame().eye_sun.w = sun_rad;
        return gpu.run(
            "vec3 c = vec3(0.2, 0.15, 0.05);\nagx_on_tonemap(c);\nresult = vec4(c, 1.0);", 1, 1)[0];
    };
    const glm::vec4 low = toned_at(0.1f), high = toned_at(0.4f), between = toned_at(0.24f);
    // Neutral tones leave middle colours as they are but for the exposure.
    EXPECT_NEAR(high.x, 0.2 * std::exp2(0.5), 2e-3);
    EXPECT_NEAR(high.z, 0.05 * std::exp2(0.5), 2e-3);
    EXPECT_LT(low.z, high.z - 0.01) << "film has darker shade";
    EXPECT_NEAR(between.z, (low.z + high.z) / 2, 1e-3);
}

TEST(Agx, HasTheContrastOfAPrintByDay) {
    test::GpuSnippet gpu("agx");
    gpu.frame().eye_sun.w = 0.3F;  // lower than those whose white is made bluer
    const int count = 1000;
    const auto greys = gpu.run("result = vec4(agx_print(vec3(float(x) / 999.0)), 0.0);", count, 1);
    const auto slope = [&](int i) {
        return 999.0 / 2 *
               (greys[static_cast<std::size_t>(i + 1)].x -
                greys[static_cast<std::size_t>(i - 1)].x);
    };
    for (int i = 1; i < count; ++i) {
        const glm::vec4& grey = greys[static_cast<std::size_t>(i)];
        EXPECT_NEAR(grey.x, grey.z, 1e-6) << i;  // greys stay grey
        EXPECT_GT(grey.x, greys[static_cast<std::size_t>(i - 1)].x) << i;
    }
    EXPECT_NEAR(greys[100].x, std::pow(100 / 999.0, 1.22) * std::pow(0.1726, -0.22),
                1e-4);  // shade
    EXPECT_NEAR(greys[20].x, 20 / 999.0 * std::pow(0.3, 0.22), 1e-4) << "deep shade is no ink";
    EXPECT_NEAR(slope(168), slope(177), 0.03);  // no edge at the middle, which is at 172
    EXPECT_GT(greys[350].x, 0.35 * 1.05);
    EXPECT_NEAR(greys[999].x, 1, 1e-4);
    EXPECT_NEAR(slope(980), 1, 0.03) << "snow keeps its form";
    // Colours get more of themselves, but neither air nor what has all of it already.
    const auto colours = gpu.run(
        "vec3 c = x == 0 ? vec3(0.16, 0.18, 0.12) : x == 1 ? vec3(0.15, 0.17, 0.3) : vec3(0.3, "
        "0.0, 0.0);\n"
        "vec3 p = agx_print(c);\n"
        "result = vec4(p / max(p.r, max(p.g, p.b)), 0.0);",
        3, 1);
    EXPECT_LT(colours[0].z, 0.12 / 0.18 - 0.02);
    EXPECT_NEAR(colours[1].x, 0.15 / 0.3, 0.01);
    EXPECT_NEAR(colours[2].y, 0, 1e-6);
}

}  // namespace
}  // namespace relevo::test_agx
