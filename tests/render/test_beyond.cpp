// The level ground around a DEM seen from the air: where it is, and that it is drawn nowhere else.

#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "drawn.h"
#include "light/fields.h"

namespace relevo::render::test_beyond {
namespace {

using test::Drawn;
using test::TestEffect;

constexpr double kLowest_m = 430;

/// A ridge of 400 m on a plain.
dem::Heightfield ridge() {
    return test::field_of(65, 65, {500000, 100, 0, 5200000, 0, -100}, "EPSG:32632",
                          [](int column, int) {
                              return kLowest_m + 400 * std::exp(-0.02 * std::pow(column - 32, 2));
                          });
}

/// Ground is blue, and sky a blue of 40. Ground beyond is its distance over 1 km in red, and in
/// green 1 if hooks of `albedo` have coloured it.
const TestEffect kTell{
    "tell",
    "//@ include lib/beyond.glsl\n"
    "void tell_on_albedo(inout Surface s) { s.diffuse = vec3(0.25); }\n"
    "vec3 tell_on_beyond(in Surface s, in vec3 view) {\n"
    "    return vec3(0.001 * s.distance_m, 4.0 * s.diffuse.g, 1.0) / frame.exposure;\n"
    "}\n"
    "vec3 tell_on_background_radiance(in vec3 direction, in bool with_disc) {\n"
    "    vec4 seen = beyond_seen(direction);\n"
    "    return mix(vec3(0.0, 0.0, 40.0) / frame.exposure, seen.rgb, seen.a);\n"
    "}\n"
    "void tell_on_atmosphere(in Surface s, in vec3 view, inout vec3 radiance) {\n"
    "    radiance = vec3(0.0, 0.0, 1.0) / frame.exposure;\n"
    "}\n"};

/// @returns distance to a sphere at the height of its rim [m]; below 0: none
double distance_m(const Drawn& drawn, const glm::dvec3& ray) {
    constexpr double kRadius_m = 6371000;
    const geo::Geodetic eye = drawn.ground().frame.to_geodetic(drawn.frame().camera.eye_m);
    const glm::dvec3 up = drawn.ground().frame.axes(eye.lat_rad, eye.lon_rad).up;
    const double above_m = eye.height_m - kLowest_m;
    const double down_m = (kRadius_m + above_m) * dot(ray, up);
    const double inside = down_m * down_m - above_m * (2 * kRadius_m + above_m);
    return down_m < 0 && inside > 0 ? -down_m - std::sqrt(inside) : -1;
}

TEST(Beyond, IsLevelGroundOfTheRimsHeightUpToTheHorizon) {
    Drawn drawn(ridge(), {kTell}, 240, 180, 2);
    drawn.frame().in_the_air = true;
    drawn.stand(0.5, 1.4, 3000, 0, -12);
    const image::ImageF image = drawn.radiance();
    int ground = 0, beyond = 0, sky = 0, wrong = 0;
    double worst = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            if (image.at(x, y, 1) == 0) {
                const bool is_ground = image.at(x, y, 2) * drawn.renderer().exposure() < 20;
                is_ground ? ++ground : ++sky;
                wrong += !is_ground && distance_m(drawn, drawn.ray(x + 0.5, y - 1)) > 0;
                continue;
            }
            ++beyond;
            const glm::dvec2 read = Drawn::values(image, x, y);
            EXPECT_NEAR(read.y, 1, 0.01);
            const double expected_m = distance_m(drawn, drawn.ray(x + 0.5, y + 0.5));
            // Near the horizon distances double from texel to texel.
            if (expected_m < 0 || expected_m > 60e3) continue;
            worst = std::max(worst, std::abs(read.x * 1000 / expected_m - 1));
        }
    fmt::print("[ beyond ] worst distance {:.1f} %, of {} px; ground {}, sky {}\n", 100 * worst,
               beyond, ground, sky);
    EXPECT_GT(ground, 3000);
    EXPECT_GT(beyond, 5000);
    EXPECT_GT(sky, 3000);
    EXPECT_EQ(wrong, 0) << "sky below the horizon";
    EXPECT_LT(worst, 0.05);
}

TEST(Beyond, IsSeenFromTheAirAlone) {
    Drawn drawn(ridge(), {kTell}, 120, 90, 2);
    drawn.stand(0.5, 1.4, 3000, 0, -12);
    const image::ImageF image = drawn.radiance();
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            ASSERT_EQ(image.at(x, y, 1), 0);
}

}  // namespace
}  // namespace relevo::render::test_beyond
