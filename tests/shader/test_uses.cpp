#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shader/conditions.h"
#include "shader/uses.h"

namespace relevo::shader::test_uses {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsSupersetOf;
using ::testing::Not;

Uses uses(std::string_view text) {
    const Source source = parse_source(SourceKind::Lib, "core", "a.glsl", text);
    return uses_of(source, source.items.back(), std::vector<bool>(source.tokens.size(), true));
}

TEST(Uses, FieldsArgumentsAndLocalsAreNotNamesOfOthers) {
    EXPECT_THAT(
        uses("vec3 f(in Surface s, float k) { vec3 n = s.normal; return n * k * scale; }").names,
        ElementsAre("Surface", "float", "in", "return", "scale", "vec3"));
}

TEST(Uses, AFunctionDoesNotUseItself) {
    EXPECT_THAT(uses("float f(float x) { return g(x) + h; }").calls, ElementsAre("g"));
}

TEST(Uses, AnInitialiserSeesTheOuterName) {
    EXPECT_THAT(uses("void f() { vec3 normal = normalize(normal); }").names, Contains("normal"));
    EXPECT_THAT(uses("void f() { float x = g(1.0, x); }").names, Contains("x"));
    EXPECT_THAT(uses("void f() { vec3 normal = vec3(0); use(normal); }").names,
                Not(Contains("normal")));
}

TEST(Uses, ALocalEndsWithItsBlock) {
    EXPECT_THAT(uses("void f() { { float x = 1.0; } y = x; }").names, IsSupersetOf({"x", "y"}));
    EXPECT_THAT(uses("void f() { float x = 1.0; { y = x; } }").names, Not(Contains("x")));
}

TEST(Uses, ALoopsCounterIsALocal) {
    EXPECT_THAT(uses("void f() { for (int i = 0; i < n; ++i) g(i); }").names, Not(Contains("i")));
}

TEST(Uses, ALoopsCounterEndsWithTheLoop) {
    for (const char* loop :
         {"for (int i = 0; i < n; ++i) g(i);", "for (int i = 0; i < n; ++i) { g(i); }",
          "for (int i = 0; i < n; ++i) for (int k = 0; k < i; ++k) g(k);",
          "for (int i = 0; i < n; ++i) { if (n > 2) { g(i); } g(i); }",
          "for (int i = 0; i < n; ++i) if (n > 2) g(i); else { g(i); g(i); }",
          "for (int i = 0; i < n; ++i) do g(i); while (n > 2);"}) {
        EXPECT_THAT(uses(std::string("void f() { ") + loop + " }").names, Not(Contains("i")))
            << loop;
        EXPECT_THAT(uses(std::string("void f() { ") + loop + " y = i; }").names, Contains("i"))
            << loop;
    }
}

TEST(Uses, TheTextOfAMacroCalls) {
    EXPECT_THAT(uses("#define LIT(s) (sky(s) * K + s)\n").calls, ElementsAre("sky"));
    EXPECT_THAT(uses("void f() {\n#if defined(SKY) && (K > 2)\n#endif\n}").calls,
                testing::IsEmpty());
}

TEST(Uses, ArraysOfEitherSpellingAreLocals) {
    EXPECT_THAT(uses("void f() { float[2] a; float b[n]; a[0] = b[1]; }").names,
                ElementsAre("float", "n", "void"));
}

TEST(Uses, AStructsNameIsUsed) {
    EXPECT_THAT(uses("Layer f(const in Layer a) { Other b; return a; }").names,
                IsSupersetOf({"Layer", "Other"}));
}

TEST(Uses, ACallIsOneWhateverTheSpace) {
    EXPECT_THAT(uses("void f() { g /* x */ (1); h; }").calls, ElementsAre("g"));
}

TEST(Uses, DirectivesNameMacros) {
    EXPECT_THAT(uses("void f() {\n#if HAS_sky && K > 2\n#endif\n}").names,
                IsSupersetOf({"HAS_sky", "K"}));
}

TEST(Uses, WhatIsSwitchedOffIsNotUsed) {
    const Source source =
        parse_source(SourceKind::Lib, "core", "a.glsl", "void f() {\n#if 0\na();\n#endif\nb();\n}");
    Macros macros;
    const Conditions conditions = evaluate_conditions(source, macros);
    EXPECT_THAT(uses_of(source, source.items[0], conditions.active).calls, ElementsAre("b"));
}

}  // namespace
}  // namespace relevo::shader::test_uses
