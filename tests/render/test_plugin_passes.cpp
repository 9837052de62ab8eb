// Passes of plugins: what they read and write, when they run, and what cannot be ordered.
#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "dem/load.h"
#include "drawn.h"
#include "effect/effect.h"

namespace relevo::render::test_plugin_passes {
namespace {

using ::testing::HasSubstr;

/// An effect in a folder of its own.
effect::Effect written(const std::string& id, const std::string& passes, const std::string& glsl) {
    const std::filesystem::path folder = test::scratch_dir("pass_" + id) / id;
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "plugin.json") << fmt::format(
        R"({{"format": 1, "id": "{}", "name": "P", "version": "1", "passes": {}}})", id, passes);
    std::ofstream(folder / (id + ".glsl")) << glsl;
    return effect::load_effect(folder, test::source_dir() / "data");
}

dem::Heightfield bundled() {
    return dem::load((test::source_dir() / "data/dem/jacksboro.tif").string());
}

/// Half ground, half sky.
void look_ahead(test::Drawn& drawn) {
    drawn.stand(0.5, 0.5, 2500, 300, -4);
}

TEST(PluginPass, AHookReadsWhatAPassWroteForEachTexel) {
    test::Drawn drawn(bundled(), {}, 64, 48, 0,
                      {written("probe", R"({"table": {"width": 8, "height": 4, "format": "rgba32f",
                                            "filter": "nearest"}})",
                               "uniform sampler2D probe_table;\n"
                               "vec4 probe_pass_table(in Texel t) {\n"
                               "    return vec4(t.at_px, t.at.x * t.size_px.x, t.size_px.y);\n"
                               "}\n"
                               "void probe_on_lit(in Surface s, inout vec3 radiance) {\n"
                               "    vec4 t = texelFetch(probe_table, ivec2(5, 2), 0);\n"
                               "    radiance = vec3(t.x + 10.0 * t.y, t.z + 10.0 * t.w, 1.0) /\n"
                               "               frame.exposure;\n"
                               "}\n")});
    look_ahead(drawn);
    const glm::dvec2 found = test::Drawn::values(drawn.radiance(), 32, 46);
    EXPECT_NEAR(found.x, 5.5 + 25, 0.02);
    EXPECT_NEAR(found.y, 5.5 + 40, 0.03);
}

TEST(PluginPass, DepthOfTheGroundIsThereBeforeItIsShaded) {
    test::Drawn drawn(
        bundled(), {}, 64, 48, 0,
        {written("probe", R"({"half": {"scale": 0.5, "format": "rg32f",
                                           "filter": "nearest"}})",
                 "//@ include lib/screen.glsl\n"
                 "uniform sampler2D probe_depth; //@ from(core.ground_depth)\n"
                 "uniform sampler2D probe_half;\n"
                 "vec4 probe_pass_half(in Texel t) {\n"
                 "    ivec2 pixel = 2 * ivec2(t.at_px);\n"
                 "    vec3 at = screen_position(probe_depth, pixel);\n"
                 "    return vec4(length(at), dot(screen_normal(probe_depth, pixel),\n"
                 "                                normalize(at)), 0.0, 0.0);\n"
                 "}\n"
                 "void probe_on_lit(in Surface s, inout vec3 radiance) {\n"
                 "    vec2 half_size = texelFetch(probe_half,\n"
                 "                                ivec2(gl_FragCoord.xy) / 2, 0).rg;\n"
                 "    radiance = vec3(half_size.x / s.distance_m, -half_size.y, 1.0) /\n"
                 "               frame.exposure;\n"
                 "}\n")});
    look_ahead(drawn);
    const image::ImageF image = drawn.radiance();
    std::vector<float> depths_m;
    drawn.renderer().read_depths(depths_m);
    int ground = 0;
    for (int y = 1; y < 48; y += 2)  // rows from the top: those that the texels are made of
        for (int x = 0; x < 64; x += 2) {
            if (std::isinf(depths_m[static_cast<std::size_t>((47 - y) * 64 + x)])) continue;
            const glm::dvec2 found = test::Drawn::values(image, x, y);
            EXPECT_NEAR(found.x, 1, 1e-3) << x << ' ' << y;
            EXPECT_GT(found.y, 0) << "a normal away from the eye at " << x << ' ' << y;
            ++ground;
        }
    EXPECT_GT(ground, 100);
}

TEST(PluginPass, NormalAndVisibleSunOfTheGroundAreThereAfterShading) {
    for (const bool with_overlay : {false, true}) {
        test::Drawn drawn(
            bundled(), {}, 64, 48, 0,
            {written("probe", R"({"copy": {"format": "rgba32f", "filter": "nearest"}})",
                     std::string("uniform sampler2D probe_normal; //@ from(core.normal)\n"
                                 "uniform sampler2D probe_sun; //@ from(core.shadow)\n"
                                 "uniform sampler2D probe_copy;\n"
                                 "vec4 probe_pass_copy(in Texel t) {\n"
                                 "    return vec4(texture(probe_normal, t.at).rgb,\n"
                                 "                texture(probe_sun, t.at).a);\n"
                                 "}\n"
                                 "void probe_on_normal(inout Surface s) {\n"
                                 "    s.normal = vec3(0.0, 0.6, 0.8);\n"
                                 "}\n"
                                 "void probe_on_visibility(in Surface s, in vec3 to_sun,\n"
                                 "                         inout float factor) {\n"
                                 "    factor *= 0.25;\n"
                                 "}\n"
                                 "void probe_on_image(in Pixel p, inout vec3 radiance) {\n"
                                 "    vec4 copy = texelFetch(probe_copy, ivec2(p.at_px), 0);\n"
                                 "    radiance = vec3(copy.y, copy.w, 0.0);\n"
                                 "}\n") +
                         (with_overlay ? "void probe_on_display(in Surface s, inout vec4 over) {}\n"
                                       : ""))});
        look_ahead(drawn);
        drawn.radiance();
        // What the hook has made of the radiance is seen in the picture alone.
        const image::Image8 picture = drawn.renderer().read_output();
        const auto value = [&](int x, int y, int c) { return int{picture.at(x, y, c)}; };
        EXPECT_EQ(value(32, 2, 0), 0) << "no normal in the sky";
        EXPECT_EQ(value(32, 2, 1), 0);
        const int normal = value(32, 46, 0), sun = value(32, 46, 1);
        EXPECT_GT(normal, sun);
        EXPECT_GT(sun, 20);
        for (int x = 4; x < 60; ++x) {
            EXPECT_NEAR(value(x, 46, 0), normal, 1);
            EXPECT_NEAR(value(x, 46, 1), sun, 1);
        }
    }
}

TEST(PluginPass, HooksOfTheGroundCannotReadWhatTheyMake) {
    const effect::Effect effect = written("probe", "{}",
                                          "uniform sampler2D probe_scene; //@ from(core.radiance)\n"
                                          "void probe_on_lit(in Surface s, inout vec3 radiance) {\n"
                                          "    radiance += texture(probe_scene, vec2(0.5)).rgb;\n"
                                          "}\n");
    EXPECT_THAT(test::error_of([&] { test::Drawn(bundled(), {}, 64, 48, 0, {effect}); }),
                testing::AllOf(
                    HasSubstr("probe.glsl:1: probe_scene: hooks of the ground and the sky cannot "
                              "read core.radiance, which they make; read it in image, finish, "
                              "overlay or a pass"),
                    HasSubstr("--disable probe goes on without it")));
}

TEST(PluginPass, RunsWhenWhatItDependsOnHasChanged) {
    const auto stored = [](const std::string& id, const std::string& when) {
        return written(id,
                       fmt::format(R"({{"kept": {{"width": 1, "height": 1, "format": "rgba32f",
                                           "when": "{}"}}}})",
                                   when),
                       fmt::format("uniform sampler2D {0}_kept;\n"
                                   "vec4 {0}_pass_kept(in Texel t) {{\n"
                                   "    return vec4(frame.sun_direction.xyz, frame.eye_m.z);\n"
                                   "}}\n"
                                   "void {0}_on_lit(in Surface s, inout vec3 radiance) {{\n"
                                   "    vec4 kept = texelFetch({0}_kept, ivec2(0), 0);\n"
                                   "    radiance = vec3(abs(kept.x), kept.w / 1000.0, 1.0) /\n"
                                   "               frame.exposure;\n"
                                   "}}\n",
                                   id));
    };
    for (const auto& [when, follows_sun, follows_eye] :
         {std::tuple("frame", true, true), {"sun", true, false}, {"dem", false, false}}) {
        test::Drawn drawn(bundled(), {}, 64, 48, 0, {stored("probe", when)});
        look_ahead(drawn);
        const glm::dvec2 before = test::Drawn::values(drawn.radiance(), 32, 46);
        drawn.stand(0.5, 0.5, 3500, 300, -10);
        const glm::dvec2 moved = test::Drawn::values(drawn.radiance(), 32, 46);
        EXPECT_EQ(std::abs(moved.y - before.y) > 0.5, follows_eye) << when;
        drawn.shine("2026-06-21T19:00Z");
        const glm::dvec2 later = test::Drawn::values(drawn.radiance(), 32, 46);
        EXPECT_EQ(std::abs(later.x - before.x) > 0.05, follows_sun) << when;
    }
}

TEST(PluginPass, WhatNobodyReadsIsNotComputed) {
    test::Drawn drawn(bundled(), {}, 64, 48, 0,
                      {written("probe", R"({"used": {}, "unused": {}})",
                               "uniform sampler2D probe_used;\n"
                               "vec4 probe_pass_used(in Texel t) { return vec4(0.5); }\n"
                               "vec4 probe_pass_unused(in Texel t) { return vec4(0.5); }\n"
                               "void probe_on_lit(in Surface s, inout vec3 radiance) {\n"
                               "    radiance = texture(probe_used, vec2(0.5)).rgb;\n"
                               "}\n")});
    look_ahead(drawn);
    PassTimes times;
    drawn.renderer().render_frame(drawn.terrain(), drawn.ground(), drawn.frame(), &times);
    const auto is_run = [&](std::string_view name) {
        return std::ranges::any_of(times, [&](const auto& time) { return time.pass == name; });
    };
    EXPECT_TRUE(is_run("probe.used"));
    EXPECT_FALSE(is_run("probe.unused"));
}

struct Unordered {
    const char* name;
    const char* passes;
    const char* glsl;
    const char* message;
};

class PluginPassError : public testing::TestWithParam<Unordered> {};

TEST_P(PluginPassError, NamesThePasses) {
    const effect::Effect effect = written("probe", GetParam().passes, GetParam().glsl);
    EXPECT_THAT(test::error_of([&] { test::Drawn(bundled(), {}, 64, 48, 0, {effect}); }),
                HasSubstr(std::string("exit 3: render: graph: ") + GetParam().message +
                          "; see Passes in docs/plugin-guide.md; --disable probe goes on without "
                          "it"));
}

INSTANTIATE_TEST_SUITE_P(
    , PluginPassError,
    testing::Values(
        Unordered{"GroundOfTheFinishedRadiance", R"({"a": {}})",
                  "uniform sampler2D probe_scene; //@ from(core.radiance)\n"
                  "uniform sampler2D probe_a;\n"
                  "vec4 probe_pass_a(in Texel t) { return texture(probe_scene, t.at); }\n"
                  "void probe_on_lit(in Surface s, inout vec3 radiance) {\n"
                  "    radiance += texture(probe_a, vec2(0.5)).rgb;\n"
                  "}\n",
                  "passes probe.a, terrain, background, post wait for each other"},
        Unordered{"SeldomOfAFrame", R"({"a": {"when": "sun"}})",
                  "uniform sampler2D probe_depth; //@ from(core.depth)\n"
                  "uniform sampler2D probe_a;\n"
                  "vec4 probe_pass_a(in Texel t) { return texture(probe_depth, t.at); }\n"
                  "void probe_on_lit(in Surface s, inout vec3 radiance) {\n"
                  "    radiance += texture(probe_a, vec2(0.5)).rgb;\n"
                  "}\n",
                  "pass probe.a is not executed in every frame but uses depth, which lasts for one "
                  "frame"},
        Unordered{"ItsOwn", R"({"a": {}})",
                  "uniform sampler2D probe_a;\n"
                  "vec4 probe_pass_a(in Texel t) { return texture(probe_a, t.at); }\n"
                  "void probe_on_lit(in Surface s, inout vec3 radiance) {\n"
                  "    radiance += texture(probe_a, vec2(0.5)).rgb;\n"
                  "}\n",
                  "pass probe.a both reads probe.a and draws into it"}),
    [](const auto& each) { return each.param.name; });

}  // namespace
}  // namespace relevo::render::test_plugin_passes
