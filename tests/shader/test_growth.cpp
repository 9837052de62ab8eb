#include <fmt/format.h>

#include "shader/limits.h"
#include "support/support.h"

namespace relevo::shader::test_growth {
namespace {

using relevo::test::error_of;

std::string error(const std::vector<std::string>& texts) {
    std::vector<Snippet> files;
    for (const std::string& text : texts)
        files.push_back(parse_snippet("odd", fmt::format("{}.glsl", files.size()), text));
    return error_of([&] { check_growth(files); });
}

std::string in_a_hook(const std::string& body) {
    return "void odd_on_albedo(inout Surface s) { " + body + " }\n";
}

/// Macros of which each has the one before so many times.
std::string doubled(int times, const std::string& first = "s.diffuse.x += 0.1;") {
    std::string text = "#define odd_m0 " + first + "\n";
    for (int i = 1; i <= times; ++i)
        text += fmt::format("#define odd_m{0} odd_m{1} odd_m{1}\n", i, i - 1);
    return text;
}

std::string chain(int calls, int times = 2) {
    std::string text = "float odd_c0(in float x) { return sin(x); }\n";
    for (int i = 1; i <= calls; ++i) {
        text += fmt::format("float odd_c{}(in float x) {{ return 0.0", i);
        for (int k = 0; k < times; ++k)
            text += fmt::format(" + odd_c{}(x)", i - 1);
        text += "; }\n";
    }
    return text;
}

TEST(Growth, WhatADriverHoldsIsLeft) {
    EXPECT_EQ(error({in_a_hook("float a[64]; a[3] = 1.0; s.diffuse.x = a[int(s.height_m) % 64];")}),
              "no error");
    EXPECT_EQ(error({doubled(12) + in_a_hook("odd_m12")}), "no error");
    EXPECT_EQ(error({chain(12) + in_a_hook("s.diffuse.x = odd_c12(s.height_m);")}), "no error");
    EXPECT_EQ(error({chain(199, 1) + in_a_hook("s.diffuse.x = odd_c198(s.height_m);")}),
              "no error");
    // A macro that is longer than any use of it.
    EXPECT_EQ(error({doubled(24) + in_a_hook("")}), "no error");
}

TEST(Growth, MacrosThatDoubleAreRefused) {
    const std::string message =
        "exit 3: shader: 0.glsl:26: odd_on_albedo: 1.7e+08 words when expanded, expected at most "
        "1e+06: drivers expand macros and inline calls; use a loop";
    EXPECT_EQ(error({doubled(24) + in_a_hook("odd_m24")}), message);
    // As functions, with arguments in each other, from another file, and of constants.
    const std::string twice = "#define odd_d(x) ((x) + (x))\n";
    std::string nested = "s.height_m";
    for (int i = 0; i < 24; ++i)
        nested = "odd_d(" + nested + ")";
    EXPECT_NE(error({twice + in_a_hook("s.diffuse.x = " + nested + ";")}), "no error");
    EXPECT_NE(error({doubled(24), in_a_hook("odd_m24")}), "no error");
    EXPECT_NE(error({doubled(24, "+ 1.0") + "const float odd_sum = odd_m24;\n" + in_a_hook("")}),
              "no error");
}

TEST(Growth, CallsThatDoubleAreRefused) {
    EXPECT_NE(error({chain(25) + in_a_hook("s.diffuse.x = odd_c25(s.height_m);")}), "no error");
    EXPECT_NE(error({chain(25), in_a_hook("s.diffuse.x = odd_c25(s.height_m);")}), "no error");
    std::string deep = "#define odd_m0 1.0\n";
    for (int i = 1; i <= 300; ++i)
        deep += fmt::format("#define odd_m{} odd_m{}\n", i, i - 1);
    EXPECT_EQ(error({deep + in_a_hook("s.diffuse.x = odd_m300;")}),
              "exit 3: shader: 0.glsl:302: macros and calls nest more than 200 deep");
    // A circle is the driver's to refuse.
    EXPECT_EQ(error({"float odd_b(in float x);\nfloat odd_a(in float x) { return odd_b(x); }\n"
                     "float odd_b(in float x) { return odd_a(x); }\n" +
                     in_a_hook("s.diffuse.x = odd_a(1.0);")}),
              "no error");
    EXPECT_EQ(error({"#define odd_x odd_y\n#define odd_y odd_x\n" + in_a_hook("odd_x;")}),
              "no error");
}

TEST(Growth, ArraysThatNoDriverHoldsAreRefused) {
    EXPECT_EQ(error({"\n" + in_a_hook("float a[2000000000]; s.diffuse.x = a[3];")}),
              "exit 3: shader: 0.glsl:2: [2000000000]: expected an array of at most 65536 "
              "elements but got 2000000000");
    for (const char* text :
         {"float a[65537];", "float a[4000000000u];", "float[1 << 20] a;", "float a[1000][1000];",
          "const int n = 2, m = 1000 * 1000; float a[n + m];", "float a[odd_n];", "odd_a;",
          "vec3 a[odd_many];"})
        EXPECT_NE(error({"#define odd_n 2000000000\n#define odd_a float a[2000000]\n"
                         "const uint odd_many = 0x7fffffffu;\n" +
                         in_a_hook(text)}),
                  "no error")
            << text;
}

}  // namespace
}  // namespace relevo::shader::test_growth
