#include <gtest/gtest.h>

#include "shader/driver_log.h"

namespace relevo::shader::test_driver_log {
namespace {

const LineMap kLines = {{"", "", 0},
                        {"core", "shaders/terrain.frag.glsl", 7},
                        {"haze", "plugins/haze/haze.glsl", 12},
                        {"haze", "plugins/haze/haze.glsl", 13}};

struct Case {
    const char* name;
    const char* log;
    const char* text;
    const char* blamed;
};

class DriverLogs : public testing::TestWithParam<Case> {};

TEST_P(DriverLogs, NameTheAuthorsLine) {
    const DriverLog log = parse_driver_log(GetParam().log, kLines);
    EXPECT_EQ(log.text(), GetParam().text);
    EXPECT_EQ(log.blamed(), GetParam().blamed);
    EXPECT_EQ(log.raw, GetParam().log);
}

INSTANTIATE_TEST_SUITE_P(
    All, DriverLogs,
    testing::Values(
        // Printed by Mesa 22.3.6.
        Case{"Mesa", "0:3(15): error: `haze_amuont' undeclared\n",
             "plugins/haze/haze.glsl:12: error: `haze_amuont' undeclared", "haze"},
        Case{"MesaWarning",
             "0:4(2): warning: `x' used uninitialized\n0:2(9): error: syntax error, unexpected "
             "';'\n",
             "plugins/haze/haze.glsl:13: warning: `x' used uninitialized\n"
             "shaders/terrain.frag.glsl:7: error: syntax error, unexpected ';'",
             "core"},
        Case{"MesaPreprocessor", "0:3(1): preprocessor error: Unterminated #if\n",
             "plugins/haze/haze.glsl:12: error: Unterminated #if", "haze"},
        // The form of NVIDIA's compiler.
        Case{"Nvidia",
             "0(3) : error C1503: undefined variable \"haze_amuont\"\n"
             "0(4) : warning C7022: unrecognized profile specifier\n",
             "plugins/haze/haze.glsl:12: error: undefined variable \"haze_amuont\"\n"
             "plugins/haze/haze.glsl:13: warning: unrecognized profile specifier",
             "haze"},
        // The form of glslang, and of Intel's and AMD's Windows compilers.
        Case{"Glslang",
             "ERROR: 0:3: 'haze_amuont' : undeclared identifier\n"
             "WARNING: 0:4: 'x' : unused\nERROR: 1 compilation errors.  No code generated.\n",
             "plugins/haze/haze.glsl:12: error: 'haze_amuont' : undeclared identifier\n"
             "plugins/haze/haze.glsl:13: warning: 'x' : unused\n"
             "ERROR: 1 compilation errors.  No code generated.",
             "haze"},
        Case{"Generated", "0:1(1): error: syntax error\n", "stitched text:1: error: syntax error",
             ""},
        Case{"Link", "error: fragment shader input `x' has no matching output\n",
             "error: fragment shader input `x' has no matching output", ""},
        Case{"LineBeyondTheText", "0:5(1): error: what\n", "0:5(1): error: what", ""},
        Case{"HugeLine", "0:99999999999(1): error: what\n", "0:99999999999(1): error: what", ""},
        Case{"Empty", "", "", ""}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace relevo::shader::test_driver_log
