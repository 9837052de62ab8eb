#include <algorithm>
#include <cstring>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shader/fixture.h"
#include "shader/stitch.h"

namespace relevo::shader::test::test_stitch {
namespace {

using relevo::test::error_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// Core texts that are written in the test, over those of the fixture.
class Texts : public CoreTexts {
  public:
    explicit Texts(std::map<std::string, std::string> texts = {}) : texts_(std::move(texts)) {}

    std::optional<std::string> text(std::string_view name) const override {
        const auto found = texts_.find(std::string(name));
        return found == texts_.end() ? fixture_core().text(name) : found->second;
    }
    std::string file(std::string_view name) const override {
        return "shaders/" + std::string(name);
    }

  private:
    std::map<std::string, std::string> texts_;
};

/// Snippets that are written in the test: pairs of id and text.
struct Written {
    StitchInput input() const {
        StitchInput result;
        for (const Snippet& snippet : snippets)
            result.snippets.push_back(&snippet);
        return result;
    }
    std::vector<Snippet> snippets;
};

Written plugins(const std::vector<std::pair<std::string, std::string>>& texts) {
    Written result;
    for (const auto& [id, text] : texts)
        result.snippets.push_back(parse_snippet(id, id + ".glsl", text));
    return result;
}

Texts core_with(std::map<std::string, std::string> texts) {
    return Texts(std::move(texts));
}

std::string fragment(const Written& written, const ProgramRecipe& program = terrain_program()) {
    return stitch(Texts(), program, written.input()).fragment.text;
}

std::string vertex(const Written& written, const ProgramRecipe& program = terrain_program()) {
    return stitch(Texts(), program, written.input()).vertex.text;
}

std::string stitch_error(const Written& written, const ProgramRecipe& program = terrain_program(),
                         const Texts& texts = Texts()) {
    return error_of([&] { stitch(texts, program, written.input()); });
}

const std::string kAlbedo = "void haze_on_albedo(inout Surface s) { s.diffuse = ";

// ---- what is in the text

TEST(Stitch, TheVersionIsTheFirstLine) {
    const Stitched stitched = stitch(Texts(), terrain_program(), {});
    EXPECT_EQ(stitched.vertex.text.substr(0, 18), "#version 450 core\n");
    EXPECT_EQ(stitched.fragment.text.substr(0, 18), "#version 450 core\n");
}

TEST(Stitch, NeverWritesALineDirective) {
    const Selection all({"ground", "bump", "sky", "haze"});
    EXPECT_THAT(stitch(Texts(), terrain_program(), all.input()).fragment.text,
                Not(HasSubstr("#line")));
}

TEST(Stitch, APluginThatAProgramDoesNotReachLeavesNoTraceInIt) {
    const std::string none = fragment(plugins({}), sky_program());
    EXPECT_EQ(fragment(plugins({{"haze", kAlbedo + "vec3(1); }"}}), sky_program()), none);
    EXPECT_EQ(vertex(plugins({{"haze", kAlbedo + "vec3(1); }"}})), vertex(plugins({})));
}

TEST(Stitch, APluginsVertexHookIsNotInTheFragmentText) {
    const Selection haze({"haze"});
    const Stitched stitched = stitch(Texts(), terrain_program(), haze.input());
    EXPECT_THAT(stitched.vertex.text, HasSubstr("void haze_on_vertex("));
    EXPECT_THAT(stitched.fragment.text, Not(HasSubstr("haze_on_vertex")));
    EXPECT_THAT(stitched.vertex.text, Not(HasSubstr("haze_on_atmosphere")));
    EXPECT_THAT(stitched.fragment.text, Not(HasSubstr("haze_unused")));
}

TEST(Stitch, DerivativesOfALibraryStayOutOfTheVertexText) {
    const Selection wobble({"wobble"});
    const Stitched stitched = stitch(Texts(), terrain_program(), wobble.input());
    EXPECT_THAT(stitched.vertex.text, HasSubstr("float value_noise("));
    EXPECT_THAT(stitched.vertex.text, Not(HasSubstr("dFdx")));
    EXPECT_THAT(stitched.vertex.text, Not(HasSubstr("pixel_size")));
}

TEST(Stitch, AChainCallsEveryProviderInOrder) {
    const std::string text =
        fragment(plugins({{"snow", "void snow_on_albedo(inout Surface s) {}"},
                          {"haze", "void haze_on_albedo(inout Surface s) {}"}}));
    EXPECT_THAT(text, HasSubstr("void hook_albedo(inout Surface s) {\n"
                                "    snow_on_albedo(s);\n"
                                "    haze_on_albedo(s);\n"
                                "}\n"));
}

// Core's own function of a chain draws the scene's overlay.
TEST(Stitch, TheOverlayLiesAmongWhatPluginsDraw) {
    const std::string main = R"(
void core_on_material(inout Surface s) {}
void core_on_display(in Surface s, inout vec4 overlay) {}
layout(location = 0) out vec4 colour;
void main() {
    Surface s;
    hook_material(s);
    hook_display(s, colour);
}
)";
    const Written written =
        plugins({{"photo",
                  "void photo_on_material(inout Surface s) {}\n"
                  "void photo_on_display(in Surface s, inout vec4 o) {}"},
                 {"track", "void track_on_display(in Surface s, inout vec4 o) {}"}});
    const auto calls = [&](std::optional<std::vector<std::string>> over) {
        StitchInput input = written.input();
        input.lit_overlay_is_over_all = !over || over->empty();
        input.over_overlay = std::move(over);
        const std::string text =
            stitch(core_with({{"terrain.frag.glsl", main}}), terrain_program(), input)
                .fragment.text;
        std::string order;
        for (std::size_t at = text.find("hook_material("); at < text.size(); ++at)
            for (const char* name :
                 {"core_on_material(s)", "photo_on_material(s)", "core_on_display(s,",
                  "photo_on_display(s,", "track_on_display(s,"})
                if (text.compare(at, std::strlen(name), name) == 0)
                    order += std::string(name, std::strchr(name, '_')) +
                             (std::strstr(name, "material") ? "/" : " ");
        return order;
    };
    EXPECT_EQ(calls(std::nullopt), "photo/core/core photo track ");
    EXPECT_EQ(calls(std::vector<std::string>{"photo"}), "core/photo/core photo track ");
    EXPECT_EQ(calls(std::vector<std::string>{"track"}), "photo/core/photo core track ");
    EXPECT_EQ(calls(std::vector<std::string>{}), "photo/core/photo track core ");
}

TEST(Stitch, AnExclusiveHookCallsItsProviderInsteadOfTheDefault) {
    const Written written = plugins({{"haze", "void haze_on_tonemap(inout vec3 c) { c *= 0.5; }"}});
    const std::string text = fragment(written, post_program());
    EXPECT_THAT(text, HasSubstr("    haze_on_tonemap(colour);\n"));
    EXPECT_THAT(text, Not(HasSubstr("core_on_tonemap")));
    EXPECT_THAT(fragment(plugins({}), post_program()), HasSubstr("    core_on_tonemap(colour);\n"));
}

TEST(Stitch, AProviderMayBuildOnTheDefault) {
    const std::string text =
        fragment(plugins({{"soft",
                           "vec3 soft_on_brdf(in Surface s, in vec3 l, in vec3 v) { return "
                           "core_on_brdf(s, l, v); }"}}));
    EXPECT_THAT(text, HasSubstr("vec3 core_on_brdf("));
    EXPECT_THAT(text, HasSubstr("    return soft_on_brdf(s, to_sun, to_eye);\n"));
}

TEST(Stitch, AServiceHasItsPrototypeBeforeAllSnippets) {
    const Selection both({"sky", "haze"});
    const std::string text = stitch(Texts(), terrain_program(), both.input()).fragment.text;
    const std::size_t prototype =
        text.find("vec3 background_radiance(in vec3 direction, in bool with_disc);");
    ASSERT_NE(prototype, std::string::npos);
    EXPECT_LT(prototype, text.find("sky_colour"));
    EXPECT_THAT(text, HasSubstr("vec3 background_radiance(in vec3 direction, in bool with_disc) {\n"
                                "    return sky_on_background_radiance(direction, with_disc);\n"));
}

TEST(Stitch, AServiceNobodyCallsIsAbsent) {
    const Selection sky({"sky"});
    const Stitched stitched = stitch(Texts(), terrain_program(), sky.input());
    EXPECT_THAT(stitched.fragment.text, Not(HasSubstr("sky_")));
    EXPECT_THAT(stitched.fragment.text, Not(HasSubstr("background_radiance")));
    for (const TextureUnit& unit : stitched.textures)
        EXPECT_NE(unit.owner, "sky");
}

TEST(Stitch, AVertexSideMayCallAService) {
    const Written written =
        plugins({{"haze",
                  "out vec3 haze_air;\n"
                  "void haze_on_vertex(in VertexFrame v) { haze_air = "
                  "background_radiance(v.up, false); }\n"
                  "void haze_on_lit(in Surface s, inout vec3 r) { r += haze_air; }\n"}});
    EXPECT_THAT(vertex(written), HasSubstr("vec3 core_on_background_radiance("));
}

TEST(Stitch, CoresLibraryMayCallHooks) {
    const Texts texts = core_with({{"lib/shade.glsl",
                                    "vec3 shade(in Surface s) { hook_lit(s, s.diffuse); "
                                    "return s.diffuse; }"},
                                   {"terrain.frag.glsl",
                                    "//@ include lib/shade.glsl\nlayout(location = 0) out vec3 c;\n"
                                    "void main() { Surface s; c = shade(s); }"}});
    const std::string text = stitch(texts, terrain_program(), {}).fragment.text;
    const std::size_t prototype = text.find("void hook_lit(in Surface s, inout vec3 radiance);");
    ASSERT_NE(prototype, std::string::npos);
    EXPECT_LT(prototype, text.find("vec3 shade("));
}

TEST(Stitch, ALibraryIsThereOnceBeforeItsUsers) {
    const Selection both({"ground", "wobble"});
    const std::string text = stitch(Texts(), terrain_program(), both.input()).fragment.text;
    const std::size_t math = text.find("// core: lib/math.glsl");
    const std::size_t noise = text.find("// core: lib/noise.glsl");
    ASSERT_NE(math, std::string::npos);
    EXPECT_LT(math, noise);
    EXPECT_LT(noise, text.find("// ground: ground.glsl"));
    EXPECT_EQ(text.find("float hash(vec2 p)"), text.rfind("float hash(vec2 p)"));
}

TEST(Stitch, MacrosEndWithTheirPlugin) {
    const std::string text = fragment(plugins(
        {{"haze", "#define haze_A 1.0\n#define haze_B 2.0\n" + kAlbedo + "vec3(haze_A); }"}}));
    EXPECT_THAT(text, HasSubstr("#define haze_A 1.0\n"));
    EXPECT_THAT(text, HasSubstr("#undef haze_A\n"));
    EXPECT_THAT(text, Not(HasSubstr("haze_B")));
}

TEST(Stitch, APluginOfTwoFilesIsOnePlugin) {
    const Written written =
        plugins({{"haze", "#define haze_A 1.0\nfloat haze_f() { return haze_A; }"},
                 {"haze", kAlbedo + "vec3(haze_f() * haze_A); }"}});
    const std::string text = fragment(written);
    EXPECT_LT(text.find("float haze_f()"), text.find("void haze_on_albedo("));
    EXPECT_LT(text.find("void haze_on_albedo("), text.find("#undef haze_A"));
}

TEST(Stitch, OverloadsAndPrototypesStayTogether) {
    const std::string text = fragment(
        plugins({{"haze", "float haze_f(vec2 x);\n" + kAlbedo + "vec3(haze_f(vec2(1))); }\n" +
                              "float haze_f(float x) { return x; }\n"
                              "float haze_f(vec2 x) { return haze_f(x.x); }\n"}}));
    EXPECT_THAT(text, HasSubstr("float haze_f(vec2 x);"));
    EXPECT_THAT(text, HasSubstr("float haze_f(float x) {"));
}

TEST(Stitch, WhatOnlyADeadBranchCallsIsAbsent) {
    const std::string plugin =
        "float haze_far() { return 1.0; }\nfloat haze_near() { return 2.0; }\n" +
        std::string(
            "void haze_on_albedo(inout Surface s) {\n#if HAS_sky\n    s.diffuse *= haze_far();\n"
            "#else\n    s.diffuse *= haze_near();\n#endif\n}\n");
    const Written written = plugins({{"haze", plugin}});
    StitchInput input = written.input();
    std::string text = stitch(Texts(), terrain_program(), input).fragment.text;
    EXPECT_THAT(text, HasSubstr("#define HAS_sky 0\n"));
    EXPECT_THAT(text, HasSubstr("float haze_near()"));
    EXPECT_THAT(text, Not(HasSubstr("float haze_far()")));
    input.capabilities = {"sky"};
    text = stitch(Texts(), terrain_program(), input).fragment.text;
    EXPECT_THAT(text, HasSubstr("#define HAS_sky 1\n"));
    EXPECT_THAT(text, HasSubstr("float haze_far()"));
    EXPECT_THAT(text, Not(HasSubstr("float haze_near()")));
}

TEST(Stitch, HasMacrosAreThereOnlyWhereTheyAreAsked) {
    const Selection haze({"haze"});
    const Stitched stitched = stitch(Texts(), terrain_program(), haze.input());
    EXPECT_THAT(stitched.fragment.text, HasSubstr("#define HAS_sky 0\n"));
    EXPECT_THAT(stitched.vertex.text, Not(HasSubstr("HAS_")));
}

TEST(Stitch, ABranchOnlyTheDriverCanDecideStaysWhole) {
    const std::string text = fragment(plugins(
        {{"haze",
          "#ifdef GL_ARB_gpu_shader5\n#if GL_ARB_gpu_shader5 > 1\n"
          "float haze_f() { return 1.0; }\n#endif\n#else\n"
          "float haze_f() { return 2.0; }\n#endif\n#ifdef GL_other\nfloat haze_g;\n#endif\n" +
              kAlbedo + "vec3(haze_f()); }"}}));
    EXPECT_THAT(text, HasSubstr("#ifdef GL_ARB_gpu_shader5\n#if GL_ARB_gpu_shader5 > 1\n"
                                "float haze_f() { return 1.0; }\n#endif\n#else\n"
                                "float haze_f() { return 2.0; }\n#endif\n"));
    EXPECT_THAT(text, Not(HasSubstr("GL_other")));
}

TEST(Stitch, ACommentGoesWithThePieceRightUnderIt) {
    const std::string text =
        fragment(plugins({{"haze",
                           "// about the file\n\n// never\nfloat haze_f() { return 1.0; }\n"
                           "// above\n/* of two\n   lines */ // and behind\n" +
                               kAlbedo + "vec3(1); }  // beside\n// below\n"}}));
    EXPECT_THAT(text,
                HasSubstr("// above\n/* of two\n   lines */ // and behind\nvoid haze_on_albedo"));
    EXPECT_THAT(text, HasSubstr("}  // beside\n"));
    for (const char* absent : {"about the file", "never", "below"})
        EXPECT_THAT(text, Not(HasSubstr(absent)));
}

TEST(Stitch, ALocalVariableDoesNotPullInAGlobalOfItsName) {
    const Written written =
        plugins({{"haze", "//@ include lib/noise.glsl\n" + kAlbedo +
                              "vec3(1); float hash = 1.0; s.shininess = hash; }"}});
    EXPECT_THAT(fragment(written), Not(HasSubstr("float hash(vec2 p)")));
}

// ---- order and equality

TEST(Stitch, EqualInputGivesEqualBytes) {
    const Selection one({"ground", "bump", "sky", "haze"});
    const Selection two({"ground", "bump", "sky", "haze"});
    EXPECT_EQ(stitch(Texts(), terrain_program(), one.input()).fragment.text,
              stitch(Texts(), terrain_program(), two.input()).fragment.text);
}

TEST(Stitch, NoPathOfAFileIsInTheText) {
    const Snippet snippet =
        parse_snippet("haze", "/home/me/plugins/haze/haze.glsl", kAlbedo + "vec3(1); }");
    StitchInput input;
    input.snippets = {&snippet};
    const Stitched stitched = stitch(Texts(), terrain_program(), input);
    EXPECT_THAT(stitched.fragment.text, HasSubstr("// haze: haze.glsl\n"));
    EXPECT_THAT(stitched.fragment.text, Not(HasSubstr("/home/me")));
    const bool mapped = std::any_of(
        stitched.fragment.lines.begin(), stitched.fragment.lines.end(),
        [](const LineOrigin& origin) { return origin.file == "/home/me/plugins/haze/haze.glsl"; });
    EXPECT_TRUE(mapped);
}

TEST(Stitch, CoresOwnTextDoesNotMoveWithThePlugins) {
    const Selection all({"ground", "bump", "sky", "haze", "wobble", "filmic"});
    const auto main_of = [](const std::string& text) {
        return text.substr(text.find("void main()"));
    };
    EXPECT_EQ(main_of(stitch(Texts(), terrain_program(), all.input()).fragment.text),
              main_of(fragment(plugins({}))));
}

// ---- the line map

TEST(LineMap, LeadsEveryLineOfAPluginToItsFile) {
    const Selection all({"ground", "bump", "sky", "haze", "wobble", "filmic"});
    std::map<std::string, std::vector<std::string>> files;
    for (const Snippet& snippet : all.snippets)
        files[snippet.file] = lines_of(snippet.source.text);
    int verbatim = 0;
    for (const ProgramRecipe& program : {terrain_program(), depth_program(), sky_program()}) {
        const Stitched stitched = stitch(Texts(), program, all.input());
        for (const StageText* stage : {&stitched.vertex, &stitched.fragment}) {
            const std::vector<std::string> lines = lines_of(stage->text);
            for (std::size_t i = 0; i < stage->lines.size(); ++i) {
                const LineOrigin& from = stage->lines[i];
                if (files.count(from.file) == 0) continue;
                const std::string& original =
                    files[from.file][static_cast<std::size_t>(from.line - 1)];
                const bool lifted = original.find("uniform") != std::string::npos ||
                                    original.substr(0, 4) == "out " ||
                                    original.substr(0, 4) == "flat";
                if (lifted) continue;
                EXPECT_EQ(lines[i], original) << from.file << ':' << from.line;
                ++verbatim;
            }
        }
    }
    EXPECT_GT(verbatim, 60);
}

TEST(LineMap, PiecesOfOneLineKeepTheirColumns) {
    const std::string line = "float haze_a() { return 1.0; } float haze_b() { return 2.0; }";
    const Written written = plugins({{"haze", line + '\n' + kAlbedo + "vec3(haze_b()); }"}});
    EXPECT_THAT(fragment(written), HasSubstr('\n' + std::string(line.find("float haze_b"), ' ') +
                                             "float haze_b() { return 2.0; }\n"));
}

TEST(LineMap, DeclarationsThatAreLiftedKeepTheirLine) {
    const Selection haze({"haze"});
    const Stitched stitched = stitch(Texts(), terrain_program(), haze.input());
    const std::vector<std::string> lines = lines_of(stitched.fragment.text);
    const auto at = std::find(lines.begin(), lines.end(), "    float haze_density;");
    ASSERT_NE(at, lines.end());
    const LineOrigin& from = stitched.fragment.lines[static_cast<std::size_t>(at - lines.begin())];
    EXPECT_EQ(from.owner, "haze");
    EXPECT_EQ(from.line, 4);
}

// ---- parameters

TEST(Params, TheBlockIsTheSameForAllProgramsOfASelection) {
    const Selection all({"ground", "bump", "sky", "haze", "wobble", "filmic"});
    const Stitched terrain = stitch(Texts(), terrain_program(), all.input());
    const Stitched depth = stitch(Texts(), depth_program(), all.input());
    const Stitched post = stitch(Texts(), post_program(), all.input());
    EXPECT_EQ(terrain.params, depth.params);
    EXPECT_EQ(terrain.params, post.params);
    EXPECT_TRUE(terrain.uses_params);
    EXPECT_TRUE(depth.uses_params);
    EXPECT_FALSE(post.uses_params);
    EXPECT_THAT(post.fragment.text, Not(HasSubstr("uniform Params")));
}

TEST(Params, StaticOnesAreConstantsOfTheirValue) {
    const Selection haze({"haze"});
    StitchInput input = haze.input();
    EXPECT_THAT(stitch(Texts(), terrain_program(), input).vertex.text,
                HasSubstr("const int haze_steps = 4;\n"));
    ParamStore values;
    values.declare(haze.snippets[0].source.params);
    values.set("haze.steps", "16");
    input.values = &values;
    const Stitched stitched = stitch(Texts(), terrain_program(), input);
    EXPECT_THAT(stitched.vertex.text, HasSubstr("const int haze_steps = 16;\n"));
    for (const BlockMember& member : stitched.params.members)
        EXPECT_NE(member.param.name, "haze_steps");
}

TEST(Params, AllAreConstantsWhereThatIsAskedForButWhatModulesWrite) {
    const Written haze =
        plugins({{"haze",
                  "uniform float haze_density = 1.5; //@ range(0, 2)\n"
                  "uniform float haze_turn = 180; //@ angle range(-180, 180)\n"
                  "uniform float haze_none = 0; //@ range(-1, 1)\n"
                  "uniform float haze_wind = 1; //@ host\n"
                  "void haze_on_atmosphere(in Surface s, in vec3 view, inout vec3 radiance) {\n"
                  "    radiance *= haze_density * haze_turn + haze_wind / haze_none;\n}\n"}});
    StitchInput input = haze.input();
    input.constants = true;
    const Stitched stitched = stitch(Texts(), terrain_program(), input);
    EXPECT_THAT(stitched.fragment.text, HasSubstr("const float haze_density = 1.5;\n"));
    EXPECT_THAT(stitched.fragment.text, HasSubstr("const float haze_turn = 3.14159"));
    // What would be divided by is no constant.
    EXPECT_THAT(stitched.fragment.text, HasSubstr("    float haze_none;\n    float haze_wind;\n"));
    EXPECT_EQ(stitched.params.members.size(), 2u);
}

TEST(Params, CoresOwnAreASnippetWithoutHooks) {
    const Texts texts =
        core_with({{"terrain.frag.glsl",
                    "layout(location = 0) out vec4 c;\nvoid main() { c = vec4(terrain_gain); }"}});
    const Written written =
        plugins({{"terrain", "uniform float terrain_gain = 1.0; //@ range(0, 2)"}, {"haze", ""}});
    const Stitched stitched = stitch(texts, terrain_program(), written.input());
    EXPECT_THAT(stitched.fragment.text, HasSubstr("    float terrain_gain;\n"));
    EXPECT_THAT(stitched.fragment.text, Not(HasSubstr("// terrain")));
}

// ---- varyings

TEST(Varyings, AreDeclaredOnBothSides) {
    const Selection haze({"haze"});
    const Stitched stitched = stitch(Texts(), terrain_program(), haze.input());
    EXPECT_THAT(stitched.vertex.text, HasSubstr("out float haze_strength;\n"));
    EXPECT_THAT(stitched.fragment.text, HasSubstr("in float haze_strength;\n"));
}

TEST(Varyings, AreZeroBeforeTheirPluginFillsThem) {
    const Selection haze({"haze"});
    EXPECT_THAT(stitch(Texts(), terrain_program(), haze.input()).vertex.text,
                HasSubstr("void hook_vertex(in VertexFrame v) {\n"
                          "    haze_strength = 0.0;\n"
                          "    haze_on_vertex(v);\n"
                          "}\n"));
}

TEST(Varyings, WrittenButNotReadAreNoOutputs) {
    const Selection haze({"haze"});
    const Stitched stitched = stitch(Texts(), terrain_program(), haze.input());
    EXPECT_THAT(stitched.vertex.text, HasSubstr("\nivec2 haze_cell;\n"));
    EXPECT_THAT(stitched.vertex.text, HasSubstr("\nvec3 ground_up;\n"));
    EXPECT_THAT(stitched.fragment.text, Not(HasSubstr("haze_cell")));
}

TEST(Varyings, AVertexHookThatNobodyReadsIsNotCalled) {
    // The depth pass calls no vertex hook at all; this program does, but only its sky is drawn.
    const Texts texts = core_with({{"terrain.frag.glsl",
                                    "layout(location = 0) out vec4 c;\nvoid main() { c = "
                                    "vec4(1.0); }"}});
    const Selection haze({"haze"});
    const Stitched stitched = stitch(texts, terrain_program(), haze.input());
    EXPECT_THAT(stitched.vertex.text, HasSubstr("void hook_vertex(in VertexFrame v) {\n}\n"));
    EXPECT_THAT(stitched.vertex.text, Not(HasSubstr("haze_")));
}

TEST(Varyings, OfADeferredProgramAreStoredAndLoaded) {
    const Selection haze({"haze"});
    const Stitched geometry = stitch(Texts(), geometry_program(), haze.input());
    const Stitched shading = stitch(Texts(), shading_program(), haze.input());
    EXPECT_EQ(geometry.varying_targets, 1);
    EXPECT_EQ(shading.varying_targets, 1);
    EXPECT_THAT(geometry.fragment.text, HasSubstr("layout(location = 1) out vec4 stored_0;\n"));
    EXPECT_THAT(geometry.fragment.text, HasSubstr("    stored_0.x = float(haze_strength);\n"));
    EXPECT_THAT(geometry.vertex.text, HasSubstr("out float haze_strength;\n"));
    EXPECT_THAT(shading.fragment.text, HasSubstr("\nfloat haze_strength;\n"));
    EXPECT_THAT(shading.fragment.text, HasSubstr("    haze_strength = float(stored_0.x);\n"));
    EXPECT_EQ(shading.textures.back().name, "varyings");
}

TEST(Varyings, OfADeferredProgramThatNobodyReadsNeedNoTarget) {
    const Stitched geometry = stitch(Texts(), geometry_program(), {});
    const Stitched shading = stitch(Texts(), shading_program(), {});
    EXPECT_EQ(geometry.varying_targets, 0);
    EXPECT_EQ(shading.varying_targets, 0);
    EXPECT_THAT(geometry.fragment.text, HasSubstr("void store_varyings() {\n}\n"));
    EXPECT_THAT(shading.fragment.text, HasSubstr("void load_varyings(in ivec2 pixel) {\n}\n"));
}

// Declares `types`, fills and reads them all.
Written many_varyings(const std::vector<std::string>& types) {
    std::string declared, filled, read;
    for (std::size_t i = 0; i < types.size(); ++i) {
        const std::string name = "haze_v" + std::to_string(i);
        const bool whole = types[i] == "int" || types[i] == "uint";
        declared += std::string(whole ? "flat " : "") + "out " + types[i] + ' ' + name + ";\n";
        filled += name + " = " + types[i] + "(1); ";
        read += "r += vec3(" + name + (whole || types[i] == "float" ? "" : ".x") + "); ";
    }
    return plugins(
        {{"haze", declared + "void haze_on_vertex(in VertexFrame v) { " + filled +
                      "}\nvoid haze_on_atmosphere(in Surface s, in vec3 view, inout vec3 "
                      "r) { " +
                      read + "}\n"}});
}

TEST(Varyings, OfADeferredProgramFillTargetsWithoutGaps) {
    const Written written = many_varyings({"vec3", "vec2", "float", "int", "vec2"});
    const Stitched geometry = stitch(Texts(), geometry_program(), written.input());
    const Stitched shading = stitch(Texts(), shading_program(), written.input());
    EXPECT_EQ(geometry.varying_targets, 3);
    for (const char* line : {"stored_0.xyz = vec3(haze_v0);", "stored_1.xy = vec2(haze_v1);",
                             "stored_0.w = float(haze_v2);", "stored_1.z = float(haze_v3);",
                             "stored_2.xy = vec2(haze_v4);"})
        EXPECT_THAT(geometry.fragment.text, HasSubstr(line));
    EXPECT_THAT(shading.fragment.text, HasSubstr("    haze_v3 = int(stored_1.z);\n"));
}

TEST(Varyings, OfADeferredProgramHaveALimit) {
    EXPECT_EQ(stitch_error(many_varyings(std::vector<std::string>(8, "vec4")), geometry_program()),
              "exit 1: shader: terrain.vert.glsl + geometry.frag.glsl: expected varyings that "
              "fit into 7 textures of 4 floats but got 8; switch a plugin off (floats: haze 32)");
    EXPECT_EQ(stitch_error(plugins({{"haze",
                                     "\nout mat3 haze_m;\nvoid haze_on_vertex(in VertexFrame v) { "
                                     "haze_m = mat3(1.0); }\nvoid haze_on_atmosphere(in Surface s, "
                                     "in vec3 view, inout vec3 r) { r = haze_m * r; }\n"}}),
                           geometry_program()),
              "exit 3: shader: haze.glsl:2: haze_m: expected a varying of type float, int, "
              "uint, vec2, vec3 or vec4 but got mat3");
}

// ---- texture units

TEST(TextureUnits, AreCoresThenSharedThenThePlugins) {
    const Selection selection({"ground", "bump"});
    const Stitched stitched = stitch(Texts(), terrain_program(), selection.input());
    std::vector<std::string> units;
    for (const TextureUnit& unit : stitched.textures)
        units.push_back(std::to_string(unit.unit) + ' ' + unit.name + ' ' + unit.type + ' ' +
                        unit.resource + ' ' + unit.owner);
    EXPECT_THAT(units, ElementsAre("0 elevation_m sampler2D elevation_m core",
                                   "1 ground_noise sampler3D ground.noise ground",
                                   "2 ground_layers sampler2DArray ground.layers ground",
                                   "3 bump_normals sampler2DArray bump.normals bump"));
}

TEST(TextureUnits, ATextureThatTwoPluginsReadHasOne) {
    const Selection selection({"ground", "bump"});
    const std::string text = stitch(Texts(), terrain_program(), selection.input()).fragment.text;
    EXPECT_THAT(text, HasSubstr("layout(binding = 1) uniform sampler3D ground_noise;\n"
                                "#define bump_grain ground_noise\n"));
}

TEST(TextureUnits, OnlyReachableSamplersHaveOne) {
    const Written written =
        plugins({{"haze", "uniform sampler2D haze_never;\n" + kAlbedo + "vec3(1); }"}});
    EXPECT_THAT(stitch(Texts(), sky_program(), written.input()).textures, IsEmpty());
    EXPECT_THAT(fragment(written), Not(HasSubstr("haze_never")));
}

TEST(TextureUnits, BothSidesOfAProgramAgree) {
    const Written written =
        plugins({{"haze",
                  "uniform sampler2D haze_a;\nuniform sampler2D haze_b;\n"
                  "void haze_on_displace(in VertexFrame v, inout vec3 p) { p += "
                  "texture(haze_b, p.xy).xyz; }\n" +
                      kAlbedo +
                      "texture(haze_a, vec2(0)).rgb + texture(haze_b, "
                      "vec2(0)).rgb; }"}});
    const Stitched stitched = stitch(Texts(), terrain_program(), written.input());
    EXPECT_THAT(stitched.vertex.text, HasSubstr("layout(binding = 2) uniform sampler2D haze_b;"));
    EXPECT_THAT(stitched.vertex.text, Not(HasSubstr("haze_a")));
    EXPECT_THAT(stitched.fragment.text, HasSubstr("layout(binding = 1) uniform sampler2D haze_a;"));
    EXPECT_THAT(stitched.fragment.text, HasSubstr("layout(binding = 2) uniform sampler2D haze_b;"));
}

TEST(TextureUnits, TooManyAreListedWithTheirPlugins) {
    const Selection selection({"ground", "bump"});
    StitchInput input = selection.input();
    input.max_texture_units = 4;
    EXPECT_NO_THROW(stitch(Texts(), terrain_program(), input));
    input.max_texture_units = 3;
    EXPECT_EQ(error_of([&] { stitch(Texts(), terrain_program(), input); }),
              "exit 1: shader: terrain.vert.glsl + terrain.frag.glsl: expected at most 3 "
              "textures, as many as this device has units, but got 4; switch a plugin off:\n"
              "  unit 0: elevation_m of core\n"
              "  unit 1: ground.noise of ground\n"
              "  unit 2: ground.layers of ground\n"
              "  unit 3: bump.normals of bump");
}

TEST(TextureUnits, TexturesThatHoldTheSameShareOne) {
    const Written written =
        plugins({{"bump",
                  "uniform sampler2D bump_rock;\n"
                  "void bump_on_albedo(inout Surface s) { s.diffuse = "
                  "texture(bump_rock, vec2(0)).rgb; }"},
                 {"haze", "uniform sampler2D haze_a;\nuniform sampler2D haze_rock;\n" + kAlbedo +
                              "texture(haze_rock, texture(haze_a, vec2(0)).xy).rgb; }"}});
    StitchInput input = written.input();
    EXPECT_THAT(stitch(Texts(), terrain_program(), input).textures, testing::SizeIs(4));
    input.same_textures = {{"haze.rock", "bump.rock"}};
    const Stitched stitched = stitch(Texts(), terrain_program(), input);
    ASSERT_THAT(stitched.textures, testing::SizeIs(3));
    EXPECT_EQ(stitched.textures[1].resource, "bump.rock");
    EXPECT_THAT(stitched.textures[1].also, ElementsAre("haze.rock"));
    EXPECT_THAT(stitched.fragment.text,
                HasSubstr("layout(binding = 1) uniform sampler2D bump_rock;\n"
                          "#define haze_rock bump_rock\n"));
    input.max_texture_units = 2;
    EXPECT_THAT(error_of([&] { stitch(Texts(), terrain_program(), input); }),
                HasSubstr("\n  unit 1: bump.rock of bump, also haze.rock\n"));
}

// ---- hooks in use

TEST(HookUse, SaysWhoAnswers) {
    const Selection selection({"wobble", "haze"});
    std::vector<std::string> uses;
    for (const HookUse& use : stitch(Texts(), depth_program(), selection.input()).hooks) {
        uses.emplace_back(use.hook->name);
        uses.insert(uses.end(), use.providers.begin(), use.providers.end());
    }
    EXPECT_THAT(uses, ElementsAre("displace", "wobble"));
}

// ---- what is refused

struct Bad {
    const char* name;
    std::vector<std::pair<std::string, std::string>> snippets;
    ProgramRecipe program;
    const char* message;
};

class StitchError : public testing::TestWithParam<Bad> {};

TEST_P(StitchError, NamesFileAndLine) {
    EXPECT_EQ(stitch_error(plugins(GetParam().snippets), GetParam().program), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    All, StitchError,
    testing::Values(
        Bad{"TwoProviders",
            {{"haze", "void haze_on_tonemap(inout vec3 c) {}"},
             {"snow", "void snow_on_tonemap(inout vec3 c) {}"}},
            post_program(),
            "exit 3: shader: tonemap: expected one provider of this exclusive hook but got "
            "haze and snow"},
        Bad{"AnotherPluginsFunction",
            {{"haze", "\nvoid haze_on_albedo(inout Surface s) { snow_f(); }"},
             {"snow", "void snow_f() {}"}},
            terrain_program(),
            "exit 3: shader: haze.glsl:2: haze_on_albedo uses snow_f, which is the plugin "
            "snow's; a plugin uses only itself, core and services"},
        Bad{"AnotherPluginsParameter",
            {{"haze", "void haze_on_albedo(inout Surface s) { s.diffuse *= snow_a; }"},
             {"snow", "uniform float snow_a = 1.0; //@ range(0, 1)"}},
            terrain_program(),
            "exit 3: shader: haze.glsl:1: haze_on_albedo uses snow_a, which is the plugin "
            "snow's; a plugin uses only itself, core and services"},
        Bad{"LibraryNotAskedFor",
            {{"snow", "//@ include lib/noise.glsl\n"},
             {"haze", "void haze_on_albedo(inout Surface s) { s.diffuse *= hash(vec2(1)); }"}},
            terrain_program(),
            "exit 3: shader: haze.glsl:1: haze_on_albedo uses hash of lib/noise.glsl; add "
            "//@ include lib/noise.glsl"},
        Bad{"MainsFunction",
            {{"haze",
              "void haze_on_displace(in VertexFrame v, inout vec3 p) { p = frame_at(p.xy).up; "
              "}"}},
            terrain_program(),
            "exit 3: shader: haze.glsl:1: haze_on_displace uses frame_at, which is "
            "terrain.vert.glsl's own; a plugin uses only itself, shaders/lib and services"},
        Bad{"NoSuchLibrary",
            {{"haze", "\n//@ include lib/nose.glsl"}},
            terrain_program(),
            "exit 3: shader: haze.glsl:2: lib/nose.glsl: core has no such file"},
        Bad{"Recursion",
            {{"haze",
              "float haze_a(float x);\nfloat haze_b(float x) { return haze_a(x); }\n"
              "float haze_a(float x) { return haze_b(x); }\n"
              "void haze_on_albedo(inout Surface s) { s.shininess = haze_a(1.0); }"}},
            terrain_program(),
            "exit 3: shader: haze.glsl:3: haze_a calls itself (haze_a -> haze_b -> "
            "haze_a); "
            "GLSL has no recursion"},
        Bad{"RecursionThroughAService",
            {{"haze",
              "vec3 haze_on_background_radiance(in vec3 d, in bool disc) { return "
              "background_radiance(d, false); }"}},
            sky_program(),
            "exit 3: shader: haze.glsl:1: haze_on_background_radiance calls itself "
            "(background_radiance -> haze_on_background_radiance -> background_radiance); GLSL has "
            "no recursion"},
        Bad{"DerivativeInTheVertexSide",
            {{"haze",
              "\nfloat haze_width(vec3 p) { return fwidth(p.x); }\n"
              "void haze_on_displace(in VertexFrame v, inout vec3 p) { p *= haze_width(p); "
              "}"}},
            terrain_program(),
            "exit 3: shader: haze.glsl:2: haze_width uses fwidth, which only the fragment "
            "stage has, but the vertex stage reaches it (main -> hook_displace -> "
            "haze_on_displace)"},
        Bad{"VertexIdInTheFragmentSide",
            {{"haze", "void haze_on_albedo(inout Surface s) { s.diffuse *= float(gl_VertexID); }"}},
            terrain_program(),
            "exit 3: shader: haze.glsl:1: haze_on_albedo uses gl_VertexID, which only the "
            "vertex stage has, but the fragment stage reaches it (main -> hook_albedo)"},
        Bad{"VaryingThatNobodyFills",
            {{"haze",
              "\n\nout float haze_strength;\n"
              "vec3 haze_on_background_radiance(in vec3 d, in bool disc) { return "
              "vec3(haze_strength); }\n"
              "void haze_on_vertex(in VertexFrame v) { haze_strength = 1.0; }"}},
            sky_program(),
            "exit 3: shader: haze.glsl:3: haze_strength: the fragment stage reads it (main "
            "-> background_radiance -> haze_on_background_radiance), but nothing that "
            "fullscreen.vert.glsl calls writes it"},
        Bad{"VaryingInDisplace",
            {{"haze",
              "out float haze_strength;\n"
              "float haze_f() { haze_strength = 1.0; return 1.0; }\n"
              "void haze_on_displace(in VertexFrame v, inout vec3 p) { p *= haze_f(); }\n"
              "void haze_on_lit(in Surface s, inout vec3 r) { r *= haze_strength; }"}},
            terrain_program(),
            "exit 3: shader: haze.glsl:2: haze_f uses the varying haze_strength; varyings "
            "are filled in haze_on_vertex, displace runs in depth passes too"},
        Bad{"SharedTextureOfTwoTypes",
            {{"haze",
              "uniform sampler2D haze_a; //@ from(snow.map)\nvoid haze_on_albedo(inout "
              "Surface s) { s.diffuse = texture(haze_a, vec2(0)).rgb; }"},
             {"snow",
              "\nuniform sampler3D snow_map;\nvoid snow_on_albedo(inout Surface s) { "
              "s.diffuse = texture(snow_map, vec3(0)).rgb; }"}},
            terrain_program(),
            "exit 3: shader: snow.glsl:2: snow_map: expected a sampler2D for the texture "
            "snow.map, as in haze.glsl:1, but got a sampler3D"},
        Bad{"NameOfTwoKinds",
            {{"haze", "uniform bool haze_a = true;"}, {"haze", "\nfloat haze_a() { return 1.0; }"}},
            terrain_program(),
            "exit 3: shader: haze.glsl:2: haze_a is declared already, in haze.glsl:1"},
        Bad{"ParameterOfTwoFiles",
            {{"haze", "uniform bool haze_a = true;"}, {"haze", "\nuniform bool haze_a = true;"}},
            terrain_program(),
            "exit 3: shader: haze.glsl:2: haze_a is declared already, in haze.glsl:1"}),
    [](const auto& test) { return test.param.name; });

struct BadCore {
    const char* name;
    std::map<std::string, std::string> texts;
    const char* message;
};

class CoreError : public testing::TestWithParam<BadCore> {};

TEST_P(CoreError, NamesFileAndLine) {
    EXPECT_EQ(stitch_error(plugins({}), terrain_program(), core_with(GetParam().texts)),
              GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    All, CoreError,
    testing::Values(
        BadCore{"NoMain",
                {{"terrain.frag.glsl", "const float x = 1.0;"}},
                "exit 1: shader: shaders/terrain.frag.glsl: no main()"},
        BadCore{"NoSuchHook",
                {{"terrain.frag.glsl", "\nvoid main() { hook_albdo(); }"}},
                "exit 1: shader: shaders/terrain.frag.glsl:2: hook_albdo: there is no such "
                "hook"},
        BadCore{"HookOfTheOtherSide",
                {{"terrain.vert.glsl", "void main() { hook_albedo(); }"}},
                "exit 1: shader: shaders/terrain.vert.glsl:1: hook_albedo is called from "
                "the vertex stage, which does not have it"},
        BadCore{"NoDefault",
                {{"defaults.glsl", ""}},
                "exit 1: shader: shaders/defaults.glsl: no core_on_brdf, the default of "
                "the hook brdf"},
        BadCore{"WrongDefault",
                {{"defaults.glsl", "\nvec3 core_on_brdf(in Surface s) { return vec3(0); }"}},
                "exit 1: shader: shaders/defaults.glsl:2: core_on_brdf: wrong signature, "
                "expected vec3 core_on_brdf(in Surface, in vec3, in vec3) but got vec3 "
                "core_on_brdf(in Surface)"},
        BadCore{"VaryingNotWritten",
                {{"terrain.frag.glsl",
                  "in vec2 screen;\nlayout(location = 0) out vec4 c;\nvoid main() { c = "
                  "screen.xyxy; }"}},
                "exit 3: shader: shaders/terrain.frag.glsl:1: screen: the fragment stage reads it "
                "(main), but nothing that terrain.vert.glsl calls writes it"},
        BadCore{"VaryingOfAnotherType",
                {{"terrain.frag.glsl",
                  "in vec2 ground_position_m;\nlayout(location = 0) out vec4 c;\nvoid main() { c = "
                  "ground_position_m.xyxy; }"}},
                "exit 1: shader: shaders/terrain.frag.glsl:1: ground_position_m: expected "
                "vec3 as in shaders/lib/terrain.glsl:3 but got vec2"},
        BadCore{"OutputWithoutLocation",
                {{"terrain.frag.glsl", "out vec4 c;\nvoid main() {}"}},
                "exit 3: shader: shaders/terrain.frag.glsl:1: c: inputs of a vertex main "
                "and outputs of a fragment main have a layout(location = N)"},
        BadCore{"CircleOfIncludes",
                {{"lib/math.glsl", "//@ include lib/noise.glsl"},
                 {"lib/noise.glsl", "//@ include lib/math.glsl"}},
                "exit 1: shader: shaders/lib/noise.glsl:1: lib/math.glsl includes itself"}),
    [](const auto& test) { return test.param.name; });

TEST(CoreErrors, CoreAndAPluginCannotShareAName) {
    EXPECT_EQ(
        stitch_error(plugins({{"haze", "\nfloat haze_f() { return 1.0; }"}}), terrain_program(),
                     core_with({{"lib/math.glsl", "float haze_f() { return 2.0; }"}})),
        "exit 3: shader: haze.glsl:2: haze_f is declared by core too, in "
        "shaders/lib/math.glsl:1");
}

TEST(CoreErrors, AMissingMainIsNamed) {
    EXPECT_EQ(error_of([] {
                  stitch(Texts(), {.vertex_main = "terain.vert.glsl", .fragment_main = "x"}, {});
              }),
              "exit 1: shader: terain.vert.glsl: core has no such shader file");
}

}  // namespace
}  // namespace relevo::shader::test::test_stitch
