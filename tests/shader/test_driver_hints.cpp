#include <gtest/gtest.h>

#include "shader/driver_hints.h"

namespace relevo::shader::test_driver_hints {
namespace {

const LineMap kLines = {
    {"", "", 0}, {"dust", "dust.glsl", 4}, {"dust", "dust.glsl", 5}, {"dust", "dust.glsl", 6}};
const CompiledText kText = {
    "struct Surface { float height_m; };\nx = s.heigth_m;\nfloat a[dust_n];\n}",
    {"dust_amount", "dust_n"},
    {"dust_n"}};

std::string brief(const std::string& log) {
    return brief_text(parse_driver_log(log, kLines), kText);
}

TEST(DriverHints, OfEachLineTheFirstErrorIsShownAndEachMessageOnce) {
    EXPECT_EQ(brief("0:2(1): error: `dust_amuont' undeclared\n"
                    "0:2(5): error: type mismatch\n"
                    "0:3(1): error: `dust_amuont' undeclared\n"
                    "0:3(9): warning: `y' used uninitialized\n"
                    "0:4(1): error: value of type float cannot be assigned\n"),
              "dust.glsl:4: error: `dust_amuont' undeclared; did you mean dust_amount?\n"
              "dust.glsl:6: error: value of type float cannot be assigned");
}

TEST(DriverHints, ALogWithoutAPlaceIsShownWhole) {
    EXPECT_EQ(brief("error: fragment shader input `x' has no matching output\nmore\n"),
              "error: fragment shader input `x' has no matching output\nmore");
}

TEST(DriverHints, KnowTheWordsOfSeveralDrivers) {
    const auto hint = [](const std::string& message, int line = 2) {
        return hint_for({"error", {"dust", "dust.glsl", 4}, line, message}, kText);
    };
    // Mesa, NVIDIA, glslang.
    EXPECT_EQ(hint("cannot access field `heigth_m' of structure"), "did you mean height_m?");
    EXPECT_EQ(hint("undefined variable \"dust_amuont\""), "did you mean dust_amount?");
    EXPECT_EQ(hint("'heigth_m' : no such field in structure"), "did you mean height_m?");
    EXPECT_EQ(hint("no function with name 'clmap'"), "did you mean clamp?");
    EXPECT_EQ(hint("`qqqqqqqqqqqq' undeclared"), "");
    EXPECT_EQ(hint("array size must be a constant valued expression", 3),
              "add static after its //@ to make dust_n a constant");
    EXPECT_EQ(hint("type mismatch"), "");
}

}  // namespace
}  // namespace relevo::shader::test_driver_hints
