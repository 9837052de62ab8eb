#include <gmock/gmock.h>

#include "shader/snippet.h"
#include "support/support.h"

namespace relevo::shader::test_colour_ramp {
namespace {

ColourRamp ramp_of(const std::string& glsl) {
    const Snippet snippet = parse_snippet("haze", "haze.glsl", glsl);
    EXPECT_EQ(snippet.source.ramps.size(), 1u);
    return snippet.source.ramps.at(0);
}

std::string error(const std::string& glsl) {
    const std::string what = test::error_of([&] { parse_snippet("haze", "haze.glsl", glsl); });
    const std::string begin = "exit 3: shader: haze.glsl:";
    EXPECT_EQ(what.substr(0, begin.size()), begin);
    return what.substr(begin.size());
}

TEST(ColourRamp, IsReadFromAConstantOverSeveralLines) {
    const ColourRamp ramp = ramp_of(
        "const vec3 haze_dust[3] = vec3[](\n    vec3(0.1, 0.2, 0.3), vec3(0.4, 0.5, 0.6),\n"
        "    vec3(1.0, 1.0, 1.0)); //@ ramp(dust_m, 60) unit(m) label(\"Dust\") where(by, dust)\n");
    ASSERT_EQ(ramp.colours.size(), 3u);
    EXPECT_THAT(ramp.colours[1], testing::ElementsAre(0.4, 0.5, 0.6));
    EXPECT_EQ(ramp.from.of, ColourRamp::End::Of::Param);
    EXPECT_EQ(ramp.from.address, "haze.dust_m");
    EXPECT_EQ(ramp.to.number, 60);
    EXPECT_EQ(ramp.unit, "m");
    EXPECT_EQ(ramp.label, "Dust");
    EXPECT_EQ(ramp.where, "haze.by");
    EXPECT_EQ(ramp.where_word, "dust");
    EXPECT_EQ(ramp.line, 1);
}

TEST(ColourRamp, MistakesNameTheirLine) {
    const std::string two = "const vec3 haze_a[2] = vec3[](vec3(0.1, 0.2, 0.3), vec3(0.5, 1, 1)); ";
    EXPECT_EQ(
        error(two + "//@ ramp(60, 0) label(\"A\")"),
        "1: haze_a: expected ramp(from, to), the first below the second, but got ramp(60, 0)");
    EXPECT_EQ(error(two + "//@ label(\"A\")"),
              "1: haze_a: a constant's annotation has a ramp(from, to), steps(edge, edge, ...) or "
              "entries(name, ...), which is missing");
    EXPECT_EQ(error(two + "//@ ramp(ring)"),
              "1: haze_a: a ramp has a label(\"Text\"), which is missing");
    EXPECT_EQ(error(two + "//@ ramp(0, 1) label(\"A\") colour()"),
              "1: haze_a: expected ramp(from, to), steps(edge, edge, ...), entries(name, ...), "
              "unit(m), label(\"Text\") or where(parameter, word) but got colour()");
    const std::string none =
        "1: haze_a: a ramp is at least two colours, vec3[](vec3(0.1, 0.2, 0.3), ...), numbers of 0 "
        "to 1";
    EXPECT_EQ(error("const vec3 haze_a[1] = vec3[](vec3(0.1)); //@ ramp(0, 1) label(\"A\")"), none);
    EXPECT_EQ(error("const vec3 haze_a[2] = vec3[](vec3(0, 0, 2), vec3(0, 0, 1)); //@ ramp(0, 1) "
                    "label(\"A\")"),
              none);
    EXPECT_EQ(error("const float haze_a = 1.0; //@ ramp(0, 1) label(\"A\")"),
              "1: haze_a: an annotation after a variable is for a legend of colours, const vec3 "
              "haze_a[N] = vec3[](...);");
}

/// Two colours with an annotation.
std::string two(const std::string& annotation) {
    return "const vec3 haze_a[2] = vec3[](vec3(0.1, 0.2, 0.3), vec3(0.5, 1, 1)); //@ " + annotation;
}

TEST(ColourRamp, StepsHaveAnEdgeMoreThanColours) {
    const ColourRamp steps =
        ramp_of(two("steps(-5, 0.5, 90) unit(deg) label(\"Slope\") where(by, slope)"));
    EXPECT_THAT(steps.edges, testing::ElementsAre(-5, 0.5, 90));
    EXPECT_EQ(steps.colours.size(), 2u);
    EXPECT_TRUE(steps.entries.empty());
    EXPECT_EQ(steps.unit, "deg");
    EXPECT_EQ(steps.where_word, "slope");
}

TEST(ColourRamp, EntriesHaveAName) {
    const ColourRamp entries = ramp_of(two("entries(rock, \"fresh snow, ice\") label(\"Ground\")"));
    EXPECT_THAT(entries.entries, testing::ElementsAre("rock", "fresh snow, ice"));
    EXPECT_TRUE(entries.edges.empty());
    const ColourRamp one = ramp_of(
        "const vec3 haze_a[1] = vec3[](vec3(0.1, 0.2, 0.3)); //@ entries(rock) label(\"A\")");
    EXPECT_EQ(one.colours.size(), 1u);
}

TEST(ColourRamp, MistakesOfStepsAndEntriesNameTheirLine) {
    const std::string label = " label(\"A\")";
    EXPECT_EQ(error(two("steps(0, 1)" + label)),
              "1: haze_a: expected 3 edges for 2 colours but got 2");
    EXPECT_EQ(error(two("steps(0, 30, 30)" + label)),
              "1: haze_a: expected steps(edge, edge, ...), rising numbers, but got "
              "steps(0, 30, 30)");
    EXPECT_EQ(error(two("steps(0, most, 30)" + label)),
              "1: haze_a: expected steps(edge, edge, ...), rising numbers, but got "
              "steps(0, most, 30)");
    EXPECT_EQ(error(two("entries(rock)" + label)),
              "1: haze_a: expected 2 names for 2 colours but got 1");
    EXPECT_EQ(error(two("entries(rock, rock)" + label)),
              "1: haze_a: expected entries(name, ...), all different, but got entries(rock, rock)");
    EXPECT_EQ(error(two("entries(rock, ice) unit(m)" + label)),
              "1: haze_a: entries have names and no unit");
    EXPECT_EQ(error(two("entries(rock, ice)")),
              "1: haze_a: entries have a label(\"Text\"), which is missing");
    EXPECT_EQ(error(two("steps(0, 1, 2) ramp(0, 1)" + label)),
              "1: haze_a: it can be only one of ramp, steps and entries");
    EXPECT_EQ(error(two("steps(0, 1, 2) steps(0, 1, 2)" + label)),
              "1: haze_a: steps is given twice");
    EXPECT_EQ(
        error("const vec3 haze_a[1] = vec3[](vec3(2)); //@ entries(rock) label(\"A\")"),
        "1: haze_a: entries are colours, vec3[](vec3(0.1, 0.2, 0.3), ...), numbers of 0 to 1");
}

}  // namespace
}  // namespace relevo::shader::test_colour_ramp
