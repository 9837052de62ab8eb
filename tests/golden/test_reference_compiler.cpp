#include <filesystem>
#include <string>
#include <vector>

#include "cli/program.h"
#include "support/support.h"

namespace relevo::test {
namespace {

/// Mesa forgives what other drivers refuse; Khronos' own compiler forgives nothing. It links each
/// program, too.
class ReferenceCompiler : public testing::TestWithParam<std::vector<std::string>> {};

TEST_P(ReferenceCompiler, TakesEveryProgram) {
    const std::filesystem::path dir = scratch_dir("reference_compiler");
    const std::filesystem::path dump = dir / "shaders";
    std::filesystem::remove_all(dump);
    std::vector<std::string> arguments{
        "-q",    "capture",     bundled_dem(),    "-o",         (dir / "a.png").string(), "--size",
        "64x48", "--overwrite", "--dump-shaders", dump.string()};
    arguments.insert(arguments.end(), GetParam().begin(), GetParam().end());
    const Result taken = relevo(arguments);
    ASSERT_EQ(taken.status, 0) << taken.err;
    int programs = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(dump)) {
        const std::string fragment = entry.path().string();
        const std::size_t stage = fragment.find(".frag.glsl");
        if (stage == std::string::npos) continue;
        const Result compiled =
            run(RELEVO_GLSLANG, {"-l", fragment.substr(0, stage) + ".vert.glsl", fragment});
        EXPECT_EQ(compiled.status, 0) << compiled.out;
        ++programs;
    }
    EXPECT_GE(programs, 5);  // geometry, terrain, background, edges, antialias
}

INSTANTIATE_TEST_SUITE_P(
    Effects, ReferenceCompiler,
    testing::Values(std::vector<std::string>{"--only", ""},
                    std::vector<std::string>{"--enable", "wet"},
                    std::vector<std::string>{"--preset", "paper"},
                    std::vector<std::string>{"--enable", "vsm", "--set", "vsm.penumbra=true"},
                    std::vector<std::string>{"--time", "2026-06-21T23:50-04:00"}));

}  // namespace
}  // namespace relevo::test
