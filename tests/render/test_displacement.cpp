#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "drawn.h"
#include "light/fields.h"
#include "render/displacement.h"

namespace relevo::render::test_displacement {
namespace {

using test::Drawn;
using test::TestEffect;

constexpr const char* kUtm = "EPSG:32632";

/// Flat ground of UTM zone 32 with a furrow now and then, so that it has a relief.
dem::Heightfield floor_at(double height_m, double spacing_m = 100, int side = 513) {
    return test::field_of(
        side, side, {500000, spacing_m, 0, 5200000, 0, -spacing_m}, kUtm,
        [&](int column, int row) { return height_m + ((column + 3 * row) % 7 == 0 ? -1.0 : 0.0); });
}

int sky_pixels_below_horizon(Drawn& drawn, double from_deg) {
    const image::ImageF image = drawn.radiance();
    int count = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            if (degrees(std::asin(drawn.ray(x + 0.5, y + 0.5).z)) < -from_deg)
                count += test::is_sky(image, x, y);
    return count;
}

effect::Effect shipped(const std::string& id) {
    return effect::load_effect(test::source_dir() / "plugins" / id,
                               test::build_dir() / "share/relevo/data");
}

TEST(Displacement, BoundsOfSeveralEffectsAddUp) {
    Displacement bound;
    EXPECT_FALSE(bound.any());
    EXPECT_EQ(bound.range_m(-5, 7), std::pair(-5.0, 7.0));
    bound.to_m = {0};
    EXPECT_EQ(bound.range_m(-3000, -10), std::pair(-3000.0, 0.0));
    EXPECT_EQ(bound.range_m(10, 300), std::pair(0.0, 300.0));
    EXPECT_EQ(bound.range_m(-10, 300), std::pair(-10.0, 300.0));
    bound.down_m = 2;
    bound.up_m = 5;
    EXPECT_EQ(bound.range_m(-3000, -10), std::pair(-3002.0, 5.0));
    // Two that raise add up where both do: from -10 to 0 and to 20 is 10 + 30 above it.
    bound.to_m = {0, 20};
    EXPECT_EQ(bound.range_m(-10, -10), std::pair(-12.0, 35.0));
    EXPECT_TRUE(bound.any());
}

TEST(Displacement, IsReadFromParametersAndNumbers) {
    const shader::Snippet snippet = shader::parse_snippet(
        "swell", "swell.glsl",
        "uniform float swell_height_m = 3.0; //@ range(-9, 9)\n"
        "uniform float swell_level_m = -2.0; //@ range(-9, 9)\n"
        "void swell_on_albedo(inout Surface s) { s.diffuse *= swell_height_m * swell_level_m; }\n");
    shader::ParamStore values;
    values.declare(snippet.source.params);
    effect::DisplaceSpec swell;
    swell.up = {0, "swell.height_m"};
    swell.to = {0, "swell.level_m"};
    effect::DisplaceSpec other;
    other.down = {1.5, ""};
    other.aside = {4, ""};
    const Displacement sum = displacement_of({swell, other}, values);
    EXPECT_EQ(sum, (Displacement{.down_m = 1.5, .up_m = 3, .aside_m = 4, .to_m = {-2}}));
    values.set("swell.height_m", "-5");  // a plugin's slip: no bound is less than none
    EXPECT_EQ(displacement_of({swell}, values).up_m, 0);
}

TEST(Displacement, TheSeaOverADeepFloorIsDrawnAtTheEyesFeet) {
    const auto sea = shipped("sea");
    Drawn drawn(floor_at(-3000), {test::kBrightSky}, 320, 256, 2, {sea});
    for (const double heading_deg : {0.0, 90.0, 200.0}) {
        drawn.stand(0.5, 0.5, 60, heading_deg, -12);
        EXPECT_EQ(sky_pixels_below_horizon(drawn, 1), 0) << heading_deg;
        EXPECT_EQ(drawn.renderer().displacement().to_m, std::vector<double>{0});
    }
}

TEST(Displacement, GroundThatIsRaisedCastsItsShadowFromThere) {
    const auto sea = shipped("sea");
    Drawn drawn(floor_at(-3000), {test::kBrightSky}, 64, 64, 2, {sea});
    drawn.stand(0.5, 0.5, 60, 0, -12);
    const std::uint64_t before = drawn.terrain().serial();
    drawn.radiance();
    const auto extent = drawn.terrain().extent(glm::dmat3(1), 1);
    ASSERT_TRUE(extent);
    // The Earth's curvature takes 50 m off the corners.
    EXPECT_NEAR(extent->high.z, 0, 1);
    EXPECT_LT(extent->low.z, -3000);
    EXPECT_NE(drawn.terrain().serial(), before);  // a kept shadow map is of another ground
}

TEST(Displacement, ACameraShowsWhatIsRaised) {
    const dem::Heightfield dem = floor_at(-3000, 100, 65);
    const Ground ground = make_ground(dem);
    const std::vector<glm::dvec3> points = points_to_show(dem, ground, 2);
    const auto highest = [&](const Displacement& bound) {
        double most = -1e9;
        for (const glm::dvec3& point : points_moved_to(points, ground, 2, bound))
            most = std::max(most, point.z);
        return most;
    };
    EXPECT_TRUE(points_moved_to(points, ground, 2, {}).empty());
    EXPECT_NEAR(highest({.to_m = {10}}), 20, 3);
    EXPECT_NEAR(highest({.up_m = 100}), -5800, 3);
    double farthest = 0;
    for (const glm::dvec3& point : points_moved_to(points, ground, 2, {.aside_m = 5000}))
        farthest = std::max(farthest, std::abs(point.x));
    EXPECT_NEAR(farthest, 3200 + 5000, 15);
    // All of it is in an orbit's picture, and its middle is the ground's.
    const Displacement bound{.to_m = {2000}};
    const std::vector<glm::dvec3> moved = points_moved_to(points, ground, 2, bound);
    const scene::Camera camera =
        scene::orbit_camera({200, 10, 1}, points, radians(40), 1.25, moved);
    const double tan_y = std::tan(radians(20));
    for (const glm::dvec3& point : moved) {
        const glm::dvec3 to = point - camera.eye_m;
        const double depth = dot(to, camera.forward);
        ASSERT_GT(depth, 0);
        ASSERT_LT(std::abs(dot(to, camera.up)) / depth, tan_y);
        ASSERT_LT(std::abs(dot(to, cross(camera.forward, camera.up))) / depth, 1.25 * tan_y);
    }
}

TEST(Displacement, BeyondTheHorizonRaisedGroundIsSeen) {
    // 100 km away ground at 0 lies 780 m below the horizon of an eye at 1.7 m.
    const TestEffect raised{
        "raised",
        "void raised_on_displace(in VertexFrame v, inout vec3 position_m) {\n"
        "    position_m += (length(v.position_m) > 60000.0 ? 3000.0 : 0.0) * v.up;\n"
        "}\n",
        effect::DisplaceSpec{.up = {3000, ""}}};
    for (const bool is_raised : {true, false}) {
        std::vector<TestEffect> effects{test::kBrightSky};
        if (is_raised) effects.push_back(raised);
        Drawn drawn(floor_at(0, 500), effects, 160, 128, 2);
        drawn.stand(0.5, 0.99, 1.7, 0, 0);
        const image::ImageF image = drawn.radiance();
        bool above = false;
        for (int y = 0; y < image.height; ++y)
            above = above || (dot(drawn.ray(80.5, y + 0.5), drawn.frame().camera.up) > 0.003 &&
                              !test::is_sky(image, 80, y));
        EXPECT_EQ(above, is_raised);
    }
}

TEST(Displacement, VertexHooksSeeWhereTheGroundIsDrawn) {
    // Distance and height of the drawn vertex: haze over a sea is that of the way to its surface.
    const TestEffect probe{
        "probe",
        "out vec2 probe_drawn;\n"
        "void probe_on_displace(in VertexFrame v, inout vec3 position_m) {\n"
        "    position_m += 500.0 * frame.height_range.z * v.up;\n"
        "}\n"
        "void probe_on_vertex(in VertexFrame v) {\n"
        "    probe_drawn = vec2(v.distance_m, v.drawn_height_m);\n"
        "}\n"
        "void probe_on_atmosphere(in Surface s, in vec3 view, inout vec3 radiance) {\n"
        "    radiance = vec3(probe_drawn.x / s.distance_m, probe_drawn.y / 1000.0, 1.0) / "
        "frame.exposure;\n"
        "}\n",
        effect::DisplaceSpec{.up = {500, ""}}};
    for (const double exaggeration : {1.0, 3.0}) {
        Drawn drawn(floor_at(-400, 20, 129), {test::kBrightSky, probe}, 64, 64);
        drawn.frame().exaggeration = exaggeration;
        drawn.stand(0.5, 0.5, 100 * exaggeration + 300, 0, -80);
        const image::ImageF image = drawn.radiance();
        for (int y = 0; y < image.height; y += 9) {
            for (int x = 0; x < image.width; x += 9) {
                ASSERT_FALSE(test::is_sky(image, x, y));
                const glm::dvec2 found = Drawn::values(image, x, y);
                EXPECT_NEAR(found.x, 1, 0.01);
                EXPECT_NEAR(found.y, 0.1 * exaggeration, 0.004 * exaggeration);
            }
        }
    }
}

TEST(Ground, FarBelowSeaLevelIsDrawn) {
    // Level with the sea an eye's horizon is near, and the ground 430 m below is seen far beyond.
    Drawn drawn(floor_at(-430), {test::kBrightSky}, 160, 128, 2);
    drawn.stand(0.5, 0.95, 5, 0, -3);
    EXPECT_EQ(sky_pixels_below_horizon(drawn, 1.5), 0);
}

TEST(Ground, BelowSeaLevelIsDrawn) {
    // Neither the horizon's ellipsoid nor exaggeration may take it for hidden.
    for (const double exaggeration : {1.0, 10.0}) {
        Drawn drawn(floor_at(-430), {test::kBrightSky}, 160, 128, 2);
        drawn.frame().exaggeration = exaggeration;
        for (const double above_m : {2.0, 4000.0, 30000.0}) {
            drawn.stand(0.5, 0.7, -430 * exaggeration + above_m, 0, -35);
            EXPECT_EQ(sky_pixels_below_horizon(drawn, 60), 0)
                << above_m << " above, " << exaggeration;
        }
    }
}

}  // namespace
}  // namespace relevo::render::test_displacement
