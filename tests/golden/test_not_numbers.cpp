// Light that is no number, or infinite: no picture, and the effect's name.

#include <cstdio>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "cli/program.h"
#include "image/image.h"
#include "support/support.h"

namespace relevo::test::test_not_numbers {
namespace {

class NotNumbers : public testing::Test {
  protected:
    void add(const std::string& id, const std::string& glsl, const std::string& members = "") {
        const std::filesystem::path folder = dir_ / "plugins" / id;
        std::filesystem::create_directories(folder);
        std::ofstream(folder / "plugin.json") << fmt::format(
            R"({{"format": 1, "id": "{0}", "name": "{0}", "version": "1"{1}}})", id, members);
        std::ofstream(folder / (id + ".glsl")) << glsl;
    }

    Result take(std::vector<std::string> more, const std::string& name = "a.png") {
        std::filesystem::remove(dir_ / name);
        more.insert(more.begin(),
                    {"-q", "capture", bundled_dem(), "-o", (dir_ / name).string(), "--size",
                     "64x48", "--view", "el=90,zoom=3", "--time", "2026-06-21T18:30-04:00",
                     "--plugin-path", (dir_ / "plugins").string()});
        return relevo(more);
    }

    static std::string message(const std::string& id, int pixels, int of,
                               const std::string& without = "none") {
        return fmt::format(
            "relevo: error: capture: {0}: {1} of {2} pixels are NaN or infinite, {3} without this "
            "effect; fix it (division by 0, root or logarithm of a negative number, normalize of a "
            "zero vector) or use --disable {0}\n",
            id, pixels, of, without);
    }

    std::filesystem::path dir_ = scratch_dir("not_numbers");
};

TEST_F(NotNumbers, OfAnyHookAreAnErrorThatNamesTheEffect) {
    const std::string zero = "uniform float sick_zero = 0.0; //@ range(-1, 1)\n";
    const std::pair<const char*, const char*> hooks[] = {
        {"albedo(inout Surface s)", "s.diffuse = vec3(sqrt(sick_zero - 1.0))"},
        {"normal(inout Surface s)", "s.normal = normalize(vec3(sick_zero))"},
        {"material(inout Surface s)", "s.emissive = vec3(1.0 / sick_zero)"},
        {"facing(in Surface s, in vec3 to_sun, inout float factor)", "factor = 1.0 / sick_zero"},
        {"visibility(in Surface s, in vec3 to_sun, inout float factor)",
         "factor = log(sick_zero - 1.0)"},
        {"ambient(in Surface s, inout vec3 irradiance)", "irradiance.g = -1.0 / sick_zero"},
        {"lit(in Surface s, inout vec3 radiance)", "radiance.b = sqrt(sick_zero - 3.0)"},
        {"atmosphere(in Surface s, in vec3 view, inout vec3 radiance)",
         "radiance *= pow(sick_zero - 2.0, 0.5)"},
        {"display(in Surface s, inout vec4 overlay)", "overlay = vec4(sick_zero / sick_zero)"},
        {"tonemap(inout vec3 colour)", "colour.r = colour.r / sick_zero"},
    };
    for (const auto& [head, body] : hooks) {
        add("sick", fmt::format("{}void sick_on_{} {{ {}; }}\n", zero, head, body));
        const Result run = take({"--only", "sick"});
        EXPECT_EQ(run.status, 1) << head;
        EXPECT_EQ(run.err, message("sick", 64 * 48, 64 * 48)) << head;
        EXPECT_FALSE(std::filesystem::exists(dir_ / "a.png")) << head;
    }
}

TEST_F(NotNumbers, AreCounted) {
    // A hundred pixels of the upper left, also where antialiasing and linear light come behind.
    add("sick",
        "uniform float sick_zero = 0.0; //@ range(-1, 1)\n"
        "void sick_on_lit(in Surface s, inout vec3 radiance) {\n"
        "    if (gl_FragCoord.x < 20.0 && gl_FragCoord.y > 43.0) radiance /= sick_zero;\n"
        "}\n");
    for (const char* name : {"a.png", "a.exr"})
        EXPECT_EQ(take({"--only", "sick"}, name).err, message("sick", 100, 64 * 48)) << name;
    EXPECT_EQ(take({"--only", "", "--ab", "sick"}).err, message("sick", 100, 64 * 48));
    // Behind the air too, whose mixing makes NaN of infinite light.
    if (std::filesystem::exists(source_dir() / "plugins/haze")) {
        EXPECT_EQ(take({"--only", "haze,sick"}).err, message("sick", 100, 64 * 48));
    }
    // What is off makes none.
    EXPECT_EQ(take({"--only", ""}).err, "");
    EXPECT_TRUE(std::filesystem::exists(dir_ / "a.png"));
}

TEST_F(NotNumbers, NameTheMakerAndNotWhatItStandsOn) {
    add("soil", "void soil_on_albedo(inout Surface s) { s.diffuse = vec3(0.4); }\n",
        R"(, "provides": ["soil"])");
    add("sick",
        "uniform float sick_zero = 0.0; //@ range(-1, 1)\n"
        "void sick_on_material(inout Surface s) { s.diffuse /= sick_zero; }\n",
        R"(, "requires": ["soil"], "after": ["soil"])");
    EXPECT_EQ(take({"--only", "soil,sick"}).err, message("sick", 64 * 48, 64 * 48));
    add("worse",
        "uniform float worse_zero = 0.0; //@ range(-1, 1)\n"
        "void worse_on_lit(in Surface s, inout vec3 radiance) {\n"
        "    if (gl_FragCoord.x < 10.0) radiance += vec3(1.0 / worse_zero);\n"
        "}\n");
    EXPECT_EQ(take({"--only", "sick,worse"}).err, message("sick", 64 * 48, 64 * 48, "480"));
    // Also where the comparison alone switches one of them on.
    EXPECT_EQ(take({"--only", "sick,worse", "--disable", "worse", "--ab", "worse"}).err,
              message("sick", 64 * 48, 64 * 48, "480"));
}

TEST_F(NotNumbers, OfPlacesAreSeenToo) {
    // A vertex that is nowhere would take its triangles along: a hole without a word.
    add("sick",
        "uniform float sick_zero = 0.0; //@ range(-1, 1)\n"
        "void sick_on_displace(in VertexFrame v, inout vec3 position_m) {\n"
        "    if (v.ground_m.x > 0.0) position_m *= 1.0 / sick_zero;\n"
        "}\n",
        R"(, "displaces": {"up_m": 1})");
    const Result run = take({"--only", "sick"});
    EXPECT_EQ(run.status, 1);
    // The eastern half, and the triangles that reach into it.
    int pixels = 0;
    ASSERT_EQ(std::sscanf(run.err.c_str(), "relevo: error: capture: sick: %d of", &pixels), 1)
        << run.err;
    EXPECT_NEAR(pixels, 32 * 48, 2 * 48);
    EXPECT_EQ(run.err, message("sick", pixels, 64 * 48));
}

TEST_F(NotNumbers, OfTheSkyAreSeenToo) {
    add("sick",
        "uniform float sick_zero = 0.0; //@ range(-1, 1)\n"
        "vec3 sick_on_background_radiance(in vec3 direction, in bool with_disc) {\n"
        "    return vec3(direction.z / sick_zero);\n"
        "}\n");
    const Result level = relevo({"-q", "capture", bundled_dem(), "-o", (dir_ / "b.png").string(),
                                 "--size", "8x8", "--eye", "36.30,-84.20,9000", "--pitch", "60",
                                 "--only", "sick", "--plugin-path", (dir_ / "plugins").string()});
    EXPECT_EQ(level.status, 1);
    EXPECT_EQ(level.err, message("sick", 64, 64));
}

}  // namespace
}  // namespace relevo::test::test_not_numbers
