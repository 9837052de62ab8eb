// Which folders are searched for plugins, and what an unmet requirement of a named one says.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/paths.h"
#include "effect/plugins.h"
#include "effect/search_path.h"

namespace relevo::effect::test::test_search_path {
namespace {

using relevo::test::error_of;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
namespace fs = std::filesystem;

TEST(SearchPath, IsBundledThenDataHomeThenVariableThenCommandLine) {
    const Plugins plugins;
    const fs::path data = plugins.folder(), own = data / "relevo/plugins";
    fs::create_directories(own);
    fs::create_directories(data / "a");
    fs::create_directories(data / "b");
    const Variable home("XDG_DATA_HOME", data.string());
    const Variable path("RELEVO_PLUGIN_PATH",
                        (data / "a").string() + "::" + (data / "b").string() + ":");
    EXPECT_THAT(user_plugin_folders(), ElementsAre(own, data / "a", data / "b"));
    EXPECT_THAT(plugin_search_path({"mine"}),
                ElementsAre(share_dir() / "plugins", own, data / "a", data / "b", "mine"));
}

TEST(SearchPath, TheDataFolderOfTheHomeIsTheDefault) {
    const Plugins plugins;
    const fs::path own = plugins.folder() / ".local/share/relevo/plugins";
    const Variable none("RELEVO_PLUGIN_PATH", "");
    const Variable home("HOME", plugins.folder().string());
    // By the specification a relative path is ignored.
    const Variable relative("XDG_DATA_HOME", "data");
    EXPECT_THAT(user_plugin_folders(), IsEmpty());
    fs::create_directories(own);
    EXPECT_THAT(user_plugin_folders(), ElementsAre(own));
}

TEST(SearchPath, FoldersOfTheVariableAreAbsoluteAndExist) {
    const Plugins plugins;
    const Variable home("XDG_DATA_HOME", plugins.folder().string());
    const auto error = [](const std::string& value) {
        const Variable path("RELEVO_PLUGIN_PATH", value);
        return error_of([] { user_plugin_folders(); });
    };
    EXPECT_EQ(error("plugins"),
              "exit 3: RELEVO_PLUGIN_PATH: plugins: expected an absolute path of a folder");
    EXPECT_EQ(error("/nowhere/plugins"),
              "exit 3: RELEVO_PLUGIN_PATH: /nowhere/plugins: no such folder");
}

TEST(SearchPath, AFolderThatTwoPathsHaveIsReadOnce) {
    const Plugins plugins;
    plugins.add("haze");
    const Registry registry = Registry::load(
        {plugins.plugins(), plugins.plugins() / "haze", plugins.plugins() / "../plugins"},
        plugins.data());
    EXPECT_EQ(registry.effects().size(), 1U);
    EXPECT_THAT(registry.broken(), IsEmpty());
}

TEST(SearchPath, OfTwoPluginsWithOneIdTheFirstIsUsed) {
    const Plugins plugins;
    plugins.add("haze", R"("description": "the first")");
    plugins.write("other/haze/plugin.json",
                  R"({"format": 1, "id": "haze", "name": "Haze", "version": "2"})");
    plugins.write("other/haze/haze.glsl", "void haze_on_albedo(inout Surface s) {}\n");
    const Registry registry =
        Registry::load({plugins.plugins(), plugins.folder() / "other"}, plugins.data());
    EXPECT_EQ(registry.effect("haze", "test").manifest.description, "the first");
    ASSERT_EQ(registry.broken().size(), 1U);
    EXPECT_EQ(plugins.relative(registry.broken()[0].error),
              "plugin: other/haze/plugin.json: the id haze is taken by plugins/haze/plugin.json; "
              "remove one of the two");
}

TEST(UnmetRequirement, OfANamedEffectIsRefusedWithItsProviders) {
    const Plugins plugins;
    plugins.add("layering", R"("provides": ["materials"])");
    plugins.add("gloss", R"("provides": ["shine"], "requires": ["materials"])");
    plugins.add("wet", R"("requires": ["shine"], "enabled_by_default": false)");
    plugins.add("glow", R"("requires": ["materails"], "enabled_by_default": false)");
    const Registry registry = plugins.load();
    const auto refused = [&](const Switches& command_line) {
        return select(registry, {}, command_line).refused;
    };
    EXPECT_THAT(refused({.enable = {"glow"}}),
                ElementsAre("effects: glow: it cannot be switched on: it requires materails, which "
                            "no plugin here provides; did you mean materials?; take it out of "
                            "--enable"));
    EXPECT_THAT(refused({.only = std::vector<std::string>{"gloss"}, .disable = {"layering"}}),
                ElementsAre("effects: gloss: it cannot be switched on: it requires materials, "
                            "layering is disabled; take it out of --only"));
    EXPECT_THAT(refused({.enable = {"wet"}, .disable = {"layering"}}),
                ElementsAre("effects: wet: it cannot be switched on: it requires shine, gloss is "
                            "off (it requires materials, layering is disabled); take it out of "
                            "--enable"));
    EXPECT_THAT(refused({.disable = {"layering"}}), IsEmpty());
    const Preset preset{"p", "p.json", "", {.enable = {"glow"}}, {}};
    EXPECT_THAT(select(registry, {preset}, {}).refused, IsEmpty());
}

}  // namespace
}  // namespace relevo::effect::test::test_search_path
