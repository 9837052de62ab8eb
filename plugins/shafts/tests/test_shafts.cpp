#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "base/array2d.h"
#include "dem/load.h"
#include "dem/posts.h"
#include "light/fields.h"
#include "light/raster/clearance.h"
#include "render/drawn.h"
#include "sky/integrate.h"
#include "sky/shipped.h"
#include "support/support.h"

namespace relevo::test_shafts {
namespace {

const test::TestEffect kBlack{
    "lit", "void lit_on_lit(in Surface s, inout vec3 radiance) { radiance = vec3(0.0); }\n"};
const test::TestEffect kDistance{
    "probe",
    "void probe_on_atmosphere(in Surface s, in vec3 view, inout vec3 radiance) {\n"
    "    radiance = vec3(s.distance_m / 1048576.0, 0.0, 1.0) / frame.exposure;\n"
    "}\n"};

/// The effects of the air, with or without shafts.
std::vector<effect::Effect> air_effects(bool shafts) {
    const std::filesystem::path share = RELEVO_SHARE_DIR;
    std::vector<effect::Effect> effects;
    if (shafts) effects.push_back(effect::load_effect(share / "plugins/shafts", {}));
    effects.push_back(effect::load_effect(share / "plugins/haze", {}));
    effects.push_back(effect::load_effect(share / "plugins/sky", share / "data"));
    effects.push_back(effect::load_effect(share / "plugins/shadows", {}));
    return effects;
}

/// A ray of a picture, as the atmosphere takes it.
sky::Atmosphere::View view_of(const test::Drawn& drawn, const glm::dvec3& ray) {
    const geo::Geodetic eye = drawn.ground().frame.to_geodetic(drawn.frame().camera.eye_m);
    const glm::dvec3 up = drawn.ground().frame.up(eye.lat_rad, eye.lon_rad);
    const glm::dvec3& to_sun = drawn.frame().sun.direction;
    const double sine = dot(ray, up), sun_sine = dot(to_sun, up);
    const double level = std::sqrt((1 - sine * sine) * (1 - sun_sine * sun_sine));
    return {eye.height_m, sine, sun_sine, (dot(ray, to_sun) - sine * sun_sine) / level};
}

/// Sunlight that air scatters once on the first part of a ray, in green.
double scattered_once(const sky::Atmosphere& air, const sky::Atmosphere::View& view, double way_m) {
    std::vector<double> ends;
    for (int i = 0; i <= 200; ++i)
        ends.push_back(way_m * i / 200);
    const sky::Sun sun{view.sun_sine, view.azimuth_cos};
    std::array<sky::Brought, 1> brought{};
    brought[0].through.fill(1);
    integrate(air.coefficients(), {.sun = true}, {view.height_m, view.sine, {&sun, 1}}, ends, false,
              brought);
    const double phase = sky::aerosol_phase(ray_sun_cosine(view.sine, sun));
    sky::Spectrum light{};
    for (std::size_t k = 0; k < light.size(); ++k)
        light[k] = kPi * (brought[0].air[k] + phase * brought[0].aerosol[k]);
    return sky::colour_of(light).g;
}

/// Height of the shadow over each post [m].
Array2d<float> shadow_heights(const test::Drawn& drawn) {
    const dem::Heightfield& field = drawn.dem();
    const dem::Posts posts(field);
    const render::SunLight& sun = drawn.frame().sun;
    light::ShadowOptions options;
    options.refraction = sun.terrestrial_refraction;
    options.air = sun.air;
    const glm::dvec3& d = sun.direction;
    Array2d<float> height_m(field.grid.columns(), field.grid.rows());
    light::Clearances(posts, options)
        .each(drawn.ground().frame.origin(),
              {std::atan2(d.x, d.y), std::atan2(d.z, std::hypot(d.x, d.y)), sun.semidiameter_rad},
              [&](const light::ClearanceRun& run) {
                  for (int i = 0; i < run.count; ++i)
                      height_m.at(run.column + i, run.row) =
                          field.height_m.at(run.column + i, run.row) -
                          0.5F * (run.upper_m[i] + run.lower_m[i]);
              });
    return height_m;
}

/// Light that shade keeps from the air along a ray, in green: a march of 512 steps.
double shade_along(const test::Drawn& drawn, const Array2d<float>& shadow_m, const glm::dvec3& ray,
                   double way_m) {
    constexpr int kSteps = 512, kKnots = 32;
    const auto air = sky::atmosphere_of(sky::Air{});
    const sky::Atmosphere::View view = view_of(drawn, ray);
    std::array<double, kKnots + 1> up_to{};  // what is scattered before a knot
    for (int i = 1; i <= kKnots; ++i)
        up_to[static_cast<std::size_t>(i)] = scattered_once(*air, view, way_m * i / kKnots);
    double shade = 0;
    for (int i = 0; i < kSteps; ++i) {
        const glm::dvec3 at = drawn.frame().camera.eye_m + (i + 0.5) * way_m / kSteps * ray;
        const geo::Geodetic place = drawn.ground().frame.to_geodetic(at);
        const glm::dvec2 post = drawn.dem().grid.post(place), first = floor(post);
        const int x = static_cast<int>(first.x), y = static_cast<int>(first.y);
        if (x < 0 || y < 0 || x + 1 >= shadow_m.width() || y + 1 >= shadow_m.height()) continue;
        const glm::dvec2 t = post - first;
        const double over =
            (1 - t.y) * ((1 - t.x) * shadow_m.at(x, y) + t.x * shadow_m.at(x + 1, y)) +
            t.y * ((1 - t.x) * shadow_m.at(x, y + 1) + t.x * shadow_m.at(x + 1, y + 1));
        if (place.height_m > over) continue;
        const std::size_t knot = static_cast<std::size_t>(i * kKnots / kSteps);
        shade += (up_to[knot + 1] - up_to[knot]) * kKnots / kSteps;
    }
    return shade;
}

// Against the sun, across it and with it, over mountains at a low sun.
TEST(Shafts, AreThoseOfAMarchThroughShadowHeights) {
    dem::Heightfield field = dem::load((test::source_dir() / "data/dem/jacksboro.tif").string());
    for (float& height_m : field.height_m)
        height_m *= 3;
    field.about.statistics = dem::statistics(field.height_m);
    std::vector<double> errors, without;
    for (const double heading_deg : {60.0, 120.0, 150.0, 240.0}) {
        std::array<image::ImageF, 3> images;  // with shafts, without, and how far
        for (const int of : {0, 1, 2}) {
            test::Drawn drawn(field, of == 2 ? std::vector{kBlack, kDistance} : std::vector{kBlack},
                              64, 48, 0, air_effects(of == 0));
            drawn.shine("2026-12-21T13:00Z");
            drawn.stand(0.5, 0.5, 2300, heading_deg, -6);
            images[static_cast<std::size_t>(of)] = drawn.radiance();
            if (of < 2) continue;
            const Array2d<float> shadow_m = shadow_heights(drawn);
            for (int y = 1; y < 48; y += 3)
                for (int x = 1; x < 64; x += 5) {
                    const bool ground = images[2].at(x, y, 2) > 0 && images[2].at(x, y, 1) == 0;
                    const double way_m =
                        ground ? 1048576 * test::Drawn::values(images[2], x, y).x : 6e4;
                    const double all = images[1].at(x, y, 1);
                    const double expected =
                        all - shade_along(drawn, shadow_m, drawn.ray(x + 0.5, y + 0.5), way_m);
                    errors.push_back(std::abs(images[0].at(x, y, 1) / expected - 1));
                    without.push_back(all / expected - 1);
                }
        }
    }
    const auto mean = [](const std::vector<double>& of) {
        return std::accumulate(of.begin(), of.end(), 0.0) / static_cast<double>(of.size());
    };
    fmt::print(
        "[ accuracy ] light of air among mountains: mean error {:.4f}, without shafts {:.4f} too "
        "bright\n",
        mean(errors), mean(without));
    test::print_accuracy("light of air among mountains", errors, "", 0.2);
    EXPECT_LT(mean(errors), 0.01);
    EXPECT_GT(mean(without), 0.02);
}

// A wall 3 km high 20 km west of the eye, and the sun behind it: from the eye on, a ray is lit
// until it meets the plane of the shadow, or not at all.
TEST(Shafts, AirInTheShadeOfAWallIsDark) {
    constexpr double kWall_m = 3000, kPlain_m = 500, kToWall_m = 20000;
    const auto field = test::field_of(
        300, 61, {480000, 200, 0, 5400000, 0, -200}, "EPSG:32632",
        [](int column, int) { return column >= 58 && column <= 60 ? kWall_m : kPlain_m; });
    const auto air = sky::atmosphere_of(sky::Air{});
    for (const double height_m : {900.0, 2600.0}) {
        std::array<image::ImageF, 2> images;
        std::vector<double> errors, unshaded;
        for (const int of : {0, 1}) {
            test::Drawn drawn(field, of == 0 ? std::vector{kBlack} : std::vector{kBlack, kDistance},
                              16, 128, 0, air_effects(true));
            drawn.shine("2026-03-20T17:00Z");
            drawn.stand(160.0 / 299, 0.5, height_m, 265, height_m < 1600 ? -2.2 : -7.5);
            drawn.frame().camera.fov_y_rad = 0.03;
            images[static_cast<std::size_t>(of)] = drawn.radiance();
            if (of == 0) continue;
            const render::SunLight& sun = drawn.frame().sun;
            const double sun_sine = view_of(drawn, drawn.ray(8, 64)).sun_sine;
            const double elevation = std::asin(sun_sine);
            const double slope = std::tan(elevation + sun.refraction_rad(elevation));
            for (int y = 0; y < 128; y += 3) {
                const double distance_m = 1048576 * test::Drawn::values(images[1], 8, y).x;
                if (distance_m > kToWall_m - 1000) continue;
                const glm::dvec3 ray = drawn.ray(8.5, y + 0.5);
                const sky::Atmosphere::View view = view_of(drawn, ray);
                const double eye_m = height_m - (kWall_m - slope * kToWall_m);
                const double point_m = kPlain_m - (kWall_m - slope * (kToWall_m - distance_m));
                const double lit = eye_m < 0 ? 0 : point_m > 0 ? 1 : eye_m / (eye_m - point_m);
                const double all = sky::colour_of(air->scattered_in(view, distance_m)).g;
                const double expected = all - scattered_once(*air, view, distance_m) +
                                        scattered_once(*air, view, lit * distance_m);
                errors.push_back(std::abs(images[0].at(8, y, 1) / expected - 1));
                unshaded.push_back(all / expected);
            }
        }
        ASSERT_GT(errors.size(), 20u);
        fmt::print("[ accuracy ] from {} m, without the shade {:.2f} to {:.2f} times as bright\n",
                   height_m, *std::ranges::min_element(unshaded),
                   *std::ranges::max_element(unshaded));
        test::print_accuracy("light of air behind a wall", errors, "", 0.03);
        EXPECT_LT(*std::ranges::max_element(errors), 0.03) << height_m;
    }
}

TEST(Shafts, HaveNoEdgeWhereTheShadowOfTerrainMeetsTheGround) {
    // The same wall in an aerial view, at the DEM's rim, where the air is no longer scaled: black
    // ground on both sides of the shadow's edge is seen through the same air.
    const auto field =
        test::field_of(300, 61, {480000, 200, 0, 5400000, 0, -200}, "EPSG:32632",
                       [](int column, int) { return column >= 4 && column <= 6 ? 3000.0 : 500.0; });
    const test::TestEffect probe{
        "probe",
        "//@ include lib/sun_share.glsl\n"
        "void probe_on_atmosphere(in Surface s, in vec3 view, inout vec3 radiance) {\n"
        "    float at = sun_shadow_clearance(s.post);\n"
        "    radiance = vec3(abs(at) < 1e4 ? at / 1024.0 : -9.0, 0.0, 1.0) / frame.exposure;\n"
        "}\n"};
    std::array<image::ImageF, 2> images;
    for (const int of : {0, 1}) {
        test::Drawn drawn(field, of == 0 ? std::vector{kBlack} : std::vector{kBlack, probe}, 16,
                          256, 0, air_effects(true));
        drawn.shine("2026-03-20T16:00Z");
        drawn.frame().in_the_air = true;
        drawn.stand(136.0 / 299, 0.5, 6000, 265, -18);
        drawn.frame().camera.fov_y_rad = 0.1;
        images[static_cast<std::size_t>(of)] = drawn.radiance();
    }
    int edges = 0;
    double worst = 0;
    for (int y = 1; y < 256; ++y) {
        const double above = test::Drawn::values(images[1], 8, y).x,
                     below = test::Drawn::values(images[1], 8, y - 1).x;
        if (std::min(above, below) < -5 || above * below > 0) continue;
        ++edges;
        worst = std::max(worst, std::abs(images[0].at(8, y, 1) / images[0].at(8, y - 1, 1) - 1.0));
    }
    fmt::print("[ accuracy ] {} edges of a shadow, a step of {:.4f} in the air there\n", edges,
               worst);
    EXPECT_GT(edges, 0);
    EXPECT_LT(worst, 0.01);
}

}  // namespace
}  // namespace relevo::test_shafts
