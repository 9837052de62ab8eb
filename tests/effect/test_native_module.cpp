// A native module that is wrong is off, with what requires it. Nothing else is.
#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/paths.h"
#include "effect/loaded_selection.h"
#include "effect/plugins.h"

namespace relevo::effect::test::test_native_module {
namespace {

using ::testing::ElementsAre;

/// A plugin `native` whose module is one of those that this folder builds.
class Native : public Plugins {
  public:
    /// @param fault  of the module `faulty`
    explicit Native(const std::string& name, const std::string& members = "",
                    const std::string& fault = "")
        : fault_("RELEVO_TEST_FAULT", fault) {
        add("native", R"("module": "native")" + (members.empty() ? "" : ", " + members));
        if (!name.empty())
            std::filesystem::copy(relevo::test::build_dir() / "tests/modules" / (name + ".so"),
                                  plugins() / "native/native.so");
    }

    std::string error() const {
        const Registry registry = load();
        return relative(relevo::test::error_of(
            [&] { NativeModule::load(registry.effect("native", "test").manifest, {}); }));
    }

  private:
    Variable fault_;
};

TEST(NativeModule, AGoodOneIsLoaded) {
    const Native plugins("good");
    const Registry registry = plugins.load();
    const NativeModule module = NativeModule::load(registry.effect("native", "test").manifest, {});
    EXPECT_EQ(module.id(), "native");
    EXPECT_EQ(module.library(), plugins.plugins() / "native/native.so");
    void* instance = &instance;
    EXPECT_EQ(module.functions().create(nullptr, &instance), RELEVO_OK);
    EXPECT_EQ(instance, nullptr);
}

TEST(NativeModule, OneThatIsBuiltAgainIsLoadedAnew) {
    const Native plugins("good");
    const Registry registry = plugins.load();
    const Manifest& manifest = registry.effect("native", "test").manifest;
    const NativeModule before = NativeModule::load(manifest, {});
    // As a linker does.
    std::filesystem::remove(before.library());
    std::filesystem::copy(relevo::test::build_dir() / "tests/modules/good.so", before.library());
    const NativeModule after = NativeModule::load(manifest, {});
    EXPECT_NE(after.functions().create, before.functions().create);
    EXPECT_EQ(after.library(), before.library());
    void* instance = &instance;
    EXPECT_EQ(after.functions().create(nullptr, &instance), RELEVO_OK);
    EXPECT_EQ(instance, nullptr);
}

TEST(NativeModule, TheGuidesExampleIsOne) {
    const Plugins plugins;
    plugins.add("tide", R"("module": "tide")");
    std::filesystem::copy(relevo::test::build_dir() / "tests/modules/tide.so",
                          plugins.plugins() / "tide/tide.so");
    const Registry registry = plugins.load();
    EXPECT_EQ(NativeModule::load(registry.effect("tide", "test").manifest, {}).id(), "tide");
}

TEST(NativeModule, EveryFaultIsAMessageThatNamesTheFile) {
    const std::pair<const char*, const char*> cases[] = {
        {"newer",
         "expected version 2 of the plugin interface but got 3.3; build it with this program's "
         "relevo/plugin.h"},
        {"older",
         "expected version 2 of the plugin interface but got 1.0; build it with this program's "
         "relevo/plugin.h"},
        {"nameless", "it has no symbol relevo_plugin_abi; see RELEVO_PLUGIN"},
        {"unregistered", "it has no symbol relevo_plugin_register; see RELEVO_PLUGIN"},
        {"asks", "its registration failed: it needs relevo.weather/1"},
        {"stranger", "expected the module of native but got that of somebody"},
        {"helpless", "its table lacks create or destroy"},
    };
    for (const auto& [name, message] : cases) {
        const Native plugins(name);
        EXPECT_EQ(plugins.error(),
                  fmt::format("exit 3: plugin: plugins/native/native.so: {}", message))
            << name;
    }
}

TEST(NativeModule, OneThatIsNotThereIsSaidToBeMissing) {
    const Native plugins("");
    EXPECT_EQ(plugins.error(),
              fmt::format("exit 3: plugin: plugins/native/plugin.json: module native is in "
                          "neither plugins/native/native.so nor {}; build it",
                          (module_dir() / "plugins/native.so").string()));
}

TEST(NativeModule, WhatIsNoLibraryIsNotLoaded) {
    const Native plugins("");
    plugins.write("plugins/native/native.so", "not a library\n");
    EXPECT_EQ(plugins.error(),
              "exit 3: plugin: plugins/native/native.so: it cannot be loaded: "
              "plugins/native/native.so: file too short");
}

TEST(NativeModule, ListingPluginsLoadsNone) {
    const Native plugins("faulty", "", "register crash");
    const Registry registry = plugins.load();
    EXPECT_TRUE(registry.broken().empty());
    EXPECT_EQ(registry.effects().size(), 1u);
}

TEST(NativeModule, ABadOneIsOffAndSoIsWhatRequiresIt) {
    const Native plugins("faulty", R"("provides": ["magic"])", "register crash");
    plugins.add("glow", R"("requires": ["magic"])");
    plugins.add("plain");
    const Registry registry = plugins.load();
    const LoadedSelection chosen = select_and_load(registry, {}, {}, {});
    EXPECT_THAT(ids(chosen.selection), ElementsAre("plain"));
    EXPECT_TRUE(chosen.modules.empty());
    EXPECT_TRUE(chosen.selection.notices.empty());
    ASSERT_EQ(chosen.selection.warnings.size(), 2u);
    EXPECT_EQ(plugins.relative(chosen.selection.warnings[0]),
              "native is off: plugin: plugins/native/native.so: its registration ended in a "
              "segmentation fault; --disable native silences this");
    EXPECT_EQ(chosen.selection.warnings[1],
              "glow is off: it requires magic, native is off; --disable glow silences this");
}

TEST(NativeModule, ABadOneThatIsAskedForByNameIsAnError) {
    const Native plugins("faulty", R"("provides": ["magic"])", "register throw");
    plugins.add("glow", R"("requires": ["magic"])");
    plugins.add("plain");
    const Registry registry = plugins.load();
    const auto error = [&](const Switches& switches) {
        return plugins.relative(
            relevo::test::error_of([&] { select_and_load(registry, {}, switches, {}); }));
    };
    const std::string reason =
        "exit 3: effects: native: it cannot be switched on: plugin: "
        "plugins/native/native.so: its registration threw an exception: no good today; take it out "
        "of ";
    using Words = std::vector<std::string>;
    EXPECT_EQ(error({.only = Words{"native", "plain"}}), reason + "--only");
    EXPECT_EQ(error({.enable = {"native"}}), reason + "--enable");
    EXPECT_EQ(error({.only = Words{"glow"}}),
              "exit 3: effects: glow: it cannot be switched on: it requires magic, native "
              "is off; take it out of --only");
    EXPECT_EQ(error({.only = Words{"plain"}}), "no error");
    const Preset preset{"winter", "winter.json", "", {.only = Words{"native", "plain"}}, {}};
    EXPECT_EQ(select_and_load(registry, {preset}, {}, {}).selection.warnings.size(), 1u);
}

TEST(NativeModule, OneThatIsOffIsNotTried) {
    const Native plugins("faulty", "", "register crash");
    plugins.add("plain");
    const Registry registry = plugins.load();
    Switches switches;
    switches.disable = {"native"};
    const LoadedSelection chosen = select_and_load(registry, {}, switches, {});
    EXPECT_TRUE(chosen.selection.notices.empty());
    EXPECT_TRUE(chosen.selection.warnings.empty());
}

}  // namespace
}  // namespace relevo::effect::test::test_native_module
