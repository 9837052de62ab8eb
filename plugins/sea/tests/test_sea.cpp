#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/units.h"
#include "support/gpu_snippet.h"
#include "support/support.h"

namespace relevo {
namespace {

double worst(const std::vector<double>& errors, std::string_view what) {
    test::print_accuracy(what, errors, "", 1e-3);
    return *std::max_element(errors.begin(), errors.end());
}

TEST(Sea, LiesUpToItsLevel) {
    test::GpuSnippet gpu("sea");
    gpu.values().set("sea.level_m", "12.5");
    const auto results = gpu.run("result = vec4(sea_share(0.1 * float(x)));", 200, 1);
    for (int x = 0; x <= 125; ++x)
        EXPECT_EQ(results[static_cast<std::size_t>(x)].x, 1) << x;
    for (int x = 129; x < 200; ++x)
        EXPECT_EQ(results[static_cast<std::size_t>(x)].x, 0) << x;
}

TEST(Sea, SwallowsLightByDepthAndColour) {
    // Pope and Fry's table at 610, 550 and 465 nm, and the spectrum of yellow substance.
    constexpr std::array<double, 3> kWater{0.2644, 0.0565, 0.0101};
    constexpr std::array<double, 3> kWavelength_nm{610, 550, 465};
    constexpr std::array<double, 3> kDeep{0.004, 0.026, 0.036};
    std::vector<double> errors;
    for (const double yellow : {0.0, 0.2, 3.0}) {
        test::GpuSnippet gpu("sea");
        gpu.values().set("sea.yellow", fmt::format("{}", yellow));
        const auto results =
            gpu.run("result = vec4(sea_albedo(vec3(0.5), 0.25 * float(x)), 0.0);", 400, 1);
        for (int x = 0; x < 400; ++x) {
            for (std::size_t c = 0; c < 3; ++c) {
                const double a = kWater[c] + yellow * std::exp(-0.014 * (kWavelength_nm[c] - 440));
                errors.push_back(
                    std::abs(results[static_cast<std::size_t>(x)][static_cast<int>(c)] -
                             (kDeep[c] + 0.5 * std::exp(-2 * a * 0.25 * x))));
            }
        }
    }
    EXPECT_LT(worst(errors, "sea albedo, GPU against double"), 1e-3);
}

TEST(Sea, MirrorsAsBrunetonsRoughWater) {
    std::vector<double> errors;
    for (const double wind : {0.0, 5.0, 20.0}) {
        test::GpuSnippet gpu("sea");
        gpu.values().set("sea.wind_m_s", fmt::format("{}", wind));
        const auto results = gpu.run("result = vec4(sea_mirrored(cos(radians(float(x)))));", 91, 1);
        for (int x = 0; x <= 90; ++x) {
            const double slope = std::sqrt((0.003 + 0.00512 * wind) / 2);
            const double expected =
                0.02 + 0.98 * std::pow(1 - std::cos(radians(x)), 5 * std::exp(-2.69 * slope)) /
                           (1 + 22.7 * std::pow(slope, 1.5));
            errors.push_back(std::abs(results[static_cast<std::size_t>(x)].x - expected));
        }
        // Straight down 2 %, as Fresnel's equations have it for a refractive index of 1.33.
        EXPECT_NEAR(results[0].x, std::pow(0.33 / 2.33, 2), 1e-3);
    }
    EXPECT_LT(worst(errors, "sea mirror, GPU against double"), 1e-3);
}

TEST(Sea, GlittersAsCoxAndMunksSlopes) {
    // Straight above, the sun behind the eye: E F p(0) / (4 mu^2), p(0) = 1 / (pi variance), in
    // units of a white ground's E / pi.
    for (const double wind : {1.0, 5.0, 15.0}) {
        test::GpuSnippet gpu("sea");
        gpu.values().set("sea.wind_m_s", fmt::format("{}", wind));
        const glm::vec4 found = gpu.run("result = vec4(sea_glitter(1.0), 0.0, 0.0);", 1, 1)[0];
        const double variance = 0.003 + 0.00512 * wind;
        EXPECT_NEAR(found.y / (0.02 / (4 * variance)), 1, 1e-3) << wind;
        // A ray turns by twice a wave's slope: Phong's lobe is as wide as the Gaussian there.
        const double slope = 0.5 * std::sqrt(variance);
        EXPECT_NEAR(std::pow(std::cos(2 * slope), found.x), std::exp(-slope * slope / variance),
                    0.01)
            << wind;
    }
}

TEST(Sea, CoversItsFloorAndNotTheLand) {
    test::GpuSnippet gpu("sea");
    gpu.frame().height_range = {-100, 0.001f, 2, 0};
    const auto results = gpu.run(
        "VertexFrame v;\n"
        "v.height_m = 10.0 * float(x) - 50.0;\n"
        "v.up = vec3(0.0, 0.6, 0.8);\n"
        "vec3 position = vec3(1.0, 2.0, 3.0);\n"
        "position += sea_lift_m(v);\n"
        "result = vec4(position, 0.0);",
        11, 1);
    for (int x = 0; x <= 10; ++x) {
        const double up = 2 * std::max(50.0 - 10 * x, 0.0);  // heights are drawn twice as high
        const glm::vec4 found = results[static_cast<std::size_t>(x)];
        EXPECT_FLOAT_EQ(found.x, 1);
        EXPECT_NEAR(found.y, 2 + 0.6 * up, 1e-4);
        EXPECT_NEAR(found.z, 3 + 0.8 * up, 1e-4);
    }
}

}  // namespace
}  // namespace relevo
