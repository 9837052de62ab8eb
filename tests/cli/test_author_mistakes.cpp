// Mistakes of authors of plugins, and the whole message for each.
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/text.h"
#include "cli/program.h"
#include "support/support.h"

namespace relevo::test::test_author_mistakes {
namespace {

using ::testing::ElementsAre;
namespace fs = std::filesystem;

const std::string kGlsl =
    "uniform float dust_amount = 0.5; //@ range(0, 1)\n"
    "float dust_cover(in float height_m) { return dust_amount * height_m; }\n"
    "void dust_on_material(inout Surface s) {\n"
    "    s.diffuse *= dust_cover(s.height_m);\n"
    "}\n";

/// A member of the manifest: a compute pass.
const std::string kSum =
    R"(, "passes": {"sum": {"kind": "compute", "writes": "uints", "count": 4, "local_size": [4]}})";

class AuthorMistakes : public testing::Test {
  protected:
    /// What `relevo plugins check` reports of the plugin dust: a line for each mistake, without the
    /// folder.
    std::vector<std::string> check(const std::string& glsl, const std::string& members = "") {
        const fs::path dust = dir_ / "dust";
        fs::create_directories(dust);
        std::ofstream(dust / "plugin.json")
            << R"({"format": 1, "id": "dust", "name": "Dust", "version": "1")" << members << "}";
        std::ofstream(dust / "dust.glsl") << glsl;
        const Result run = relevo({"plugins", "check", "--device", "software", dust.string()});
        std::string out = run.out;
        const std::string folder = dir_.string() + "/";
        for (std::size_t at; (at = out.find(folder)) != std::string::npos;)
            out.erase(at, folder.size());
        std::vector<std::string> lines = split(out, '\n');
        std::erase_if(lines, [](const std::string& line) {
            return line.empty() || line.starts_with("dust: ");
        });
        const bool error = std::ranges::any_of(
            lines, [](const std::string& line) { return line.starts_with("error: "); });
        EXPECT_EQ(run.status, error ? 1 : 0) << run.err;
        return lines;
    }
    /// The same with another statement in the hook's fourth line.
    std::vector<std::string> check_line(const std::string& statement) {
        std::string glsl = kGlsl;
        const std::string usual = "s.diffuse *= dust_cover(s.height_m);";
        return check(glsl.replace(glsl.find(usual), usual.size(),
                                  usual == statement ? usual : statement + " " + usual));
    }

    fs::path dir_ = scratch_dir();
};

/// It is drawn with each bundled effect, which takes most of the time of these tests: they share
/// one such plugin, and the others have errors alone.
TEST_F(AuthorMistakes, AGoodPluginHasNoErrorsAndWordsAndParametersAreWarnings) {
    EXPECT_THAT(check(kGlsl + "uniform int dust_kind = 0; //@ range(0, 3)\n"
                              "uniform usamplerBuffer dust_sum;\n"
                              "void dust_pass_sum(in Invocation i) { dust_sum_out[0] = 1u; }\n"
                              "void dust_on_lit(in Surface s, inout vec3 radiance) {\n"
                              "    radiance *= float(texelFetch(dust_sum, 0).r);\n"
                              "}\n",
                      kSum + R"(, "after": ["materails"])"),
                ElementsAre("warning: dust/plugin.json:1: after: no installed plugin provides "
                            "\"materails\"; did you mean \"materials\"?",
                            "warning: dust/dust.glsl:6: dust_kind: no hook reads this parameter; "
                            "use it or remove it"));
}

TEST_F(AuthorMistakes, MisspeltNamesAreSuggested) {
    const std::string line = "error: dust/dust.glsl:4: error: ";
    const std::pair<const char*, const char*> cases[] = {
        {"s.diffuse *= s.heigth_m;",
         "cannot access field `heigth_m' of structure; did you mean height_m?"},
        {"s.diffuse *= frame.sun_directoin;",
         "cannot access field `sun_directoin' of structure; did you mean sun_direction?"},
        {"s.diffuse *= clmap(s.height_m, 0.0, 1.0);",
         "no function with name 'clmap'; did you mean clamp?"},
        {"s.diffuse *= dust_cvoer(s.height_m);",
         "no function with name 'dust_cvoer'; did you mean dust_cover?"},
        {"s.diffuse *= dust_amuont;", "`dust_amuont' undeclared; did you mean dust_amount?"},
        {"vec3 x = s.height_m;",
         "initializer of type float cannot be assigned to variable of type vec3; write vec3(x) for "
         "a vector of equal components"},
        {"float h = s.height_m; s.diffuse *= float(h % 1000);",
         "LHS of operator % must be an integer; write mod(a, b) for numbers of type float"},
        {"s.diffuse *= 0.5 s.ambient *= 0.5;",
         "syntax error, unexpected IDENTIFIER, expecting ',' or ';'; is a ; missing before it?"},
        {"Surfce other = s;",
         "syntax error, unexpected NEW_IDENTIFIER, expecting ',' or ';'; is a ; missing before it, "
         "or a type misspelt?"},
        {"s.diffuse *= dust_cover(s.normal);",
         "no matching function for call to `dust_cover(vec3)'"},
        {"float a[dust_amount]; a[0] = 0.0;",
         "array size must be integer type; add static after its //@ to make dust_amount a "
         "constant"},
    };
    for (const auto& [statement, message] : cases)
        EXPECT_THAT(check_line(statement), ElementsAre(line + message)) << statement;
}

TEST_F(AuthorMistakes, AFunctionWithoutItsIncludeIsNamed) {
    EXPECT_THAT(check_line("s.diffuse *= climate_place(s.up).x;"),
                ElementsAre("error: dust/dust.glsl:3: dust_on_material uses climate_place of "
                            "lib/climate.glsl; add //@ include lib/climate.glsl"));
    EXPECT_THAT(check("//@ include lib/climat.glsl\n" + kGlsl),
                ElementsAre("error: dust/dust.glsl:1: lib/climat.glsl: core has no such file; did "
                            "you mean lib/climate.glsl?"));
}

TEST_F(AuthorMistakes, ATextureThatNobodyMakesIsNamed) {
    EXPECT_THAT(check("uniform sampler2D dust_map; //@ from(vsm.momnts)\n"
                      "void dust_on_material(inout Surface s) {\n"
                      "    s.diffuse = s.ambient = textureLod(dust_map, vec2(0.5), 0.0).rgb;\n"
                      "}\n"),
                ElementsAre("error: dust/dust.glsl:1: dust_map: no effect that is on makes the "
                            "texture vsm.momnts; correct //@ from(vsm.momnts)"));
}

TEST_F(AuthorMistakes, AnErrorOfTheLoaderIsOneLine) {
    EXPECT_THAT(check("void dust_on_materail(inout Surface s) {}\n"),
                ElementsAre("error: dust/dust.glsl:1: dust_on_materail: there is no hook materail; "
                            "did you mean dust_on_material?"));
    EXPECT_THAT(check(kGlsl, R"(, "afetr": ["materials"])"),
                ElementsAre("error: dust/plugin.json:1: afetr: no such key; did you mean "
                            "\"after\"?"));
}

TEST_F(AuthorMistakes, LightThatIsNoNumberIsNamedWithHookLineAndPixel) {
    const std::string causes =
        "; usual causes are a division by 0, a root, power or logarithm of a negative number, and "
        "normalize of a zero vector";
    const auto expect = [&](const std::string& statement, const std::string& value) {
        const std::vector<std::string> lines = check_line(statement);
        ASSERT_EQ(lines.size(), 1U) << statement;
        EXPECT_THAT(lines[0], ::testing::StartsWith("error: dust/dust.glsl:4: dust_on_material: " +
                                                    value + " is NaN or infinite in "));
        EXPECT_TRUE(lines[0].ends_with(causes)) << lines[0];
        EXPECT_THAT(lines[0], ::testing::HasSubstr(" of 19200 pixels from outside, the first in "
                                                   "column "));
    };
    expect("s.specular = vec3(sqrt(-s.height_m));", "s.specular");
    expect("s.normal = normalize(s.normal * (dust_amount - 0.5));", "s.normal");
    expect("s.emissive = vec3(1.0 / (dust_amount - 0.5));", "s.emissive");
    EXPECT_THAT(check("uniform float dust_zero = 0.0; //@ range(-1, 1)\n"
                      "void dust_on_albedo(inout Surface s) { s.diffuse *= 0.5; }\n"
                      "void dust_on_lit(in Surface s, inout vec3 radiance) {\n"
                      "    vec3 grey = vec3(0.2);\n"
                      "    radiance.g = grey.x / dust_zero;\n"
                      "}\n"),
                ElementsAre(::testing::StartsWith(
                    "error: dust/dust.glsl:5: dust_on_lit: radiance is NaN or infinite in ")));
}

TEST_F(AuthorMistakes, APassWhoseTexelsAreNoNumbersIsNamed) {
    EXPECT_THAT(check("uniform float dust_zero = 0.0; //@ range(-1, 1)\n"
                      "uniform sampler3D dust_block;\n"
                      "vec4 dust_pass_block(in Voxel v) {\n"
                      "    return vec4(v.at_px, 1.0) / dust_zero;\n"
                      "}\n"
                      "void dust_on_lit(in Surface s, inout vec3 radiance) {\n"
                      "    radiance += textureLod(dust_block, vec3(0.5), 0.0).rgb;\n"
                      "}\n",
                      R"(, "passes": {"block": {"kind": "3d", "size": [4, 4, 4]}})"),
                ElementsAre(::testing::StartsWith("error: dust/dust.glsl:3: dust_pass_block: it "
                                                  "makes light that is NaN or infinite in ")));
}

TEST_F(AuthorMistakes, OfComputePassesEachIsNamed) {
    const std::string reads =
        "uniform usamplerBuffer dust_sum;\n"
        "void dust_on_lit(in Surface s, inout vec3 radiance) {\n"
        "    radiance *= float(texelFetch(dust_sum, 0).r);\n"
        "}\n";
    EXPECT_THAT(check(reads, kSum),
                ElementsAre("error: dust/plugin.json:1: passes.sum: expected one function void "
                            "dust_pass_sum(in Invocation i) in the plugin's GLSL but got 0"));
    EXPECT_THAT(check(reads + "void dust_pass_sum(in Invocation i) {\n"
                              "    dust_sum_out[i.at.x] = i.at;\n"
                              "}\n",
                      kSum),
                ElementsAre(::testing::StartsWith("error: dust/dust.glsl:6: ")));
    EXPECT_THAT(check(reads + "void dust_pass_sum(in Invocation i) {\n"
                              "    imageStore(dust_sum_out, ivec2(0), vec4(1.0));\n"
                              "}\n",
                      kSum),
                ElementsAre(::testing::StartsWith("error: dust/dust.glsl:6: ")));
    EXPECT_THAT(check(reads + "void dust_pass_sum(in Invocation i) {\n"
                              "    while (i.at.x >= 0) dust_sum_out[0] = 1u;\n"
                              "}\n"
                              "buffer Dust { float dust_more[]; };\n",
                      kSum),
                ElementsAre("error: dust/dust.glsl:8: buffer is core's; a plugin declares "
                            "parameters, samplers, varyings, constants, structs and functions"));
}

}  // namespace
}  // namespace relevo::test::test_author_mistakes
