// The trial finds a fault in any function of a native module.
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/paths.h"
#include "effect/module_trial.h"
#include "effect/native_module.h"
#include "effect/plugins.h"

namespace relevo::effect::test::test_module_trial {
namespace {

std::filesystem::path faulty() {
    return relevo::test::build_dir() / "tests/modules/faulty.so";
}

/// What a trial says of the module when it behaves like that.
std::string verdict(const std::string& fault) {
    const Variable told("RELEVO_TEST_FAULT", fault);
    return try_module(faulty(), "native", faulty().parent_path(), {});
}

TEST(ModuleTrial, AGoodModulePasses) {
    EXPECT_EQ(verdict(""), "");
}

TEST(ModuleTrial, CallsEveryFunction) {
    const std::pair<const char*, const char*> places[] = {{"load", "loading it"},
                                                          {"register", "its registration"},
                                                          {"create", "its create()"},
                                                          {"prepare", "its prepare()"},
                                                          {"destroy", "its destroy()"}};
    const std::pair<const char*, const char*> faults[] = {
        {"crash", "ended in a segmentation fault"},
        {"overflow", "ended in a segmentation fault"},
        {"abort", "ended in an abort"},
        {"exit", "ended the process"},
        {"under", "ended the process"},
        {"kill", "ended in signal 9"}};
    for (const auto& [place, name] : places)
        for (const auto& [fault, ending] : faults)
            EXPECT_EQ(verdict(fmt::format("{} {}", place, fault)),
                      fmt::format("{} {}", name, ending));
}

TEST(ModuleTrial, ExceptionsAreNamed) {
    EXPECT_EQ(verdict("register throw"), "its registration threw an exception: no good today");
    EXPECT_EQ(verdict("create throw"), "its create() threw an exception: no good today");
    EXPECT_EQ(verdict("prepare throwint"), "its prepare() threw an exception");
    EXPECT_EQ(verdict("destroy throw"), "its destroy() threw an exception: no good today");
}

TEST(ModuleTrial, HasADeadline) {
    const Variable patience("RELEVO_PATIENCE_S", "1");
    for (const char* what : {"hang", "print", "log"}) {
        const auto began = std::chrono::steady_clock::now();
        EXPECT_EQ(verdict(std::string("prepare ") + what), "its prepare() took more than 0.5 s");
        EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(5)) << what;
    }
}

TEST(ModuleTrial, WhatAModuleStartsEndsWithIt) {
    const auto began = std::chrono::steady_clock::now();
    EXPECT_EQ(verdict("prepare fork"), "");
    EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(5));
}

TEST(ModuleTrial, WithoutAReportItIsNotPassed) {
    EXPECT_EQ(verdict("create close"), "its create() ended the process");
}

TEST(ModuleTrial, FailingInGoodOrderIsLeftToTheDevice) {
    EXPECT_EQ(verdict("create fail"), "");
    EXPECT_EQ(verdict("prepare fail"), "");
    EXPECT_EQ(verdict("register fail"), "its registration failed: the moon is not full");
}

TEST(ModuleTrial, TheShippedModulePassesWithItsParameters) {
    const Registry registry =
        Registry::load({relevo::test::source_dir() / "plugins"}, share_dir() / "data");
    const Effect* vsm = registry.find("vsm");
    if (!vsm) GTEST_SKIP() << "the plugin vsm is not there";
    shader::ParamStore values;
    values.declare(registry.params());
    EXPECT_EQ(try_module(module_file(vsm->manifest), "vsm", vsm->manifest.folder, values), "");
}

TEST(ModuleTrial, PatienceIsANumberOfSeconds) {
    const Variable patience("RELEVO_PATIENCE_S", "soon");
    EXPECT_EQ(relevo::test::error_of([] { verdict(""); }),
              "exit 2: RELEVO_PATIENCE_S: expected a number of seconds in [0.1, 100000] but got "
              "\"soon\"");
}

// ---- in the program itself

/// Loads the module, which spared the trial, and calls prepare() as a renderer would.
void call_it(const std::string& fault) {
    const Variable told("RELEVO_TEST_FAULT", fault);
    const Plugins plugins;
    plugins.add("native", R"("module": "native")");
    std::filesystem::copy(faulty(), plugins.plugins() / "native/native.so");
    const Registry registry = plugins.load();
    const NativeModule module = NativeModule::load(registry.effect("native", "test").manifest, {});
    void* instance = nullptr;
    {
        const ModuleCall call(module.process(), "create()");
        module.functions().create(nullptr, &instance);
    }
    {
        const ModuleCall call(module.process(), "prepare()");
        module.functions().prepare(instance);
    }
}

/// The pattern of what standard error has then.
std::string blamed(const std::string& what) {
    return "relevo: error: effect: .*/native\\.so: " + what +
           "; --disable native goes on without it\n";
}

TEST(ModuleCallDeathTest, WhatEndsTheProgramIsNamed) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const std::pair<const char*, const char*> cases[] = {
        {"prepare crash later", "its prepare\\(\\) ended in a segmentation fault"},
        {"prepare overflow later", "its prepare\\(\\) ended in a segmentation fault"},
        {"create abort later", "its create\\(\\) ended in an abort"},
        {"prepare exit later", "its prepare\\(\\) ended the program"},
        {"prepare quick later", "its prepare\\(\\) ended the program"},
        {"prepare under later", "its prepare\\(\\) ended the program"},
        {"prepare Under later", "its prepare\\(\\) ended the program"},
        {"prepare thread later", "its prepare\\(\\) ended the program"},
        {"register crash later", "its registration ended in a segmentation fault"},
        {"load exit later", "its registration ended the program"},
        {"unload crash later", "its unloading ended in a segmentation fault"},
    };
    for (const auto& [fault, what] : cases)
        EXPECT_EXIT(call_it(fault), testing::ExitedWithCode(1), blamed(what)) << fault;
}

TEST(ModuleCallDeathTest, AHangEndsTheProgram) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const Variable patience("RELEVO_PATIENCE_S", "1");
    EXPECT_EXIT(call_it("prepare hang later"), testing::ExitedWithCode(1),
                blamed("its prepare\\(\\) took more than 1 s"));
}

TEST(ModuleCall, LeavesSignalsAsTheyWere) {
    struct sigaction before {
    }, after{};
    sigaction(SIGSEGV, nullptr, &before);
    call_it("");
    sigaction(SIGSEGV, nullptr, &after);
    EXPECT_EQ(before.sa_handler, after.sa_handler);
}

TEST(ModuleCall, TheHostsTimeIsNotTheModules) {
    const Variable patience("RELEVO_PATIENCE_S", "0.2");
    ModuleInProcess module("native", "native.so");
    const ModuleCall call(module, "prepare()");
    const ModuleCall::Pause pause;
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
}

}  // namespace
}  // namespace relevo::effect::test::test_module_trial
