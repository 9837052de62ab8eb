#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/log.h"
#include "base/units.h"
#include "shader/param_store.h"
#include "shader/params.h"
#include "shader/snippet.h"
#include "support/support.h"

namespace relevo::shader::test_params {
namespace {

using relevo::test::error_of;

Param param(const std::string& declaration) {
    return parse_snippet("haze", "haze.glsl", declaration).source.params.at(0);
}

// ---- declarations

TEST(Param, IsReadFromItsDeclaration) {
    const Param p = param(
        "uniform float haze_noise_scale = -0.08; //@ range(-1, 2) unit(1/km) label(\"Noise, "
        "(scaled)\") description(\"One. Two, three.\") static");
    EXPECT_EQ(p.name, "haze_noise_scale");
    EXPECT_EQ(p.address, "haze.noise_scale");
    EXPECT_EQ(p.type, ParamType::Float);
    EXPECT_EQ(p.initial[0], -0.08);
    EXPECT_EQ(p.range->min, -1);
    EXPECT_EQ(p.range->max, 2);
    EXPECT_EQ(p.unit, "1/km");
    EXPECT_EQ(p.label, "Noise, (scaled)");
    EXPECT_EQ(p.description, "One. Two, three.");
    EXPECT_TRUE(p.is_static);
    EXPECT_FALSE(p.is_host);
    EXPECT_EQ(p.line, 1);
}

TEST(Param, LabelComesFromTheNameIfNotGiven) {
    EXPECT_EQ(param("uniform bool haze_low_sun = true;").label, "Low sun");
}

TEST(Param, AUnitMayHaveBrackets) {
    EXPECT_EQ(param("uniform float haze_a = 1; //@ range(0, 2) unit(W/(m2 sr))").unit, "W/(m2 sr)");
}

TEST(Param, DefaultsAreGlslLiterals) {
    EXPECT_EQ(param("uniform float haze_a = .5f; //@ range(0, 2)").initial, ParamValue{0.5});
    EXPECT_EQ(param("uniform float haze_a = 1e-3; //@ range(0, 2)").initial, ParamValue{0.001});
    EXPECT_EQ(param("uniform int haze_a = -3; //@ range(-5, 5)").initial, ParamValue{-3});
    EXPECT_EQ(param("uniform bool haze_a = true;").initial, ParamValue{1});
    EXPECT_EQ(param("uniform vec2 haze_a = vec2(1, -2.5);").initial, (ParamValue{1, -2.5}));
    EXPECT_EQ(param("uniform vec3 haze_a = vec3(0.5);").initial, (ParamValue{0.5, 0.5, 0.5}));
    EXPECT_EQ(param("uniform vec4 haze_a = vec4( 1, 2 , 3,4);").initial, (ParamValue{1, 2, 3, 4}));
}

// ---- values as people write them

struct Value {
    const char* name;
    const char* declaration;
    const char* text;
    ParamValue value;
    const char* written;  ///< by format_value
};

class ParamValues : public testing::TestWithParam<Value> {};

TEST_P(ParamValues, AreReadAndWritten) {
    const Param p = param(GetParam().declaration);
    const ParamValue value = parse_value(p, GetParam().text);
    EXPECT_EQ(value, GetParam().value);
    EXPECT_EQ(format_value(p, value), GetParam().written);
    EXPECT_EQ(parse_value(p, format_value(p, value)), value);
}

constexpr const char* kFloat = "uniform float haze_a = 1; //@ range(0, 2) unit(1/km)";
constexpr const char* kInt = "uniform int haze_a = 1; //@ range(1, 64)";
constexpr const char* kBool = "uniform bool haze_a = true;";
constexpr const char* kEnum = "uniform int haze_a = 0; //@ enum(linear, square)";
constexpr const char* kVec2 = "uniform vec2 haze_a = vec2(0); //@ range(-1, 1)";
constexpr const char* kColour = "uniform vec3 haze_a = vec3(1); //@ colour";
constexpr const char* kSrgb = "uniform vec4 haze_a = vec4(1); //@ colour(srgb)";
constexpr const char* kAngle = "uniform float haze_a = 0; //@ angle range(-180, 180)";
constexpr const char* kDirection = "uniform vec3 haze_a = vec3(0, 0, 1); //@ direction";

INSTANTIATE_TEST_SUITE_P(
    All, ParamValues,
    testing::Values(Value{"Float", kFloat, "0.2", {0.2}, "0.2"},
                    Value{"RangeIncludesItsEnds", kFloat, " 2 ", {2}, "2"},
                    Value{"Int", kInt, "64", {64}, "64"}, Value{"True", kBool, "true", {1}, "true"},
                    Value{"Off", kBool, "off", {0}, "false"},
                    Value{"Word", kEnum, "square", {1}, "square"},
                    Value{"NumberOfAWord", kEnum, "1", {1}, "square"},
                    Value{"Vec2", kVec2, "0.1, -1", {0.1, -1}, "0.1,-1"},
                    // 188/255 is the sRGB of 0.5 light to three digits (IEC 61966-2-1).
                    Value{"HexIsLinearised", kColour, "#FF0000", {1, 0, 0}, "1,0,0"},
                    Value{
                        "ColourAsNumbers", kColour, "0.1,0.2,0.3", {0.1, 0.2, 0.3}, "0.1,0.2,0.3"},
                    Value{"SrgbHexStays", kSrgb, "#00ff0033", {0, 1, 0, 0.2}, "0,1,0,0.2"},
                    Value{"HexWithoutAlphaIsOpaque", kSrgb, "#00ff00", {0, 1, 0, 1}, "0,1,0,1"},
                    Value{"AngleInDegrees", kAngle, "-90", {-90}, "-90"},
                    Value{"Direction", kDirection, "0,3,4", {0, 3, 4}, "0,3,4"}),
    [](const auto& test) { return test.param.name; });

TEST(ParamValues, AHexColourIsLinearLight) {
    const ParamValue value = parse_value(param(kColour), "#bcbcbc");
    // sRGB 188/255 = 0.737255 is linear 0.502886 (IEC 61966-2-1: ((c + 0.055) / 1.055)^2.4).
    EXPECT_NEAR(value[0], 0.502886, 1e-6);
    const Param with_alpha = param("uniform vec4 haze_a = vec4(1); //@ colour");
    EXPECT_EQ(parse_value(with_alpha, "#bcbcbc80")[3], 128 / 255.0);  // alpha is no light
    EXPECT_NEAR(parse_value(param(kColour), "#0a0a0a")[1], 10 / 255.0 / 12.92, 1e-12);
}

TEST(ParamValues, BeyondAFloatSayWhy) {
    const auto error = [](const char* declaration, const char* text) {
        return error_of([&] { parse_value(param(declaration), text); });
    };
    const std::string head = "exit 3: parameter: haze.a: expected ";
    EXPECT_EQ(error(kDirection, "1e99,0,0"),
              head +
                  "a direction, three numbers east,north,up that are not all zero, none beyond "
                  "3.40282e+38 in size but got \"1e99,0,0\"");
    EXPECT_EQ(error("uniform vec2 haze_a = vec2(0);", "1e99,0"),
              head +
                  "two numbers with commas between, none beyond 3.40282e+38 in size but got "
                  "\"1e99,0\"");
    EXPECT_EQ(error(kFloat, "1e99"), head + "a number in [0, 2] 1/km but got \"1e99\"");
    EXPECT_EQ(error(kFloat, "2.0000000000000004"),
              head + "a number in [0, 2] 1/km but got \"2.0000000000000004\"");
    EXPECT_EQ(error_of([] { param("uniform float haze_a = 5e98; //@ range(0, 1e99)"); }),
              "exit 3: shader: haze.glsl:1: haze_a: expected a range within -3.402823466e+38 "
              "and 3.402823466e+38, as a float can hold, but got range(0, 1e99)");
    EXPECT_EQ(error_of([] { param("uniform int haze_a = 5; //@ range(0, 1e10)"); }),
              "exit 3: shader: haze.glsl:1: haze_a: expected a range within -2147483647 and "
              "2147483647, as an int can hold, but got range(0, 1e10)");
}

TEST(ParamStore, WritesWholeNumbersOnlyWhereTheyFit) {
    ParamStore store;
    store.declare({param("uniform int haze_a = 0; //@ host")});
    store.write_host("haze.a", {7});
    for (const double bad : {1e99, 0.5, std::nan("")})
        EXPECT_EQ(error_of([&] { store.write_host("haze.a", {bad}); }),
                  fmt::format("exit 3: parameter: haze.a: expected a whole number but got "
                              "{}",
                              bad));
    EXPECT_EQ(store.value("haze.a")[0], 7);
}

struct BadValue {
    const char* name;
    const char* declaration;
    const char* text;
    const char* message;
};

class ParamValueError : public testing::TestWithParam<BadValue> {};

TEST_P(ParamValueError, NamesParameterTypeAndRange) {
    const Param p = param(GetParam().declaration);
    EXPECT_EQ(error_of([&] { parse_value(p, GetParam().text); }), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    All, ParamValueError,
    testing::Values(
        BadValue{"OutOfRange", kFloat, "5",
                 "exit 3: parameter: haze.a: expected a number in [0, 2] 1/km but got "
                 "\"5\""},
        BadValue{"NotANumber", kFloat, "much",
                 "exit 3: parameter: haze.a: expected a number in [0, 2] 1/km but got "
                 "\"much\""},
        BadValue{"Nan", kFloat, "nan",
                 "exit 3: parameter: haze.a: expected a number in [0, 2] 1/km but got "
                 "\"nan\""},
        BadValue{"NotWhole", kInt, "1.5",
                 "exit 3: parameter: haze.a: expected a whole number in [1, 64] but got "
                 "\"1.5\""},
        BadValue{"Bool", kBool, "maybe",
                 "exit 3: parameter: haze.a: expected true or false but got \"maybe\""},
        BadValue{"Word", kEnum, "cubic",
                 "exit 3: parameter: haze.a: expected one of linear, square but got "
                 "\"cubic\""},
        BadValue{"NumberWithoutWord", kEnum, "2",
                 "exit 3: parameter: haze.a: expected one of linear, square but got \"2\""},
        BadValue{"TooMany", kVec2, "1,1,1",
                 "exit 3: parameter: haze.a: expected two numbers with commas between in "
                 "[-1, 1] but got \"1,1,1\""},
        BadValue{"OneComponentOutside", kVec2, "0,2",
                 "exit 3: parameter: haze.a: expected two numbers with commas between in "
                 "[-1, 1] but got \"0,2\""},
        BadValue{"Hex", kColour, "#12345",
                 "exit 3: parameter: haze.a: expected a colour, #rrggbb or three numbers "
                 "in [0, 1] but got \"#12345\""},
        BadValue{"AlphaForThree", kColour, "#11223344",
                 "exit 3: parameter: haze.a: expected a colour, #rrggbb or three numbers "
                 "in [0, 1] but got \"#11223344\""},
        BadValue{"Angle", kAngle, "200",
                 "exit 3: parameter: haze.a: expected an angle in [-180, 180] deg but got "
                 "\"200\""},
        BadValue{"Nowhere", kDirection, "0,0,0",
                 "exit 3: parameter: haze.a: expected a direction, three numbers "
                 "east,north,up that are not all zero but got \"0,0,0\""},
        BadValue{"Empty", kFloat, "",
                 "exit 3: parameter: haze.a: expected a number in [0, 2] 1/km but got "
                 "\"\""}),
    [](const auto& test) { return test.param.name; });

// ---- values as the shader gets them

TEST(ShaderValue, AnglesAreRadians) {
    EXPECT_FLOAT_EQ(shader_value(param(kAngle), {180})[0], static_cast<float>(kPi));
}

TEST(ShaderValue, DirectionsHaveUnitLength) {
    const std::array<float, 4> sent = shader_value(param(kDirection), {0, 3, 4});
    EXPECT_FLOAT_EQ(sent[1], 0.6f);
    EXPECT_FLOAT_EQ(sent[2], 0.8f);
}

TEST(GlslValue, IsAConstantExpression) {
    EXPECT_EQ(glsl_value(param(kFloat), {2}), "2.0");
    EXPECT_EQ(glsl_value(param(kFloat), {1e-10}), "1e-10");
    EXPECT_EQ(glsl_value(param(kFloat), {0.1}), "0.1");
    EXPECT_EQ(glsl_value(param(kInt), {7}), "7");
    EXPECT_EQ(glsl_value(param(kBool), {0}), "false");
    EXPECT_EQ(glsl_value(param(kVec2), {0.5, -1}), "vec2(0.5, -1.0)");
}

// ---- the store

std::vector<Param> params(const std::string& text) {
    return parse_snippet("haze", "haze.glsl", text).source.params;
}

/// What is logged while it lives.
struct Logged {
    Logged() {
        log::set_sink([this](log::Level, std::string_view text) { lines.emplace_back(text); });
    }
    ~Logged() { log::set_sink({}); }
    std::vector<std::string> lines;
};

TEST(ParamStore, StartsWithDefaults) {
    ParamStore store;
    store.declare(params(kFloat));
    EXPECT_EQ(store.value("haze.a"), ParamValue{1});
    EXPECT_EQ(store.params().size(), 1u);
}

TEST(ParamStore, ValuesOutliveTheirDeclaration) {
    ParamStore store;
    store.declare(params(kFloat));
    store.set("haze.a", "0.5");
    store.declare({});
    EXPECT_EQ(store.find("haze.a"), nullptr);
    store.declare(params(kFloat));
    EXPECT_EQ(store.value("haze.a"), ParamValue{0.5});
    store.reset("haze.a");
    EXPECT_EQ(store.value("haze.a"), ParamValue{1});
}

TEST(ParamStore, ANewDefaultDoesNotTouchAValueThatWasSet) {
    ParamStore store;
    store.declare(params("uniform float haze_a = 1; //@ range(0, 2)"));
    store.set("haze.a", "0.5");
    store.declare(params("uniform float haze_a = 2; //@ range(0, 2)"));
    EXPECT_EQ(store.value("haze.a"), ParamValue{0.5});
}

TEST(ParamStore, AnotherTypeResetsWithAWarning) {
    const Logged logged;
    ParamStore store;
    store.declare(params(kFloat));
    store.set("haze.a", "0.5");
    store.declare(params(kInt));
    EXPECT_EQ(store.value("haze.a"), ParamValue{1});
    EXPECT_EQ(logged.lines,
              std::vector<std::string>{
                  "haze.a: the type has changed from float to int; the value is reset to 1"});
}

TEST(ParamStore, ANarrowerRangeResetsWithAWarning) {
    const Logged logged;
    ParamStore store;
    store.declare(params(kFloat));
    store.set("haze.a", "1.5");
    store.declare(params("uniform float haze_a = 0; //@ range(0, 1)"));
    EXPECT_EQ(store.value("haze.a"), ParamValue{0});
    EXPECT_EQ(logged.lines, std::vector<std::string>{
                                "haze.a: the value is not a number in [0, 1]; it is reset to 0"});
}

TEST(ParamStore, ErrorsNameTheParameter) {
    ParamStore store;
    store.declare(
        params("uniform float haze_density = 1; //@ range(0, 2)\n"
               "uniform float haze_drift = 0; //@ host"));
    EXPECT_EQ(error_of([&] { store.set("haze.densty", "1"); }),
              "exit 3: parameter: haze.densty: no such parameter; did you mean "
              "haze.density?");
    EXPECT_EQ(error_of([&] { store.set("snow", "1"); }),
              "exit 3: parameter: snow: no such parameter");
    EXPECT_EQ(error_of([&] { store.set("haze.density", ParamValue{3}); }),
              "exit 3: parameter: haze.density: expected a number in [0, 2] but got 3");
    EXPECT_EQ(error_of([&] { store.set("haze.drift", "1"); }),
              "exit 3: parameter: haze.drift: written by the program for every frame; it "
              "cannot be set");
    EXPECT_EQ(error_of([&] { store.write_host("haze.density", {1}); }),
              "exit 3: parameter: haze.density: not a host parameter; modules cannot write it");
    store.write_host("haze.drift", {7});
    EXPECT_EQ(store.value("haze.drift"), ParamValue{7});
}

// ---- the block

struct Member {
    const char* name;
    std::size_t offset;
};

// OpenGL 4.5 core, 7.6.2.2, rules 1 to 3: scalars on 4, vec2 on 8, vec3 and vec4 on 16 bytes.
TEST(BlockLayout, FollowsStd140) {
    const BlockLayout layout =
        block_layout(params("uniform float haze_a = 0; //@ range(0, 1)\n"
                            "uniform vec3 haze_b = vec3(0);\n"
                            "uniform bool haze_c = true;\n"
                            "uniform float haze_d = 0; //@ range(0, 1)\n"
                            "uniform vec2 haze_e = vec2(0);\n"
                            "uniform vec4 haze_f = vec4(0);\n"
                            "uniform int haze_g = 0; //@ range(0, 1)\n"));
    constexpr Member kExpected[] = {{"haze_a", 0},  {"haze_b", 16}, {"haze_c", 28}, {"haze_d", 32},
                                    {"haze_e", 40}, {"haze_f", 48}, {"haze_g", 64}};
    ASSERT_EQ(layout.members.size(), std::size(kExpected));
    for (std::size_t i = 0; i < std::size(kExpected); ++i) {
        EXPECT_EQ(layout.members[i].param.name, kExpected[i].name);
        EXPECT_EQ(layout.members[i].offset, kExpected[i].offset) << kExpected[i].name;
    }
    EXPECT_EQ(layout.size, 80u);
    EXPECT_EQ(block_layout({}).size, 0u);
}

template <typename T>
T at(const std::vector<std::byte>& bytes, std::size_t offset) {
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

TEST(BlockLayout, PacksValuesAsTheShaderReadsThem) {
    const std::vector<Param> declared = params(
        "uniform float haze_turn = 180; //@ angle range(-180, 180)\n"
        "uniform vec3 haze_wind = vec3(0, 2, 0); //@ direction\n"
        "uniform bool haze_on = true;\n"
        "uniform int haze_mode = 0; //@ enum(a, b)\n");
    ParamStore store;
    store.declare(declared);
    store.set("haze.mode", "b");
    const std::vector<std::byte> bytes = pack(block_layout(declared), store);
    ASSERT_EQ(bytes.size(), 48u);
    EXPECT_FLOAT_EQ(at<float>(bytes, 0), static_cast<float>(kPi));
    EXPECT_EQ(at<float>(bytes, 20), 1.0f);
    EXPECT_EQ(at<std::int32_t>(bytes, 28), 1);
    EXPECT_EQ(at<std::int32_t>(bytes, 32), 1);
}

TEST(BlockLayout, AProgramThatOutlivesAReloadGetsDefaults) {
    const BlockLayout old = block_layout(params(kFloat));
    ParamStore store;
    store.declare(params(kInt));
    store.set("haze.a", "64");
    EXPECT_EQ(at<float>(pack(old, store), 0), 1.0f);
    store.declare({});
    EXPECT_EQ(at<float>(pack(old, store), 0), 1.0f);
}

TEST(BlockLayout, IsEqualByNamesTypesAndOffsets) {
    EXPECT_EQ(block_layout(params(kFloat)),
              block_layout(params("uniform float haze_a = 2; //@ range(0, 9)")));
    EXPECT_FALSE(block_layout(params(kFloat)) == block_layout(params(kInt)));
}

}  // namespace
}  // namespace relevo::shader::test_params
