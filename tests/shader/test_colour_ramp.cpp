#include <gmock/gmock.h>

#include "shader/snippet.h"
#include "support/support.h"

namespace relevo::shader {
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
              "1: haze_a: a constant's annotation is a ramp(from, to), which is missing");
    EXPECT_EQ(error(two + "//@ ramp(ring)"),
              "1: haze_a: a ramp has a label(\"Text\"), which is missing");
    EXPECT_EQ(error(two + "//@ ramp(0, 1) label(\"A\") colour()"),
              "1: haze_a: expected ramp(from, to), unit(m), label(\"Text\") or where(parameter, "
              "word) but got colour()");
    const std::string none =
        "1: haze_a: a ramp is at least two colours, vec3[](vec3(0.1, 0.2, 0.3), ...), numbers of 0 "
        "to 1";
    EXPECT_EQ(error("const vec3 haze_a[1] = vec3[](vec3(0.1)); //@ ramp(0, 1) label(\"A\")"), none);
    EXPECT_EQ(error("const vec3 haze_a[2] = vec3[](vec3(0, 0, 2), vec3(0, 0, 1)); //@ ramp(0, 1) "
                    "label(\"A\")"),
              none);
    EXPECT_EQ(error("const float haze_a = 1.0; //@ ramp(0, 1) label(\"A\")"),
              "1: haze_a: an annotation after a variable is for a ramp of colours, const vec3 "
              "haze_a[N] = vec3[](...);");
}

}  // namespace
}  // namespace relevo::shader
