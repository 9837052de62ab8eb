#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shader/limits.h"

namespace relevo::shader::test_loops {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<int> loops(const std::string& body) {
    return open_loops(parse_snippet("haze", "haze.glsl",
                                    "const int haze_N = 8;\n"
                                    "#define haze_M 4\n"
                                    "uniform int haze_s = 2; //@ range(1, 64) static\n"
                                    "uniform int haze_u = 2; //@ range(1, 64)\n"
                                    "void haze_f(inout float x, int k) {\n" +
                                        body + "\n}\n")
                          .source);
}

TEST(Loops, WithAConstantBoundEnd) {
    for (const char* head :
         {"int i = 0; i < 8; ++i", "int i = 0; i < haze_N; i++", "int i = 0; i <= haze_M; i += 2",
          "int i = 9; i > 0; --i", "int i = 0; i < haze_s; ++i", "uint i = 0u; i < 8u; ++i",
          "float f = 0.0; f < 1.0; f += 0.25", "int i = 64; i > 0; i /= 2",
          "int i = k; i < 8; i += haze_N", "int i = -4; i <= 4; i++"}) {
        EXPECT_THAT(loops(std::string("for (") + head + ") { x += float(i); }"), IsEmpty()) << head;
        EXPECT_THAT(loops(std::string("for (") + head + ") x += float(i);"), IsEmpty()) << head;
    }
    EXPECT_THAT(loops("for (int i = 0; i < 8; ++i) {\nfor (int j = 0; j < 8; ++j) x += 1.0;\n}"),
                IsEmpty());
}

TEST(Loops, OthersAreOpen) {
    for (const char* loop : {"while (x > 0.0) x -= 0.1;",
                             "do { x -= 0.1; } while (x > 0.0);",
                             "for (;;) x += 1.0;",
                             "for (int i = 0; i < k; ++i) x += 1.0;",
                             "for (int i = 0; i < haze_u; ++i) x += 1.0;",
                             "for (int i = 0; i < 20000; ++i) x += 1.0;",
                             "for (int i = 0; i < 8; x += 1.0) {}",
                             "for (int i = 0; i < 8; ++i) { i = 0; }",
                             "for (int i = 0; i < 8; ++i) --i;",
                             "for (int i = 0; i != 8; ++i) {}",
                             "for (int i = 0; i < 8 || x > 0.0; ++i) {}",
                             "for (float f = 0.0; f < 10.0; f += 0.0) {}",
                             "for (int i = 0; i < 8; --i) {}",
                             "for (int i = 0; i >= 0; i = (i + 1) % 1000) {}",
                             "for (int i = 8; i > 0; ++i) {}",
                             "for (float f = 0.0; f < 10.0; f += 1e-6) {}",
                             "for (int i = 1; i < 8; i *= 1) {}",
                             "for (int i = -20000; i < 8; ++i) {}",
                             "for (int i = 0; i < 8; i -= 1) {}",
                             "for (int i = 0; i < 8; ++i) if (x > 0.0) x = 1.0; else i = 0;",
                             "for (int i = 0; i < 8; ++i) for (int j = 0; j < 8; ++j) i = 0;",
                             "for (int i = 0; i < 8; ++i) { i <<= 1; }"})
        EXPECT_THAT(loops(loop), ElementsAre(6)) << loop;
}

TEST(Loops, DeepNestingTakesNoStackAndLittleTime) {
    std::string nested;
    for (int i = 0; i < 50000; ++i)
        nested += "for (;;) ";
    EXPECT_EQ(loops(nested + "x += 1.0;").size(), 50000u);
}

}  // namespace
}  // namespace relevo::shader::test_loops
