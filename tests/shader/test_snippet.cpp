#include <random>

#include <gtest/gtest.h>

#include "shader/fixture.h"
#include "shader/snippet.h"
#include "support/support.h"

namespace relevo::shader::test_snippet {
namespace {

using relevo::test::error_of;

Snippet parse(std::string_view text) {
    return parse_snippet("haze", "haze.glsl", text);
}

// ---- what is read

TEST(Hooks, TheirNamesAndSignaturesAreAPromise) {
    std::string table;
    for (const Hook& hook : hooks())
        table += std::string(hook.signature) + '\n';
    EXPECT_EQ(table,
              "void displace(in VertexFrame v, inout vec3 position_m)\n"
              "void vertex(in VertexFrame v)\n"
              "void albedo(inout Surface s)\n"
              "void normal(inout Surface s)\n"
              "void material(inout Surface s)\n"
              "void facing(in Surface s, in vec3 to_sun, inout float factor)\n"
              "void visibility(in Surface s, in vec3 to_sun, inout float factor)\n"
              "vec3 brdf(in Surface s, in vec3 to_sun, in vec3 to_eye)\n"
              "void ambient(in Surface s, inout vec3 irradiance)\n"
              "void lit(in Surface s, inout vec3 radiance)\n"
              "void atmosphere(in Surface s, in vec3 view, inout vec3 radiance)\n"
              "void display(in Surface s, inout vec4 overlay)\n"
              "vec3 side(in Surface s, in float down)\n"
              "vec3 backdrop(in vec3 direction, in vec2 at)\n"
              "vec3 beyond(in Surface s, in vec3 view)\n"
              "void image(in Pixel p, inout vec3 radiance)\n"
              "void tonemap(inout vec3 colour)\n"
              "void finish(in Pixel p, inout vec3 colour)\n"
              "void overlay(in Pixel p, inout vec4 over)\n"
              "void sky(in vec3 direction, inout vec3 radiance, inout vec3 transmittance)\n"
              "vec3 background_radiance(in vec3 direction, in bool with_disc)\n");
    for (const Hook& hook : hooks())
        EXPECT_EQ(parse_signature(hook.signature).name, hook.name);
}

TEST(Signature, CountsTypesAndQualifiersOnly) {
    const Signature plain = parse_signature("vec3 f(in vec3 a, inout float b[2])");
    EXPECT_TRUE(plain.matches(parse_signature("vec3 g(vec3 x, inout float[2] y)")));
    EXPECT_TRUE(plain.matches(parse_signature("vec3 f(const in highp vec3, inout float[2])")));
    EXPECT_FALSE(plain.matches(parse_signature("vec3 f(in vec3 a, in float b[2])")));
    EXPECT_FALSE(plain.matches(parse_signature("vec3 f(in vec3 a, inout float b[3])")));
    EXPECT_FALSE(plain.matches(parse_signature("vec4 f(in vec3 a, inout float b[2])")));
    EXPECT_FALSE(plain.matches(parse_signature("vec3 f(in vec3 a)")));
    EXPECT_TRUE(parse_signature("void f(void)").arguments.empty());
}

TEST(Snippet, FindsHooksByTheirNames) {
    const Snippet snippet = shader::test::fixture_snippet("haze");
    ASSERT_EQ(snippet.hooks.size(), 2u);
    EXPECT_EQ(snippet.hooks[0].hook->name, "vertex");
    EXPECT_EQ(snippet.hooks[1].name, "haze_on_atmosphere");
    EXPECT_EQ(snippet.hooks[1].line, 31);
    EXPECT_NE(snippet.find("atmosphere"), nullptr);
    EXPECT_EQ(snippet.find("albedo"), nullptr);
}

TEST(Snippet, APrototypeOfAHookIsNotItsDefinition) {
    EXPECT_TRUE(parse("void haze_on_albedo(inout Surface s);").hooks.empty());
    EXPECT_EQ(
        parse("void haze_on_albedo(inout Surface s);\nvoid haze_on_albedo(inout Surface s) {}")
            .hooks.at(0)
            .line,
        2);
}

TEST(Snippet, LiftsParametersSamplersAndVaryings) {
    const Snippet haze = shader::test::fixture_snippet("haze");
    ASSERT_EQ(haze.source.params.size(), 4u);
    EXPECT_EQ(haze.source.params[0].address, "haze.density");
    EXPECT_EQ(haze.source.params[0].line, 4);
    ASSERT_EQ(haze.source.varyings.size(), 2u);
    EXPECT_EQ(haze.source.varyings[0].type, "float");
    EXPECT_EQ(haze.source.varyings[1].interpolation, "flat");

    const Snippet bump = shader::test::fixture_snippet("bump");
    ASSERT_EQ(bump.source.samplers.size(), 2u);
    EXPECT_EQ(bump.source.samplers[0].resource, "bump.normals");
    EXPECT_EQ(bump.source.samplers[1].type, "sampler3D");
    EXPECT_EQ(bump.source.samplers[1].resource, "ground.noise");
}

TEST(Snippet, NotesIncludesAndWants) {
    EXPECT_EQ(shader::test::fixture_snippet("ground").source.includes.at(0).name, "lib/noise.glsl");
    const Snippet haze = shader::test::fixture_snippet("haze");
    ASSERT_EQ(haze.wanted.size(), 1u);
    EXPECT_EQ(haze.wanted[0].word, "sky");
    EXPECT_EQ(haze.wanted[0].line, 32);
}

TEST(Snippet, WindowsLineEndsKeepTheLines) {
    const Snippet snippet = parse("\r\n\r\nvoid haze_on_albedo(inout Surface s) {\r\n}\r\n");
    EXPECT_EQ(snippet.hooks.at(0).line, 3);
}

TEST(Snippet, AcceptsWhatGlslHas) {
    const Snippet snippet = parse(
        "const float haze_a = 1.0, haze_b[2] = float[](1.0, 2.0);\n"
        "struct haze_S { float x; vec2 y[3]; } haze_s;\n"
        "float haze_state;\n"
        "float haze_f(haze_S s);\n"
        ";\n"
        "float[2] haze_g(const in float x, inout vec3 y[2]) { return float[2](x, x); }\n"
        "float haze_f(haze_S s) { return s.x; }\n"
        "#define haze_SQ(x) ((x) * (x))\n"
        "#if haze_SQ(2) > 3\nfloat haze_h() { return 1.0; }\n#endif\n"
        "#\n"
        "void haze_on_lit(Surface s, inout vec3 radiance) { radiance *= haze_SQ(haze_a); }\n");
    EXPECT_EQ(snippet.hooks.size(), 1u);
    std::string names;
    for (const Item& item : snippet.source.items)
        for (const std::string& name : item.names)
            names += name + ' ';
    EXPECT_EQ(names,
              "haze_a haze_b haze_S haze_s haze_state haze_f haze_g haze_f haze_SQ haze_h "
              "haze_on_lit ");
}

// ---- what is refused

struct Bad {
    const char* name;
    const char* text;
    const char* message;  ///< behind "exit 3: shader: haze.glsl:"
};

class SnippetError : public testing::TestWithParam<Bad> {};

TEST_P(SnippetError, NamesFileAndLine) {
    EXPECT_EQ(error_of([] { parse(GetParam().text); }),
              std::string("exit 3: shader: haze.glsl:") + GetParam().message);
}

constexpr const char* kAmongHooks =
    "; hooks are displace, vertex, albedo, normal, material, facing, visibility, brdf, ambient, "
    "lit, atmosphere, display, side, backdrop, beyond, image, tonemap, finish, overlay, sky, "
    "background_radiance";
const std::string kNoHook = std::string("1: haze_on_xyz: there is no hook xyz") + kAmongHooks;

INSTANTIATE_TEST_SUITE_P(
    Hooks, SnippetError,
    testing::Values(
        Bad{"WrongQualifier", "\nvoid haze_on_albedo(in Surface s) {}",
            "2: haze_on_albedo: wrong signature, expected void haze_on_albedo(inout Surface) but "
            "got void haze_on_albedo(in Surface)"},
        Bad{"WrongType", "void haze_on_albedo(inout vec3 s) {}",
            "1: haze_on_albedo: wrong signature, expected void haze_on_albedo(inout Surface) but "
            "got void haze_on_albedo(inout vec3)"},
        Bad{"WrongReturn", "void haze_on_brdf(in Surface s, in vec3 l, in vec3 v) {}",
            "1: haze_on_brdf: wrong signature, expected vec3 haze_on_brdf(in Surface, in vec3, in "
            "vec3) but got void haze_on_brdf(in Surface, in vec3, in vec3)"},
        Bad{"TooFew", "void haze_on_lit(in Surface s) {}",
            "1: haze_on_lit: wrong signature, expected void haze_on_lit(in Surface, inout vec3) "
            "but got void haze_on_lit(in Surface)"},
        Bad{"Misspelt", "void haze_on_albdo(inout Surface s) {}",
            "1: haze_on_albdo: there is no hook albdo; did you mean haze_on_albedo?"},
        Bad{"Unknown", "void haze_on_xyz(inout Surface s) {}", kNoHook.c_str()},
        Bad{"Twice",
            "void haze_on_albedo(inout Surface s) {}\nvoid haze_on_albedo(inout Surface s) {}",
            "2: haze_on_albedo: defined already in line 1"},
        Bad{"UnderIf", "#if HAS_sky\nvoid haze_on_albedo(inout Surface s) {}\n#endif",
            "2: haze_on_albedo is under the #if of line 1; a plugin's declarations must not depend "
            "on other effects; move the #if into a function"},
        Bad{"CallsAHook", "void haze_on_albedo(inout Surface s) { hook_normal(s); }",
            "1: hook_normal: only core's main programs call hooks"}),
    [](const auto& test) { return test.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Names, SnippetError,
    testing::Values(
        Bad{"Function", "\n\nfloat density() { return 1.0; }",
            "3: density: a plugin's globals begin with its id, expected haze_density but got "
            "density"},
        Bad{"OnlyThePrefix", "float haze_() { return 1.0; }",
            "1: haze_: a plugin's globals begin with its id, expected haze_haze_ but got haze_"},
        Bad{"SecondDeclarator", "const float haze_a = 1.0, b = 2.0;",
            "1: b: a plugin's globals begin with its id, expected haze_b but got b"},
        Bad{"Struct", "struct Layer { float x; };",
            "1: Layer: a plugin's globals begin with its id, expected haze_Layer but got Layer"},
        Bad{"Variable", "vec3 hazed;",
            "1: hazed: a plugin's globals begin with its id, expected haze_hazed but got hazed"},
        Bad{"Macro", "#define STEPS 8",
            "1: STEPS: a plugin's globals begin with its id, expected haze_STEPS but got STEPS"},
        Bad{"Uniform", "uniform float density = 1.0; //@ range(0, 1)",
            "1: density: a plugin's globals begin with its id, expected haze_density but got "
            "density"},
        Bad{"Sampler", "uniform sampler2D noise;",
            "1: noise: a plugin's globals begin with its id, expected haze_noise but got noise"},
        Bad{"Varying", "out float strength;",
            "1: strength: a plugin's globals begin with its id, expected haze_strength but got "
            "strength"},
        Bad{"TwoUnderscores", "void haze_f() { float a__b; }",
            "1: a__b: names with __ are reserved for GLSL"},
        Bad{"TwoUnderscoresInAMacro", "#define haze__A 1",
            "1: haze__A: names with __ are reserved for GLSL"},
        Bad{"Main", "void main() {}",
            "1: main is core's; a plugin hooks into it with functions named haze_on_<hook>"},
        Bad{"Position", "\nvoid haze_f() { gl_Position.x = 1.0; }",
            "2: gl_Position is core's; a plugin moves the ground in haze_on_displace"},
        Bad{"PositionInAMacro", "\n#define haze_P gl_Position\n",
            "2: gl_Position is core's; a plugin moves the ground in haze_on_displace"},
        Bad{"Depth", "void haze_on_albedo(inout Surface s) { gl_FragDepth = 0.0; }",
            "1: gl_FragDepth is core's; a plugin moves the ground in haze_on_displace"},
        Bad{"HookInAMacro", "#define haze_A hook_albedo",
            "1: hook_albedo: only core's main programs call hooks"}),
    [](const auto& test) { return test.param.name; });

const std::string kDiscard =
    "discard: every pixel must be written, or it shows an earlier frame; leave the arguments "
    "unchanged instead";
const std::string kDiscard1 = "1: " + kDiscard, kDiscard3 = "3: " + kDiscard;

INSTANTIATE_TEST_SUITE_P(
    Forbidden, SnippetError,
    testing::Values(
        Bad{"Discard",
            "void haze_on_albedo(inout Surface s) {\n"
            "    if (s.height_m < 0.0)\n        discard;\n}",
            kDiscard3.c_str()},
        Bad{"DiscardInAMacro", "#define haze_DROP(x) if (x) discard", kDiscard1.c_str()},
        Bad{"DiscardUnderIf", "#if HAS_sky\n\nvoid haze_f() { discard; }\n#endif",
            kDiscard3.c_str()},
        Bad{"DiscardAsAnArgument", "#define haze_DO(x) x\n\nvoid haze_f() { haze_DO(discard); }",
            kDiscard3.c_str()},
        Bad{"DiscardPasted", "#define haze_DROP dis ## card",
            "1: # is not allowed in a directive of GLSL 4.50"},
        Bad{"DiscardInTwoLines", "\nvoid haze_f() { dis\\\ncard; }",
            "2: \\ joins this line and the next without a space between them; add one"},
        Bad{"DiscardInThreeLines", "\nvoid haze_f() { dis\\\n\\\ncard; }",
            "2: \\ joins this line and the next without a space between them; add one"},
        Bad{"DiscardInTwoLinesOfAMacro", "#define haze_DROP dis\\\ncard",
            "1: \\ joins this line and the next without a space between them; add one"},
        Bad{"CommentThatTheDriverEndsEarlier", "void haze_f() { /* *\\\n/ discard; /* */ }",
            "1: * and \\ next to each other in a comment may end it; put a space between them"},
        Bad{"CommentThatTheDriverBegins", "void haze_f() { /\\\n/ }\n}",
            "1: \\ joins this line and the next without a space between them; add one"},
        Bad{"Buffer", "buffer Haze { float haze_x[]; };",
            "1: buffer is core's; a plugin declares parameters, samplers, varyings, constants, "
            "structs and functions"},
        Bad{"Image", "uniform image2D haze_i;",
            "1: haze_i: expected a parameter of type float, int, bool, vec2, vec3 or vec4, or a "
            "sampler, but got image2D"},
        Bad{"Atomic", "uniform atomic_uint haze_i;",
            "1: haze_i: expected a parameter of type float, int, bool, vec2, vec3 or vec4, or a "
            "sampler, but got atomic_uint"},
        Bad{"DefineInAStruct", "struct haze_S {\n#define haze_A 1\n    float x;\n};",
            "2: #define inside haze_S; move it out of the declaration"},
        Bad{"LineInAStruct", "struct haze_S {\n#line 9\n    float x;\n};",
            "2: #line inside haze_S; move it out of the declaration"},
        Bad{"ExtensionInAnArgument", "void haze_f(\n#extension all : enable\n) {}",
            "2: #extension inside haze_f; move it out of the function"},
        Bad{"PragmaInAnInitialiser", "const float haze_a[1] = float[1](\n#pragma x\n1.0);",
            "2: #pragma inside haze_a; move it out of the declaration"}),
    [](const auto& test) { return test.param.name; });

TEST(Snippet, ContinuedMacrosAndCommentsAreAccepted) {
    const Snippet snippet = parse(
        "#define haze_MAX(a, b) \\\n    max(a, b)\n"
        "// discard is not \\\n used here: discard\n"
        "/* nor discard \\\n here **/\n"
        "void haze_on_albedo(inout Surface s) {}\n");
    EXPECT_EQ(snippet.hooks.size(), 1u);
}

TEST(Snippet, AnnotationsAreUtf8WithoutControlCharacters) {
    EXPECT_EQ(
        parse("uniform bool haze_a = true; //@\tlabel(\"Nebelstärke\")").source.params.at(0).label,
        "Nebelstärke");
    EXPECT_EQ(error_of([] { parse("\nuniform bool haze_a = true; //@ label(\"\xe4\")"); }),
              "exit 3: shader: haze.glsl:2: //@ label(\"\\xe4\"): expected UTF-8 without control "
              "characters");
    EXPECT_EQ(error_of([] { parse("uniform bool haze_a = true; //@ label(\"\x1b[2J\")"); }),
              "exit 3: shader: haze.glsl:1: //@ label(\"\\x1b[2J\"): expected UTF-8 without "
              "control characters");
}

INSTANTIATE_TEST_SUITE_P(
    Text, SnippetError,
    testing::Values(
        Bad{"BraceNeverClosed",
            "void haze_f() {\n    if (true) {\n}\n\nvoid haze_on_albedo(inout Surface s) {\n}\n",
            "1: { is never closed"},
        Bad{"ParenthesisNeverClosed", "void haze_f() {\n    float x = (1.0;\n}\n",
            "3: } cannot close the ( of line 2"},
        Bad{"ClosesNothing", "void haze_f() {\n}\n}\n", "3: } closes nothing"},
        Bad{"BranchesDoNotBalance",
            "void haze_f() {\n#if 1\n    if (true) {\n#else\n    {\n#endif\n    }\n}",
            "3: { is not closed before the #else of line 4"},
        Bad{"BranchClosesTooMuch", "void haze_f() {\n#if 1\n}\n#endif\n",
            "3: } closes a bracket that was opened before the #if of line 2"},
        Bad{"BraceInAMacro", "#define haze_BEGIN if (true) {\n",
            "1: { is never closed in this #define"},
        Bad{"IfWithoutEndif", "\n#if 1\n", "2: #if without an #endif"},
        Bad{"EndifWithoutIf", "#endif", "1: #endif without an #if"},
        Bad{"ElseWithoutIf", "#else", "1: #else without an #if"},
        Bad{"Version", "#version 330",
            "1: #version is core's: every program is plain GLSL 4.50 core"},
        Bad{"Extension", "#extension GL_ARB_gpu_shader5 : enable",
            "1: #extension is core's: every program is plain GLSL 4.50 core"},
        Bad{"Line", "#line 7", "1: #line would lose the file's own line numbers; remove it"},
        Bad{"Pragma", "#pragma optimize(off)",
            "1: #pragma is not supported; use #define, #undef or #if"},
        Bad{"MisspeltDirective", "#defin haze_A",
            "1: #defin is not supported; use #define, #undef or #if"},
        Bad{"NamelessDefine", "#define", "1: #define without a name"},
        Bad{"DefineInAFunction", "void haze_f() {\n#define haze_A 1\n}",
            "2: #define inside haze_f; move it out of the function"},
        Bad{"AlwaysDefined", "void haze_f() {\n#ifdef HAS_sky\n#endif\n}",
            "2: HAS_sky is always defined, as 0 or as 1; write #if HAS_sky"},
        Bad{"AlwaysDefinedInAnIf", "void haze_f() {\n#if 1 && defined(HAS_sky)\n#endif\n}",
            "2: HAS_sky is always defined, as 0 or as 1; write #if HAS_sky"},
        Bad{"Statement", "haze_f(1.0);", "1: expected a declaration but got haze_f ("},
        Bad{"Junk", "\n= 3;", "2: expected a declaration but got ="},
        Bad{"EndsEarly", "const float",
            "1: expected a declaration but got float the end of the file"},
        Bad{"NoBody", "void haze_f()\nvoid haze_g() {}",
            "1: expected { or ; after the head of haze_f but got void"},
        Bad{"ForgottenSemicolon",
            "const float haze_a = 1.0\nvoid haze_on_albedo(inout Surface s) {}",
            "1: expected ; after haze_a but got void"},
        Bad{"ForgottenSemicolonAfterStruct", "struct haze_S { float x; }\nvoid haze_f() {}",
            "1: expected ; after the struct haze_S"},
        Bad{"NamelessStruct", "struct { float x; } haze_s;",
            "1: expected a struct with a name and its members"},
        Bad{"Layout", "layout(location = 0) out vec4 haze_colour;",
            "1: layout is core's; a plugin declares parameters, samplers, varyings, constants, "
            "structs and functions"},
        Bad{"Buffer", "buffer haze_Data { float x; };",
            "1: buffer is core's; a plugin declares parameters, samplers, varyings, constants, "
            "structs and functions"},
        Bad{"Block", "uniform haze_Block { float haze_x; };",
            "1: haze_Block is a block, which is core's; a plugin declares parameters one by one"},
        Bad{"Precision", "precision highp float;",
            "1: precision does nothing in desktop GLSL; remove it"},
        Bad{"Include", "//@ include noise.glsl",
            "1: expected //@ include lib/NAME.glsl but got //@ include noise.glsl"},
        Bad{"IncludeFromElsewhere", "//@ include lib/../../secret.glsl",
            "1: expected //@ include lib/NAME.glsl but got //@ include lib/../../secret.glsl"},
        Bad{"StrayAnnotation", "\n//@ range(0, 1)\nuniform bool haze_a = true;",
            "2: //@ range(0, 1) is misplaced; expected it after a uniform, or //@ "
            "include lib/NAME.glsl"}),
    [](const auto& test) { return test.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Parameters, SnippetError,
    testing::Values(
        Bad{"NoDefault", "uniform float haze_a; //@ range(0, 1)",
            "1: haze_a: a parameter has a default; expected = after it but got ;"},
        Bad{"NoRange", "uniform float haze_a = 1.0;",
            "1: haze_a: expected a //@ after it with a range; add //@ range(min, max)"},
        Bad{"NoRangeOrEnum", "uniform int haze_a = 1; //@ label(\"A\")",
            "1: haze_a: expected a //@ after it with a range or an enum; add //@ range(min, max)"},
        Bad{"DefaultOutOfRange", "uniform float haze_a = 3.0; //@ range(0, 2) unit(m)",
            "1: haze_a: expected a default that is a number in [0, 2] m but got 3.0"},
        Bad{"DefaultIsNoLiteral", "uniform float haze_a = 1.0 / 3.0; //@ range(0, 2)",
            "1: haze_a: expected a float literal as its default but got 1.0 / 3.0"},
        Bad{"DefaultOfAnotherType", "uniform vec3 haze_a = vec2(1.0);",
            "1: haze_a: expected a vec3 literal as its default but got vec2(1.0)"},
        Bad{"WrongCount", "uniform vec3 haze_a = vec3(1.0, 2.0);",
            "1: haze_a: expected a vec3 literal as its default but got vec3(1.0, 2.0)"},
        Bad{"BoolFromNumber", "uniform bool haze_a = 1;",
            "1: haze_a: expected a bool literal as its default but got 1"},
        Bad{"IntFromFloat", "uniform int haze_a = 1.5; //@ range(0, 2)",
            "1: haze_a: expected a default that is a whole number in [0, 2] but got 1.5"},
        Bad{"Type", "uniform mat4 haze_a = mat4(1.0);",
            "1: haze_a: expected a parameter of type float, int, bool, vec2, vec3 or vec4, or a "
            "sampler, but got mat4"},
        Bad{"Array", "uniform float haze_a[2] = float[2](1.0, 2.0); //@ range(0, 2)",
            "1: haze_a: expected one float without brackets and commas"},
        Bad{"TwoAtOnce", "uniform float haze_a = 1.0; uniform float haze_b = 1.0;",
            "1: haze_a: expected one uniform or varying, alone on its line"},
        Bad{"TwoNames", "uniform float haze_a, haze_b;",
            "1: haze_a: expected one float without brackets and commas"},
        Bad{"TwoLines", "uniform float haze_a =\n    1.0; //@ range(0, 2)",
            "1: haze_a: expected ; before the end of the line"},
        Bad{"UnderIf", "#if 1\nuniform float haze_a = 1.0; //@ range(0, 2)\n#endif",
            "2: haze_a is under the #if of line 1; a plugin's declarations must not depend on "
            "other effects; move the #if into a function"},
        Bad{"Twice", "uniform bool haze_a = true;\nout float haze_a;",
            "2: haze_a: declared already in line 1"},
        Bad{"UnknownAnnotation", "uniform bool haze_a = true; //@ labl(\"A\")",
            "1: haze_a: unknown annotation labl; did you mean label?"},
        Bad{"FarOffAnnotation", "uniform bool haze_a = true; //@ tooltip(\"A\")",
            "1: haze_a: unknown annotation tooltip; there are range, unit, label, description, "
            "enum, colour, angle, direction, static, host"},
        Bad{"AnnotationTwice", "uniform bool haze_a = true; //@ static static",
            "1: haze_a: static is given twice"},
        Bad{"RangeBackwards", "uniform float haze_a = 1.0; //@ range(2, 0)",
            "1: haze_a: expected range(min, max), two numbers of which the first is less, but got "
            "range(2, 0)"},
        Bad{"RangeOfOne", "uniform float haze_a = 1.0; //@ range(2)",
            "1: haze_a: expected range(min, max) but got range(2)"},
        Bad{"RangeOfABool", "uniform bool haze_a = true; //@ range(0, 1)",
            "1: haze_a: a bool has no range"},
        Bad{"EnumOfAFloat", "uniform float haze_a = 1.0; //@ enum(a, b)",
            "1: haze_a: enum is for int, not for a float"},
        Bad{"EnumOfOne", "uniform int haze_a = 0; //@ enum(a)",
            "1: haze_a: expected an enum of at least two words but got enum(a)"},
        Bad{"EnumTwice", "uniform int haze_a = 0; //@ enum(a, a)",
            "1: haze_a: expected enum(word, word, ...), all different, but got enum(a, a)"},
        Bad{"EnumOfNumbers", "uniform int haze_a = 0; //@ enum(1, 2)",
            "1: haze_a: expected enum(word, word, ...), all different, but got enum(1, 2)"},
        Bad{"EnumAndRange", "uniform int haze_a = 0; //@ enum(a, b) range(0, 1)",
            "1: haze_a: an enum has its words and no range"},
        Bad{"ColourOfAFloat", "uniform float haze_a = 0.0; //@ colour",
            "1: haze_a: colour is for vec3 and vec4, not for a float"},
        Bad{"ColourSpace", "uniform vec3 haze_a = vec3(0); //@ colour(hsv)",
            "1: haze_a: expected colour or colour(srgb) but got colour(hsv)"},
        Bad{"BrightColour", "uniform vec3 haze_a = vec3(2); //@ colour",
            "1: haze_a: expected a default that is a colour, #rrggbb or three numbers in [0, 1] "
            "but "
            "got vec3(2)"},
        Bad{"AngleOfAVector", "uniform vec3 haze_a = vec3(0); //@ angle",
            "1: haze_a: angle is for float, not for a vec3"},
        Bad{"AngleInRadians", "uniform float haze_a = 0; //@ angle range(0, 1) unit(rad)",
            "1: haze_a: an angle is in deg, not in rad"},
        Bad{"DirectionToNowhere", "uniform vec3 haze_a = vec3(0); //@ direction",
            "1: haze_a: expected a default that is a direction, three numbers east,north,up that "
            "are not all zero but got vec3(0)"},
        Bad{"StaticHost", "uniform float haze_a = 1.0; //@ static host",
            "1: haze_a: it cannot be both static, a constant, and host, written for every frame"},
        Bad{"HostAngle", "uniform float haze_a = 1.0; //@ angle host",
            "1: haze_a: a host parameter is in radians; remove angle"},
        Bad{"TwoRoles", "uniform vec3 haze_a = vec3(1); //@ colour direction",
            "1: haze_a: it can be only one of colour, angle and direction"},
        Bad{"OpenQuote", "uniform bool haze_a = true; //@ label(\"A)",
            "1: //@ label(\"A): a quotation mark is never closed"},
        Bad{"OpenBracket", "uniform bool haze_a = true; //@ range(0, 1",
            "1: //@ range(0, 1: the ( after range is never closed"},
        Bad{"NoWord", "uniform bool haze_a = true; //@ , static",
            "1: //@ , static: expected a word but got , static"}),
    [](const auto& test) { return test.param.name; });

INSTANTIATE_TEST_SUITE_P(
    SamplersAndVaryings, SnippetError,
    testing::Values(
        Bad{"SamplerArray", "uniform sampler2D haze_a[2];",
            "1: haze_a: expected one sampler2D without brackets and commas"},
        Bad{"SamplerWithDefault", "uniform sampler2D haze_a = 1;",
            "1: haze_a: expected ; but got ="},
        Bad{"SamplerAnnotation", "uniform sampler2D haze_a; //@ range(0, 1)",
            "1: haze_a: a sampler's only annotation is from(name.word), for a texture of another "
            "plugin"},
        Bad{"FromNowhere", "uniform sampler2D haze_a; //@ from(noise)",
            "1: haze_a: a sampler's only annotation is from(name.word), for a texture of another "
            "plugin"},
        Bad{"Image", "uniform image2D haze_a;",
            "1: haze_a: expected a parameter of type float, int, bool, vec2, vec3 or vec4, or a "
            "sampler, but got image2D"},
        Bad{"In", "in float haze_strength;",
            "1: a varying is declared once, for both stages, with out instead of in"},
        Bad{"VaryingType", "out bool haze_a;",
            "1: haze_a: expected a varying of type float, int or uint, a vector of them, mat3 or "
            "mat4, but got bool"},
        Bad{"VaryingArray", "out float[2] haze_a;",
            "1: haze_a: expected a varying of type float, int or uint, a vector of them, mat3 or "
            "mat4, but got float[]"},
        Bad{"VaryingArrayBehind", "out float haze_a[2];",
            "1: haze_a: expected ; after the varying but got ["},
        Bad{"WholeVarying", "out int haze_a;",
            "1: haze_a: whole numbers are not interpolated; expected flat out int but got out int"},
        Bad{"VaryingUnderIf", "#if 1\nout float haze_a;\n#endif",
            "2: haze_a is under the #if of line 1; a plugin's declarations must not depend on "
            "other effects; move the #if into a function"},
        Bad{"TwoVaryings", "out float haze_a; out float haze_b;",
            "1: haze_a: expected one uniform or varying, alone on its line"}),
    [](const auto& test) { return test.param.name; });

// ---- broken files

// Whatever stands in a file, it is read or refused, never crashed upon. Run with the sanitizers.
TEST(Snippet, AMangledFileIsReadOrRefused) {
    std::mt19937 random(20260621);
    const auto below = [&](std::size_t n) { return random() % n; };
    constexpr std::string_view kPieces[] = {"{",
                                            "}",
                                            "(",
                                            ")",
                                            "#if 1\n",
                                            "#endif\n",
                                            ";",
                                            "*/",
                                            "/*",
                                            "//@",
                                            "#define",
                                            "\\\n",
                                            "\"",
                                            "[",
                                            ",",
                                            "uniform float haze_",
                                            "void haze_on_",
                                            "\n"};
    int refused = 0;
    for (const char* id : {"haze", "ground", "bump"}) {
        const std::string text = read_text(shader::test::shader_tests() / "fixtures" / "plugins" /
                                               id / (std::string(id) + ".glsl"),
                                           "test");
        for (int round = 0; round < 1500; ++round) {
            std::string mangled = text;
            for (std::size_t edits = 1 + below(4); edits > 0 && !mangled.empty(); --edits) {
                const std::size_t at = below(mangled.size());
                switch (below(3)) {
                    case 0:
                        mangled.erase(at, 1 + below(20));
                        break;
                    case 1:
                        mangled.insert(at, kPieces[below(std::size(kPieces))]);
                        break;
                    default:
                        mangled.resize(at);
                }
            }
            try {
                const Snippet snippet = parse_snippet(id, "mangled.glsl", mangled);
                StitchInput input;
                input.snippets = {&snippet};
                stitch(shader::test::fixture_core(), shader::test::terrain_program(), input);
            } catch (const Error&) {
                ++refused;
            }
        }
    }
    EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace relevo::shader::test_snippet
