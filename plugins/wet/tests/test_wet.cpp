#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "support/gpu_snippet.h"
#include "support/support.h"

namespace relevo::test_wet {
namespace {

constexpr std::array<double, 4> kDiffuse{0.60, 0.75, 0.42, 0.92};  // sand, grass, rock, snow
constexpr std::array<double, 4> kSpecular{0.16, 0.08, 0.45, 0.12};

double blend(const std::array<double, 4>& values, int first, int second, double weight) {
    return weight * values[static_cast<std::size_t>(first)] +
           (1 - weight) * values[static_cast<std::size_t>(second)];
}

TEST(Wet, DiffuseFallsAndSpecularRisesByMaterial) {
    // Columns: 16 pairs of materials; rows: 5 wetnesses x 5 weights.
    std::vector<double> errors;
    for (int wetness = 0; wetness <= 4; ++wetness) {
        test::GpuSnippet gpu("wet");
        gpu.values().set("wet.wetness", fmt::format("{}", 0.25 * wetness));
        const auto results = gpu.run(
            "Surface s;\n"
            "s.material = ivec2(x % 4, x / 4);\n"
            "s.material_weight = vec2(0.25 * float(y), 1.0 - 0.25 * float(y));\n"
            "s.height_m = 100.0;\n"
            "s.diffuse = s.ambient = vec3(0.5);\n"
            "s.specular = vec3(0.02);\n"
            "s.shininess = 12.0;\n"
            "wet_on_material(s);\n"
            "result = vec4(s.diffuse.g, s.specular.g, s.ambient.g, s.shininess / 1000.0);",
            16, 5);
        for (int y = 0; y < 5; ++y) {
            for (int x = 0; x < 16; ++x) {
                const double weight = 0.25 * y, amount = 0.25 * wetness;
                const double kept = 1 + amount * (blend(kDiffuse, x % 4, x / 4, weight) - 1);
                const glm::vec4 found = results[static_cast<std::size_t>(y * 16 + x)];
                errors.push_back(std::abs(found.x - 0.5 * kept));
                errors.push_back(
                    std::abs(found.y - (0.02 + amount * blend(kSpecular, x % 4, x / 4, weight))));
                errors.push_back(std::abs(found.z - 0.5 * kept));
                errors.push_back(std::abs(found.w - (12 + amount * (60 - 12)) / 1000));
            }
        }
    }
    test::print_accuracy("wet factors, GPU against double", errors, "", 1e-3);
    EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 1e-3);
}

TEST(Wet, RockChangesMost) {
    EXPECT_EQ(*std::min_element(kDiffuse.begin(), kDiffuse.end()), kDiffuse[2]);
    EXPECT_EQ(*std::max_element(kSpecular.begin(), kSpecular.end()), kSpecular[2]);
    test::GpuSnippet gpu("wet");
    const auto results = gpu.run(
        "result = vec4(wet_of(wet_diffuse, ivec2(x, x), vec2(1.0, 0.0)),\n"
        "              wet_of(wet_specular, ivec2(x, x), vec2(1.0, 0.0)), 0.0, 0.0);",
        4, 1);
    for (std::size_t material : {0u, 1u, 3u}) {
        EXPECT_LT(results[2].x, results[material].x);
        EXPECT_GT(results[2].y, results[material].y);
    }
}

TEST(Wet, TheShoreIsWetUpToItsHeightAndDriesAbove) {
    test::GpuSnippet gpu("wet");
    gpu.values().set("wet.where", "shore");
    gpu.values().set("wet.shore_m", "10");
    gpu.values().set("wet.shore_fade_m", "4");
    const auto results = gpu.run("result = vec4(wet_amount_at(0.1 * float(x)));", 201, 1);
    std::vector<double> errors;
    for (int x = 0; x <= 200; ++x) {
        const double t = std::clamp((0.1 * x - 10) / 4, 0.0, 1.0);
        errors.push_back(
            std::abs(results[static_cast<std::size_t>(x)].x - (1 - t * t * (3 - 2 * t))));
    }
    test::print_accuracy("wet shore, GPU against double", errors, "", 1e-3);
    EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 1e-3);
}

TEST(Wet, WaterMirrorsAsFresnelSays) {
    // Fresnel's equations for unpolarised light and an index of 1.33. Schlick's is within 0.04 up
    // to 75 degrees; from 79 on the plugin holds it at 0.35.
    test::GpuSnippet gpu("wet");
    const auto results = gpu.run("result = vec4(wet_mirrored(cos(radians(float(x)))));", 76, 1);
    for (int deg = 0; deg <= 75; ++deg) {
        const double ci = std::cos(deg * 3.14159265358979 / 180);
        const double ct = std::sqrt(1 - (1 - ci * ci) / (1.33 * 1.33));
        const double s = (ci - 1.33 * ct) / (ci + 1.33 * ct),
                     p = (ct - 1.33 * ci) / (ct + 1.33 * ci);
        EXPECT_NEAR(results[static_cast<std::size_t>(deg)].x, 0.5 * (s * s + p * p), 0.04) << deg;
    }
}

}  // namespace
}  // namespace relevo::test_wet
