#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "base/units.h"
#include "support/gpu_snippet.h"
#include "support/support.h"

namespace relevo::test_bump {
namespace {

double smoothstep(double from, double to, double x) {
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

/// A normal by column (azimuth) and row (slope 0 to 85 degrees), as in kNormal.
glm::dvec3 normal_of(int x, int y) {
    const double azimuth = radians(10.0 * x), slope = radians(5.0 * y);
    return {std::sin(slope) * std::sin(azimuth), std::sin(slope) * std::cos(azimuth),
            std::cos(slope)};
}
constexpr const char* kNormal =
    "float azimuth = radians(10.0 * float(x)), slope = radians(5.0 * float(y));\n"
    "vec3 normal = vec3(sin(slope) * vec2(sin(azimuth), cos(azimuth)), cos(slope));\n";
constexpr int kColumns = 36, kRows = 18;

TEST(Bump, TangentFrameIsOrthonormalAndRunsEast) {
    // The reference: Gram and Schmidt's of east, and the cross product.
    test::GpuSnippet gpu("bump");
    std::vector<double> errors;
    for (const bool bitangent : {false, true}) {
        const auto results = gpu.run(std::string("//@ include lib/tangent.glsl\n") + kNormal +
                                         "vec3 tangent = tangent_of(normal);\n" +
                                         (bitangent ? "result = vec4(cross(normal, tangent), 0.0);"
                                                    : "result = vec4(tangent, 0.0);"),
                                     kColumns, kRows);
        for (int y = 0; y < kRows; ++y) {
            for (int x = 0; x < kColumns; ++x) {
                const glm::dvec3 n = normal_of(x, y);
                const glm::dvec3 tangent = normalize(glm::dvec3(1, 0, 0) - n.x * n);
                const glm::dvec3 expected = bitangent ? cross(n, tangent) : tangent;
                const glm::dvec3 found(results[static_cast<std::size_t>(y * kColumns + x)]);
                errors.push_back(length(found - expected));
                errors.push_back(std::abs(dot(found, n)));
                errors.push_back(std::abs(length(found) - 1));
                if (bitangent) {
                    EXPECT_GE(found.y, -1e-6) << "the bitangent runs north";
                }
            }
        }
    }
    test::print_accuracy("tangent frame, GPU against double", errors, "", 1e-3);
    EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 1e-3);
}

TEST(Bump, TheNormalIsTheMapsInTheTangentFrame) {
    for (const double strength : {0.0, 1.0, 2.5}) {
        test::GpuSnippet gpu("bump");
        gpu.values().set("bump.strength", fmt::format("{}", strength));
        const auto results = gpu.run(
            std::string("//@ include lib/tangent.glsl\n") + kNormal +
                "vec3 tangent = tangent_of(normal);\n"
                "vec3 map = normalize(vec3(0.4, -0.3, 0.8));\n"
                "result = vec4(bump_normal(map, tangent, cross(normal, tangent), normal), 0.0);",
            kColumns, kRows);
        std::vector<double> errors;
        const glm::dvec3 map = normalize(glm::dvec3(0.4, -0.3, 0.8));
        for (int y = 0; y < kRows; ++y) {
            for (int x = 0; x < kColumns; ++x) {
                const glm::dvec3 n = normal_of(x, y);
                const glm::dvec3 tangent = normalize(glm::dvec3(1, 0, 0) - n.x * n);
                const glm::dvec3 expected =
                    normalize(strength * (map.x * tangent + map.y * cross(n, tangent)) + map.z * n);
                errors.push_back(length(
                    glm::dvec3(results[static_cast<std::size_t>(y * kColumns + x)]) - expected));
            }
        }
        test::print_accuracy("bumped normal, GPU against double", errors, "", 1e-3);
        EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 1e-3);
    }
}

TEST(Bump, LitOnlyWhereGroundAndBumpBothFaceTheSun) {
    // Columns: cosine of the ground's angle, rows: of the bump's, both -1 to 1.
    struct Case {
        const char* correction;
        double (*factor)(double cosine);
    };
    for (const Case& c :
         {Case{"none", [](double) { return 1.0; }},
          Case{"abrupt", [](double cosine) { return cosine > 0 ? 1.0 : 0.0; }},
          Case{"smooth", [](double cosine) { return smoothstep(0, 0.12, cosine); }}}) {
        test::GpuSnippet gpu("bump");
        gpu.values().set("bump.correction", c.correction);
        constexpr int n = 201;
        const auto results = gpu.run(
            "Surface s;\n"
            "float ground = float(x - 100) / 100.0, bumped = float(y - 100) / 100.0;\n"
            "s.geometric_normal = vec3(sqrt(1.0 - ground * ground), 0.0, ground);\n"
            "s.normal = vec3(0.0, sqrt(1.0 - bumped * bumped), bumped);\n"
            "float factor = 1.0;\n"
            "bump_on_facing(s, vec3(0.0, 0.0, 1.0), factor);\n"
            "result = vec4(factor);",
            n, n);
        std::vector<double> errors;
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x)
                errors.push_back(
                    std::abs(results[static_cast<std::size_t>(y * n + x)].x -
                             c.factor((x - 100) / 100.0) * c.factor((y - 100) / 100.0)));
        test::print_accuracy(fmt::format("facing factor, {}", c.correction), errors, "", 1e-3);
        EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 1e-3) << c.correction;
    }
}

// ---- relief between the posts

/// Slopes of the relief over a square of the ground, where posts are 30 m apart.
/// @param step_m, pixel_m  from one to the next, and the width of a pixel
std::vector<glm::vec4> relief(int side, double step_m, double pixel_m, double east_m = 0) {
    test::GpuSnippet gpu("bump");
    gpu.frame().normal_texels_per_m = 1.0f / 30;
    return gpu.run(
        fmt::format("vec2 at = vec2({:.9f} + {:.9f} * float(x), {:.9f} * float(y));\n"
                    "result = vec4(bump_relief_slope(at, {:.9f}, {:.9f} / 30.0), 0.0, 0.0);",
                    east_m, step_m, step_m, pixel_m, pixel_m),
        side, side);
}

double variance(const std::vector<glm::vec4>& slopes) {
    double sum = 0;
    for (const glm::vec4& slope : slopes)
        sum += (slope.x * slope.x + slope.y * slope.y) / 2.0 / static_cast<double>(slopes.size());
    return sum;
}

TEST(Bump, ReliefIsNearTheEyeAlone) {
    const double at_0_1 = variance(relief(400, 1.7, 0.1)), at_0_4 = variance(relief(400, 1.7, 0.4)),
                 at_2 = variance(relief(400, 1.7, 2)), at_5 = variance(relief(400, 1.7, 5));
    fmt::print(
        "[ accuracy ] variance of slopes at pixels of 0.1, 0.4, 2 and 5 m on posts 30 m "
        "apart: {:.3f}, {:.3f}, {:.3f}, {:g}\n",
        at_0_1, at_0_4, at_2, at_5);
    EXPECT_NEAR(at_0_1, 1, 0.1);
    EXPECT_GT(at_0_4, 0.7);
    EXPECT_LT(at_2, 0.5 * at_0_4);
    EXPECT_GT(at_2, 0);
    EXPECT_EQ(at_5, 0);
}

TEST(Bump, ReliefLeansNoWay) {
    // So that ground has the light that the DEM's slopes give it, and a walk sees no plane tilt.
    glm::dvec2 mean{};
    const std::vector<glm::vec4> slopes = relief(600, 2.3, 0.1);
    for (const glm::vec4& slope : slopes)
        mean += glm::dvec2(slope.x, slope.y) / static_cast<double>(slopes.size());
    fmt::print("[ accuracy ] mean slope {:.4f}, {:.4f}\n", mean.x, mean.y);
    EXPECT_LT(length(mean), 0.01);
}

TEST(Bump, ReliefIsNarrowerThanThePosts) {
    // Means over squares of two posts, which the DEM knows better.
    constexpr int kSide = 640, kBlock = 40;
    const std::vector<glm::vec4> slopes = relief(kSide, 1.5, 0.1);
    std::vector<glm::vec4> means((kSide / kBlock) * (kSide / kBlock));
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
            means[static_cast<std::size_t>((y / kBlock) * (kSide / kBlock) + x / kBlock)] +=
                slopes[static_cast<std::size_t>(y * kSide + x)] / float{kBlock * kBlock};
    fmt::print("[ accuracy ] variance of means over two posts: {:.4f} of {:.3f}\n", variance(means),
               variance(slopes));
    EXPECT_LT(variance(means), 0.02 * variance(slopes));
}

TEST(Bump, ReliefRepeatsNowhere) {
    // Against itself moved by anything up to 3 km.
    const std::vector<glm::vec4> here = relief(120, 1.1, 0.1);
    double worst = 0;
    for (int east_m = 60; east_m <= 3000; east_m += 210) {
        const std::vector<glm::vec4> there = relief(120, 1.1, 0.1, east_m);
        double product = 0;
        for (std::size_t i = 0; i < here.size(); ++i)
            product += (here[i].x * there[i].x + here[i].y * there[i].y) / 2.0;
        worst = std::max(worst, std::abs(product) / (variance(here) * double(here.size())));
    }
    fmt::print("[ accuracy ] greatest correlation with itself elsewhere: {:.3f}\n", worst);
    EXPECT_LT(worst, 0.15);
}

// ---- gullies

/// Slopes of gullies over a square of a hillside that falls evenly, posts 30 m apart.
/// @param fall  tangent of its slope, and which way is down, as GLSL
std::vector<glm::vec4> gullies(int side, double step_m, double pixel_m, const std::string& fall) {
    test::GpuSnippet gpu("bump");
    gpu.frame().normal_texels_per_m = 1.0f / 30;
    return gpu.run(fmt::format("vec2 at = {:.9f} * vec2(x, y);\n"
                               "result = vec4(bump_gully_slope(at, {}, {:.9f}, 0.0), 0.0, 0.0);",
                               step_m, fall, pixel_m),
                   side, side);
}

TEST(Bump, GulliesLieAcrossSlopesAndLeanNoWay) {
    // Down to the east: the greatest slopes run north and south; finer ones, which start on the
    // sides of those, turn aside.
    const std::vector<glm::vec4> steep = gullies(500, 7.3, 1, "vec2(0.6, 0.0)");
    glm::dvec2 mean{}, square{};
    for (const glm::vec4& slope : steep) {
        mean += glm::dvec2(slope.x, slope.y) / static_cast<double>(steep.size());
        square +=
            glm::dvec2(slope.x * slope.x, slope.y * slope.y) / static_cast<double>(steep.size());
    }
    fmt::print(
        "[ accuracy ] gullies: mean slope {:.4f} {:.4f}, its root mean square {:.3f} {:.3f}\n",
        mean.x, mean.y, std::sqrt(square.x), std::sqrt(square.y));
    EXPECT_LT(length(mean), 0.01);
    EXPECT_GT(square.y, 4 * square.x);
    EXPECT_NEAR(std::sqrt(square.y), 0.198, 0.025);
}

TEST(Bump, LevelGroundAndWidePixelsHaveNoGullies) {
    const double steep = variance(gullies(200, 7.3, 1, "vec2(0.6, 0.0)"));
    EXPECT_GT(steep, 0.01);
    EXPECT_EQ(variance(gullies(200, 7.3, 1, "vec2(0.0)")), 0);
    EXPECT_EQ(variance(gullies(200, 7.3, 1, "vec2(2.6, 0.0)")), 0) << "a wall";
    EXPECT_LT(variance(gullies(200, 7.3, 15, "vec2(0.6, 0.0)")), 0.7 * steep);
    EXPECT_EQ(variance(gullies(200, 7.3, 35, "vec2(0.6, 0.0)")), 0);
}

TEST(Bump, InventedSlopesAreAsHighAsTheGroundIsDrawn) {
    constexpr int kSide = 30;
    const auto slopes = [](float exaggeration) {
        test::GpuSnippet gpu("bump");
        gpu.frame().normal_texels_per_m = 1.0f / 90;
        gpu.frame().height_range.z = exaggeration;
        gpu.frame().polar_axis = {0, 1, 0, 0};
        return gpu.run(
            "Surface s;\n"
            "s.up = vec3(0.0, 0.0, 1.0);\n"
            "s.ground_normal = normalize(vec3(0.3, 0.4, 1.0));\n"
            "s.anchored_m = 13.0 * vec2(x, y);\n"
            "s.ground_dx_m = s.ground_dy_m = vec3(1.0, 1.0, 0.0);\n"
            "s.pixel_posts = 0.01;\n"
            "s.material = ivec2(1);\n"
            "s.material_weight = vec2(1.0, 0.0);\n"
            "result = vec4(bump_invented_slope(s), 0.0, 0.0);",
            kSide, kSide);
    };
    const std::vector<glm::vec4> once = slopes(1), thrice = slopes(3);
    EXPECT_GT(variance(once), 0.01);
    for (std::size_t i = 0; i < once.size(); ++i)
        EXPECT_LT(length(thrice[i] - 3.0f * once[i]), 1e-5);
}

}  // namespace
}  // namespace relevo::test_bump
