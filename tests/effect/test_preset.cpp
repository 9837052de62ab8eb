#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "effect/plugins.h"
#include "effect/preset.h"

namespace relevo::effect::test::test_preset {
namespace {

using relevo::test::error_of;
using ::testing::ElementsAre;

TEST(Setting, IsAddressAndValue) {
    const Setting setting = parse_setting("layering.label=a=b");
    EXPECT_EQ(setting.address, "layering.label");
    EXPECT_EQ(setting.text, "a=b");
    for (const char* bad : {"haze", "haze.density", "haze=1.0", ".density=1", ""})
        EXPECT_EQ(error_of([&] { parse_setting(bad); }),
                  std::string(
                      "exit 2: --set: expected PLUGIN.PARAMETER=VALUE without spaces but got \"") +
                      bad + "\"");
}

TEST(Preset, IsReadWhole) {
    const Plugins plugins;
    plugins.write("winter.json", R"({
        "description": "Deep snow.",
        "only": ["layering"], "enable": ["haze"], "disable": ["wet"],
        "set": {
            "layering.scale": 1.5,
            "layering.on": true,
            "layering.mode": "metres",
            "layering.tint": [0.1, 0.2, 0.3]
        }})");
    const Preset preset = load_preset((plugins.folder() / "winter.json").string());
    EXPECT_EQ(preset.name, "winter");
    EXPECT_EQ(preset.description, "Deep snow.");
    EXPECT_THAT(*preset.switches.only, ElementsAre("layering"));
    EXPECT_THAT(preset.switches.enable, ElementsAre("haze"));
    EXPECT_THAT(preset.switches.disable, ElementsAre("wet"));
    std::vector<std::string> settings;
    for (const Setting& setting : preset.settings)
        settings.push_back(setting.address + '=' + setting.text + ':' +
                           std::to_string(setting.line));
    EXPECT_THAT(settings, ElementsAre("layering.scale=1.5:5", "layering.on=true:6",
                                      "layering.mode=metres:7", "layering.tint=0.1,0.2,0.3:8"));
}

TEST(Preset, WithoutOnlyLeavesTheDefaultsOn) {
    const Plugins plugins;
    plugins.write("a.json", "{}");
    EXPECT_FALSE(load_preset((plugins.folder() / "a.json").string()).switches.only.has_value());
    plugins.write("b.json", R"({"only": []})");
    EXPECT_TRUE(load_preset((plugins.folder() / "b.json").string()).switches.only.has_value());
}

/// share_dir() is elsewhere while it lives.
struct Share {
    explicit Share(const std::filesystem::path& folder) {
        setenv("RELEVO_SHARE", folder.c_str(), 1);
    }
    ~Share() { unsetenv("RELEVO_SHARE"); }
};

TEST(Preset, IsFoundByItsName) {
    const Plugins plugins;
    const Share share(plugins.folder());
    EXPECT_EQ(error_of([] { load_preset("paper"); }),
              "exit 3: preset: paper: no such preset; there are none");
    plugins.write("presets/paper.json", R"({"description": "The paper."})");
    plugins.write("presets/winter.json", "{}");
    EXPECT_THAT(preset_names(), ElementsAre("paper", "winter"));
    EXPECT_EQ(load_preset("paper").description, "The paper.");
    EXPECT_EQ(error_of([] { load_preset("papers"); }),
              "exit 3: preset: papers: no such preset; did you mean paper?");
    EXPECT_EQ(error_of([] { load_preset("contours"); }),
              "exit 3: preset: contours: no such preset; there are paper, winter");
}

TEST(Registry, InstalledPluginsComeFirst) {
    const Plugins plugins;
    const Share share(plugins.folder());
    plugins.add("haze");
    plugins.write("mine/haze/plugin.json",
                  R"({"format": 1, "id": "haze", "name": "Mine", "version": "2"})");
    plugins.write("mine/haze/haze.glsl", "void haze_on_albedo(inout Surface s) {}");
    const Registry registry = Registry::load_installed({plugins.folder() / "mine"});
    ASSERT_EQ(registry.effects().size(), 1u);
    EXPECT_EQ(registry.effects()[0].manifest.name, "haze");
    EXPECT_EQ(registry.broken().size(), 1u);
}

struct Bad {
    const char* name;
    const char* text;
    const char* message;
};

class PresetError : public testing::TestWithParam<Bad> {};

TEST_P(PresetError, NamesFileAndLine) {
    const Plugins plugins;
    plugins.write("bad.json", GetParam().text);
    EXPECT_EQ(
        plugins.relative(error_of([&] { load_preset((plugins.folder() / "bad.json").string()); })),
        std::string("exit 3: preset: bad.json:") + GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    All, PresetError,
    testing::Values(
        Bad{"Syntax", "{\n\"only\": [}",
            "2: syntax error while parsing value - unexpected '}'; expected '[', '{', or a "
            "literal"},
        Bad{"UnknownKey", "{\n\"onyl\": []}", "2: onyl: no such key; did you mean \"only\"?"},
        Bad{"NearKey", "{\n\"enabled\": []}", "2: enabled: no such key; did you mean \"enable\"?"},
        Bad{"NoList", "{\n\"only\": \"haze\"}",
            "2: only: expected a list of texts but got \"haze\""},
        Bad{"SetList", "{\n\"set\": []}",
            "2: set: expected an object of address and value but got a list"},
        Bad{"SetNull", "{\"set\": {\n\"haze.density\": null}}",
            "2: set: haze.density: expected a number, true or false, a text or a list of numbers "
            "but got null"},
        Bad{"SetTexts", "{\"set\": {\n\"haze.tint\": [\"a\"]}}",
            "2: set: haze.tint: expected a number, true or false, a text or a list of numbers but "
            "got a list"}),
    [](const auto& test) { return test.param.name; });

TEST(PresetErrors, AMissingFileIsNamed) {
    EXPECT_EQ(error_of([] { load_preset("nowhere/winter.json"); }),
              "exit 3: preset: nowhere/winter.json: cannot be read, No such file or "
              "directory");
}

}  // namespace
}  // namespace relevo::effect::test::test_preset
