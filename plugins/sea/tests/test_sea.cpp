#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <glm/exponential.hpp>
#include <glm/vec3.hpp>
#include <gmock/gmock.h>

#include "base/units.h"
#include "support/gpu_snippet.h"
#include "support/support.h"

namespace relevo::test_sea {
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
        const auto results =
            gpu.run("result = vec4(sea_mirrored(cos(radians(float(x))), sea_roughness()));", 91, 1);
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
        const glm::vec4 found =
            gpu.run("result = vec4(sea_glitter(1.0, sea_roughness()), 0.0, 0.0);", 1, 1)[0];
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

/// Slopes of the waves at points of a square, and how rough the rest is.
std::vector<glm::vec4> waves_of(test::GpuSnippet& gpu, double pixel_m, double apart_m, int side) {
    return gpu.run(fmt::format("sea_Waves w = sea_waves({:f} * vec2(x, y), vec2({:f}, 0.0), "
                               "vec2(0.0, {:f}), 1.0, 1.0);\n"
                               "result = vec4(w.slope, w.roughness, sea_roughness());",
                               apart_m, pixel_m, pixel_m),
                   side, side);
}

TEST(Sea, WavesTakeTheirSlopesFromTheRoughness) {
    // Cox and Munk's mean square slope is there at any distance, as waves or as roughness.
    std::vector<double> errors;
    for (const double wind : {3.0, 8.0, 20.0})
        for (const double pixel_m : {0.02, 0.5, 5.0, 100.0}) {
            test::GpuSnippet gpu("sea");
            gpu.values().set("sea.wind_m_s", fmt::format("{}", wind));
            double square = 0, rough = 0;
            const int side = 160;
            for (const glm::vec4& one : waves_of(gpu, pixel_m, 5.3, side)) {
                square += one.x * one.x + one.y * one.y;
                rough += one.z;
                EXPECT_GT(one.z, 0.002);
            }
            const double expected = 0.003 + 0.00512 * wind;
            errors.push_back(std::abs((square + rough) / (side * side) / expected - 1));
            if (pixel_m == 100) {
                EXPECT_EQ(square, 0) << "longer than any wave";
            }
            if (pixel_m == 0.02) {
                EXPECT_GT(square, 0.3 * rough) << "waves are seen";
            }
        }
    test::print_accuracy("slopes of waves and roughness, relative", errors, "", 0.02);
    EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 0.02);
}

TEST(Sea, WavesAreAsLongAsTheWindMakesThem) {
    // Pierson and Moskowitz: the peak is at 0.855 g / U; and JONSWAP's after a fetch of 5 km.
    for (const double wind : {3.0, 8.0, 15.0}) {
        test::GpuSnippet gpu("sea");
        gpu.values().set("sea.wind_m_s", fmt::format("{}", wind));
        const glm::vec4 found =
            gpu.run("result = vec4(sea_peak_m(1.0), sea_peak_m(0.0), 0.0, 0.0);", 1, 1)[0];
        const double g = 9.81, sea = 0.855 * g / wind,
                     lake = std::max(sea, 22 * std::cbrt(g * g / (wind * 5000)));
        EXPECT_NEAR(found.x, 2 * kPi * g / (sea * sea), 1e-3 * found.x);
        EXPECT_NEAR(found.y, 2 * kPi * g / (lake * lake), 1e-3 * found.y);
    }
}

/// Correlation of slopes along the x axis.
double correlation(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b) {
    double both = 0, of_a = 0, of_b = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        both += a[i].x * b[i].x;
        of_a += a[i].x * a[i].x;
        of_b += b[i].x * b[i].x;
    }
    return both / std::sqrt(of_a * of_b);
}

TEST(Sea, WavesRunBeforeTheWindAndRepeat) {
    const auto at = [](double seconds, const std::string& wind_deg, double east_m) {
        test::GpuSnippet gpu("sea");
        gpu.values().set("sea.wind_deg", wind_deg);
        gpu.values().set("sea.wind_m_s", "10");
        gpu.frame().still_seconds = static_cast<float>(seconds);
        return gpu.run(
            fmt::format("result = vec4(sea_waves(vec2(float(x) + {:f}, float(y)), vec2(4.0, 0.0), "
                        "vec2(0.0, 4.0), 1.0, 1.0).slope, 0.0, 0.0);",
                        east_m),
            200, 200);
    };
    const std::vector<glm::vec4> before = at(3, "270", 0);
    EXPECT_GT(correlation(before, at(3 + 512, "270", 0)), 0.999);
    EXPECT_LT(correlation(before, at(5, "270", 0)), 0.9) << "they move";
    // The wind from the west: what was here is 5 m further east half a second later.
    const double along = correlation(before, at(3.5, "270", 4)),
                 against = correlation(before, at(3.5, "270", -4));
    EXPECT_GT(along, against + 0.2);
    const std::vector<glm::vec4> east = at(3, "90", 0);
    EXPECT_GT(correlation(east, at(3.5, "90", -4)), correlation(east, at(3.5, "90", 4)) + 0.2);
}

TEST(Sea, WavesHaveNoTiles) {
    // No step brings the waves back: at the peak of 57 m, from 100 m to 6 km.
    test::GpuSnippet gpu("sea");
    gpu.values().set("sea.wind_m_s", "8");
    const std::string body =
        "vec2 at = 7.3 * vec2(x % 32, x / 32);\n"
        "float lag = 100.0 * pow(1.0072, float(y)), way = 2.4 * float(y);\n"
        "vec2 dx = vec2(1.0, 0.0), dy = vec2(0.0, 1.0);\n"
        "vec2 a = sea_waves(at, dx, dy, 1.0, 1.0).slope;\n"
        "vec2 b = sea_waves(at + lag * vec2(cos(way), sin(way)), dx, dy, 1.0, 1.0).slope;\n"
        "result = vec4(dot(a, b), dot(a, a), dot(b, b), 0.0);";
    const int points = 1024, lags = 570;
    const std::vector<glm::vec4> found = gpu.run(body, points, lags);
    double most = 0;
    for (int lag = 0; lag < lags; ++lag) {
        glm::dvec3 sum(0);
        for (int i = 0; i < points; ++i)
            sum += glm::dvec3(found[static_cast<std::size_t>(lag * points + i)]);
        most = std::max(most, sum.x / std::sqrt(sum.y * sum.z));
    }
    fmt::print("[ accuracy ] waves: greatest correlation at a distance {:.2f}\n", most);
    EXPECT_LT(most, 0.35);
}

TEST(Sea, ItsFloorIsShadedByTheSunAndNeverAllDark) {
    for (const double elevation_deg : {2.0, 30.0, 60.0}) {
        test::GpuSnippet gpu("sea");
        const auto results = gpu.run(
            fmt::format("float e = radians({:f}), slope = radians(float(x) - 40.0);\n"
                        "vec3 to_sun = vec3(cos(e), 0.0, sin(e));\n"
                        "result.x = sea_shade(vec3(sin(slope), 0.0, cos(slope)), vec3(0.0, 0.0, "
                        "1.0), to_sun, 1.0);",
                        elevation_deg),
            81, 1);
        const double used = radians(std::max(elevation_deg, 30.0));
        for (int x = 0; x <= 80; ++x) {
            const double facing = std::max(std::sin(used + radians(x - 40.0)), 0.0);
            EXPECT_NEAR(results[static_cast<std::size_t>(x)].x,
                        0.25 + 0.75 * facing / std::sin(used), 1e-4)
                << elevation_deg << " " << x;
        }
    }
}

TEST(Sea, ItsFloorsColourFollowsTheDepth) {
    test::GpuSnippet gpu("sea");
    const auto results = gpu.run("result = vec4(sea_map_albedo(2.0 * float(x)), 0.0);", 5500, 1);
    for (std::size_t x = 0; x < results.size(); ++x) {
        const double depth_m = 2.0 * static_cast<double>(x);
        const glm::dvec3 expected = glm::dvec3(0.006, 0.037, 0.108) +
                                    glm::dvec3(0.003, 0.018, 0.028) * std::exp(-depth_m / 1200) +
                                    glm::dvec3(0.045, 0.085, 0.065) *
                                        glm::exp(-glm::sqrt(depth_m / glm::dvec3(40, 130, 420)));
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(results[x][c], expected[c], 1e-4) << depth_m;
            if (x > 0) {
                EXPECT_LE(results[x][c], results[x - 1][c]);
            }
        }
    }
}

TEST(Sea, ItsFloorIsSeenFromHighAbove) {
    const auto seen = [](const std::string& floor, double share, double width_m) {
        test::GpuSnippet gpu("sea");
        gpu.values().set("sea.floor", floor);
        gpu.frame().sea_floor_share = static_cast<float>(share);
        gpu.frame().ground_extent = glm::vec4(0, 0, 1 / width_m, 0.5 / width_m);
        std::vector<double> values;
        for (const double eye_m : {-50.0, 300.0, 2000.0, 4000.0, 8000.0, 90'000.0}) {
            gpu.frame().eye_m.w = static_cast<float>(eye_m);
            values.push_back(gpu.run("result = vec4(sea_seen());", 1, 1)[0].x);
        }
        return values;
    };
    using Values = std::vector<double>;
    EXPECT_THAT(seen("auto", 0.11, 500e3),
                testing::Pointwise(testing::DoubleNear(1e-5), Values{0, 0, 0, 0.5, 1, 1}));
    EXPECT_THAT(seen("auto", 0.11, 20e3),
                testing::Pointwise(testing::DoubleNear(1e-5), Values{0, 0, 0.5, 1, 1, 1}))
        << "a fjord";
    EXPECT_EQ(seen("auto", 0.09, 500e3), (Values{0, 0, 0, 0, 0, 0}));
    EXPECT_EQ(seen("hidden", 0.9, 500e3), (Values{0, 0, 0, 0, 0, 0}));
    EXPECT_EQ(seen("seen", 0.01, 500e3), (Values{1, 1, 1, 1, 1, 1}));
}

/// Of 201 x 101 posts: how far a seen floor is the sea beyond, every 2 posts on the middle row.
std::vector<float> at_rim(double share) {
    test::GpuSnippet gpu("sea");
    gpu.frame().sea_floor_share = static_cast<float>(share);
    gpu.frame().posts = {201, 101, 1 / 201.0F, 1 / 101.0F};
    std::vector<float> values;
    for (const glm::vec4& value :
         gpu.run("result = vec4(sea_at_rim(vec2(2.0 * float(x), 50.0)));", 101, 1))
        values.push_back(value.x);
    return values;
}

TEST(Sea, ItsFloorEndsInTheSeaAroundTheDem) {
    const std::vector<float> mostly_sea = at_rim(0.99);
    EXPECT_EQ(mostly_sea.front(), 1);
    EXPECT_EQ(mostly_sea.back(), 1);
    EXPECT_NEAR(mostly_sea[2], 0.5, 0.02) << "4 of 8 posts from the rim";
    for (std::size_t x = 5; x + 5 < mostly_sea.size(); ++x)
        EXPECT_EQ(mostly_sea[x], 0) << x;
    EXPECT_EQ(at_rim(0.5), std::vector<float>(101, 0.0F)) << "land may be around it";
}

/// How far the shore runs beside the lines between posts, over 60 x 60 posts.
std::vector<double> shores(const std::string& shore, double pixel_posts) {
    test::GpuSnippet gpu("sea");
    gpu.values().set("sea.shore", shore);
    std::vector<double> moved;
    for (const glm::vec4& value : gpu.run(
             fmt::format("result = vec4(sea_shore_moved(0.1 * vec2(x, y), {:f}));", pixel_posts),
             600, 600))
        moved.push_back(value.x);
    return moved;
}

TEST(Sea, ShoresStayBetweenTheirPosts) {
    // Half of the way would reach a post: land where it is sea, or a pond on land.
    const std::vector<double> moved = shores("1", 0.01);
    const auto [bay, headland] = std::ranges::minmax(moved);
    double mean = 0;
    for (const double m : moved)
        mean += m / static_cast<double>(moved.size());
    fmt::print("[ accuracy ] shores by {:.3f} to {:.3f} of the way between posts, mean {:.3f}\n",
               bay, headland, mean);
    EXPECT_GT(bay, -0.3);
    EXPECT_LT(bay, -0.1);
    EXPECT_LT(headland, 0.5);
    EXPECT_GT(headland, 0.3);
    EXPECT_NEAR(mean, 0.1, 0.02);
    EXPECT_EQ(shores("0", 0.01), std::vector<double>(600 * 600, 0.0));
    EXPECT_EQ(shores("1", 0.5), std::vector<double>(600 * 600, 0.0)) << "wide pixels";
}

TEST(Sea, LandOfCoarsePostsIsShadedSteeper) {
    test::GpuSnippet gpu("sea");
    const auto steeper = [&](double apart_m, float exaggeration) {
        gpu.frame().normal_texels_per_m = static_cast<float>(1 / apart_m);
        gpu.frame().height_range.z = exaggeration;
        return gpu.run("result = vec4(sea_land_steeper());", 1, 1)[0].x;
    };
    for (const auto& [apart_m, factor] : {std::pair{90.0, 1.0}, {300.0, 1.0}, {8100.0, 3.0}})
        EXPECT_NEAR(steeper(apart_m, 1), factor, 1e-3);
    EXPECT_NEAR(steeper(8100, 2), 1.5, 1e-3) << "exaggerated slopes are steep already";
    EXPECT_NEAR(steeper(8100, 4), 1, 1e-3);
    const auto steep = gpu.run(
        "vec3 n = sea_steep(normalize(vec3(-0.1, 0.0, 1.0)), vec3(0.0, 0.0, 1.0), 3.0);\n"
        "result.x = -n.x / n.z;",
        1, 1);
    EXPECT_NEAR(steep[0].x, 0.3, 1e-4);
}

}  // namespace
}  // namespace relevo::test_sea
