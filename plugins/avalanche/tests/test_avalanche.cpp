#include <gtest/gtest.h>

#include "support/gpu_snippet.h"

namespace relevo::test_avalanche {
namespace {

/// Colours of slopes from 0 to 89.5 degrees, every half degree.
std::vector<glm::vec4> colours(const char* classes) {
    test::GpuSnippet gpu("avalanche");
    gpu.values().set("avalanche.classes", classes);
    return gpu.run("result = avalanche_of(0.5 * float(x));", 180, 1);
}

/// Slopes at which the colour changes [degrees].
std::vector<double> edges(const char* classes) {
    const std::vector<glm::vec4> found = colours(classes);
    std::vector<double> changes;
    for (std::size_t i = 1; i < found.size(); ++i)
        if (found[i] != found[i - 1]) changes.push_back(0.5 * static_cast<double>(i));
    return changes;
}

TEST(Avalanche, ClassesBeginAtTheirEdges) {
    EXPECT_EQ(edges("swiss"), (std::vector<double>{30, 35, 40, 45}));
    EXPECT_EQ(edges("american"), (std::vector<double>{27, 30, 32, 35, 46, 51, 60}));
}

TEST(Avalanche, FlatterGroundKeepsItsLook) {
    for (const char* const classes : {"swiss", "american"}) {
        const std::vector<glm::vec4> found = colours(classes);
        EXPECT_EQ(found.front(), glm::vec4(0));
        EXPECT_EQ(found.back().w, 1);
    }
}

TEST(Avalanche, ASlopeIsThatOfTheGroundWhateverTheVertical) {
    test::GpuSnippet gpu("avalanche");
    gpu.values().set("avalanche.opacity", "0.5");
    // Slopes of 29 and of 31 degrees, under a vertical that is inclined by 20 degrees.
    const auto found = gpu.run(
        "Surface s;\n"
        "float slope = radians(x == 0 ? 29.0 : 31.0), tilt = radians(20.0);\n"
        "s.up = vec3(sin(tilt), 0.0, cos(tilt));\n"
        "s.ground_normal = vec3(sin(tilt - slope), 0.0, cos(tilt - slope));\n"
        "result = vec4(0.0, 0.0, 0.0, 0.2);\n"
        "avalanche_on_display(s, result);",
        2, 1);
    EXPECT_NEAR(found[0].w, 0.2, 1e-6);
    EXPECT_NEAR(found[1].w, 0.5 + 0.5 * 0.2, 1e-6);
    EXPECT_NEAR(found[1].x, 0.5 * 0.976, 1e-3);
}

}  // namespace
}  // namespace relevo::test_avalanche
