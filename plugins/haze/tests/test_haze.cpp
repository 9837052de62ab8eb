#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "support/gpu_snippet.h"
#include "support/support.h"

namespace relevo {
namespace {

/// Optical depth of green light: the integral of the extinction along the straight line, by
/// Simpson's rule over 2000 steps. What lies below the sea counts as on it.
double depth(double per_km, double scale_m, double eye_m, double height_m, double distance_m) {
    constexpr int kSteps = 2000;
    eye_m = std::max(eye_m, 0.0);
    height_m = std::max(height_m, 0.0);
    double sum = 0;
    for (int i = 0; i <= kSteps; ++i) {
        const double z = eye_m + (height_m - eye_m) * i / kSteps;
        const double weight = i == 0 || i == kSteps ? 1 : i % 2 == 1 ? 4 : 2;
        sum += weight * std::exp(-z / scale_m);
    }
    return 1e-3 * per_km * distance_m * sum / (3 * kSteps);
}

TEST(Haze, StrengthOnTheGpuIsTheIntegralsAlongTheRay) {
    // Eyes from a depression to above the highest summits, points likewise, 10 m to 300 km.
    test::GpuSnippet gpu("haze");
    constexpr std::array<double, 3> kBlue{0.661, 1.0, 1.957};
    std::vector<double> errors;
    for (const double per_km : {0.02, 1.0, 20.0}) {
        for (const double scale_m : {50.0, 2500.0, 100000.0}) {
            gpu.values().set("haze.density", fmt::format("{}", per_km));
            gpu.values().set("haze.scale_height", fmt::format("{}", scale_m));
            const auto results = gpu.run(
                "float eye = -400.0 + 400.0 * float(x % 26), height = -400.0 + 400.0 * float(x / "
                "26);\n"
                "float distance = 10.0 * pow(1.5, float(y));\n"
                "result = vec4(haze_strength_of(haze_depth(eye, height, distance)), 1.0);",
                26 * 24, 26);
            for (int y = 0; y < 26; ++y) {
                for (int x = 0; x < 26 * 24; x += 3) {
                    const double tau = depth(per_km, scale_m, -400.0 + 400 * (x % 26),
                                             -400.0 + 400 * (x / 26), 10 * std::pow(1.5, y));
                    const glm::vec4 found = results[static_cast<std::size_t>(y * 26 * 24 + x)];
                    for (std::size_t c = 0; c < 3; ++c) {
                        const double share = 1 + 0.6 * (kBlue[c] - 1);
                        errors.push_back(
                            std::abs(found[static_cast<int>(c)] - (1 - std::exp(-tau * share))));
                    }
                }
            }
        }
    }
    test::print_accuracy("haze strength, GPU against the integral", errors, "", 1e-3);
    EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 1e-3);
}

TEST(Haze, VisibilityIsTheDistanceOfTwoPercentContrast) {
    // Koschmieder: on level ground at height 0, what is left of a thing at the visibility is 2 %.
    test::GpuSnippet gpu("haze");
    gpu.values().set("haze.visibility", "20");
    gpu.values().set("haze.blue", "0");
    const auto results = gpu.run(
        "result = vec4(haze_strength_of(haze_depth(0.0, 0.0, 20000.0)), haze_extinction());", 1, 1);
    EXPECT_NEAR(results[0].x, 0.98, 1e-4);
    EXPECT_NEAR(results[0].w, 3.912e-3 / 20, 1e-8);
    gpu.values().set("haze.visibility", "0");
    gpu.values().set("haze.density", "0.5");
    EXPECT_NEAR(gpu.run("result = vec4(haze_extinction());", 1, 1)[0].x, 5e-4, 1e-8);
}

TEST(Haze, FogIsGreyAndAirIsBlue) {
    test::GpuSnippet gpu("haze");
    const char* body = "result = vec4(haze_strength_of(0.5), 1.0);";
    gpu.values().set("haze.blue", "0");
    const glm::vec4 fog = gpu.run(body, 1, 1)[0];
    EXPECT_EQ(fog.r, fog.g);
    EXPECT_EQ(fog.b, fog.g);
    gpu.values().set("haze.blue", "1");
    const glm::vec4 air = gpu.run(body, 1, 1)[0];
    EXPECT_LT(air.r, fog.g);
    EXPECT_GT(air.b, fog.g);
    // Rayleigh: the fourth power of the wavelengths 610, 550 and 465 nm.
    EXPECT_NEAR(std::log(1 - air.r) / std::log(1 - air.g), std::pow(550.0 / 610, 4), 1e-3);
    EXPECT_NEAR(std::log(1 - air.b) / std::log(1 - air.g), std::pow(550.0 / 465, 4), 1e-3);
}

}  // namespace
}  // namespace relevo
