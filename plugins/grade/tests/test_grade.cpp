#include <cmath>

#include "support/gpu_snippet.h"
#include "support/support.h"

namespace relevo::test_grade {
namespace {

double luminance(const glm::vec4& c) {
    return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}

constexpr const char* kFinish =
    "vec3 c = vec3(0.1, 0.3, 0.05) * float(x + 1);\n"
    "grade_on_finish(Pixel(vec2(0.0), vec2(0.5), vec3(0.0, 1.0, 0.0), 1.0, vec2(0.5)), c);\n"
    "result = vec4(c, 1.0);";

TEST(Grade, LeavesAPictureAsItIsAtNeutralValues) {
    test::GpuSnippet gpu("grade");
    gpu.values().set("grade.contrast", "1");
    gpu.values().set("grade.vignette", "0");
    const auto found = gpu.run(kFinish, 3, 1);
    for (int x = 0; x < 3; ++x) {
        EXPECT_NEAR(found[static_cast<std::size_t>(x)].x, 0.1 * (x + 1), 1e-6);
        EXPECT_NEAR(found[static_cast<std::size_t>(x)].y, 0.3 * (x + 1), 1e-6);
    }
}

TEST(Grade, WarmthKeepsTheLuminanceAndExposureCountsInStops) {
    test::GpuSnippet gpu("grade");
    gpu.values().set("grade.warmth", "0.8");
    gpu.values().set("grade.exposure", "1");
    const glm::vec4 found = gpu.run(
        "vec3 c = vec3(0.2, 0.4, 0.6);\n"
        "grade_on_image(Pixel(vec2(0.0), vec2(0.5), vec3(0.0, 1.0, 0.0), 1.0, vec2(0.5)), c);\n"
        "result = vec4(c, 1.0);",
        1, 1)[0];
    EXPECT_NEAR(luminance(found), 2 * luminance({0.2, 0.4, 0.6, 1}), 1e-5);
    EXPECT_GT(found.x / found.z, 0.2 / 0.6);
}

TEST(Grade, ContrastTurnsAboutMiddleGrey) {
    test::GpuSnippet gpu("grade");
    gpu.values().set("grade.contrast", "2");
    gpu.values().set("grade.saturation", "0");
    const auto found = gpu.run(
        "vec3 c = vec3(x == 0 ? 0.18 : x == 1 ? 0.09 : 0.0);\n"
        "grade_on_finish(Pixel(vec2(0.0), vec2(0.5), vec3(0.0, 1.0, 0.0), 1.0, vec2(0.5)), c);\n"
        "result = vec4(c, 1.0);",
        3, 1);
    EXPECT_NEAR(found[0].x, 0.18, 1e-5);
    EXPECT_NEAR(found[1].x, 0.045, 1e-5);
    EXPECT_NEAR(found[2].x, 0, 1e-6);
}

TEST(Grade, TheVignetteDarkensTheCorners) {
    test::GpuSnippet gpu("grade");
    gpu.values().set("grade.contrast", "1");
    gpu.values().set("grade.vignette", "0.6");
    const auto found = gpu.run(
        "vec3 c = vec3(0.5);\n"
        "grade_on_finish(Pixel(vec2(0.0), vec2(0.5), vec3(0.0, 1.0, 0.0), 1.0,\n"
        "                      x == 0 ? vec2(0.5) : vec2(1.0)), c);\n"
        "result = vec4(c, 1.0);",
        2, 1);
    EXPECT_NEAR(found[0].x, 0.5, 1e-6);
    EXPECT_NEAR(found[1].x, 0.2, 1e-6);
}

}  // namespace
}  // namespace relevo::test_grade
