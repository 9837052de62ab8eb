#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/units.h"
#include "effect/effect.h"
#include "support/gpu_snippet.h"
#include "support/support.h"

namespace relevo::test_tint {
namespace {

constexpr double kHalfAStep = 0.5 / 255;

/// Whether a colour is the one that people see in a legend.
void expect_colour(const glm::vec4& found, double red, double green, double blue) {
    EXPECT_NEAR(found.x, red, kHalfAStep);
    EXPECT_NEAR(found.y, green, kHalfAStep);
    EXPECT_NEAR(found.z, blue, kHalfAStep);
}

TEST(Tint, SlopesHaveTheColoursOfTheirTens) {
    test::GpuSnippet gpu("tint");
    const auto results = gpu.run("result = vec4(tint_of_slope(5.0 * float(x)), 1.0);", 19, 1);
    expect_colour(results[0], 0.965, 0.961, 0.937);
    expect_colour(results[6], 0.933, 0.604, 0.271);   // 30 degrees
    expect_colour(results[12], 0.353, 0.067, 0.314);  // 60, and all that is steeper
    expect_colour(results[18], 0.353, 0.067, 0.314);
    expect_colour(results[7], (0.933 + 0.851) / 2, (0.604 + 0.318) / 2, (0.271 + 0.184) / 2);
}

TEST(Tint, AspectsAreARingThatBeginsInTheNorth) {
    test::GpuSnippet gpu("tint");
    const auto results =
        gpu.run("result = vec4(tint_of_aspect(45.0 * float(x), y == 0 ? 30.0 : 0.0), 1.0);", 9, 2);
    expect_colour(results[0], 0.290, 0.435, 0.690);
    expect_colour(results[2], 0.361, 0.722, 0.478);  // east
    expect_colour(results[4], 0.949, 0.812, 0.290);  // south
    expect_colour(results[6], 0.812, 0.353, 0.373);  // west
    expect_colour(results[8], 0.290, 0.435, 0.690);  // round
    expect_colour(results[9 + 4], 0.851, 0.851, 0.831);
}

TEST(Tint, GroundFacesWhereItsNormalLeans) {
    test::GpuSnippet gpu("tint");
    const auto results = gpu.run(
        "float a = radians(90.0 * float(x));\n"
        "result = vec4(tint_of_aspect(tint_aspect_deg(0.5 * vec2(sin(a), cos(a))), 30.0), 1.0);",
        4, 1);
    expect_colour(results[0], 0.290, 0.435, 0.690);
    expect_colour(results[1], 0.361, 0.722, 0.478);
    expect_colour(results[2], 0.949, 0.812, 0.290);
    expect_colour(results[3], 0.812, 0.353, 0.373);
}

TEST(Tint, HeightsGoFromTheFirstColourToTheLast) {
    test::GpuSnippet gpu("tint");
    gpu.values().set("tint.low_m", "500");
    gpu.values().set("tint.high_m", "4000");
    const auto results =
        gpu.run("result = vec4(tint_of_height(500.0 + 500.0 * float(x)), 1.0);", 8, 1);
    expect_colour(results[0], 0.475, 0.643, 0.518);
    expect_colour(results[3], 0.910, 0.835, 0.620);
    expect_colour(results[7], 0.957, 0.949, 0.937);
    const auto beyond =
        gpu.run("result = vec4(tint_of_height(x == 0 ? 100.0 : 8000.0), 1.0);", 2, 1);
    expect_colour(beyond[0], 0.475, 0.643, 0.518);
    expect_colour(beyond[1], 0.957, 0.949, 0.937);
}

/// A ramp as plugin.json's legend shows it.
shader::ColourRamp ramp(const std::string& name) {
    const effect::Effect tint =
        effect::load_effect(test::source_dir() / "plugins" / "tint", test::source_dir());
    for (const shader::ColourRamp& one : tint.ramps())
        if (one.name == name) return one;
    ADD_FAILURE() << name;
    return {};
}

TEST(Tint, LegendsShowTheColoursOfTheShader) {
    test::GpuSnippet gpu("tint");
    const auto expect_ramp = [&](const std::string& name, const std::string& colour, double from,
                                 double step) {
        const shader::ColourRamp shown = ramp(name);
        ASSERT_GE(shown.colours.size(), 4u);
        const auto count = static_cast<int>(shown.colours.size());
        const auto results = gpu.run(
            fmt::format("result = vec4({}, 1.0);",
                        fmt::format(fmt::runtime(colour),
                                    fmt::format("({:.6f} + {:.6f} * float(x))", from, step))),
            count, 1);
        for (std::size_t k = 0; k < shown.colours.size(); ++k)
            expect_colour(results[k], shown.colours[k][0], shown.colours[k][1],
                          shown.colours[k][2]);
    };
    const shader::ColourRamp slope = ramp("tint_slope");
    EXPECT_EQ(slope.from.number, 0);
    EXPECT_EQ(slope.to.number, 60);
    EXPECT_EQ(slope.where, "tint.by");
    EXPECT_EQ(slope.where_word, "slope");
    expect_ramp("tint_slope", "tint_of_slope({})", 0, 10);
    EXPECT_TRUE(ramp("tint_aspect").is_ring);
    expect_ramp("tint_aspect", "tint_of_aspect({}, 30.0)", 0, 45);
    gpu.values().set("tint.low_m", "500");
    gpu.values().set("tint.high_m", "4000");
    EXPECT_EQ(ramp("tint_land").from.address, "tint.low_m");
    expect_ramp("tint_land", "tint_of_height({})", 500, 500);
    gpu.frame().height_range = {-3000, 1.0f / 7000, 1, 0};
    EXPECT_EQ(ramp("tint_sea").to.of, shader::ColourRamp::End::Of::Floor);
    expect_ramp("tint_sea", "tint_of_floor({})", -1e-3, -1000);
}

TEST(Tint, LitColoursAreThoseOfTheLegendAsLight) {
    test::GpuSnippet gpu("tint");
    const auto results = gpu.run("result = vec4(srgb_decoded(vec3(float(x) / 16.0)), 1.0);", 17, 1);
    for (int x = 0; x <= 16; ++x) {
        const double c = x / 16.0;
        const double linear = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
        EXPECT_NEAR(results[static_cast<std::size_t>(x)].x, linear, 1e-5) << x;
    }
}

}  // namespace
}  // namespace relevo::test_tint
