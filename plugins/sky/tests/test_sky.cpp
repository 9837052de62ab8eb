#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "base/units.h"
#include "render/air_textures.h"
#include "sky/eye_tables.h"
#include "sky/night.h"
#include "sky/path.h"
#include "sky/shipped.h"
#include "support/gpu_snippet.h"
#include "support/support.h"

namespace relevo::test_sky {
namespace {

// The paper's equations, written again in double precision; up is z.

glm::dvec3 direction(double azimuth_rad, double elevation_rad) {
    return {std::cos(elevation_rad) * std::sin(azimuth_rad),
            std::cos(elevation_rad) * std::cos(azimuth_rad), std::sin(elevation_rad)};
}

/// Horizontal part of unit length, but for the last 0.01 before the zenith.
glm::dvec3 level(const glm::dvec3& v) {
    const glm::dvec3 flat(v.x, v.y, 0);
    return flat / std::max(length(flat), 0.01);
}

/// Equation 2. @param l  towards the sun  @param v  of the view
double equation_2(const glm::dvec3& l, const glm::dvec3& v) {
    return dot(level(l), level(v)) / 2 + 0.5;
}

/// Equation 3.
double equation_3(const glm::dvec3& v, double h) {
    return std::pow(std::max(0.0, v.z), h);
}

constexpr const char* kDirection =
    "float azimuth = radians(float(x)), elevation = radians(float(y) - 90.0);\n"
    "vec3 up = vec3(0.0, 0.0, 1.0);\n"
    "vec3 view = vec3(cos(elevation) * vec2(sin(azimuth), cos(azimuth)), sin(elevation));\n";

double worst(std::vector<double>& errors, std::string_view what, double limit) {
    test::print_accuracy(what, errors, "", limit);
    return *std::max_element(errors.begin(), errors.end());
}

TEST(Sky, Equation1IsTheSumOfThePowersOfTheCosine) {
    // Every tenth of a degree; weights and powers as they are by default and as in the paper.
    for (const bool paper : {false, true}) {
        test::GpuSnippet gpu("sky");
        if (paper) gpu.values().set("sky.weights", "1,1,1");
        const std::array<double, 3> weights =
            paper ? std::array{1.0, 1.0, 1.0} : std::array{0.133, 0.532, 0.346};
        const auto results =
            gpu.run("result = vec4(sky_glow(cos(radians(0.1 * float(x)))));", 1801, 1);
        std::vector<double> errors;
        for (int x = 0; x <= 1800; ++x) {
            const double cosine = std::max(std::cos(radians(0.1 * x)), 0.0);
            const double expected = weights[0] * std::pow(cosine, 20) +
                                    weights[1] * std::pow(cosine, 80) +
                                    weights[2] * std::pow(cosine, 320);
            errors.push_back(std::abs(results[static_cast<std::size_t>(x)].x - expected));
        }
        EXPECT_LT(worst(errors, "sky equation 1, GPU against double", 1e-3), 1e-3);
    }
}

TEST(Sky, TheNarrowestPowerIsADiscOfTheSunsTrueSize) {
    // A thousandth of a degree apart, out to a whole one.
    test::GpuSnippet gpu("sky");
    const auto results = gpu.run(
        "vec3 sun = vec3(0.6, 0.0, 0.8);\n"
        "float angle = radians(0.001 * float(x));\n"
        "vec3 view = vec3(0.6 * cos(angle) + 0.8 * sin(angle), 0.0,\n"
        "                 0.8 * cos(angle) - 0.6 * sin(angle));\n"
        "vec3 apart = sun - view;\n"
        "float d2 = dot(apart, apart);\n"
        "result = vec4(sky_narrow(d2), sky_sun(d2), 0.0, 0.0);",
        1001, 1);
    std::vector<double> errors;
    for (int x = 0; x <= 1000; ++x)
        errors.push_back(std::abs(results[static_cast<std::size_t>(x)].x -
                                  std::pow(std::cos(radians(0.001 * x)), 65000)));
    EXPECT_LT(worst(errors, "sky (L.V)^65000, GPU against double", 1e-3), 1e-3);
    // Half of it, at the limb, lies 0.53 / 2 degrees from the centre: the sun's mean semidiameter
    // is 0.2666 (Astronomical Almanac).
    for (const int component : {0, 1}) {
        int x = 0;
        while (results[static_cast<std::size_t>(x)][component] > 0.5f)
            ++x;
        EXPECT_NEAR(0.001 * x, 0.2655, 0.0015) << component;
    }
}

TEST(Sky, Equation2IsTheHorizontalAngleToTheSun) {
    test::GpuSnippet gpu("sky");
    std::vector<double> errors;
    for (const double sun_deg : {0.0, 15.0, 60.0, 89.0, 90.0}) {
        const glm::dvec3 sun = direction(radians(200.0), radians(sun_deg));
        const auto results = gpu.run(fmt::format("{}vec3 sun = vec3({:.9f}, {:.9f}, {:.9f});\n"
                                                 "result = vec4(sky_s(sun, view, up));",
                                                 kDirection, sun.x, sun.y, sun.z),
                                     360, 181);
        for (int y = 0; y <= 180; ++y)
            for (int x = 0; x < 360; ++x)
                errors.push_back(
                    std::abs(results[static_cast<std::size_t>(y * 360 + x)].x -
                             equation_2(sun, direction(radians(x), radians(y - 90.0)))));
    }
    EXPECT_LT(worst(errors, "sky equation 2, GPU against double", 1e-3), 1e-3);
}

TEST(Sky, TheZenithHasNoAzimuth) {
    test::GpuSnippet gpu("sky");
    const auto results = gpu.run(
        "vec3 up = vec3(0.0, 0.0, 1.0);\n"
        "result = vec4(sky_s(normalize(vec3(1.0, 0.0, 1.0)), up, up), sky_s(up, up, up), 0.0, "
        "0.0);",
        1, 1);
    EXPECT_EQ(results[0].x, 0.5f);
    EXPECT_EQ(results[0].y, 0.5f);
}

TEST(Sky, Equation3IsAPowerOfTheHeight) {
    test::GpuSnippet gpu("sky");
    std::vector<double> errors;
    for (const double h : {0.05, 0.3, 0.5, 1.0, 2.0}) {
        const auto results = gpu.run(
            fmt::format("{}result = vec4(sky_t(dot(view, up), {:.2f}));", kDirection, h), 1, 181);
        for (int y = 0; y <= 180; ++y) {
            if (y == 90) continue;  // 0^h: a float's sin 0 is not the double's
            errors.push_back(std::abs(results[static_cast<std::size_t>(y)].x -
                                      equation_3(direction(0, radians(y - 90.0)), h)));
        }
    }
    EXPECT_LT(worst(errors, "sky equation 3, GPU against double", 1e-3), 1e-3);
}

TEST(Sky, TheHorizonOfAHighEyeLiesLowerAndIsWhereTheColoursBegin) {
    // Eyes at the sea, on a mountain, in an aeroplane, at 200 km.
    for (const double height_m : {0.0, 2000.0, 11000.0, 200e3}) {
        const double dip = std::sqrt(1 - std::pow(6371e3 / (6371e3 + height_m), 2));
        test::GpuSnippet gpu("sky");
        gpu.frame().eye_up = {0, 0, 1, static_cast<float>(-dip)};
        const auto results = gpu.run(
            "float sine = float(x) / 500.0 - 1.0;\n"
            "result = vec4(sky_above_horizon(sine), sky_band(), 0.0, 0.0);",
            1001, 1);
        std::vector<double> errors;
        for (int x = 0; x <= 1000; ++x)
            errors.push_back(std::abs(results[static_cast<std::size_t>(x)].x -
                                      (x / 500.0 - 1 + dip) / (1 + dip)));
        EXPECT_LT(worst(errors, "sky above the horizon, GPU against double", 1e-3), 1e-3);
        // Air 17 km thick, as far away as the horizon; never more than the dip.
        const double distance_m = std::sqrt(2 * 6371e3 * height_m);
        const double expected = height_m > 0 ? std::min(dip, 17e3 / distance_m) : 1e-4;
        EXPECT_NEAR(results[0].y, expected, 0.05 * expected) << height_m;
    }
}

TEST(Sky, AirScattersWhatSunAndSkyShedOnIt) {
    test::GpuSnippet gpu("sky");
    gpu.frame().sun_light[0] = {0.9f, 0.8f, 0.6f, 0};
    gpu.frame().sky_irradiance = {0.05f, 0.07f, 0.12f, 0};
    const auto results =
        gpu.run("result = vec4(sky_air_light(cos(radians(float(x)))), 0.0);", 181, 1);
    const glm::dvec3 sun(0.9, 0.8, 0.6), sky(0.05, 0.07, 0.12);
    std::vector<double> errors;
    double all = 0, solid_angle = 0;
    for (int deg = 0; deg <= 180; ++deg) {
        const double cosine = std::cos(radians(deg));
        const double phase = 0.5 + 0.375 * std::pow(1 + cosine, 2);
        const glm::vec4 found = results[static_cast<std::size_t>(deg)];
        for (int c = 0; c < 3; ++c)
            errors.push_back(std::abs(found[c] - (0.2 * phase * sun[c] + 0.5 * sky[c])));
        all += std::sin(radians(deg)) * (found.x - 0.5 * sky.x) / (0.2 * sun.x);
        solid_angle += std::sin(radians(deg));
    }
    EXPECT_LT(worst(errors, "light of the air, GPU against double", 1e-3), 1e-3);
    EXPECT_NEAR(all / solid_angle, 1, 1e-3);  // a phase function's mean
}

TEST(Sky, GroundBeyondTheDemIsLitAsTheTerrainAndFadesIntoTheAir) {
    test::GpuSnippet gpu("sky");
    gpu.frame().sun_light[0] = {0.9f, 0.8f, 0.6f, 0};
    gpu.frame().sky_irradiance = {0.05f, 0.07f, 0.12f, 0};
    const auto results = gpu.run(
        "result = vec4(sky_ground_seen(vec3(0.3, 0.2, 0.1), float(y) / 10.0 - 0.5,\n"
        "                              float(x) / 100.0), 0.0);",
        101, 11);
    const glm::dvec3 sun(0.9, 0.8, 0.6), sky(0.05, 0.07, 0.12), albedo(0.13, 0.14, 0.10);
    const glm::dvec3 air(0.3, 0.2, 0.1);
    std::vector<double> errors;
    for (int y = 0; y <= 10; ++y) {
        for (int x = 0; x <= 100; ++x) {
            const double seen = std::exp(-0.12 / std::max(x / 100.0, 1e-3));
            const glm::vec4 found = results[static_cast<std::size_t>(y * 101 + x)];
            for (int c = 0; c < 3; ++c) {
                const double ground = albedo[c] * (sky[c] + std::max(y / 10.0 - 0.5, 0.0) * sun[c]);
                errors.push_back(std::abs(found[c] - (air[c] + seen * (ground - air[c]))));
            }
        }
    }
    EXPECT_LT(worst(errors, "ground beyond the DEM, GPU against double", 1e-3), 1e-3);
}

TEST(Sky, SlopesGetTheLightOfTheGroundThatTheySee) {
    test::GpuSnippet gpu("sky");
    const auto results = gpu.run(
        "result = vec4(sky_bounce(cos(radians(float(x))), vec3(0.5, 0.4, 0.3)), 0.0);", 181, 1);
    // The share of the sphere's cosine-weighted half that lies below the horizon, by integration.
    std::vector<double> errors;
    for (int deg = 0; deg <= 180; deg += 15) {
        const glm::dvec3 normal(std::sin(radians(deg)), 0, std::cos(radians(deg)));
        double below = 0;
        for (int e = 0; e < 180; ++e) {
            for (int a = 0; a < 360; ++a) {
                const glm::dvec3 to = direction(radians(a + 0.5), radians(e - 89.5));
                if (to.z < 0)
                    below += std::max(dot(to, normal), 0.0) * std::cos(radians(e - 89.5)) *
                             radians(1) * radians(1) / kPi;
            }
        }
        const double expected = below * 0.13 * 0.5;
        errors.push_back(std::abs(results[static_cast<std::size_t>(deg)].x - expected));
    }
    EXPECT_LT(worst(errors, "light of the ground on slopes, GPU against double", 1e-3), 1e-3);
    EXPECT_EQ(results[0].x, 0);  // level ground sees none
}

TEST(Sky, TheExponentFallsWithTheEyesHeight) {
    test::GpuSnippet gpu("sky");
    const auto results = gpu.run("result = vec4(sky_exponent(100.0 * float(x) - 500.0));", 301, 1);
    std::vector<double> errors;
    for (int x = 0; x <= 300; ++x)
        errors.push_back(
            std::abs(results[static_cast<std::size_t>(x)].x -
                     0.5 * std::exp(-std::clamp(100.0 * x - 500.0, 0.0, 20000.0) / 8430)));
    EXPECT_LT(worst(errors, "sky exponent, GPU against double", 1e-3), 1e-3);
}

TEST(Sky, TheSunsHeightBlendsTwoOfTheThreeTextures) {
    test::GpuSnippet gpu("sky");
    const auto results =
        gpu.run("result = vec4(sky_blend(sin(radians(float(x) - 90.0))), 0.0);", 181, 1);
    std::vector<double> errors;
    for (int deg = -90; deg <= 90; ++deg) {
        const glm::vec4 w = results[static_cast<std::size_t>(deg + 90)];
        const double sine = std::sin(radians(deg));
        const double day = std::clamp(sine / std::sin(radians(25.0)), 0.0, 1.0);
        const double night = std::clamp(sine / std::sin(radians(-12.0)), 0.0, 1.0);
        errors.push_back(std::abs(w.x - day));
        errors.push_back(std::abs(w.y - (1 - day - night)));
        errors.push_back(std::abs(w.z - night));
        EXPECT_LE((w.x > 0) + (w.y > 0) + (w.z > 0), 2) << deg;
    }
    EXPECT_LT(worst(errors, "sky blend, GPU against double", 1e-3), 1e-3);
}

TEST(Sky, SlicesAreThoseOfTheGenerator) {
    // tools/sky/textures.cpp, Layout::slice_of.
    const auto folded = [](double y) { return y / (0.14 + std::abs(y)); };
    const double lowest = folded(std::sin(radians(-18.0)));
    test::GpuSnippet gpu("sky");
    const auto results =
        gpu.run("result = vec4(sky_slice(sin(radians(float(x) - 90.0))));", 181, 1);
    std::vector<double> errors;
    for (int deg = -90; deg <= 90; ++deg)
        errors.push_back(
            std::abs(results[static_cast<std::size_t>(deg + 90)].x -
                     std::clamp((folded(std::sin(radians(deg))) - lowest) / (folded(1) - lowest),
                                0.0, 1.0)));
    EXPECT_LT(worst(errors, "sky slice, GPU against double", 1e-3), 1e-3);
}

TEST(Sky, AirMassIsRozenbergs) {
    test::GpuSnippet gpu("sky");
    const auto results = gpu.run("result = vec4(sky_air_mass_of(sin(radians(float(x)))));", 91, 1);
    std::vector<double> errors;
    for (int deg = 0; deg <= 90; ++deg) {
        const double sine = std::sin(radians(deg));
        const double expected = 1 / (sine + 0.025 * std::exp(-11 * sine));
        errors.push_back(std::abs(results[static_cast<std::size_t>(deg)].x / expected - 1));
    }
    EXPECT_LT(worst(errors, "sky air mass, relative", 1e-3), 1e-3);
}

/// An eye over the DEM's centre, the sun in the north.
void look(test::GpuSnippet& gpu, render::AirTextures& air, double height_m, double sun_deg) {
    render::FrameBlock& frame = gpu.frame();
    const double sun = radians(sun_deg);
    frame.eye_m = {0, 0, height_m, height_m};
    frame.eye_up = {0, 0, 1, sky::horizon_sine(height_m)};
    frame.eye_sun = {0, std::cos(sun), std::sin(sun), sun};
    frame.sun_direction = frame.eye_sun;
    air.update(sky::Air{}, {.height_m = height_m, .light = {.sun_sine = std::sin(sun)}}, frame);
    gpu.bind("air_sky", *air.texture("air_sky"));
    gpu.bind("air_between", *air.texture("air_between"));
}

TEST(SkyAir, RadianceOnTheGpuIsTheAtmospheres) {
    // 30 directions of 12 azimuths from the sun's; the sun's disc is not part of it.
    const auto atmosphere = sky::atmosphere_of(sky::Air{});
    for (const double height : {2.0, 3000.0, 11000.0}) {
        for (const double sun_deg : {60.0, 5.0, -2.0, -8.0}) {
            test::GpuSnippet gpu("sky");
            render::AirTextures air;
            look(gpu, air, height, sun_deg);
            const auto results = gpu.run(
                "float azimuth = radians(15.0 * float(x) + 7.0), elevation = radians(3.0 * "
                "float(y) + 1.0);\n"
                "vec3 view = vec3(cos(elevation) * vec2(sin(azimuth), cos(azimuth)), "
                "sin(elevation));\n"
                "result = vec4(sky_on_background_radiance(view, false), 1.0);",
                12, 30);
            std::vector<double> errors;
            double mean = 0;
            for (int y = 0; y < 30; ++y) {
                for (int x = 0; x < 12; ++x) {
                    const double elevation = radians(3.0 * y + 1);
                    const glm::dvec3 expected =
                        sky::colour_of(atmosphere->radiance({height, std::sin(elevation),
                                                             std::sin(radians(sun_deg)),
                                                             std::cos(radians(15.0 * x + 7))})) +
                        sky::night_radiance(height, std::sin(elevation),
                                            sky::colour_of(atmosphere->transmittance(
                                                               height, std::sin(elevation), 1e9))
                                                .g);
                    const glm::dvec3 found(results[static_cast<std::size_t>(12 * y + x)]);
                    errors.push_back(std::abs(found.g / expected.g - 1));
                    mean += errors.back() / 360;
                }
            }
            fmt::print("[ sky ] from {:.0f} m, sun {:.0f}: mean {:.2f} %\n", height, sun_deg,
                       100 * mean);
            EXPECT_LT(worst(errors, "sky radiance, GPU against the atmosphere", 0.08), 0.08);
            EXPECT_LT(mean, 0.01);
        }
    }
}

TEST(SkyAir, GroundOfTheEarthIsSeenThroughItsAir) {
    const auto atmosphere = sky::atmosphere_of(sky::Air{});
    test::GpuSnippet gpu("sky");
    render::AirTextures air;
    look(gpu, air, 8000, 30);
    const auto results = gpu.run(
        "float elevation = radians(-4.0 - 3.0 * float(x));\n"
        "vec3 view = vec3(0.0, cos(elevation), sin(elevation));\n"
        "result = vec4(air_radiance(view) + 0.12 * air_ground(view), 1.0);",
        28, 1);
    std::vector<double> errors;
    for (int x = 0; x < 28; ++x) {
        const glm::dvec3 expected = sky::colour_of(atmosphere->radiance(
            {8000, std::sin(radians(-4.0 - 3 * x)), std::sin(radians(30.0)), 1}));
        errors.push_back(std::abs(results[static_cast<std::size_t>(x)].g / expected.g - 1));
    }
    EXPECT_LT(worst(errors, "ground of the Earth, GPU against the atmosphere", 0.03), 0.03);
}

TEST(SkyAir, AroundADemThatIsMostlySeaIsSea) {
    const auto beyond = [](double share, const std::string& sea) {
        test::GpuSnippet gpu("sky");
        gpu.values().set("sky.earth_sea", sea);
        gpu.frame().sea_floor_share = static_cast<float>(share);
        return glm::vec3(gpu.run("result = vec4(sky_beyond(), 0.0);", 1, 1)[0]);
    };
    const glm::vec3 land{0.13, 0.14, 0.10}, sea{0.006, 0.037, 0.108};
    EXPECT_EQ(beyond(0, "true"), land);
    EXPECT_EQ(beyond(0.5, "true"), land);
    EXPECT_LT(glm::distance(beyond(0.99, "true"), sea), 1e-6F);
    EXPECT_EQ(beyond(0.99, "false"), land);
}

TEST(SkyAir, BelowTheHorizonTheSkyGoesOnAsTheHorizon) {
    // What fades into the sky, and what stands where there is no ground.
    test::GpuSnippet gpu("sky");
    render::AirTextures air;
    look(gpu, air, 2000, 30);
    const auto results = gpu.run(
        "float elevation = 0.9999 * asin(frame.eye_up.w) - 0.3 * float(x);\n"
        "vec3 view = vec3(0.0, -cos(elevation), sin(elevation));\n"
        "result = vec4(sky_on_background_radiance(view, false), 1.0);",
        5, 1);
    for (int x = 1; x < 5; ++x)
        EXPECT_NEAR(results[static_cast<std::size_t>(x)].g / results[0].g, 1, 0.05) << x;
}

TEST(SkyAir, TheMoonHasTheAureoleOfItsLight) {
    // A moon 40 degrees high in the east of a night, whose light is a millionth of the sun's.
    const auto atmosphere = sky::atmosphere_of(sky::Air{});
    const double moon_sine = std::sin(radians(40.0)), strength = 1e-6;
    test::GpuSnippet gpu("sky");
    render::AirTextures air;
    look(gpu, air, 2, -40);
    gpu.frame().eye_moon = glm::vec4(std::cos(radians(40.0)), 0, moon_sine, 0.0045);
    gpu.frame().eye_moon_light = glm::vec4(glm::vec3(1e-6f), 1);
    air.update(sky::Air{},
               {.height_m = 2,
                .light = {.sun_sine = std::sin(radians(-40.0)),
                          .moon_sine = moon_sine,
                          .moon = glm::vec3(1e-6f)}},
               gpu.frame());
    const auto results = gpu.run(
        "float elevation = radians(40.0 + 2.0 * float(x));\n"
        "vec3 view = vec3(cos(elevation), 0.0, sin(elevation));\n"
        "result = vec4(1e6 * air_radiance(view), 1.0);",
        20, 1);
    std::vector<double> errors;
    for (int x = 1; x < 20; ++x) {
        const double sine = std::sin(radians(40.0 + 2 * x));
        const glm::dvec3 night =
            sky::night_radiance(2, sine, sky::colour_of(atmosphere->transmittance(2, sine, 1e9)).g);
        const glm::dvec3 expected =
            sky::colour_of(atmosphere->radiance({2, sine, moon_sine, 1})) + night / strength;
        errors.push_back(std::abs(results[static_cast<std::size_t>(x)].g / expected.g - 1));
    }
    // But for the aureole the sky has the mean of its azimuths.
    EXPECT_LT(worst(errors, "sky around the moon, GPU against the atmosphere", 0.1), 0.1);
}

TEST(SkyAir, ColoursOfTheDuskStayAboveBlack) {
    test::GpuSnippet gpu("sky");
    render::AirTextures air;
    look(gpu, air, 2, 0);
    for (const glm::vec4& result :
         gpu.run(std::string(kDirection) + "result = vec4(air_radiance(view), 1.0);", 360, 181))
        for (int c = 0; c < 3; ++c)
            ASSERT_GE(result[c], 0);
}

// Stars. tools/sky/stars.h has their texture, tests/golden/test_stars.cpp their places in pictures.

TEST(SkyStars, AreBentByBennettsRefraction) {
    // By a quarter of a degree, from half a degree below the horizon.
    test::GpuSnippet gpu("sky");
    const auto results = gpu.run(
        "float h = radians(0.25 * float(x) - 0.5);\n"
        "result = vec4(sky_bend(sin(h)) * cos(h));",
        362, 1);
    std::vector<double> errors;
    for (int x = 0; x < 362; ++x) {
        const double deg = 0.25 * x - 0.5, h = radians(deg);
        const double refraction =
            radians(1 / std::tan(radians(deg + 7.31 / (deg + 4.4))) / 60);  // Bennett
        const double expected = std::sin(refraction) / std::cos(h - refraction) * std::cos(h);
        errors.push_back(std::abs(results[static_cast<std::size_t>(x)].x - expected) /
                         kArcsecond_rad);
    }
    EXPECT_LT(worst(errors, "sky refraction of stars [arcsec], against Bennett", 1), 1);
}

TEST(SkyStars, AreLookedUpWhereTheCatalogueHasThem) {
    // A rotation about an odd axis, an odd velocity, air of strength 1.1: as in the frame block.
    const glm::dvec3 axis = normalize(glm::dvec3(0.3, -0.5, 0.8));
    const glm::dvec3 velocity(3e-5, -8e-5, 4e-5);
    const auto turned = [&](const glm::dvec3& v) {
        const double c = std::cos(2.0), s = std::sin(2.0);
        return c * v + s * cross(axis, v) + (1 - c) * dot(axis, v) * axis;
    };
    test::GpuSnippet gpu("sky");
    const glm::dvec3 columns[3] = {turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1})};
    for (int i = 0; i < 3; ++i)
        gpu.frame().celestial[static_cast<std::size_t>(i)] =
            glm::vec4(columns[0][i], columns[1][i], columns[2][i], velocity[i]);
    gpu.frame().eye_sun_light.a = 1.1f;
    const auto results = gpu.run(
        std::string(kDirection) + "result = vec4(sky_catalogued(view, up), 0.0);", 360, 181);
    std::vector<double> errors;
    for (int y = 90; y <= 180; ++y) {
        for (int x = 0; x < 360; x += 7) {
            const glm::dvec3 view = direction(radians(x), radians(y - 90.0));
            const double bent = 1.1 * 0.00029043 / (view.z + 0.0022149 / (view.z + 0.0765018));
            const glm::dvec3 expected =
                normalize(turned(normalize(view - bent * glm::dvec3(0, 0, 1))) - velocity);
            errors.push_back(
                distance(glm::dvec3(results[static_cast<std::size_t>(y * 360 + x)]), expected) /
                kArcsecond_rad);
        }
    }
    EXPECT_LT(worst(errors, "sky place in the catalogue [arcsec], GPU against double", 0.5), 0.5);
}

TEST(SkyStars, CellsAreThoseOfTheGenerator) {
    // tools/sky/stars.cpp, StarLayout: an octahedron unfolded onto 96 x 96 cells.
    const auto sign = [](double v) { return v < 0 ? -1.0 : 1.0; };
    test::GpuSnippet gpu("sky");
    const auto centres = gpu.run("result = vec4(sky_star_centre(ivec2(x, y)), 0.0);", 96, 96);
    const auto cells = gpu.run(
        "result = vec4(vec2(sky_star_cell(sky_star_centre(ivec2(x, y)))), 0.0, 0.0);", 96, 96);
    std::vector<double> errors;
    for (int y = 0; y < 96; ++y) {
        for (int x = 0; x < 96; ++x) {
            const glm::dvec2 p((2 * x + 1) / 96.0 - 1, (2 * y + 1) / 96.0 - 1);
            glm::dvec3 centre(p, 1 - std::abs(p.x) - std::abs(p.y));
            if (centre.z < 0) {
                centre.x = (1 - std::abs(p.y)) * sign(p.x);
                centre.y = (1 - std::abs(p.x)) * sign(p.y);
            }
            const auto at = static_cast<std::size_t>(y * 96 + x);
            errors.push_back(distance(glm::dvec3(centres[at]), normalize(centre)) / kArcsecond_rad);
            EXPECT_EQ(cells[at].x, x);
            EXPECT_EQ(cells[at].y, y);
        }
    }
    EXPECT_LT(worst(errors, "sky middle of a star's cell [arcsec], GPU against double", 0.2), 0.2);
}

TEST(SkyStars, BrightnessIsPogsonsAndColourOfLuminanceOne) {
    test::GpuSnippet gpu("sky");
    const auto results =
        gpu.run("result = vec4(sky_star_colour(float(1 + 16 * y + x)), 0.0);", 16, 128);
    std::vector<double> errors;
    for (int y = 0; y < 128; ++y) {
        for (int x = 0; x < 16; ++x) {
            const double flux = std::pow(10, -0.4 * (0.0625 * y - 1.5)), b_v = 0.15 * x - 0.35;
            const double red = 0.7829 + 0.3121 * b_v + 0.0325 * b_v * b_v;
            const double blue = 1.567 - 0.9949 * b_v + 0.2023 * b_v * b_v;
            const double green = (1 - 0.2126 * red - 0.0722 * blue) / 0.7152;
            const glm::dvec3 found(results[static_cast<std::size_t>(y * 16 + x)]);
            errors.push_back(distance(found / flux, glm::dvec3(red, green, blue)));
        }
    }
    EXPECT_LT(worst(errors, "sky light of a star, relative, GPU against double", 1e-3), 1e-3);
}

TEST(SkyStars, AreOfTheSameSizeAllOverThePicture) {
    // A star off the axis by this angle: the picture is scaled by 1 / cos^2 outwards and 1 / cos
    // across, so that its area is 0.6^2 square pixels everywhere.
    test::GpuSnippet gpu("sky");
    gpu.frame().pixel_ray_dx = {0.001f, 0, 0, 0};
    gpu.frame().pixel_ray_dy = {0, 0, 0.001f, 0};  // up is z, so the camera looks north
    const auto results = gpu.run(
        "float off = radians(0.5 * float(x));\n"
        "result = vec4(1e6 * sky_star_spread(vec3(sin(off), cos(off), 0.0)));",
        120, 1);
    std::vector<double> errors;
    for (int x = 0; x < 120; ++x)
        errors.push_back(std::abs(results[static_cast<std::size_t>(x)].x -
                                  0.36 * std::pow(std::cos(radians(0.5 * x)), 3)));
    EXPECT_LT(worst(errors, "sky size of a star, GPU against double", 1e-3), 1e-3);
}

}  // namespace
}  // namespace relevo::test_sky
