// Shadows that are not those of the figures are found out.
#include <cmath>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "session/audit.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::session::test_audit {
namespace {

/// Shadows of a test's own: three posts off, and none at all.
std::filesystem::path broken_shadows() {
    static const std::filesystem::path folder = [] {
        std::filesystem::path made = test::scratch_dir("audit_plugins");
        const auto add = [&](const std::string& id, const std::string& glsl) {
            std::filesystem::create_directory(made / id);
            std::ofstream(made / id / "plugin.json") << fmt::format(
                R"({{"format": 1, "id": "{0}", "name": "{0}", "version": "1",
                    "provides": ["shadow"], "exclusive": ["shadow"]}})",
                id);
            std::ofstream(made / id / (id + ".glsl")) << glsl;
        };
        add("shifted",
            "//@ include lib/sun_share.glsl\n"
            "void shifted_on_visibility(in Surface s, in vec3 to_sun, inout float factor) {\n"
            "    Surface beside = s;\n"
            "    beside.post += vec2(3.0, 0.0);\n"
            "    factor *= sun_share(beside, to_sun);\n"
            "}\n");
        add("bright",
            "void bright_on_visibility(in Surface s, in vec3 to_sun, inout float factor) {}\n");
        return made;
    }();
    return folder;
}

/// With the sun some 7 degrees high.
scene::Scene morning(const std::string& effect) {
    scene::Scene scene;
    scene.dems = {(test::source_dir() / "data/dem/jacksboro.tif").string()};
    scene.time.at = "2026-06-21T11:00Z";
    scene.width_px = 900;
    scene.height_px = 700;
    scene.effects.switches.only = std::vector<std::string>{};
    if (!effect.empty()) scene.effects.switches.only->push_back(effect);
    scene.effects.plugin_path = {broken_shadows().string()};
    return scene;
}

ShadowAudit audit_of(const scene::Scene& scene) {
    FilesInUse files;
    Session session(scene, {.device = test::gl_device(), .audited = true}, files);
    session.draw();
    const ShadowAudit audit = audit_shadows(session);
    fmt::print("[ audit  ] {}\n", audit.text());
    return audit;
}

TEST(Audit, ShadowsOfEitherEffectAreThoseOfTheSweep) {
    for (const char* const effect : {"shadows", "vsm"}) {
        const ShadowAudit audit = audit_of(morning(effect));
        EXPECT_EQ(audit.provider, effect);
        EXPECT_GT(audit.lit, 1000);
        EXPECT_GT(audit.shaded, 400);
        EXPECT_GE(audit.agreement(), effect == std::string("shadows") ? 0.99 : 0.98);
        EXPECT_GE(audit.balanced_accuracy(), effect == std::string("shadows") ? 0.99 : 0.98);
        EXPECT_LT(std::abs(audit.all.sum / static_cast<double>(audit.all.pixels)), 0.01);
    }
}

TEST(Audit, CoarsePixelsAreComparedWithAllPostsThatTheyHold) {
    scene::Scene scene = morning("shadows");
    scene.width_px = 200;
    scene.height_px = 160;
    const ShadowAudit audit = audit_of(scene);
    EXPECT_GE(audit.agreement(), 0.99);
    EXPECT_GT(audit.excluded.mixed, 1000);
    EXPECT_EQ(audit.all.pixels, audit.pixels() + audit.excluded.mixed);
    EXPECT_LT(audit.all.sum_of_sizes / static_cast<double>(audit.all.pixels), 0.06);
}

TEST(Audit, GroundInTheShadowOfInstancesIsCountedApart) {
    scene::Scene scene = morning("shadows");
    scene.time.at = "2026-06-21T13:00Z";
    scene.view = {.eye = scene::Standpoint{geo::geodetic_deg(36.3, -84.25, 900)},
                  .heading_deg = 0,
                  .pitch_deg = -30};
    const ShadowAudit bare = audit_of(scene);
    scene.effects.switches.only->push_back("trees");
    const ShadowAudit forest = audit_of(scene);
    fmt::print("[ audit  ] {} px show instances, {} are in their shadow\n", forest.excluded.moved,
               forest.excluded.instances);
    EXPECT_EQ(bare.excluded.instances, 0);
    EXPECT_GT(forest.excluded.instances, 10000);
    EXPECT_GT(forest.pixels(), 50);
    EXPECT_EQ(forest.agreement(), bare.agreement());
    EXPECT_NE(forest.json_text().find("\"instances\":"), std::string::npos);
}

TEST(Audit, ShadowsThreePostsOffAreFoundOut) {
    const ShadowAudit audit = audit_of(morning("shifted"));
    EXPECT_EQ(audit.provider, "shifted");
    EXPECT_LT(audit.agreement(), 0.92);
    EXPECT_LT(audit.balanced_accuracy(), 0.9);
}

TEST(Audit, GroundThatIsAlwaysLitIsNoBetterThanNoShadows) {
    const ShadowAudit bright = audit_of(morning("bright")), none = audit_of(morning(""));
    EXPECT_EQ(bright.balanced_accuracy(), 0.5);
    EXPECT_EQ(bright.lit, none.lit);
    EXPECT_EQ(bright.shaded, none.shaded);
    EXPECT_EQ(bright.agreement(), none.agreement());
    EXPECT_EQ(none.provider, "");
    EXPECT_NE(none.json_text().find("\"provider\":null"), std::string::npos);
    EXPECT_EQ(
        none.text(),
        fmt::format("audit: no active effect draws shadows; a fully lit DEM agrees with "
                    "the CPU sweep on {:.2f} % of {} pixels that show a post, balanced 50.00 %",
                    100 * none.agreement(), none.pixels()));
}

TEST(Audit, ExaggeratedGroundHasTheShadowsOfItsOwnHeights) {
    for (const char* const effect : {"shadows", "vsm"}) {
        scene::Scene scene = morning(effect);
        scene.time.at = "2026-06-21T13:00Z";  // some 30 degrees
        const ShadowAudit flat = audit_of(scene);
        scene.exaggeration = 4;
        const ShadowAudit high = audit_of(scene);
        EXPECT_GT(high.shaded, 5 * flat.shaded + 100);
        EXPECT_GE(high.agreement(), effect == std::string("shadows") ? 0.99 : 0.97);
        EXPECT_GE(high.balanced_accuracy(), effect == std::string("shadows") ? 0.98 : 0.96);
    }
}

TEST(Audit, WallsOfTheBlockAndTheSurfaceOfASeaAreNoPosts) {
    scene::Scene scene = morning("shadows");
    scene.effects.switches.only = {"shadows", "block", "sea"};
    scene.effects.settings = {{"sea.level_m", "450"}};
    scene.view.orbit = {200, 15, 1};
    const ShadowAudit audit = audit_of(scene);
    EXPECT_LT(std::abs(audit.all.sum / static_cast<double>(audit.all.pixels)), 0.02);
    EXPECT_GT(audit.excluded.moved, 1000);
    EXPECT_GT(audit.pixels(), 100);
    EXPECT_GE(audit.agreement(), 0.97);
}

TEST(Audit, ASeaOverExaggeratedGroundMovesNothingButWater) {
    std::vector<double> moved;
    for (const double exaggeration : {1.0, 3.0}) {
        scene::Scene scene = morning("shadows");
        scene.effects.switches.only = {"shadows", "sea"};
        scene.effects.settings = {{"sea.level_m", "400"}};
        scene.exaggeration = exaggeration;
        scene.view.orbit = {200, 60, 1};
        const ShadowAudit audit = audit_of(scene);
        EXPECT_GT(audit.pixels(), 1000);
        EXPECT_GE(audit.agreement(), 0.97);
        moved.push_back(static_cast<double>(audit.excluded.moved) /
                        static_cast<double>(audit.pixels() + audit.excluded.moved +
                                            audit.excluded.between_posts));
    }
    EXPECT_NEAR(moved[0], moved[1], 0.15);
    EXPECT_GT(moved[0], 0.05);
}

TEST(Audit, MeansOfADemHaveTheShadowsOfMeans) {
    // A DEM beyond --memory: 403 x 344 posts as means of 2 x 2.
    scene::Scene scene = morning("shadows");
    scene.dem.memory = MemoryBudget::of_posts(50000);
    const ShadowAudit audit = audit_of(scene);
    EXPECT_GT(audit.lit, 1000);
    EXPECT_GT(audit.shaded, 100);
    EXPECT_GE(audit.agreement(), 0.98);
    EXPECT_GE(audit.balanced_accuracy(), 0.98);
}

TEST(Audit, MeansOfManyPostsAreComparedWithTheirOwnPixels) {
    // Means of 4 x 4 posts: a pixel that is taken for one half a mean aside is found out.
    scene::Scene scene = morning("shadows");
    scene.dem.memory = MemoryBudget::of_posts(10000);
    const ShadowAudit audit = audit_of(scene);
    EXPECT_GE(audit.agreement(), 0.98);
    EXPECT_GE(audit.balanced_accuracy(), 0.98);
}

TEST(Audit, AtNightThereIsNothingToCompare) {
    scene::Scene scene = morning("shadows");
    scene.time.at = "2026-06-15T05:00Z";  // new moon
    scene.view.orbit = {180, 30, 1};
    const ShadowAudit audit = audit_of(scene);
    EXPECT_EQ(audit.pixels(), 0);
    EXPECT_EQ(audit.text(),
              "audit: no pixel shows a post of the DEM that faces the sun; nothing to compare");
    EXPECT_NE(audit.json_text().find("\"agreement\":null"), std::string::npos);
}

TEST(Audit, ShadowsOfTheMoonAreThoseOfItsSweep) {
    scene::Scene scene = morning("shadows");
    scene.time.at = "2026-06-21T05:00Z";
    const ShadowAudit audit = audit_of(scene);
    fmt::print("[ accuracy ] moonlight: {}\n", audit.text());
    EXPECT_GT(audit.pixels(), 1000);
    EXPECT_GT(audit.agreement(), 0.995);
}

TEST(Audit, LeavesThePictureAsItIs) {
    for (const bool radiance : {false, true}) {
        scene::Scene scene = morning("shadows");
        scene.effects.switches.only.reset();
        std::vector<std::uint8_t> pictures[2];
        for (const bool audited : {false, true}) {
            FilesInUse files;
            Session session(scene,
                            {.device = test::gl_device(), .radiance = radiance, .audited = audited},
                            files);
            session.draw();
            pictures[audited] = session.picture().values;
        }
        EXPECT_TRUE(pictures[0] == pictures[1]) << radiance;
    }
}

}  // namespace
}  // namespace relevo::session::test_audit
