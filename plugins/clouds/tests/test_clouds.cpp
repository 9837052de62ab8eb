#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include "light/fields.h"
#include "render/drawn.h"
#include "support/gpu_snippet.h"
#include "support/support.h"
#include "weather/two_stream.h"

namespace relevo::test_clouds {
namespace {

constexpr double kEarth_m = 6371000;

/// A frame at the origin of a round Earth: x east, y north, z up.
void place_eye(render::FrameBlock& frame, double height_m) {
    frame.eye_m = {0, 0, height_m, height_m};
    frame.eye_up = {0, 0, 1, 0};
    frame.up_at_eye = glm::vec4(0, 0, 1 + height_m / kEarth_m, 0);
    frame.up_matrix = glm::mat4(static_cast<float>(1 / kEarth_m));
    frame.height_range = {0, 1e-3F, 1, 0};
}

// ---- coverage

/// Share of a square of 120 cells that has cloud, of one seed.
double covered(test::GpuSnippet& gpu, int kind, double cover, int seed) {
    constexpr int kSide = 192;
    gpu.values().set("clouds.kind_1", kind == 0 ? "cumulus" : kind == 1 ? "stratus" : "cirrus");
    gpu.values().set("clouds.cover_1", fmt::format("{}", cover));
    gpu.values().set("clouds.seed", fmt::format("{}", seed));
    const auto found = gpu.run(
        "result = vec4(clouds_thickness(0, clouds_cell_m * 0.63 * vec2(x, y)));", kSide, kSide);
    return static_cast<double>(
               std::ranges::count_if(found, [](const glm::vec4& one) { return one.x > 0; })) /
           (kSide * kSide);
}

TEST(Clouds, CoverIsTheShareSeenFromStraightAbove) {
    test::GpuSnippet gpu("clouds");
    for (const int kind : {0, 1, 2})
        for (const double cover : {0.2, 0.5, 0.75}) {
            double sum = 0;
            for (int seed = 0; seed < 20; ++seed)
                sum += covered(gpu, kind, cover, seed) / 20;
            fmt::print("[ accuracy ] kind {}, cover {}: {:.3f} of 20 seeds\n", kind, cover, sum);
            EXPECT_NEAR(sum, cover, 0.02) << kind;
        }
    EXPECT_EQ(covered(gpu, 0, 0, 3), 0);
    for (const int kind : {0, 1, 2})
        EXPECT_GT(covered(gpu, kind, 1, 3), 0.999);
}

TEST(Clouds, ThickPartsHideHalfOrMoreOfWhatIsBelow) {
    // What one sees as covered: more than half of the light from below is kept off.
    test::GpuSnippet gpu("clouds");
    gpu.values().set("clouds.cover_1", "0.5");
    gpu.values().set("clouds.variation", "0");
    double sum = 0;
    for (int seed = 0; seed < 20; ++seed) {
        gpu.values().set("clouds.seed", fmt::format("{}", seed));
        const auto found = gpu.run(
            "float share = clamp(clouds_thickness(0, clouds_cell_m * 0.63 * vec2(x, y)), 0.0, "
            "1.0);\n"
            "result = vec4(exp(-clouds_tau(clouds_deck(0), share, 0.5)));",
            192, 192);
        sum += static_cast<double>(std::ranges::count_if(
                   found, [](const glm::vec4& one) { return one.x < 0.5F; })) /
               (192 * 192 * 20);
    }
    EXPECT_NEAR(sum, 0.5, 0.02);
}

TEST(Clouds, MoveWithTheWindAndComeAgain) {
    test::GpuSnippet gpu("clouds");
    gpu.values().set("clouds.wind_m_s", "10");
    gpu.values().set("clouds.wind_from_deg", "270");
    const std::string body =
        "result = vec4(clouds_thickness(0, vec2({}, 0.0) + 50.0 * vec2(x, y)));";
    const auto before = gpu.run(fmt::format(fmt::runtime(body), "0.0"), 64, 64);
    gpu.frame().seconds = 100;
    const auto later = gpu.run(fmt::format(fmt::runtime(body), "1000.0"), 64, 64);  // 1 km east
    for (std::size_t i = 0; i < before.size(); ++i)
        EXPECT_NEAR(before[i].x, later[i].x, 2e-3);
    const auto again = gpu.run(fmt::format(fmt::runtime(body), "1000.0"), 64, 64);
    EXPECT_EQ(later, again);
}

// ---- shape

/// Largest difference between how much of a column is cloud and what its density reckons with.
double worst_filled(test::GpuSnippet& gpu) {
    double worst = 0;
    for (const glm::vec4& one :
         gpu.run("clouds_Deck d = clouds_deck(0);\n"
                 "float share = (float(x) + 1.0) / 40.0, vary = 0.25 * float(y), inside = 0.0;\n"
                 "float top = clouds_column_top_m(d, share, vary) - d.base_m;\n"
                 "for (int i = 0; i < 500; ++i) {\n"
                 "    float within = (float(i) + 0.5) / 500.0 * top / clouds_tall_m(d, vary);\n"
                 "    if (clouds_needed(d, within) <= share) inside += 1.0 / 500.0;\n"
                 "}\n"
                 "result = vec4(inside, clouds_filled(d, share), share, 0.0);",
                 40, 5))
        if (std::abs(one.z - 0.44F) > 0.03F)  // where a tower closes
            worst = std::max(worst, std::abs(double{one.x} - one.y));
    return worst;
}

TEST(Clouds, ColumnsAreCloudAsFarAsTheirDensityReckons) {
    // So that what the eye sees is as deep as what shades the ground. Above a share's top is none
    // of it.
    test::GpuSnippet gpu("clouds");
    place_eye(gpu.frame(), 3000);
    for (const char* const kind : {"cumulus", "stratus", "cirrus"})
        for (const double top_m :
             {3700.0, 7600.0, 12000.0}) {  // cumulus: none, half, a whole anvil
            gpu.values().set("clouds.kind_1", kind);
            gpu.values().set("clouds.top_1_m", fmt::format("{}", top_m));
            const double worst = worst_filled(gpu);
            fmt::print("[ accuracy ] filled part of a column, {} up to {} m: worst {:.3f}\n", kind,
                       top_m, worst);
            EXPECT_LT(worst, 0.05) << kind << ' ' << top_m;
        }
}

// ---- shadows

/// Where the sun's ray to a point meets a deck, in double precision on a sphere: the place below.
glm::dvec2 crossing(const glm::dvec3& point, const glm::dvec3& to_sun, double deck_m) {
    const glm::dvec3 centre(0, 0, -kEarth_m);
    const glm::dvec3 from = point - centre;
    const double b = dot(from, to_sun);
    const double c = dot(from, from) - (kEarth_m + deck_m) * (kEarth_m + deck_m);
    const glm::dvec3 there = point + (std::sqrt(b * b - c) - b) * to_sun;
    const glm::dvec3 up = normalize(there - centre);
    return glm::dvec2(there - deck_m * up);
}

TEST(Clouds, ShadowsLieWhereTheSunsRayMeetsTheDeck) {
    // A deck at 2600 m over ground of 0 to 2500 m, 60 km around, five suns: to less than a post.
    test::GpuSnippet gpu("clouds");
    place_eye(gpu.frame(), 3000);
    std::vector<double> errors;
    for (const double elevation_deg : {5.0, 12.0, 25.0, 45.0, 75.0}) {
        const double el = elevation_deg * M_PI / 180, az = (97 + 31 * elevation_deg) * M_PI / 180;
        const glm::dvec3 to_sun(std::cos(el) * std::sin(az), std::cos(el) * std::cos(az),
                                std::sin(el));
        const auto found =
            gpu.run(fmt::format("vec3 sun = vec3({:.9f}, {:.9f}, {:.9f});\n"
                                "float h = 100.0 * float(x);\n"
                                "vec2 at = 60000.0 * (vec2(fract(0.618 * float(y)), fract(0.755 * "
                                "float(y))) - 0.5);\n"
                                "vec3 p = vec3(at, -dot(at, at) / 2.0 / 6371000.0 + h - 3000.0);\n"
                                "vec3 up = up_at(p);\n"
                                "vec3 there = clouds_crossing(p, h, up, sun, 2600.0);\n"
                                "result = vec4(clouds_place(there, 2600.0), at);",
                                to_sun.x, to_sun.y, to_sun.z),
                    26, 50);
        for (int y = 0; y < 50; ++y)
            for (int x = 0; x < 26; ++x) {
                const glm::vec4 one = found[static_cast<std::size_t>(y * 26 + x)];
                const glm::dvec2 at(one.z, one.w);
                const glm::dvec3 point(at, -dot(at, at) / 2 / kEarth_m + 100.0 * x);
                const double error =
                    distance(glm::dvec2(one.x, one.y), crossing(point, to_sun, 2600));
                errors.push_back(error);
            }
    }
    test::print_accuracy("place of cloud shadows", errors, "m", 20);
    EXPECT_LT(*std::ranges::max_element(errors), 20);
}

// ---- light

TEST(Clouds, LightBelowAUniformDeckIsTheTwoStreams) {
    // Conservative delta-Eddington, Meador and Weaver's equation 24, in double precision.
    test::GpuSnippet gpu("clouds");
    std::vector<double> errors;
    const auto found = gpu.run(
        "float tau = x == 0 ? 0.0 : 0.1 * pow(1.6, float(x)), mu = 0.05 + 0.05 * float(y);\n"
        "result = vec4(clouds_diffuse_of_sun(tau, mu), exp(-tau / mu), clouds_reflected_sky(tau), "
        "tau);",
        26, 20);
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 26; ++x) {
            const glm::vec4 one = found[static_cast<std::size_t>(y * 26 + x)];
            const double mu = 0.05 + 0.05 * y, tau = x == 0 ? 0 : 0.1 * std::pow(1.6, x);
            const double f = 0.85 * 0.85, g = 0.85 / 1.85, scaled = (1 - f) * tau;
            const double g1 = 0.75 * (1 - g), g3 = (2 - 3 * g * mu) / 4;
            const double kept = std::exp(-scaled / mu);
            const double reflected =
                (g1 * scaled + (g3 - g1 * mu) * (1 - kept)) / (1 + g1 * scaled);
            errors.push_back(std::abs(1 - reflected - one.x - one.y));
            errors.push_back(std::abs(g1 * scaled / (1 + g1 * scaled) - one.z));
        }
    test::print_accuracy("two-stream on the device", errors, "of the irradiance", 1e-3);
    EXPECT_LT(*std::ranges::max_element(errors), 1e-3);
}

/// Irradiance on level ground under a uniform deck as a picture has it, in multiples of the sun's
/// on the level without it, and what is expected: weather::two_stream.
void check_drawn_light(double tau, const char* utc) {
    const auto plain = test::field_of(65, 65, {480000, 30, 0, 5400000, 0, -30}, "EPSG:32632",
                                      [](int, int row) { return 500.0 + 1e-3 * (row % 2); });
    const test::TestEffect probe{
        "probe",
        "void probe_on_material(inout Surface s) {\n"
        "    s.normal = s.up;\n"
        "    s.diffuse = s.ambient = vec3(1.0);\n"
        "    s.specular = vec3(0.0);\n"
        "}\n"
        "void probe_on_atmosphere(in Surface s, in vec3 view, inout vec3 radiance) {\n"
        "    float sun = frame.sun_light[0].r * frame.sun_apparent.z;\n"
        "    radiance = vec3(radiance.r / sun, frame.sky_irradiance.r / sun, 1.0) / "
        "frame.exposure;\n"
        "}\n"};
    const auto clouds = effect::load_effect(test::source_dir() / "plugins/clouds", {});
    test::Drawn drawn(plain, {probe}, 64, 64, 0, {clouds},
                      {{"clouds.cover_1", "1"},
                       {"clouds.kind_1", "stratus"},
                       {"clouds.base_1_m", "3000"},
                       {"clouds.top_1_m", "3500"},
                       {"clouds.variation", "0"},
                       {"clouds.depth_1", fmt::format("{}", tau)}});
    drawn.shine(utc);
    drawn.stand(0.5, 0.5, 1200, 0, -89);
    const image::ImageF image = drawn.radiance();
    const glm::dvec2 found = test::Drawn::values(image, 32, 32);
    const double elevation = std::asin(drawn.frame().sun.direction.z);
    const double mu = std::sin(elevation + drawn.frame().sun.refraction_rad(elevation));
    const weather::CloudLayerOptics layer{tau};
    const weather::LayerLight sky = weather::sky_through(layer);
    const double expected =
        weather::over_ground(weather::beam_through(layer, mu), sky, 0.15).transmitted() +
        found.y * weather::over_ground(sky, sky, 0.15).transmitted();
    EXPECT_NEAR(found.x, expected, 1e-3 * expected + 2e-4) << tau << ' ' << utc;
}

TEST(Clouds, IrradianceOfADrawnPlainIsTheTwoStreams) {
    for (const char* const utc : {"2026-06-21T11:00Z", "2026-06-21T16:00Z"})
        for (const double tau : {0.3, 2.0, 10.0, 100.0})
            check_drawn_light(tau, utc);
}

TEST(Clouds, OvercastSkyIsCiesAndShedsItsIrradiance) {
    test::GpuSnippet gpu("clouds");
    const auto found =
        gpu.run("result = vec4(clouds_overcast((float(x) + 0.5) / 1000.0));", 1000, 1);
    EXPECT_NEAR(found[999].x / found[0].x, 3, 0.01);  // the zenith is three times the horizon
    double irradiance = 0;                            // over pi
    for (int i = 0; i < 1000; ++i)
        irradiance += double{found[static_cast<std::size_t>(i)].x} * 2 * (i + 0.5) / 1e6;
    EXPECT_NEAR(irradiance, 1, 1e-3);
}

TEST(Clouds, PhaseFunctionSpreadsAllLight) {
    test::GpuSnippet gpu("clouds");
    const auto found =
        gpu.run("result = vec4(clouds_phase((float(x) + 0.5) / 500.0 - 1.0));", 1000, 1);
    double sum = 0;  // of p over all directions; the function is pi p
    for (const glm::vec4& one : found)
        sum += double{one.x} * 2 * M_PI / 500 / M_PI;
    EXPECT_NEAR(sum, 1, 0.01);
    EXPECT_GT(found[999].x, 20 * found[300].x);
}

}  // namespace
}  // namespace relevo::test_clouds
