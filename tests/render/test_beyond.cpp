// The ground that is made up around a DEM seen from the air: where it is, and that it is drawn
// nowhere else.

#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "drawn.h"
#include "light/fields.h"
#include "render/height_means.h"
#include "support/gpu_snippet.h"

namespace relevo::render::test_beyond {
namespace {

using test::Drawn;
using test::TestEffect;

constexpr double kLowest_m = 430;

dem::Heightfield plain() {
    return test::field_of(65, 65, {500000, 100, 0, 5200000, 0, -100}, "EPSG:32632",
                          [](int, int) { return kLowest_m; });
}

/// A ridge of 400 m on a plain, from the northern rim to the southern one.
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

TEST(Beyond, IsLevelAroundAPlainUpToTheHorizon) {
    Drawn drawn(plain(), {kTell}, 240, 180, 2);
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

/// Made-up heights at places east and north of the ridge's centre, in km [m].
class Relief {
  public:
    Relief() {
        FrameBlock& frame = gpu_.frame();
        means_.update(frame);
        frame.height_range = {kLowest_m, 1.0F / 400, 1, 0};
        frame.ground_extent = {-3250, -3250, 1.0F / 6500, 1.0F / 6500};
        frame.posts = {65, 65, 1.0F / 65, 1.0F / 65};
        frame.light_axes = {0.01F, 0, 0, -0.01F};
        frame.normal_texels_per_m = 0.01F;
        frame.beyond = 1;
        frame.beyond_m = kLowest_m;
        gpu_.bind(kHeightMeansTexture, *means_.texture());
    }
    double at(double east_km, double north_km) {
        return gpu_
            .run(fmt::format("result = vec4(beyond_relief_m(vec2({:.1f}, {:.1f}), 1.0));",
                             1000 * east_km, 1000 * north_km),
                 1, 1)[0]
            .x;
    }
    /// From 5 km above the plain's middle northwards, down at a slope [m].
    double met_m(double slope) {
        frame().eye_m = {0, 0, kLowest_m + 5000, kLowest_m + 5000};
        frame().eye_up = {0, 0, 1, 0};
        return gpu_
            .run(fmt::format("vec3 view = normalize(vec3(0.0, 1.0, {:f}));\n"
                             "result = vec4(beyond_met_m(view, 200000.0, 1.0));",
                             -slope),
                 1, 1)[0]
            .x;
    }
    FrameBlock& frame() { return gpu_.frame(); }

  private:
    dem::Heightfield field_ = ridge();
    HeightMeans means_{field_};
    test::GpuSnippet gpu_{"", "lib/beyond_relief.glsl"};
};

TEST(Beyond, GoesOnFromTheRimAndEndsInLevelGround) {
    Relief relief;
    EXPECT_NEAR(relief.at(0, 3.2), 400, 1) << "on the rim, which the ridge crosses";
    EXPECT_NEAR(relief.at(0.5, 3.2), 400 * std::exp(-0.5), 1);
    EXPECT_NEAR(relief.at(-3.2, 0), 0, 1) << "where the rim is a plain";
    EXPECT_NEAR(relief.at(0, 3.3), 390, 20) << "a post beyond it";
    const double near_m = relief.at(0, 4), far_m = relief.at(0, 6);
    EXPECT_GT(near_m, 100);
    EXPECT_LT(far_m, 0.7 * near_m);
    double highest = 0;
    for (double north = 8; north < 12; north += 0.5)
        highest = std::max(highest, std::abs(relief.at(1, north)));
    EXPECT_GT(highest, 3) << "hills";
    EXPECT_EQ(relief.at(0, 30), 0) << "four widths away";
    EXPECT_NEAR(relief.met_m(1.4), 4600 * std::hypot(1, 1 / 1.4), 40) << "the ridge that goes on";
    EXPECT_NEAR(relief.met_m(0.05), 124460, 200) << "level ground, by the Earth's curve";
    EXPECT_EQ(relief.met_m(-0.01), 200000) << "above the horizon";
    relief.frame().sea_floor_share = 1;
    EXPECT_EQ(relief.at(0, 4), 0) << "a sea has none";
}

}  // namespace
}  // namespace relevo::render::test_beyond
