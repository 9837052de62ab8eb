#include <gtest/gtest.h>

#include "base/contains.h"
#include "shader/conditions.h"

namespace relevo::shader::test_conditions {
namespace {

const Macros kMacros = {{"ONE", "1"},     {"TWO", "ONE + ONE"},
                        {"EMPTY", ""},    {"CALL", std::nullopt},
                        {"LOOP", "LOOP"}, {"GROW", "GROW GROW GROW GROW"}};

struct Case {
    const char* name;
    const char* expression;
    std::optional<long long> value;
};

class Expression : public testing::TestWithParam<Case> {};

TEST_P(Expression, HasTheValueOfGlsl) {
    EXPECT_EQ(evaluate_expression(GetParam().expression, kMacros), GetParam().value);
}

INSTANTIATE_TEST_SUITE_P(
    All, Expression,
    testing::Values(Case{"Number", "42", 42}, Case{"Hexadecimal", "0x1F", 31},
                    Case{"Precedence", "1 + 2 * 3 == 7", 1}, Case{"LeftToRight", "10 - 4 - 3", 3},
                    Case{"Parentheses", "(1 + 2) * 3", 9}, Case{"Shift", "1 << 4 | 1", 17},
                    Case{"Minus", "-3 + 1", -2}, Case{"Not", "!0 && !ONE == 0", 1},
                    Case{"MacroIsText", "TWO * 3", 4}, Case{"Defined", "defined ONE", 1},
                    Case{"DefinedBracket", "defined(ONE) && defined(EMPTY)", 1},
                    Case{"NotDefined", "defined(NOBODY)", 0},
                    Case{"Version", "__VERSION__ >= 450", 1},
                    Case{"Unknown", "NOBODY", std::nullopt},
                    Case{"UnknownBehindFalse", "defined(NOBODY) && NOBODY > 2", 0},
                    Case{"UnknownBesideTrue", "NOBODY || ONE", 1},
                    Case{"Extension", "defined(GL_ARB_gpu_shader5)", std::nullopt},
                    Case{"FunctionMacro", "CALL(1)", std::nullopt},
                    Case{"DefinedFunctionMacro", "defined(CALL)", std::nullopt},
                    Case{"DivisionByZero", "1 / 0", std::nullopt},
                    Case{"Overflow", "0x7FFFFFFF + 1", std::nullopt},
                    Case{"Circle", "LOOP", std::nullopt}, Case{"Growth", "GROW", std::nullopt},
                    Case{"Unfinished", "1 +", std::nullopt}, Case{"Empty", "", std::nullopt},
                    Case{"TooMuch", "1 1", std::nullopt}, Case{"Bracket", "(1", std::nullopt}),
    [](const auto& test) { return test.param.name; });

TEST(Expression, DeepNestingDoesNotExhaustTheStack) {
    EXPECT_EQ(evaluate_expression(std::string(1000000, '('), {}), std::nullopt);
    EXPECT_EQ(evaluate_expression(std::string(1000000, '!') + "1", {}), std::nullopt);
}

/// The words that may be left in, with "?" behind directives that stay.
std::string left_in(std::string_view text, Macros macros = {}) {
    const Source source = parse_source(SourceKind::Lib, "core", "a.glsl", text);
    const Conditions conditions = evaluate_conditions(source, macros);
    std::string result;
    for (const Item& item : source.items) {
        if (!conditions.active[item.first]) continue;
        if (item.kind == Item::Kind::Conditional)
            result +=
                std::ranges::any_of(conditions.undecided,
                                    [&](const auto& group) { return contains(group, item.first); })
                    ? "# "
                    : "";
        else
            result += item.names[0] + ' ';
    }
    return result;
}

TEST(Conditions, OnlyTheTakenBranchIsLeft) {
    constexpr const char* kText = "#if A\nint a;\n#elif B\nint b;\n#else\nint c;\n#endif\nint d;";
    EXPECT_EQ(left_in(kText, {{"A", "1"}, {"B", "1"}}), "a d ");
    EXPECT_EQ(left_in(kText, {{"A", "0"}, {"B", "1"}}), "b d ");
    EXPECT_EQ(left_in(kText, {{"A", "0"}, {"B", "0"}}), "c d ");
}

TEST(Conditions, WhatCannotBeToldStaysWithItsDirectives) {
    constexpr const char* kText = "#if A\nint a;\n#elif B\nint b;\n#else\nint c;\n#endif\nint d;";
    EXPECT_EQ(left_in(kText, {{"A", "0"}}), "# b # c # d ");
    EXPECT_EQ(left_in(kText, {{"B", "1"}}), "# a # b # d ");
}

TEST(Conditions, ABranchInsideADeadOneIsDead) {
    EXPECT_EQ(left_in("#if 0\n#if A\nint a;\n#endif\n#else\nint b;\n#endif"), "b ");
}

TEST(Conditions, AFilesOwnMacrosCount) {
    EXPECT_EQ(left_in("#define A 1\n#if A\nint a;\n#endif\n#undef A\n#ifdef A\nint b;\n#endif"),
              "A a A ");
}

TEST(Conditions, AMacroOfAnUndecidedBranchIsUndecided) {
    EXPECT_EQ(left_in("#if X\n#define A 1\n#endif\n#ifdef A\nint a;\n#endif"), "# A # # a # ");
}

}  // namespace
}  // namespace relevo::shader::test_conditions
