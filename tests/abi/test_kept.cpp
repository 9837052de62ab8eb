// Modules that were built against earlier headers load and work, in a stand-in host and in the
// program.
#include <filesystem>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cli/program.h"
#include "image/image.h"
#include "support/support.h"

namespace relevo::test {
namespace {

/// Folders of kept modules that this processor can load.
std::vector<std::filesystem::path> kept() {
#if defined(__x86_64__) && defined(__linux__)
    constexpr std::string_view kProcessor = "-x86_64";
#else
    constexpr std::string_view kProcessor = "-none";
#endif
    std::vector<std::filesystem::path> folders;
    for (const auto& entry : std::filesystem::directory_iterator(source_dir() / "tests/abi/kept"))
        if (entry.path().filename().string().ends_with(kProcessor)) folders.push_back(entry.path());
    return folders;
}

class Kept : public testing::Test {
  protected:
    void SetUp() override {
        if (kept().empty()) GTEST_SKIP() << "no modules are kept for this processor";
    }
};

TEST_F(Kept, ModulesDoInTodaysHost) {
    for (const std::filesystem::path& folder : kept())
        for (const char* const module : {"c_module.so", "cpp_module.so"}) {
            const Result done =
                run(build_dir() / "tests/abi/host",
                    {(folder / module).string(), (source_dir() / "tests/abi/plugin").string()});
            const std::string version = folder.filename().string().substr(0, 3);
            EXPECT_EQ(done.out, fmt::format("ok, interface {} of the module\n", version)) << folder;
        }
}

/// Grey of the ground, which the module tide writes from its parameter and the sun.
int grey(const std::filesystem::path& folder, const std::string& time) {
    const std::filesystem::path taken = scratch_dir("kept") / "taken.png";
    const Result run = relevo({"-q",
                               "capture",
                               bundled_dem(),
                               "-o",
                               taken.string(),
                               "--overwrite",
                               "--device",
                               "software",
                               "--size",
                               "96x64",
                               "--view",
                               "el=90,zoom=3",
                               "--plugin-path",
                               folder.string(),
                               "--only",
                               "tide",
                               "--set",
                               "tide.range_m=0.8",
                               "--time",
                               time});
    EXPECT_EQ(run.status, 0) << run.err;
    return image::read(taken).at(48, 32, 0);
}

TEST_F(Kept, AModuleWorksInTodaysProgram) {
    for (const std::filesystem::path& folder : kept()) {
        // 0.8 |sin h|, with the sun's geometric elevation h at 36.4 N, 84.1 W.
        EXPECT_NEAR(grey(folder, "2026-06-21T13:38-04:00"), 255 * 0.8 * 0.9746, 2);
        EXPECT_NEAR(grey(folder, "2026-06-21T18:30-04:00"), 255 * 0.8 * 0.4534, 2);
    }
}

}  // namespace
}  // namespace relevo::test
