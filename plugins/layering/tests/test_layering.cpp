#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/units.h"
#include "support/gpu_snippet.h"
#include "support/support.h"

namespace relevo::test_layering {
namespace {

using Weights = std::array<double, 4>;  // sand, grass, rock, snow

double smoothstep(double from, double to, double x) {
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

/// The paper's layering, section 3.1: limits moved by noise, smoothstep between two materials; and
/// beyond the paper, rock on steep ground with the third material taken out.
Weights reference(const std::array<double, 6>& limits, double elevation, double noise,
                  double steep) {
    const double grass = smoothstep(limits[0] + noise, limits[1] + noise, elevation);
    const double rock = smoothstep(limits[2] + noise, limits[3] + noise, elevation);
    const double snow = smoothstep(limits[4] + noise, limits[5] + noise, elevation);
    Weights w{1 - grass, grass * (1 - rock), grass * rock * (1 - snow), grass * rock * snow};
    for (std::size_t i = 0; i < 4; ++i)
        w[i] = (1 - steep) * w[i] + (i == 2 ? steep : 0);
    Weights sorted = w;
    std::sort(sorted.begin(), sorted.end(), std::greater<>());
    double sum = 0;
    for (double& value : w) {
        value = std::max(value - sorted[2], 0.0);
        sum += value;
    }
    for (double& value : w)
        value /= sum;
    return w;
}

constexpr std::array<double, 6> kTable1{0.20, 0.25, 0.40, 0.45, 0.80, 0.85};
constexpr const char* kPaperLimits =
    "layering_Limits limits = layering_Limits(layering_sand_grass, layering_grass_rock, "
    "layering_rock_snow);\n";

TEST(Layering, WeightsOnTheGpuAreTheReferences) {
    constexpr int kElevations = 1001, kOthers = 45;  // 9 noises x 5 steepnesses
    test::GpuSnippet gpu("layering");
    const auto results =
        gpu.run(std::string(kPaperLimits) +
                    "float noise = float(y % 9 - 4) * 0.025;\n"
                    "float steep = float(y / 9) * 0.25;\n"
                    "result = layering_weights(limits, float(x) / 1000.0, vec3(noise), "
                    "steep);",
                kElevations, kOthers);
    std::vector<double> errors;
    for (int y = 0; y < kOthers; ++y) {
        for (int x = 0; x < kElevations; ++x) {
            const Weights expected =
                reference(kTable1, x / 1000.0, (y % 9 - 4) * 0.025, (y / 9) * 0.25);
            const glm::vec4 found = results[static_cast<std::size_t>(y * kElevations + x)];
            int above_zero = 0;
            for (int i = 0; i < 4; ++i) {
                errors.push_back(std::abs(found[i] - expected[static_cast<std::size_t>(i)]));
                above_zero += found[i] > 1e-6f;
            }
            ASSERT_LE(above_zero, 2) << "elevation " << x / 1000.0 << " row " << y;
        }
    }
    test::print_accuracy("layering weights, GPU against double", errors, "", 1e-3);
    EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 1e-3);
}

TEST(Layering, LimitsAreThoseOfTable1) {
    // elevation: sand 0.00-0.25, grass 0.20-0.45, rock 0.40-0.85, snow 0.80-1.00
    struct Row {
        int material;
        double from, to;
    };
    test::GpuSnippet gpu("layering");
    const auto results =
        gpu.run(std::string(kPaperLimits) +
                    "result = layering_weights(limits, float(x) / 1000.0, vec3(0.0), 0.0);",
                1001, 1);
    for (const Row& row :
         {Row{0, 0.00, 0.25}, Row{1, 0.20, 0.45}, Row{2, 0.40, 0.85}, Row{3, 0.80, 1.00}}) {
        for (int x = 0; x <= 1000; ++x) {
            const double elevation = x / 1000.0;
            const float weight = results[static_cast<std::size_t>(x)][row.material];
            const bool inside = elevation > row.from + 0.002 && elevation < row.to - 0.002;
            const bool outside = elevation < row.from - 0.0005 || elevation > row.to + 0.0005;
            if (inside) {
                EXPECT_GT(weight, 0) << "material " << row.material << " at " << elevation;
            } else if (outside) {
                EXPECT_EQ(weight, 0) << "material " << row.material << " at " << elevation;
            }
        }
    }
}

TEST(Layering, NoiseMovesTheLimitsAndNotTheElevation) {
    // Flat ground in the middle of a range keeps its one material whatever the noise.
    test::GpuSnippet gpu("layering");
    const auto results =
        gpu.run(std::string(kPaperLimits) +
                    "result = layering_weights(limits, 0.6, vec3(float(x - 5) * 0.03), 0.0);",
                11, 1);
    for (const glm::vec4& weights : results)
        EXPECT_EQ(weights, glm::vec4(0, 0, 1, 0));
}

TEST(Layering, TreeLineFollowsKoerner) {
    test::GpuSnippet gpu("layering");
    const auto results =
        gpu.run("result = vec4(layering_tree_line_m(float(x) - 90.0), 0.0, 0.0, 0.0);", 181, 1);
    const auto tree_line = [&](int latitude) {
        return results[static_cast<std::size_t>(latitude + 90)].x;
    };
    EXPECT_NEAR(tree_line(0), 3800, 1);    // tropics, 3500 to 4000 m
    EXPECT_NEAR(tree_line(47), 1850, 1);   // northern Alps, 1800 to 1900 m
    EXPECT_NEAR(tree_line(-33), 3670, 1);  // the same in the south
    EXPECT_NEAR(tree_line(70), -40, 1);    // the coast of the Arctic
}

TEST(Layering, AnglesAreRightToAFewThousandthsOfADegree) {
    test::GpuSnippet gpu("layering");
    const auto results =
        gpu.run("result = vec4(layering_angle_deg(cos(radians(float(x) / 10.0))));", 901, 1);
    std::vector<double> errors;
    for (int tenth = 0; tenth <= 900; ++tenth)
        errors.push_back(std::abs(results[static_cast<std::size_t>(tenth)].x - tenth / 10.0));
    test::print_accuracy("Slope, GPU against double", errors, "deg", 0.03);
    // A float's cosine of a tenth of a degree says no more.
    EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 0.03);
    EXPECT_LT(*std::max_element(errors.begin() + 50, errors.end()), 0.003);
}

TEST(Layering, SteepGroundShowsRock) {
    test::GpuSnippet gpu("layering");
    const auto results =
        gpu.run("result = vec4(layering_steepness(cos(radians(float(x))), 0.0));", 91, 1);
    for (int slope_deg = 0; slope_deg <= 90; ++slope_deg)
        EXPECT_NEAR(results[static_cast<std::size_t>(slope_deg)].x, smoothstep(33, 47, slope_deg),
                    1e-3)
            << slope_deg;
    gpu.values().set("layering.slope", "false");
    EXPECT_EQ(gpu.run("result = vec4(layering_steepness(0.1, 0.0));", 1, 1)[0].x, 0);
}

}  // namespace
}  // namespace relevo::test_layering
