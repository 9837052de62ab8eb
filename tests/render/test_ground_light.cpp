// The light by place that shaders read of core's figures.
#include <cmath>

#include "dem/load.h"
#include "drawn.h"
#include "light/fields.h"
#include "render/ground_light.h"

namespace relevo::render::test_ground_light {
namespace {

using test::Drawn;
using test::TestEffect;

const TestEffect kOpenSky{
    "probe",
    "//@ include lib/openness.glsl\n"
    "void probe_on_atmosphere(in Surface s, in vec3 view, inout vec3 radiance) {\n"
    "    radiance = vec3(surface_open_sky(s), s.post.x / 1024.0, 1.0) / frame.exposure;\n}\n"};

/// The least and the greatest share of the sky that pixels of ground see.
std::pair<double, double> open_sky(const dem::Heightfield& field, double above_m) {
    Drawn drawn(field, {test::kBrightSky, kOpenSky}, 200, 160);
    drawn.stand(0.5, 0.5, 100 + above_m, 0, -90);
    const image::ImageF image = drawn.radiance();
    double least = 2, most = -1;
    int ground = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            if (test::is_sky(image, x, y)) continue;
            ++ground;
            const double share = Drawn::values(image, x, y).x;
            least = std::min(least, share);
            most = std::max(most, share);
        }
    EXPECT_GT(ground, 800);
    return {least, most};
}

dem::Heightfield plain(const std::function<double(int, int)>& height_m) {
    return test::field_of(129, 129, {500000, 10, 0, 640, 0, -10}, "EPSG:32631", height_m);
}

TEST(GroundLight, LevelGroundSeesTheWholeSkyBesideVoidsToo) {
    // Voids of a post, of rows and of a corner; seen from near, and where a pixel holds many posts.
    const dem::Heightfield field = plain([](int x, int y) {
        return (x % 9 == 4 && y % 7 == 3) || y % 31 == 30 || x + y < 40 ? std::nan("") : 100.0;
    });
    for (const double above_m : {300.0, 1500.0, 9000.0}) {
        const auto [least, most] = open_sky(field, above_m);
        EXPECT_GT(least, 0.98) << above_m;
        EXPECT_LE(most, 1.001) << above_m;
    }
}

TEST(GroundLight, MeansOfALargeDemAreOfThePostsThatAreThere) {
    // Of more posts than the sky is found for: voids make no pits.
    const dem::Heightfield field = test::field_of(
        640, 600, {500000, 10, 0, 3000, 0, -10}, "EPSG:32631",
        [](int x, int y) { return (3 * x + 5 * y) % 11 == 0 ? std::nan("") : 100.0; });
    ASSERT_GT(640 * 600, GroundLight::kMaxSkyPosts);
    const auto [least, most] = open_sky(field, 4000);
    EXPECT_GT(least, 0.98);
    EXPECT_LE(most, 1.001);
}

TEST(GroundLight, DarkGroundOfALargeDemIsWhereItsWallIs) {
    const dem::Heightfield field =
        test::field_of(640, 600, {500000, 10, 0, 3000, 0, -10}, "EPSG:32631",
                       [](int x, int) { return x >= 340 && x < 350 ? 400.0 : 100.0; });
    Drawn drawn(field, {test::kBrightSky, kOpenSky}, 200, 160);
    drawn.stand(0.5, 0.5, 4000, 0, -90);
    const image::ImageF image = drawn.radiance();
    int dark = 0;
    for (int x = 0; x < image.width; ++x) {
        const glm::dvec2 found = Drawn::values(image, x, 80);
        if (test::is_sky(image, x, 80) || found.x > 0.8) continue;
        ++dark;
        // Within the wall's height of its middle.
        EXPECT_NEAR(1024 * found.y, 345, 35) << x;
    }
    EXPECT_GT(dark, 2);
}

TEST(GroundLight, TheFootOfAWallSeesHalfOfIt) {
    // What the test above finds is no constant.
    const auto [least, most] =
        open_sky(plain([](int x, int) { return x > 64 ? 2100.0 : 100.0; }), 3500);
    EXPECT_LT(least, 0.6);
    EXPECT_GT(most, 0.9);
}

TEST(GroundLight, IsOfTheSunAsItIsWhereGroundIsInSight) {
    const std::vector<effect::Effect> shadows{
        effect::load_effect(test::source_dir() / "plugins/shadows", test::source_dir() / "data")};
    Drawn drawn(dem::load((test::source_dir() / "data/dem/jacksboro.tif").string()), {}, 64, 48, 0,
                shadows);
    const auto draw = [&](double pitch_deg) {
        drawn.stand(0.5, 0.5, 3000, 0, pitch_deg);
        drawn.renderer().render_frame(drawn.terrain(), drawn.ground(), drawn.frame());
        return drawn.terrain().light().shadow_sun();
    };
    const glm::dvec3 morning = drawn.frame().sun.direction;
    EXPECT_EQ(draw(-40), morning);
    drawn.shine("2026-06-21T19:00Z");
    const glm::dvec3 afternoon = drawn.frame().sun.direction;
    ASSERT_NE(morning, afternoon);
    EXPECT_EQ(draw(60), morning);  // at the sky alone
    EXPECT_EQ(draw(-40), afternoon);
}

TEST(GroundLight, IsThereWhereTheFirstPictureIsOfTheSky) {
    const std::vector<effect::Effect> shadows{
        effect::load_effect(test::source_dir() / "plugins/shadows", test::source_dir() / "data")};
    Drawn drawn(dem::load((test::source_dir() / "data/dem/jacksboro.tif").string()), {}, 64, 48, 0,
                shadows);
    drawn.stand(0.5, 0.5, 3000, 0, 60);
    drawn.renderer().render_frame(drawn.terrain(), drawn.ground(), drawn.frame());
    EXPECT_TRUE(drawn.terrain().light().shadow_sun());
}

}  // namespace
}  // namespace relevo::render::test_ground_light
