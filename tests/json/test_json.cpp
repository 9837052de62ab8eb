#include <fmt/format.h>
#include <gtest/gtest.h>

#include "json/object_reader.h"
#include "support/support.h"

namespace relevo::json {
namespace {

using relevo::test::error_of;

TEST(Json, KnowsTheLineOfEveryMember) {
    const Value json = parse("who", "a.json", "{\n  \"a\": 1,\n  \"b\": {\n\"c\": [\n1,\n\"x\"]}}");
    ASSERT_EQ(json.members.size(), 2u);
    EXPECT_EQ(json.members[0].value.line, 2);
    EXPECT_EQ(json.members[1].value.line, 3);
    const Value& list = json.members[1].value.members[0].value;
    EXPECT_EQ(list.line, 4);
    EXPECT_EQ(list.items[1].line, 6);
    EXPECT_EQ(list.items[0].number, 1);
}

TEST(Json, AMembersLineIsItsKeys) {
    EXPECT_EQ(parse("who", "a.json", "{\"a\":\n\n1}").members[0].value.line, 1);
}

struct Bad {
    const char* name;
    const char* text;
    const char* message;
};

class JsonError : public testing::TestWithParam<Bad> {};

TEST_P(JsonError, NamesFileAndLine) {
    EXPECT_EQ(error_of([] { parse("who", "a.json", GetParam().text); }), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    All, JsonError,
    testing::Values(
        Bad{"MissingComma", "{\n  \"a\": 1\n  \"b\": 2\n}",
            "exit 3: who: a.json:3: syntax error while parsing object - unexpected string literal; "
            "expected '}'"},
        Bad{"TrailingComma", "{\n  \"a\": 1,\n}",
            "exit 3: who: a.json:3: syntax error while parsing object key - unexpected '}'; "
            "expected string literal"},
        Bad{"Empty", "",
            "exit 3: who: a.json:1: syntax error while parsing value - unexpected end of input; "
            "expected '[', '{', or a literal"},
        Bad{"KeyTwice", "{\"a\": 1,\n\n\"a\": 2}",
            "exit 3: who: a.json:3: a: given already in line 1"},
        Bad{"Comment", "{\n// no\n}",
            "exit 3: who: a.json:2: syntax error while parsing object key - invalid literal; last "
            "read: '{<U+000A>/'; expected string literal"}),
    [](const auto& test) { return test.param.name; });

TEST(Json, DeepNestingIsRefused) {
    EXPECT_EQ(error_of([] { parse("who", "a.json", std::string(100000, '[')); }),
              "exit 3: who: a.json:1: nested deeper than 64 levels");
}

TEST(Json, BytesThatAreNoUtf8AreNamedInAMessageThatIs) {
    EXPECT_EQ(
        error_of([] { parse("who", "a.json", "{\n\"a\": \"\xff\"}"); }),
        "exit 3: who: a.json:2: syntax error while parsing value - invalid string: ill-formed "
        "UTF-8 byte; last read: '\"\\xff'");
    EXPECT_EQ(
        error_of([] { parse("who", "a.json", "{\xff}"); }),
        "exit 3: who: a.json:1: syntax error while parsing object key - invalid literal; last "
        "read: '{\\xff'; expected string literal");
}

TEST(Json, NumbersBeyondADoubleHaveNoRawText) {
    EXPECT_EQ(error_of([] { parse("who", "a.json", "{\n\"a\": 1e999}"); }),
              "exit 3: who: a.json:2: number overflow parsing '1e999'");
}

TEST(Json, TextsThatATerminalWouldObeyAreRefused) {
    const Value json = parse("who", "a.json", R"({"name": "a\u001b[2J", "words": ["b\n"]})");
    ObjectReader object("who", "a.json", "", json);
    EXPECT_EQ(error_of([&] { object.string("name"); }),
              "exit 3: who: a.json:1: name: expected a text without control characters but got "
              "\"a\\x1b[2J\"");
    EXPECT_EQ(error_of([&] { object.boolean("name", true); }),
              "exit 3: who: a.json:1: name: expected true or false but got \"a\\x1b[2J\"");
    EXPECT_EQ(error_of([&] { object.strings("words"); }),
              "exit 3: who: a.json:1: words: expected a list of texts without control characters "
              "but got \"b\\n\" in it");
}

TEST(Json, ManyKeysTakeNoLongerThanTheyShould) {
    std::string text = "{";
    for (int i = 0; i < 90000; ++i)
        text += fmt::format("{}\"k{}\":1", i > 0 ? "," : "", i);
    EXPECT_EQ(parse("who", "a.json", text + "}").members.size(), 90000u);
}

TEST(Json, LongFilesAreRefused) {
    EXPECT_EQ(error_of([] { parse("who", "a.json", std::string(kMaxBytes + 1, ' ')); }),
              "exit 3: who: a.json: expected at most 1024 KiB but got 1025");
}

}  // namespace
}  // namespace relevo::json
