#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/text.h"
#include "effect/effect.h"
#include "light/fields.h"
#include "render/drawn.h"
#include "support/gpu_snippet.h"
#include "support/support.h"

namespace relevo::test_trees {
namespace {

constexpr double kHighest_m = 28;
constexpr int kSide_px = 200;

effect::Effect trees() {
    return effect::load_effect(test::source_dir() / "plugins/trees", test::source_dir() / "data");
}

/// A plain in Switzerland at 800 m, which is forest.
dem::Heightfield plain() {
    return test::field_of(129, 129, {500000, 40, 0, 5200000, 0, -40}, "EPSG:32632",
                          [](int, int) { return 800.0; });
}

test::Drawn forest(const std::vector<std::pair<std::string, std::string>>& settings) {
    return {plain(), {}, kSide_px, kSide_px, 0, {trees()}, settings};
}

/// Mean of a square of the ground in the middle of a picture from above, sRGB of 8 bits.
std::array<double, 3> colour_from(test::Drawn& drawn, double above_m,
                                  const char* utc = "2026-06-21T10:00Z") {
    drawn.shine(utc);
    drawn.stand(0.5, 0.5, 800 + above_m, 0, -90);
    drawn.renderer().render_frame(drawn.terrain(), drawn.ground(), drawn.frame());
    const image::Image8 picture = drawn.renderer().read_output();
    const double pixel_rad = 2 * std::tan(radians(test::Drawn::kFov_deg / 2)) / kSide_px;
    const int half = std::min(kSide_px / 2, static_cast<int>(170 / (above_m * pixel_rad)));
    std::array<double, 3> sum{};
    for (int y = kSide_px / 2 - half; y < kSide_px / 2 + half; ++y)
        for (int x = kSide_px / 2 - half; x < kSide_px / 2 + half; ++x)
            for (int c = 0; c < 3; ++c)
                sum[static_cast<std::size_t>(c)] += picture.at(x, y, c);
    for (double& each : sum)
        each /= 4.0 * half * half;
    return sum;
}

double step(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    double most = 0;
    for (std::size_t c = 0; c < 3; ++c)
        most = std::max(most, std::abs(a[c] - b[c]));
    return most;
}

TEST(Trees, BecomeCoverOfTheSameColour) {
    test::Drawn drawn = forest({});
    const double pixel_rad = 2 * std::tan(radians(test::Drawn::kFov_deg / 2)) / kSide_px;
    const double range_m = kHighest_m / (4 * pixel_rad);
    const std::array<double, 3> drawn_all = colour_from(drawn, 0.58 * range_m);
    std::array<double, 3> before = drawn_all;
    double worst = 0;
    for (const double share : {0.64, 0.7, 0.77, 0.85, 0.93, 1.02}) {
        const std::array<double, 3> here = colour_from(drawn, share * range_m);
        worst = std::max(worst, step(before, here));
        fmt::print("[ trees ] at {:.2f} of the range: {:.1f} {:.1f} {:.1f}\n", share, here[0],
                   here[1], here[2]);
        before = here;
    }
    fmt::print(
        "[ trees ] from all trees to cover alone: {:.1f} of 255, at most {:.1f} for a tenth "
        "of the distance; green {:.1f}\n",
        step(drawn_all, before), worst, before[1]);
    EXPECT_LT(worst, 3);
    EXPECT_LT(step(drawn_all, before), 4);
}

/// The same under a low sun, whose shadows fill most of the ground.
TEST(Trees, ShadowsEndInGroundAndCoverOfTheSameColour) {
    for (const char* const utc : {"2026-06-21T06:00Z", "2026-06-21T16:30Z"}) {
        test::Drawn drawn = forest({});
        const double pixel_rad = 2 * std::tan(radians(test::Drawn::kFov_deg / 2)) / kSide_px;
        const double range_m = kHighest_m / (4 * pixel_rad);
        std::array<double, 3> before{}, first{};
        double worst = 0;
        for (const double share : {0.45, 0.58, 0.64, 0.7, 0.77, 0.85, 0.93, 1.02}) {
            const std::array<double, 3> here = colour_from(drawn, share * range_m, utc);
            if (share == 0.45)
                first = here;
            else
                worst = std::max(worst, step(before, here));
            fmt::print("[ trees ] {} at {:.2f} of the range: {:.1f} {:.1f} {:.1f}\n", utc, share,
                       here[0], here[1], here[2]);
            before = here;
        }
        fmt::print("[ trees ] from shadows of all trees to none: {:.1f} of 255, a step {:.1f}\n",
                   step(first, before), worst);
        EXPECT_LT(worst, 4);
        EXPECT_LT(step(first, before), 8);
    }
}

TEST(Trees, LevelsAreEquallyBright) {
    test::Drawn drawn = forest({});
    const double pixel_rad = 2 * std::tan(radians(test::Drawn::kFov_deg / 2)) / kSide_px;
    const double sprites_m = kHighest_m / (80 * pixel_rad);
    const std::array<double, 3> meshes = colour_from(drawn, 0.88 * sprites_m),
                                sprites = colour_from(drawn, 1.15 * sprites_m);
    fmt::print("[ trees ] from meshes to sprites: {:.1f} of 255; {::.1f} {::.1f}\n",
               step(meshes, sprites), meshes, sprites);
    EXPECT_LT(step(meshes, sprites), 4);
}

TEST(Trees, ThereAreNoneAboveTheTreeLine) {
    const auto colour = [](const std::vector<std::pair<std::string, std::string>>& settings) {
        test::Drawn drawn = forest(settings);
        return colour_from(drawn, 500);
    };
    const std::array<double, 3> bare = colour({{"trees.density", "0"}});
    EXPECT_LT(step(colour({{"trees.line_m", "-3000"}}), bare), 0.01);
    EXPECT_GT(step(colour({}), bare), 10);
}

TEST(Trees, ConstantsAreThoseOfTheManifest) {
    const effect::Effect effect = trees();
    ASSERT_EQ(effect.manifest.instances.size(), 1U);
    EXPECT_EQ(effect.manifest.instances[0].height_m, kHighest_m);
    const std::string glsl = read_text(test::source_dir() / "plugins/trees/trees.glsl", "test");
    EXPECT_NE(
        glsl.find(fmt::format("trees_spacing_m = {:.1f};", effect.manifest.instances[0].spacing_m)),
        std::string::npos);
    EXPECT_NE(glsl.find(fmt::format("trees_highest_m = {:.1f};", kHighest_m)), std::string::npos);
    EXPECT_NE(
        glsl.find(fmt::format("trees_light = {:.1f};", effect.manifest.instances[0].light_through)),
        std::string::npos);
}

constexpr double kPi_ = 3.14159265358979;

TEST(Crown, AreaAndGapsAreThoseOfAnEllipsoid) {
    test::GpuSnippet gpu("", "lib/crown.glsl");
    const auto results = gpu.run(
        "float c = cos(radians(10.0 * float(x)));\n"
        "Crown crown = Crown(12.0, 4.0, 0.2);\n"
        "result = vec4(crown_area_m2(crown, c), crown_gap(0.25 * float(x), 0.5),\n"
        "              crown_cone_area_m2(crown, c), 0.0);",
        9, 1);
    for (int x = 0; x < 9; ++x) {
        // An ellipsoid's shadow on level ground: pi w/2 times the half axis along the light.
        const double zenith = 10 * x * kPi_ / 180, filled = 0.25 * x;
        const double along = std::hypot(2.0, 6.0 * std::tan(zenith));
        const auto& result = results[static_cast<std::size_t>(x)];
        EXPECT_NEAR(result.x / (kPi_ * 2.0 * along), 1, 1e-3) << x;
        const double order = std::max(1 + 1.35 * 0.5, filled);
        EXPECT_NEAR(result.y, std::pow(1 - filled / order, order), 1e-5) << x;
        // A cone's: the base, and the triangle of both tangents from the tip less its part of that.
        const double tip = std::max(12 * std::tan(zenith), 2.0);
        const double angle = std::acos(2 / tip);
        const double cone = kPi_ * 4 + 2 * std::sqrt(tip * tip - 4) - 4 * angle;
        EXPECT_NEAR(result.z / cone, 1, 2e-3) << x;
    }
}

/// Whether the sun's ray through a point of the plane across its rays meets a cone of radius 2 and
/// height 12 that stands on the plain, by steps. @param at  across the rays, and upwards across
/// them
bool meets_cone(double across, double at, double elevation) {
    const double c = std::sin(elevation), s = std::cos(elevation);
    for (double t = -30; t < 30; t += 0.005) {
        const double x = -at * c + t * s, z = at * s + t * c;  // x: towards the sun
        if (z >= 0 && z <= 12 && std::hypot(x, across) <= 2 * (1 - z / 12)) return true;
    }
    return false;
}

TEST(Crown, OutlinesAreThoseThatRaysFind) {
    test::GpuSnippet gpu("", "lib/crown.glsl");
    constexpr int kSteps = 24;
    for (const double elevation_deg : {15.0, 40.0, 85.0}) {
        const double elevation = elevation_deg * kPi_ / 180;
        const auto results =
            gpu.run(fmt::format("vec2 ends = crown_ends(2.0, 12.0, 1.0, {0:.8f});\n"
                                "float at = mix(ends.x, ends.y, (float(x) + 0.5) / {1}.0);\n"
                                "CrownSeen seen = crown_seen(2.0, 12.0, 1.0, {0:.8f}, at);\n"
                                "result = vec4(seen.half_width_m, at, seen.towards_m, 0.0);",
                                std::sin(elevation), kSteps),
                    kSteps, 1);
        for (const auto& seen : results) {
            EXPECT_TRUE(meets_cone(seen.x - 0.03, seen.y, elevation)) << seen.y;
            EXPECT_FALSE(meets_cone(seen.x + 0.03, seen.y, elevation)) << seen.y;
        }
    }
}

}  // namespace
}  // namespace relevo::test_trees
