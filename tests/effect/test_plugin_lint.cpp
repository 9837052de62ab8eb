// Mistakes that the files of a plugin show.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "effect/plugin_lint.h"
#include "effect/plugins.h"

namespace relevo::effect::test::test_plugin_lint {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const std::string kHook = "void dust_on_material(inout Surface s) { s.diffuse *= 0.5; }\n";

/// The findings of the plugin dust: "warning plugins/dust/...".
std::vector<std::string> findings(const std::string& glsl, const std::string& members = "") {
    const Plugins plugins;
    plugins.add("soil", R"("provides": ["materials"])");
    plugins.add("dust", members, glsl);
    const Registry registry = plugins.load();
    std::vector<std::string> texts;
    for (const BrokenEffect& broken : registry.broken())
        texts.push_back(plugins.relative(broken.error));
    if (const Effect* const effect = registry.find("dust"))
        for (const Finding& finding : lint(*effect, registry))
            texts.push_back((finding.is_error ? "error " : "warning ") +
                            plugins.relative(finding.text));
    return texts;
}

TEST(PluginLint, OfAGoodPluginFindsNothing) {
    EXPECT_THAT(findings("uniform float dust_amount = 0.5; //@ range(0, 1)\n"
                         "float dust_half() { return dust_amount; }\n"
                         "void dust_on_material(inout Surface s) {\n"
                         "    for (int i = 0; i < 4; ++i) s.diffuse *= dust_half();\n"
                         "}\n",
                         R"("after": ["materials"], "wants": ["outside", "night"])"),
                IsEmpty());
}

TEST(PluginLint, NamesLoopsThatMayNeverEnd) {
    EXPECT_THAT(findings("void dust_on_material(inout Surface s) {\n"
                         "    while (s.height_m > -9e9) {}\n"
                         "    for (float i = 0.0; i < 10.0; i += 0.0) s.diffuse *= 0.5;\n"
                         "    for (int i = 0; i >= 0; i = (i + 1) % 1000) s.diffuse *= 0.5;\n"
                         "}\n"),
                ElementsAre("warning plugins/dust/dust.glsl:2: this loop has no constant bound and "
                            "may never end; write for (int i = "
                            "0; i < N; ++i) with a constant N of at most 10000",
                            "warning plugins/dust/dust.glsl:3: this loop has no constant bound and "
                            "may never end; write for (int i = "
                            "0; i < N; ++i) with a constant N of at most 10000",
                            "warning plugins/dust/dust.glsl:4: this loop has no constant bound and "
                            "may never end; write for (int i = "
                            "0; i < N; ++i) with a constant N of at most 10000"));
}

TEST(PluginLint, NamesPassesThatNothingReads) {
    const std::string passes = R"("passes": {
        "sum": {"kind": "compute", "writes": "uints", "count": 4, "local_size": [4]}})";
    const std::string function = "void dust_pass_sum(in Invocation i) { dust_sum_out[0] = 1u; }\n";
    EXPECT_THAT(findings(kHook + function, passes),
                ElementsAre("warning plugins/dust/plugin.json:2: passes.sum: nothing reads it, so "
                            "it is never computed; add uniform usamplerBuffer dust_sum, or remove "
                            "it"));
    EXPECT_THAT(findings("uniform usamplerBuffer dust_sum;\n" + kHook + function, passes),
                IsEmpty());
}

TEST(PluginLint, NamesParametersThatNoHookReads) {
    EXPECT_THAT(findings("uniform float dust_amount = 0.5; //@ range(0, 1)\n"
                         "uniform float dust_level_m = 0.5; //@ range(0, 1)\n"
                         "float dust_unused() { return dust_amount; }\n"
                         "void dust_on_displace(in VertexFrame v, inout vec3 position_m) {}\n",
                         R"("displaces": {"to_m": "dust.level_m"})"),
                ElementsAre("warning plugins/dust/dust.glsl:1: dust_amount: no hook reads this "
                            "parameter; use it or remove it"));
}

TEST(PluginLint, NamesWordsThatNoPluginProvides) {
    EXPECT_THAT(findings(kHook, "\n\"after\": [\"materails\"],\n\"wants\": [\"mist\"]"),
                ElementsAre("warning plugins/dust/plugin.json:3: wants: no installed plugin "
                            "provides \"mist\"; there are materials",
                            "warning plugins/dust/plugin.json:2: after: no installed plugin "
                            "provides \"materails\"; did you mean \"materials\"?"));
    EXPECT_THAT(findings(kHook, "\"requires\": [\"materails\"]"),
                ElementsAre("error plugins/dust/plugin.json:1: requires: no installed plugin "
                            "provides \"materails\"; did you mean \"materials\"?"));
}

TEST(PluginLint, NamesDerivativesThatAreNotThere) {
    const std::string texture =
        R"("textures": {"map": {"kind": "2d", "file": "dust.glsl", "encoding": "srgb"}})";
    EXPECT_THAT(
        findings("uniform sampler2D dust_map;\n"
                 "void dust_on_material(inout Surface s) {\n"
                 "    s.diffuse = s.ambient = texture(dust_map, s.ground_m.xy).rgb;\n"
                 "    s.diffuse *= dFdx(s.height_m);\n"
                 "}\n",
                 texture),
        ElementsAre("warning plugins/dust/dust.glsl:3: texture: the next pixel may be other "
                    "ground, so derivatives are wrong; use textureGrad with s.ground_dx_m and "
                    "s.ground_dy_m",
                    "warning plugins/dust/dust.glsl:4: dFdx: the next pixel may be other ground, "
                    "so derivatives are wrong; use s.height_dx_m, s.height_dy_m, s.ground_dx_m or "
                    "s.ground_dy_m"));
    EXPECT_THAT(findings("uniform sampler2D dust_map;\n"
                         "vec3 dust_on_backdrop(in vec3 direction, in vec2 at) {\n"
                         "    return texture(dust_map, at).rgb;\n"
                         "}\n",
                         texture),
                IsEmpty());
}

TEST(PluginLint, NamesHooksThatPaintTheGroundInDirectLightAlone) {
    const std::string expected =
        "warning plugins/dust/dust.glsl:2: dust_on_material sets diffuse without ambient, so the "
        "ground keeps its earlier colour in the sky's light and in shade; set s.ambient, too";
    EXPECT_THAT(findings("void dust_on_material(inout Surface s) {\n"
                         "    s.diffuse = mix(s.ambient, vec3(0.4), 0.5);\n"
                         "}\n"),
                ElementsAre(expected));
    EXPECT_THAT(findings("void dust_paint(inout Surface s) {\n"
                         "    s.diffuse.rg = vec2(0.4);\n"
                         "}\n"
                         "void dust_on_material(inout Surface s) { dust_paint(s); }\n"),
                ElementsAre(expected));
    EXPECT_THAT(findings("void dust_paint(inout Surface s) { s.ambient = s.diffuse; }\n"
                         "void dust_on_material(inout Surface s) {\n"
                         "    s.diffuse = vec3(0.4);\n"
                         "    dust_paint(s);\n"
                         "}\n"),
                IsEmpty());
}

TEST(PluginLint, OfBundledPluginsFindsNothing) {
    const auto share = relevo::test::build_dir() / "share/relevo";
    const Registry registry = Registry::load({share / "plugins"}, share / "data");
    ASSERT_TRUE(registry.broken().empty()) << registry.broken()[0].error;
    std::vector<std::string> texts;
    for (const Effect& effect : registry.effects())
        for (const Finding& finding : lint(effect, registry))
            // Some loops count to one or two materials.
            if (finding.text.find("no constant bound") == std::string::npos)
                texts.push_back(finding.text);
    EXPECT_THAT(texts, IsEmpty());
    EXPECT_GT(registry.effects().size(), 1U);
}

}  // namespace
}  // namespace relevo::effect::test::test_plugin_lint
