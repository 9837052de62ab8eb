// docs/plugin-guide.md is true: its example loads and stitches, and its tables are complete.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/text.h"
#include "effect/plugins.h"
#include "shader/stitch.h"

namespace relevo::effect::test::test_guide {
namespace {

using ::testing::HasSubstr;

std::string guide() {
    return read_text(relevo::test::source_dir() / "docs" / "plugin-guide.md", "test");
}

/// The text between "```language name" and "```".
std::string block(const std::string& text, const std::string& fence) {
    const std::size_t begin = text.find("```" + fence + '\n');
    if (begin == std::string::npos) return "";
    const std::size_t start = text.find('\n', begin) + 1;
    return text.substr(start, text.find("```", start) - start);
}

TEST(PluginGuide, ItsExampleIsAPlugin) {
    const Plugins plugins;
    plugins.write("plugins/dust/plugin.json", block(guide(), "json plugin.json"));
    plugins.write("plugins/dust/dust.glsl", block(guide(), "glsl dust.glsl"));
    const Registry registry = plugins.load();
    ASSERT_TRUE(registry.broken().empty()) << registry.broken()[0].error;
    const Selection selection = select(registry, {}, {});
    shader::StitchInput input;
    input.snippets = selection.snippets();
    const shader::Stitched stitched =
        shader::stitch(shader::FolderTexts(relevo::test::source_dir() / "shaders"),
                       {.vertex_main = "fullscreen.vert.glsl",
                        .fragment_main = "terrain.frag.glsl",
                        .geometry_of = "terrain.vert.glsl"},
                       input);
    EXPECT_THAT(stitched.fragment.text, HasSubstr("    dust_on_material(s);\n"));
    EXPECT_EQ(stitched.params.members.size(), 3u);
}

TEST(PluginGuide, ItsContoursAreAPlugin) {
    const Plugins plugins;
    plugins.add("contour", "", block(guide(), "glsl contour.glsl"));
    const Registry registry = plugins.load();
    ASSERT_TRUE(registry.broken().empty()) << registry.broken()[0].error;
    EXPECT_TRUE(registry.effects()[0].answers("display"));
}

TEST(PluginGuide, ItsWayIsAPlugin) {
    const Plugins plugins;
    plugins.add("way", R"("texts": {"file": {"kind": "file"}, "by": {}},
                          "textures": {"way": {"kind": "lines", "from": "file", "attribute": "by"}})",
                block(guide(), "glsl way.glsl"));
    const Registry registry = plugins.load();
    ASSERT_TRUE(registry.broken().empty()) << registry.broken()[0].error;
    const Manifest& manifest = registry.effects()[0].manifest;
    ASSERT_EQ(manifest.lines.size(), 1U);
    EXPECT_EQ(manifest.lines[0].resource, "way.way");
    EXPECT_EQ(manifest.lines[0].file, "way.file");
    EXPECT_EQ(manifest.lines[0].attribute, "by");
}

TEST(PluginGuide, ItsGlowIsAPlugin) {
    const Plugins plugins;
    plugins.add("glow", R"("passes": {"small": {"scale": 0.125}})",
                block(guide(), "glsl glow.glsl"));
    const Registry registry = plugins.load();
    ASSERT_TRUE(registry.broken().empty()) << registry.broken()[0].error;
    EXPECT_EQ(registry.effects()[0].manifest.passes.size(), 1U);
}

TEST(PluginGuide, ItsAirAndItsMeterArePlugins) {
    const Plugins plugins;
    plugins.add("mist", R"("passes": {"air": {"kind": "3d", "size": [32, 32, 16], "when": "sun"}})",
                block(guide(), "glsl mist.glsl"));
    plugins.add("meter",
                R"("passes": {"histogram": {"kind": "compute", "writes": "uints", "count": 64,
                                            "local_size": [8, 8], "over": "frame"}})",
                block(guide(), "glsl meter.glsl"));
    const Registry registry = plugins.load();
    ASSERT_TRUE(registry.broken().empty()) << registry.broken()[0].error;
    EXPECT_EQ(registry.effects()[0].manifest.passes.size(), 1U);
    EXPECT_EQ(registry.effects()[1].manifest.passes.size(), 1U);
}

TEST(PluginGuide, ItsStonesAreAPlugin) {
    const Plugins plugins;
    plugins.write("plugins/stones/stone.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    plugins.add("stones",
                R"("instances": {"stone": {"spacing_m": 5, "height_m": 2,
                   "levels": [{"meshes": ["stone.obj"]}]}})",
                block(guide(), "glsl stones.glsl"));
    const Registry registry = plugins.load();
    ASSERT_TRUE(registry.broken().empty()) << registry.broken()[0].error;
    EXPECT_EQ(registry.effects()[0].manifest.instances.size(), 1U);
}

TEST(PluginGuide, ItsRampIsOne) {
    const Plugins plugins;
    const std::string glsl = block(guide(), "glsl rain.glsl");
    plugins.add("rain", "", glsl);
    const Registry registry = plugins.load();
    ASSERT_TRUE(registry.broken().empty()) << registry.broken()[0].error;
    const std::vector<shader::ColourRamp> ramps = registry.effects()[0].ramps();
    ASSERT_EQ(ramps.size(), 1u);
    EXPECT_EQ(ramps[0].to.number, 3000);
    EXPECT_EQ(ramps[0].where_word, "year");
    const auto broken = [&](std::string from, const std::string& to) {
        std::string other = glsl;
        other.replace(other.find(from), from.size(), to);
        plugins.add("rain", "", other);
        return plugins.load().broken().at(0).error;
    };
    EXPECT_THAT(broken("where(by, year)", "where(by, month)"),
                HasSubstr("rain.glsl:3: rain_year: where: expected an enum parameter of the "
                          "plugin's and one of its words but got rain.by, month"));
    EXPECT_THAT(
        broken("ramp(0, 3000)", "ramp(0, most)"),
        HasSubstr("rain.glsl:3: rain_year: ramp: expected a number, lowest, highest, floor or a "
                  "float parameter of the plugin's but got rain.most"));
}

TEST(PluginGuide, ItsClassesAreStepsAndEntries) {
    const Plugins plugins;
    plugins.add("steepness", "", block(guide(), "glsl steepness.glsl"));
    const Registry registry = plugins.load();
    ASSERT_TRUE(registry.broken().empty()) << registry.broken()[0].error;
    const std::vector<shader::ColourRamp> ramps = registry.effects()[0].ramps();
    ASSERT_EQ(ramps.size(), 2u);
    EXPECT_THAT(ramps[0].edges, testing::ElementsAre(0, 30, 35, 40, 90));
    EXPECT_THAT(ramps[1].entries, testing::ElementsAre("rock", "fresh snow"));
}

TEST(PluginGuide, ItsFrostReadsTheClimate) {
    const Plugins plugins;
    plugins.add("frost", "", block(guide(), "glsl frost.glsl"));
    const Registry registry = plugins.load();
    ASSERT_TRUE(registry.broken().empty()) << registry.broken()[0].error;
    const Selection selection = select(registry, {}, {});
    shader::StitchInput input;
    input.snippets = selection.snippets();
    const shader::Stitched stitched =
        shader::stitch(shader::FolderTexts(relevo::test::source_dir() / "shaders"),
                       {.vertex_main = "fullscreen.vert.glsl",
                        .fragment_main = "terrain.frag.glsl",
                        .geometry_of = "terrain.vert.glsl"},
                       input);
    EXPECT_THAT(stitched.fragment.text, HasSubstr("sampler3D climate_table;"));
}

TEST(PluginGuide, HasEveryHook) {
    const std::string text = guide();
    for (const shader::Hook& hook : shader::hooks())
        EXPECT_THAT(text, HasSubstr('`' + std::string(hook.signature) + '`'));
}

TEST(PluginGuide, HasEveryKey) {
    const std::string text = guide();
    const Plugins plugins;
    plugins.write("plugins/dust/dust.glsl", "void dust_on_albedo(inout Surface s) {}");
    plugins.write("plugins/dust/plugin.json",
                  R"({"format": 1, "id": "dust", "name": "D", "version": "1", "qqqqqqqqqqqq": 0})");
    const std::string error =
        relevo::test::error_of([&] { load_effect(plugins.plugins() / "dust", plugins.data()); });
    const std::string list = error.substr(error.find("there are ") + 10);
    const std::vector<std::string> keys = split(list, ',');
    EXPECT_EQ(keys.size(), 26u);
    for (const std::string& key : keys)
        EXPECT_THAT(text, HasSubstr('`' + std::string(trimmed(key)) + '`'));
    for (const MarkKey& key : mark_keys())
        EXPECT_THAT(text, HasSubstr('`' + std::string(key.key) + '`'));
}

TEST(PluginGuide, HasEveryAnnotation) {
    const std::string text = guide();
    const std::string error = relevo::test::error_of([] {
        shader::parse_snippet("dust", "dust.glsl", "uniform bool dust_a = true; //@ qqqqqqqqqqqq");
    });
    const std::string list = error.substr(error.find("there are ") + 10);
    const std::vector<std::string> words = split(list, ',');
    EXPECT_EQ(words.size(), 10u);
    for (const std::string& word : words)
        EXPECT_TRUE(text.find("| `" + std::string(trimmed(word)) + '`') != std::string::npos ||
                    text.find("| `" + std::string(trimmed(word)) + '(') != std::string::npos)
            << word;
}

}  // namespace
}  // namespace relevo::effect::test::test_guide
