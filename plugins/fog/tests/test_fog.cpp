#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/gpu_snippet.h"
#include "support/support.h"

namespace relevo::test_fog {
namespace {

TEST(Fog, DepthIsTheIntegralAlongTheRay) {
    test::GpuSnippet gpu("fog");
    gpu.frame().height_range = {0, 1e-3F, 1, 0};
    std::vector<double> errors;
    for (const double soft : {5.0, 25.0, 200.0}) {
        gpu.values().set("fog.soft_m", fmt::format("{}", soft));
        const auto found = gpu.run(
            "float from = 400.0 + 50.0 * float(x), to = 400.0 + 50.0 * float(y);\n"
            "result = vec4(fog_depth(from, to, 3000.0, 900.0), fog_above(from, 900.0), from, to);",
            40, 40);
        for (const glm::vec4& one : found) {
            constexpr int kSteps = 4000;
            double sum = 0;
            for (int i = 0; i < kSteps; ++i) {
                const double h = double{one.z} + (double{one.w} - one.z) * (i + 0.5) / kSteps;
                sum += 1 / (1 + std::exp((h - 900) / soft)) / kSteps;
            }
            const double expected = 3.912 / 400 * 3000 * sum;
            errors.push_back(std::abs(one.x - expected) / std::max(expected, 0.1));
        }
    }
    test::print_accuracy("fog, device against the integral", errors, "of the depth", 0.005);
    EXPECT_LT(*std::ranges::max_element(errors), 0.005);
}

TEST(Fog, OneSeesAsFarAsItsVisibility) {
    test::GpuSnippet gpu("fog");
    gpu.frame().height_range = {0, 1e-3F, 1, 0};
    gpu.values().set("fog.visibility_m", "200");
    const auto found = gpu.run("result = vec4(exp(-fog_depth(100.0, 100.0, 200.0, 900.0)));", 1, 1);
    EXPECT_NEAR(found[0].x, 0.02, 1e-4);
}

TEST(Fog, EndsAtItsTop) {
    test::GpuSnippet gpu("fog");
    gpu.frame().height_range = {0, 1e-3F, 1, 0};
    const auto found = gpu.run("result = vec4(fog_above(900.0 + 100.0 * float(x), 900.0));", 4, 1);
    EXPECT_NEAR(found[0].x, 3.912 / 400 * 25 * std::log(2), 1e-3);
    EXPECT_LT(found[3].x, 1e-5);
}

}  // namespace
}  // namespace relevo::test_fog
