#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shader/tokenizer.h"
#include "support/support.h"

namespace relevo::shader::test_tokenizer {
namespace {

using ::testing::ElementsAre;

std::vector<std::string> words(std::string_view text) {
    std::vector<std::string> result;
    for (const Token& token : tokenize(text, "a.glsl").code)
        result.emplace_back(text_of(text, token));
    return result;
}

TEST(Tokenizer, SplitsWordsNumbersAndMarks) {
    EXPECT_THAT(words("vec3 a=b.xyz*.5f+1e-3-0x1E-7u+2E+4;"),
                ElementsAre("vec3", "a", "=", "b", ".", "xyz", "*", ".5f", "+", "1e-3", "-", "0x1E",
                            "-", "7u", "+", "2E+4", ";"));
}

TEST(Tokenizer, TakesTheLongestMark) {
    EXPECT_THAT(words("a<<=b>>c<=d^^e&&f++"),
                ElementsAre("a", "<<=", "b", ">>", "c", "<=", "d", "^^", "e", "&&", "f", "++"));
}

TEST(Tokenizer, KeepsLines) {
    const std::vector<Token> code = tokenize("a /* x\ny */ b\n\n  c", "a.glsl").code;
    ASSERT_EQ(code.size(), 3u);
    EXPECT_EQ(code[0].line, 1);
    EXPECT_EQ(code[1].line, 2);
    EXPECT_EQ(code[2].line, 4);
}

TEST(Tokenizer, BracesInCommentsAreNotCode) {
    EXPECT_THAT(words("a // { }\n/* { \" ' */ b"), ElementsAre("a", "b"));
}

TEST(Tokenizer, CommentsMayHoldAnyBytes) {
    const Tokens tokens = tokenize("// Höhe, 高度\na", "a.glsl");
    EXPECT_EQ(tokens.code.size(), 1u);
    EXPECT_EQ(tokens.comments.size(), 1u);
}

TEST(Tokenizer, ABackslashJoinsLines) {
    const std::string_view text = "// a \\\n b { \nc\n#define X 1 \\\n  + 2\nd";
    const Tokens tokens = tokenize(text, "a.glsl");
    EXPECT_EQ(tokens.comments[0].last_line, 2);
    ASSERT_EQ(tokens.code.size(), 3u);
    EXPECT_EQ(text_of(text, tokens.code[1]), "#define X 1 \\\n  + 2");
    EXPECT_EQ(tokens.code[2].line, 6);
}

TEST(Tokenizer, ADirectiveIsOneTokenWithoutTheCommentBehindIt) {
    const std::string_view text = "  # define X 1 /* a */ + 2 // b\ny";
    const Tokens tokens = tokenize(text, "a.glsl");
    ASSERT_EQ(tokens.code.size(), 2u);
    EXPECT_EQ(text_of(text, tokens.code[0]), "# define X 1 /* a */ + 2");
    std::vector<std::string> inner;
    for (const Token& token : tokens.code[0].words)
        inner.emplace_back(text_of(text, token));
    EXPECT_THAT(inner, ElementsAre("define", "X", "1", "+", "2"));
    EXPECT_EQ(tokens.comments.size(), 1u);
}

TEST(Tokenizer, EveryLineEndBecomesOne) {
    EXPECT_EQ(unix_lines("\xEF\xBB\xBF"
                         "a\r\nb\rc\n"),
              "a\nb\nc\n");
}

struct Bad {
    const char* name;
    const char* text;
    const char* message;
};

class TokenizerError : public testing::TestWithParam<Bad> {};

TEST_P(TokenizerError, SaysWhere) {
    EXPECT_EQ(relevo::test::error_of([] { tokenize(GetParam().text, "a.glsl"); }),
              GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    All, TokenizerError,
    testing::Values(
        Bad{"UnclosedComment", "a\n/* b\n", "exit 3: shader: a.glsl:2: /* is never closed"},
        Bad{"Quote", "\n\n\"a\"",
            "exit 3: shader: a.glsl:3: the character \" has no place in GLSL"},
        Bad{"At", "float a @ b;", "exit 3: shader: a.glsl:1: the character @ has no place in GLSL"},
        Bad{"Umlaut", "float h\xC3\xB6he;",
            "exit 3: shader: a.glsl:1: the byte 0xC3 may stand in comments only"},
        Bad{"LateHash", "a #define", "exit 3: shader: a.glsl:1: # must be first on its line"}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace relevo::shader::test_tokenizer
