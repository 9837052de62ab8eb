#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "light/fields.h"
#include "render/drawn.h"
#include "sky/shipped.h"
#include "support/gpu_snippet.h"
#include "support/support.h"

namespace relevo::test_haze {
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

TEST(Haze, OfTheDrawnGroundIsTheIntegralsToThreeHundredKilometres) {
    // A plateau at 3000 m from an eye at 12000 m, whose horizon lies at 340 km: black ground before
    // a white sky shows the share alone.
    const auto plateau =
        test::field_of(81, 801, {480000, 500, 0, 5400000, 0, -500}, "EPSG:32632", [](int, int row) {
            return 3000.0 + (row % 2);  // so that it has a relief
        });
    const test::TestEffect sky{
        "white",
        "vec3 white_on_background_radiance(in vec3 direction, in bool with_disc) {\n"
        "    return vec3(1.0, 0.0, 0.0);\n"
        "}\n"
        "void white_on_lit(in Surface s, inout vec3 radiance) { radiance = vec3(0.0); }\n"};
    const test::TestEffect probe{
        "probe",
        "void probe_on_atmosphere(in Surface s, in vec3 view, inout vec3 radiance) {\n"
        "    radiance = vec3(radiance.r, s.distance_m / 1048576.0, 1.0) / frame.exposure;\n"
        "}\n"};
    const auto haze = effect::load_effect(test::source_dir() / "plugins/haze", {});
    test::Drawn drawn(plateau, {sky, probe}, 64, 512, 0, {haze},
                      {{"haze.air", "false"}, {"haze.blue", "0"}, {"haze.density", "0.02"}});
    std::vector<double> errors;
    double farthest_m = 0;
    // Under exaggeration the air is that before what is drawn: from 24000 m to 6000 m.
    for (const double exaggeration : {1.0, 2.0}) {
        drawn.frame().exaggeration = exaggeration;
        drawn.stand(0.5, 1, 12000 * exaggeration, 0, -3.6);
        drawn.frame().camera.fov_y_rad = 0.06;
        const image::ImageF image = drawn.radiance();
        for (int y = 0; y < image.height; ++y) {
            if (image.at(32, y, 2) == 0) continue;
            const glm::dvec2 found = test::Drawn::values(image, 32, y);
            const double distance_m = 1048576 * found.y;
            farthest_m = std::max(farthest_m, distance_m);
            errors.push_back(
                std::abs(found.x - (1 - std::exp(-depth(0.02, 2500, 12000 * exaggeration,
                                                        3000 * exaggeration, distance_m)))));
        }
    }
    EXPECT_GT(farthest_m, 250000);
    test::print_accuracy("haze over drawn ground, to 250 km", errors, "", 2e-3);
    EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 2e-3);
}

TEST(Haze, OfTheDefaultIsTheAtmospheresAir) {
    // Black and white ground from 12 km: what black ground shows is scattered, the difference of
    // the two has passed.
    const auto plateau = test::field_of(81, 801, {480000, 500, 0, 5400000, 0, -500}, "EPSG:32632",
                                        [](int, int row) { return 3000.0 + (row % 2); });
    const auto haze = effect::load_effect(test::source_dir() / "plugins/haze", {});
    const std::filesystem::path share = RELEVO_SHARE_DIR;
    const auto sky_effect = effect::load_effect(share / "plugins/sky", share / "data");
    std::array<image::ImageF, 3> images;
    for (const int ground : {0, 1, 2}) {  // black, white, and how far
        const test::TestEffect lit{"lit", fmt::format("void lit_on_lit(in Surface s, inout vec3 "
                                                      "radiance) {{ radiance = vec3({}); }}\n",
                                                      ground == 1 ? "1.0" : "0.0")};
        const test::TestEffect probe{
            "probe",
            "void probe_on_atmosphere(in Surface s, in vec3 view, inout vec3 radiance) {\n"
            "    radiance = vec3(s.distance_m / 1048576.0, 0.0, 1.0) / frame.exposure;\n"
            "}\n"};
        test::Drawn drawn(plateau, ground == 2 ? std::vector{lit, probe} : std::vector{lit}, 16,
                          256, 0, {haze, sky_effect}, {});
        drawn.stand(0.5, 1, 12000, 0, -3.6);
        drawn.frame().camera.fov_y_rad = 0.06;
        images[static_cast<std::size_t>(ground)] = drawn.radiance();
        if (ground != 2) continue;
        const auto air = sky::atmosphere_of(sky::Air{});
        const glm::dvec3 to_sun = drawn.frame().sun.direction;
        const geo::Geodetic eye = drawn.ground().frame.to_geodetic(drawn.frame().camera.eye_m);
        const glm::dvec3 up = drawn.ground().frame.up(eye.lat_rad, eye.lon_rad);
        const double sun_sine = dot(to_sun, up);
        std::vector<double> scattered, passed;
        for (int y = 0; y < 256; y += 5) {
            const double distance_m = 1048576 * test::Drawn::values(images[2], 8, y).x;
            if (distance_m > 400e3) continue;  // the sky
            const glm::dvec3 ray = drawn.ray(8.5, y + 0.5);
            const double sine = dot(ray, up);
            const double level = std::sqrt((1 - sine * sine) * (1 - sun_sine * sun_sine));
            const sky::Atmosphere::View view{eye.height_m, sine, sun_sine,
                                             (dot(ray, to_sun) - sine * sun_sine) / level};
            const glm::dvec3 expected = sky::colour_of(air->scattered_in(view, distance_m));
            const glm::dvec3 through =
                sky::colour_of(air->transmittance(view.height_m, view.sine, distance_m));
            const double black = images[0].at(8, y, 1), white = images[1].at(8, y, 1);
            scattered.push_back(std::abs(black / expected.g - 1));
            passed.push_back(std::abs(white - black - through.g));
        }
        ASSERT_GT(scattered.size(), 20u);
        test::print_accuracy("light of the air, drawn", scattered, "", 0.01);
        test::print_accuracy("share of light that passes, drawn", passed, "", 0.005);
        EXPECT_LT(*std::max_element(scattered.begin(), scattered.end()), 0.01);
        EXPECT_LT(*std::max_element(passed.begin(), passed.end()), 0.005);
    }
}

TEST(Haze, IsNoClearerThanTheAtmosphere) {
    // Of an extinction, what the atmosphere does not have comes on top.
    test::GpuSnippet gpu("haze");
    gpu.frame().air_mapping.w = 8e-5f;
    const char* body = "result = vec4(haze_extra_share());";
    gpu.values().set("haze.density", "0.02");
    EXPECT_EQ(gpu.run(body, 1, 1)[0].x, 0);
    gpu.values().set("haze.density", "0.8");
    EXPECT_NEAR(gpu.run(body, 1, 1)[0].x, 0.9, 1e-6);
    gpu.values().set("haze.visibility", "10");
    EXPECT_NEAR(gpu.run(body, 1, 1)[0].x, 1 - 0.08 / 0.3912, 1e-6);
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
}  // namespace relevo::test_haze
