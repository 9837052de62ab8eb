// Patterns on the ground keep their place far from the DEM's centre: shaders/lib/repeats.glsl.
#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <glm/mat2x2.hpp>
#include <gtest/gtest.h>

#include "render/frame_block.h"
#include "support/gpu_snippet.h"
#include "support/support.h"

namespace relevo::render::test_repeats {
namespace {

constexpr int kColumns = 40, kRows = 30;

/// From an eye: its anchor, as make_frame_block() has it.
void look_from(test::GpuSnippet& gpu, const glm::dvec2& eye_m) {
    const glm::dvec2 anchor = eye_anchor(eye_m);
    gpu.frame().eye_anchor = glm::vec4(anchor, eye_m - kEyeAnchor_m * anchor);
}

/// GLSL: a point of a pixel, near the eye.
const char* const kPlace =
    "vec2 anchored_m = vec2(3.1 * float(x), 2.7 * float(y)) + frame.eye_anchor.zw;\n";

glm::dvec2 place_of(const glm::dvec2& eye_m, int column, int row) {
    return eye_m + glm::dvec2(3.1F * static_cast<float>(column), 2.7F * static_cast<float>(row));
}

/// Distance of two coordinates of a pattern that repeats at whole numbers.
double apart(double a, double b) {
    return std::abs(a - b - std::round(a - b));
}

TEST(Repeats, KeepTheirPlaceOverTheWholeEarth) {
    test::GpuSnippet gpu("", "lib/repeats.glsl");
    const float per_m = 1 / 3.7F;
    const glm::mat2 turn(0.7986F * per_m, 0.6018F * per_m, -0.6018F * per_m, 0.7986F * per_m);
    const std::string body =
        std::string(kPlace) +
        fmt::format(
            "vec2 even = ground_repeats(anchored_m, vec2({0:.9g}));\n"
            "vec2 turned = ground_repeats(anchored_m, mat2({1:.9g}, {2:.9g}, {3:.9g}, {4:.9g}));\n"
            "result = vec4(fract(even), fract(turned));\n",
            per_m, turn[0][0], turn[0][1], turn[1][0], turn[1][1]);
    for (const double away_m : {0.0, 8.5e3, 6.5e5, 6.3e6}) {
        std::vector<double> errors_mm;
        // Eyes on either side of where the anchor changes.
        for (const double beside_m : {0.0, 517.3, 1023.9, 1024.1, 1500.7}) {
            const glm::dvec2 eye_m(away_m + beside_m, -0.4 * away_m - beside_m);
            look_from(gpu, eye_m);
            const auto results = gpu.run(body, kColumns, kRows);
            for (int row = 0; row < kRows; ++row)
                for (int column = 0; column < kColumns; ++column) {
                    const glm::dvec2 at = place_of(eye_m, column, row);
                    const glm::vec4 seen =
                        results[static_cast<std::size_t>(row * kColumns + column)];
                    const glm::dvec2 even = double{per_m} * at, turned = glm::dmat2(turn) * at;
                    for (const double miss : {apart(seen.x, even.x), apart(seen.y, even.y),
                                              apart(seen.z, turned.x), apart(seen.w, turned.y)})
                        errors_mm.push_back(1e3 * miss / per_m);
                }
        }
        test::print_accuracy(
            fmt::format("a pattern of 3.7 m, {:g} km from the centre", away_m / 1e3), errors_mm,
            "mm", 1);
        EXPECT_LT(*std::ranges::max_element(errors_mm), 1) << away_m;
    }
}

TEST(Repeats, CellsHaveTheirNumbersFromEveryEye) {
    test::GpuSnippet gpu("", "lib/repeats.glsl");
    const float per_m = 1 / 2.3F;
    const std::string body =
        std::string(kPlace) + fmt::format(
                                  "vec2 within;\n"
                                  "ivec2 cell = ground_cell(anchored_m, mat2({:.9g}), within);\n"
                                  "result = vec4(vec2(cell % 4096), within);\n",
                                  per_m);
    double worst = 0;
    for (const double beside_m : {0.0, 1023.9, 1024.1}) {
        const glm::dvec2 eye_m(6.5e5 + beside_m, 2.5e5);
        look_from(gpu, eye_m);
        const auto results = gpu.run(body, kColumns, kRows);
        for (int row = 0; row < kRows; ++row)
            for (int column = 0; column < kColumns; ++column) {
                const glm::dvec2 at = double{per_m} * place_of(eye_m, column, row);
                const glm::vec4 seen = results[static_cast<std::size_t>(row * kColumns + column)];
                for (int i = 0; i < 2; ++i) {
                    const double numbered =
                        std::fmod(std::floor(at[i]), 4096) + (at[i] - std::floor(at[i]));
                    worst = std::max(worst, std::abs(seen[i] + double{seen[i + 2]} - numbered));
                }
            }
    }
    fmt::print("[ accuracy ] cells of 2.3 m, 650 km from the centre: worst {:.5f} of a cell\n",
               worst);
    EXPECT_LT(worst, 4e-4);
}

}  // namespace
}  // namespace relevo::render::test_repeats
