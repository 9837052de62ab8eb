#include <algorithm>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "effect/plugins.h"
#include "effect/registry.h"
#include "shader/stitch.h"

namespace relevo::effect::test::test_registry {
namespace {

using relevo::test::error_of;
using ::testing::ElementsAre;

std::vector<std::string> ids(const Registry& registry) {
    std::vector<std::string> result;
    for (const Effect& effect : registry.effects())
        result.push_back(effect.id());
    return result;
}

TEST(Registry, LoadsEveryPluginOfAFolder) {
    const Plugins plugins;
    plugins.add("haze");
    plugins.add("bump");
    plugins.write("plugins/notes/README.md", "no plugin");
    plugins.write("plugins/CMakeLists.txt", "");
    const Registry registry = plugins.load();
    EXPECT_THAT(ids(registry), ElementsAre("bump", "haze"));
    EXPECT_TRUE(registry.broken().empty());
}

TEST(Registry, DeletingAFolderRemovesItsEffect) {
    const Plugins plugins;
    plugins.add("haze");
    plugins.add("bump");
    std::filesystem::remove_all(plugins.plugins() / "haze");
    EXPECT_THAT(ids(plugins.load()), ElementsAre("bump"));
}

TEST(Registry, APathMayBeAPluginItself) {
    const Plugins plugins;
    plugins.add("haze");
    EXPECT_THAT(ids(Registry::load({plugins.plugins() / "haze"}, plugins.data())),
                ElementsAre("haze"));
}

TEST(Registry, IsInTheOrderOfTheIds) {
    const Plugins plugins;
    plugins.add("haze");
    plugins.add("bump");
    EXPECT_THAT(ids(Registry::load({plugins.plugins() / "haze", plugins.plugins() / "bump"},
                                   plugins.data())),
                ElementsAre("bump", "haze"));
}

TEST(Registry, ABrokenPluginTakesNoOtherDown) {
    const Plugins plugins;
    plugins.add("bump");
    plugins.add("haze", "", "void haze_on_albedo(inout Surface s) {\n");
    plugins.write("plugins/snow/plugin.json", "{");
    const Registry registry = plugins.load();
    EXPECT_THAT(ids(registry), ElementsAre("bump"));
    ASSERT_EQ(registry.broken().size(), 2u);
    EXPECT_EQ(registry.broken()[0].id, "haze");
    EXPECT_EQ(registry.broken()[0].folder, plugins.plugins() / "haze");
    EXPECT_EQ(plugins.relative(registry.broken()[0].error),
              "shader: plugins/haze/haze.glsl:1: { is never closed");
    EXPECT_EQ(registry.broken()[1].id, "snow");
    EXPECT_EQ(plugins.relative(registry.broken()[1].error),
              "plugin: plugins/snow/plugin.json:1: syntax error while parsing object key - "
              "unexpected end of input; expected string literal");
}

TEST(Registry, ABrokenPluginMayBeDisabled) {
    const Plugins plugins;
    plugins.add("bump");
    plugins.add("haze", "", "}");
    const Registry registry = plugins.load();
    EXPECT_TRUE(registry.is_broken("haze"));
    EXPECT_FALSE(registry.is_broken("bump"));
    EXPECT_EQ(select(registry, {}, {.disable = {"haze"}}).effects.size(), 1u);
    EXPECT_EQ(plugins.relative(error_of([&] { select(registry, {}, {.enable = {"haze"}}); })),
              "exit 3: effects: haze: this plugin could not be loaded: shader: "
              "plugins/haze/haze.glsl:1: } closes nothing");
}

TEST(Registry, OneByteThatIsNoUtf8BreaksItsPluginAlone) {
    const Plugins plugins;
    plugins.add("bump");
    plugins.add("haze",
                "\"description\": \"N\xe4"
                "he\"");
    const Registry registry = plugins.load();
    EXPECT_THAT(ids(registry), ElementsAre("bump"));
    ASSERT_EQ(registry.broken().size(), 1u);
    EXPECT_EQ(plugins.relative(registry.broken()[0].error),
              "plugin: plugins/haze/plugin.json:1: syntax error while parsing value - invalid "
              "string: ill-formed UTF-8 byte; last read: '\"N\\xe4h'");
}

TEST(Registry, OfTwoWithOneIdTheFirstStays) {
    const Plugins plugins;
    plugins.add("haze");
    plugins.write("more/mist/plugin.json",
                  R"({"format": 1, "id": "haze", "name": "Mist", "version": "2"})");
    plugins.write("more/mist/haze.glsl", "void haze_on_albedo(inout Surface s) {}");
    const Registry registry =
        Registry::load({plugins.plugins(), plugins.folder() / "more"}, plugins.data());
    ASSERT_EQ(registry.effects().size(), 1u);
    EXPECT_EQ(registry.effects()[0].manifest.name, "haze");
    ASSERT_EQ(registry.broken().size(), 1u);
    EXPECT_EQ(plugins.relative(registry.broken()[0].error),
              "plugin: more/mist/plugin.json: the id haze is taken by "
              "plugins/haze/plugin.json; remove one of the two");
}

TEST(Registry, ErrorsNameWhatIsNotThere) {
    const Plugins plugins;
    plugins.add("haze");
    plugins.add("bump");
    plugins.add("snow", "", "}");
    const Registry registry = plugins.load();
    EXPECT_EQ(error_of([&] { registry.effect("hase", "who"); }),
              "exit 3: who: hase: no such plugin; did you mean haze?");
    EXPECT_EQ(error_of([&] { registry.effect("contours", "who"); }),
              "exit 3: who: contours: no such plugin; there are bump, haze");
    EXPECT_EQ(plugins.relative(error_of([&] { registry.effect("snow", "who"); })),
              "exit 3: who: snow: this plugin could not be loaded: shader: "
              "plugins/snow/snow.glsl:1: } closes nothing");
    EXPECT_EQ(error_of([] { Registry().effect("haze", "who"); }),
              "exit 3: who: haze: no such plugin; there are none");
    EXPECT_EQ(plugins.relative(error_of(
                  [&] { Registry::load({plugins.folder() / "nowhere"}, plugins.data()); })),
              "exit 3: plugin: nowhere: no such folder");
}

TEST(Registry, KnowsAllParameters) {
    const Plugins plugins;
    plugins.add("haze", "",
                "uniform bool haze_on = true;\nvoid haze_on_albedo(inout Surface s) { if (haze_on) "
                "s.diffuse *= 0.5; }");
    plugins.add("bump", "",
                "uniform bool bump_on = true;\nvoid bump_on_normal(inout Surface s) { if (bump_on) "
                "s.normal = -s.normal; }");
    std::vector<std::string> addresses;
    for (const shader::Param& param : plugins.load().params())
        addresses.push_back(param.address);
    EXPECT_THAT(addresses, ElementsAre("bump.on", "haze.on"));
}

// Whatever the order in which folders are found, what is compiled is the same.
TEST(Registry, ShuffledRegistrationGivesEqualBytes) {
    const Plugins plugins;
    const std::vector<std::string> names = {"ash", "bump", "contours", "haze", "relief", "wet"};
    for (const std::string& id : names)
        plugins.add(id,
                    id == "bump"   ? R"("after": ["mood"])"
                    : id == "wet"  ? R"("provides": ["mood"])"
                    : id == "haze" ? R"("provides": ["mood"])"
                                   : "",
                    "uniform bool " + id + "_on = true;\nvoid " + id +
                        "_on_albedo(inout Surface s) { if (" + id + "_on) s.diffuse *= 0.5; }");
    const shader::FolderTexts core(relevo::test::source_dir() / "tests/shader/fixtures/shaders");
    const shader::ProgramRecipe program{.vertex_main = "terrain.vert.glsl",
                                        .fragment_main = "terrain.frag.glsl"};
    std::vector<std::filesystem::path> paths;
    for (const std::string& id : names)
        paths.push_back(plugins.plugins() / id);
    std::string first;
    std::mt19937 random(7);
    for (int round = 0; round < 10; ++round) {
        const Registry registry = Registry::load(paths, plugins.data());
        const Selection selection = select(registry, {}, {});
        shader::StitchInput input;
        input.snippets = selection.snippets();
        input.capabilities = selection.capabilities;
        const shader::Stitched stitched = shader::stitch(core, program, input);
        const std::string text = stitched.vertex.text + stitched.fragment.text;
        if (first.empty()) first = text;
        EXPECT_EQ(text, first);
        std::shuffle(paths.begin(), paths.end(), random);
    }
    EXPECT_LT(first.find("    wet_on_albedo(s);"), first.find("    bump_on_albedo(s);"));
    EXPECT_NE(first.find("    ash_on_albedo(s);"), std::string::npos);
}

}  // namespace
}  // namespace relevo::effect::test::test_registry
