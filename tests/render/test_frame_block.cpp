#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "base/units.h"
#include "render/frame_block.h"
#include "render/height_light.h"
#include "sun/daylight.h"
#include "sun/refraction.h"
#include "support/gpu_snippet.h"
#include "support/support.h"

namespace relevo::render::test_frame_block {
namespace {

scene::Camera camera_at(const glm::dvec3& eye_m) {
    return scene::look_at_camera(eye_m, {0, 0, 0}, {0, 0, 1}, radians(40));
}

FrameInputs inputs_at(const glm::dvec3& eye_m) {
    FrameInputs inputs;
    inputs.camera = camera_at(eye_m);
    inputs.sun.direction = normalize(glm::dvec3(0.5, 0.3, 0.6));
    inputs.sun.lowest_sine = 0.6;
    inputs.sun.highest_sine = 0.8;
    return inputs;
}

TEST(FrameBlock, EachPartIsWhereTheShadersReadIt) {
    test::GpuSnippet gpu("");
    FrameBlock& frame = gpu.frame();
    frame.eye_above_ground = 1;
    frame.sun_direction.w = 2;
    frame.instance_shadow_weight = 3;
    frame.eye_sun.w = 4;
    frame.corona.w = 5;
    frame.height_range.w = 6;
    frame.beyond_m = 7;
    frame.viewport.w = 8;
    frame.time_of_year = 9;
    const auto read = gpu.run(
        "result = x == 0 ? vec4(frame.eye_above_ground, frame.sun_direction.w,\n"
        "                       frame.instance_shadow_weight, frame.eye_sun.w)\n"
        "                : vec4(frame.corona.w, frame.height_range.w, frame.beyond_m,\n"
        "                       10.0 * frame.viewport.w + frame.time_of_year);",
        2, 1);
    EXPECT_EQ(read[0], glm::vec4(1, 2, 3, 4));
    EXPECT_EQ(read[1], glm::vec4(5, 6, 7, 89));
}

TEST(FrameBlock, UpIsTheNormalOfTheEllipsoidEverywhere) {
    double worst = 0;
    for (const double lat_deg : {-80.0, -33.9, 0.0, 46.5, 89.9}) {
        const Ground ground{.frame = geo::LocalFrame(geo::geodetic_deg(lat_deg, 11, 0)),
                            .lowest_m = 0,
                            .highest_m = 3000};
        const glm::dvec3 eye{3000, -8000, 4000};
        const FrameBlock block = make_frame_block(inputs_at(eye), ground, 640, 512, 4);
        for (const double x : {-100e3, 0.0, 400e3}) {
            for (const double y : {-200e3, 1000.0, 100e3}) {
                const glm::dvec3 point{x, y, 2000};
                const geo::Geodetic place = ground.frame.to_geodetic(point);
                const glm::dvec3 exact = ground.frame.up(place.lat_rad, place.lon_rad);
                const glm::vec3 relative(point - eye);
                const glm::vec3 up =
                    normalize(glm::vec3(block.up_at_eye) + glm::mat3(block.up_matrix) * relative);
                worst = std::max(worst, distance(exact, glm::dvec3(up)));
            }
        }
    }
    fmt::print("[ accuracy ] local vertical on the GPU: worst {:.2g} rad\n", worst);
    // The normal of a level surface turns by flattening * height / radius, and points 400 km away
    // in the tangent plane lie 14 km high.
    EXPECT_LT(worst, 1e-5);
}

TEST(FrameBlock, APartOfAPictureHasItsRaysAndPlaces) {
    const Ground ground{
        .frame = geo::LocalFrame(geo::geodetic_deg(46, 11, 0)), .lowest_m = 0, .highest_m = 3000};
    FrameInputs inputs = inputs_at({3000, -8000, 4000});
    const FrameBlock whole = make_frame_block(inputs, ground, 1000, 600, 4);
    inputs.part = PicturePart{{1000, 600}, {640, 128}};
    const FrameBlock part = make_frame_block(inputs, ground, 256, 192, 4);
    const auto place = [](const FrameBlock& block, const glm::vec3& point) {
        const glm::vec4 clip = block.view_projection * glm::vec4(point, 1);
        return 0.5F * (glm::vec2(clip) / clip.w + 1.0F) * glm::vec2(block.viewport);
    };
    for (const glm::vec2 at : {glm::vec2(650, 130), {800.25, 300.5}, {895, 319}}) {
        const glm::vec3 ray = glm::vec3(whole.pixel_ray) + at.x * glm::vec3(whole.pixel_ray_dx) +
                              at.y * glm::vec3(whole.pixel_ray_dy);
        EXPECT_LT(distance(place(whole, 5000.0F * ray), at), 1e-2F);
        EXPECT_LT(distance(place(part, 5000.0F * ray), at - glm::vec2(640, 128)), 1e-2F);
    }
    EXPECT_EQ(part.part_left, 640);
    EXPECT_EQ(part.picture, whole.picture);
    EXPECT_EQ(part.pixel_ray_dx, whole.pixel_ray_dx);
}

TEST(FrameBlock, TheTargetIsInTheMiddleOfThePicture) {
    const Ground ground{
        .frame = geo::LocalFrame(geo::geodetic_deg(46, 11, 0)), .lowest_m = 0, .highest_m = 3000};
    const glm::dvec3 eye{3000, -8000, 4000};
    const FrameBlock block = make_frame_block(inputs_at(eye), ground, 640, 512, 4);
    const glm::vec4 clip = block.view_projection * glm::vec4(glm::vec3(-eye), 1);
    EXPECT_NEAR(clip.x / clip.w, 0, 1e-6);
    EXPECT_NEAR(clip.y / clip.w, 0, 1e-6);
    EXPECT_NEAR(clip.w, length(eye), 1e-2);
    const glm::vec3 ray = glm::vec3(block.pixel_ray) + 320.0f * glm::vec3(block.pixel_ray_dx) +
                          256.0f * glm::vec3(block.pixel_ray_dy);
    EXPECT_NEAR(distance(ray, glm::vec3(normalize(-eye))), 0, 1e-6);
}

TEST(FrameBlock, APointRightOfTheTargetIsDrawnRightAndAHigherOneHigher) {
    const Ground ground{
        .frame = geo::LocalFrame(geo::geodetic_deg(46, 11, 0)), .lowest_m = 0, .highest_m = 3000};
    const glm::dvec3 eye{0, -8000, 4000};  // looks north
    const FrameBlock block = make_frame_block(inputs_at(eye), ground, 640, 512, 4);
    const auto clip = [&](const glm::dvec3& point) {
        return block.view_projection * glm::vec4(glm::vec3(point - eye), 1);
    };
    EXPECT_GT(clip({1000, 0, 0}).x, 0);
    EXPECT_GT(clip({0, 0, 1000}).y, 0);
    // Reversed depth: nearer is larger.
    const glm::vec4 near = clip({0, -1000, 0}), far = clip({0, 1000, 0});
    EXPECT_GT(near.z / near.w, far.z / far.w);
}

/// What the shader computes from the table, in single precision.
struct Lit {
    glm::vec3 light;
    glm::vec3 to_sun;
};
Lit evaluate(const SunLightTable& table, const glm::dvec3& direction, const glm::dvec3& up) {
    const auto sine = static_cast<float>(dot(direction, up));
    const float scaled = sine / (std::abs(sine) + 0.1F);
    const float at = std::clamp((scaled - table.domain.x) * table.domain.y, 0.0F, 127.0F);
    const auto entry = std::min(static_cast<std::size_t>(at), std::size_t{126});
    const glm::vec4 light =
        mix(table.light[entry], table.light[entry + 1], at - static_cast<float>(entry));
    return {glm::vec3(light), normalize(glm::vec3(direction) + light.a * glm::vec3(up))};
}

/// Bennett's formula: any smooth refraction will do, the table is what is tested.
double bennett_rad(double h_rad) {
    const double h = std::max(degrees(h_rad), -1.0);
    return radians(1.02 / std::tan(radians(h + 10.3 / (h + 5.11))) / 60);
}

/// Worst of refraction [arcsec] and of irradiance [share] of a sun that stands from one elevation
/// over a DEM to another [degrees].
struct Off {
    double arcsec = 0, light = 0;
};
Off worst_over(double lowest_deg, double highest_deg, double from_deg) {
    SunLight sun;
    sun.direction = {0, 0, 1};
    sun.refraction_rad = bennett_rad;
    sun.lowest_sine = std::sin(radians(lowest_deg));
    sun.highest_sine = std::sin(radians(highest_deg));
    const scene::Camera camera;
    const FrameInputs inputs{.camera = camera, .sun = sun, .stars = {}};
    const SunLightTable table = sun_light_table(sun, HeightLight(inputs, 0));
    Off worst;
    for (double at_deg = from_deg; at_deg <= highest_deg;
         at_deg += (highest_deg - lowest_deg) / 517) {
        const double elevation = radians(at_deg);
        const glm::dvec3 up{0, std::cos(elevation), std::sin(elevation)};
        const Lit lit = evaluate(table, sun.direction, up);
        const double apparent =
            std::atan2(dot(glm::dvec3(lit.to_sun), up),
                       length(glm::dvec3(lit.to_sun) - dot(glm::dvec3(lit.to_sun), up) * up));
        worst.arcsec = std::max(
            worst.arcsec, std::abs(apparent - elevation - bennett_rad(elevation)) / kArcsecond_rad);
        const glm::dvec3 exact = sun::direct_transmittance(elevation + bennett_rad(elevation), 0);
        worst.light = std::max(worst.light, std::abs(lit.light.r - exact.r) / exact.r);
    }
    fmt::print(
        "[ accuracy ] light of a sun {} to {} degrees high over a DEM: refraction {:.2g} arcsec, "
        "irradiance {:.2g} %\n",
        from_deg, highest_deg, worst.arcsec, 100 * worst.light);
    return worst;
}

TEST(SunLight, FollowsRefractionAndTransmittanceOverADem) {
    // A DEM of 100 km: the sun's elevation differs by 0.45 degrees to either side.
    for (const double centre_deg : {2.0, 5.0, 20.0, 60.0}) {
        const Off worst = worst_over(centre_deg - 0.45, centre_deg + 0.45, centre_deg - 0.45);
        // Single precision alone is worth 0.05 arcsec.
        EXPECT_LT(worst.arcsec, centre_deg >= 5 ? 0.2 : 2.0);
        EXPECT_LT(worst.light, 0.001);
    }
}

TEST(SunLight, IsAsGoodOverTheWholeEarth) {
    const Off worst = worst_over(-90, 89.9, 0);
    EXPECT_LT(worst.arcsec, 20);
    EXPECT_LT(worst.light, 0.01);
}

/// As plugins/sky/sky.glsl: how far refraction of strength 1 moves a direction along the vertical.
double bend(double sine) {
    return 0.00029043 / (sine + 0.0022149 / (sine + 0.0765018));
}

TEST(FrameBlock, OnlyAerialViewsHaveAClearForeground) {
    Ground ground{.frame = geo::LocalFrame(geo::geodetic_deg(47, 11))};
    ground.south_west_m = glm::dvec2(-30000);
    ground.north_east_m = glm::dvec2(30000);
    FrameInputs inputs = inputs_at({0, -60000, 15000});
    const FrameBlock as_it_is = make_frame_block(inputs, ground, 640, 512, 4);
    EXPECT_EQ(as_it_is.air_near_m, 0);
    EXPECT_EQ(as_it_is.air_scale, 1);
    inputs.in_the_air = true;
    const FrameBlock aerial = make_frame_block(inputs, ground, 640, 512, 4);
    EXPECT_NEAR(aerial.air_near_m, 0.9 * std::hypot(30000, 15000), 400);
    EXPECT_NEAR(aerial.air_scale, std::sqrt(0.1), 1e-3);
    // Near the ground the air is the true one.
    const FrameBlock low = make_frame_block(
        [] {
            FrameInputs near_ground = inputs_at({0, -60000, 300});
            near_ground.in_the_air = true;
            return near_ground;
        }(),
        ground, 640, 512, 4);
    EXPECT_LT(low.air_near_m, 3000);
    EXPECT_GT(low.air_scale, 0.9);
}

TEST(FrameBlock, TheCountryAroundIsAsHighAsTheRimOrItsSea) {
    Ground ground{.frame = geo::LocalFrame(geo::geodetic_deg(47, 11)), .lowest_m = -20};
    ground.rim_m = 700;
    EXPECT_EQ(ground.country_m(), 700);
    ground.sea_rim_share = 0.1;
    EXPECT_EQ(ground.country_m(), -20);
    ground.sea_floor_share = 0.3;
    EXPECT_EQ(ground.country_m(), 0);
}

TEST(FrameBlock, SaysHowMuchTheAirBendsStarlight) {
    std::vector<double> high_arcsec, low_arcsec;
    for (const double height_m : {0.0, 1500.0, 4000.0}) {
        const Ground ground{.frame = geo::LocalFrame(geo::geodetic_deg(46, 11, height_m)),
                            .lowest_m = 0};
        const sun::Refraction air = sun::Refraction::standard(ground.frame.origin());
        FrameInputs inputs = inputs_at({0, -10, 0});
        inputs.sun.ground_height_m = height_m;
        inputs.sun.refraction_rad = [&](double elevation_rad) {
            return air.apparent_rad(elevation_rad) - elevation_rad;
        };
        const double strength = make_frame_block(inputs, ground, 640, 512, 4).eye_sun_light.a;
        for (double deg = 0; deg < 90; deg += 0.25) {
            const double apparent = radians(deg);
            const double found = std::atan2(
                std::sin(apparent) - strength * bend(std::sin(apparent)), std::cos(apparent));
            (deg < 10 ? low_arcsec : high_arcsec)
                .push_back(std::abs(found - air.true_rad(apparent)) / kArcsecond_rad);
        }
    }
    test::print_accuracy("refraction of stars from 10 degrees up, against integration", high_arcsec,
                         "arcsec", 4);
    test::print_accuracy("refraction of stars below 10 degrees, against integration", low_arcsec,
                         "arcsec", 40);
    EXPECT_LT(*std::max_element(high_arcsec.begin(), high_arcsec.end()), 4);
    EXPECT_LT(*std::max_element(low_arcsec.begin(), low_arcsec.end()), 40);
}

TEST(FrameBlock, WithoutRefractionNothingIsBent) {
    const Ground ground{.frame = geo::LocalFrame(geo::geodetic_deg(46, 11, 0))};
    EXPECT_EQ(make_frame_block(inputs_at({0, -10, 5}), ground, 640, 512, 4).eye_sun_light.a, 0);
}

TEST(FrameBlock, HasTheRowsOfTheRotationToTheStars) {
    const Ground ground{.frame = geo::LocalFrame(geo::geodetic_deg(46, 11, 0))};
    FrameInputs inputs = inputs_at({0, -10, 5});
    inputs.stars = sun::celestial_frame(sun::Epoch::at(sun::Instant::from_utc({{2026, 1, 15}, 22})),
                                        ground.frame.origin());
    const FrameBlock block = make_frame_block(inputs, ground, 640, 512, 4);
    // The Earth's axis leads to the celestial pole of date, which precession carries away from that
    // of J2000 by 20 arcsec a year.
    const glm::vec3 axis(block.polar_axis);
    const glm::dvec3 pole{dot(glm::vec3(block.celestial[0]), axis),
                          dot(glm::vec3(block.celestial[1]), axis),
                          dot(glm::vec3(block.celestial[2]), axis)};
    EXPECT_NEAR(std::hypot(pole.x, pole.y) / kArcsecond_rad, 20.04 * 26.04, 10);
    EXPECT_NEAR(pole.z, 1, 1e-5);
    for (glm::length_t i = 0; i < 3; ++i)
        EXPECT_EQ(block.celestial[static_cast<std::size_t>(i)].w,
                  static_cast<float>(inputs.stars.velocity[i]));
}

TEST(FrameBlock, RefractionFallsWithTheHeightOfTheEye) {
    const Ground ground{.frame = geo::LocalFrame(geo::geodetic_deg(46, 11, 0)), .lowest_m = 0};
    const auto lift = [&](double eye_height_m) {
        FrameInputs inputs = inputs_at({0, -10, eye_height_m});
        inputs.sun.ground_height_m = 0;
        inputs.sun.direction = normalize(glm::dvec3(0, 1, 0.05));
        inputs.sun.refraction_rad = [](double) { return 0.004; };
        const FrameBlock block = make_frame_block(inputs, ground, 640, 512, 4);
        return static_cast<double>(block.eye_sun.w) - std::asin(inputs.sun.direction.z);
    };
    EXPECT_NEAR(lift(0), 0.004, 3e-6);
    EXPECT_NEAR(lift(10000), 0.004 * std::exp(-1.0), 3e-6);
}

}  // namespace
}  // namespace relevo::render::test_frame_block
