// What plugins do wrong, as whoever runs the program meets it.
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "cli/program.h"
#include "image/image.h"
#include "image/ktx.h"
#include "support/support.h"

namespace relevo::test::test_plugins {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::string kNothing = "void odd_on_albedo(inout Surface s) {}\n";

class Plugins : public testing::Test {
  protected:
    Plugins() { std::filesystem::create_directories(own()); }

    std::filesystem::path own() const { return folder_ / "plugins/odd"; }
    std::string picture() const { return (folder_ / "a.png").string(); }

    void write(const std::string& file, const std::string& text) const {
        std::ofstream(own() / file, std::ios::binary) << text;
    }
    /// The plugin `odd`.
    void make(const std::string& glsl, const std::string& members = "") const {
        write("plugin.json", R"({"format": 1, "id": "odd", "name": "Odd", "version": "1")" +
                                 (members.empty() ? "" : ", " + members) + "}");
        write("odd.glsl", glsl);
    }
    /// One whose module does what the environment says.
    void make_native() const {
        make(kNothing, R"("module": "native")");
        std::filesystem::create_directories(folder_ / "plugins/native");
        std::filesystem::copy(build_dir() / "tests/modules/faulty.so",
                              folder_ / "plugins/native/native.so");
        std::filesystem::remove_all(own());
        std::ofstream(folder_ / "plugins/native/plugin.json")
            << R"({"format": 1, "id": "native", "name": "N", "version": "1", "module": "native"})";
        std::ofstream(folder_ / "plugins/native/native.glsl")
            << "void native_on_albedo(inout Surface s) {}\n";
    }

    Result capture(const std::vector<std::string>& more = {},
                   const std::vector<std::string>& environment = {}) const {
        std::vector<std::string> arguments{
            "-q",
            "capture",
            bundled_dem(),
            "-o",
            picture(),
            "--overwrite",
            "--size",
            "64x48",
            "--disable",
            "block,bump,cover,gloss,haze,layering,shadows,sky,skylight",
            "--plugin-path",
            (folder_ / "plugins").string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        std::filesystem::remove(picture());
        Result result = relevo(arguments, environment);
        // Without the test's own folder.
        const std::string folder = folder_.string() + "/";
        for (std::size_t at; (at = result.err.find(folder)) != std::string::npos;)
            result.err.erase(at, folder.size());
        return result;
    }
    bool drawn() const { return std::filesystem::exists(picture()); }

    std::filesystem::path folder_ = scratch_dir("cli_odd_plugins");
};

TEST_F(Plugins, ABrokenTextureLeavesThePluginOutAndThePictureWhole) {
    make("uniform sampler2DArray odd_map;\n" + kNothing,
         R"("textures": {"map": {"kind": "2d-array", "files": ["a.ktx2", "b.ktx2"],
                                 "encoding": "linear"}})");
    using image::TextureData;
    image::write_ktx(own() / "a.ktx2", TextureData(PixelFormat::R8, 64, 64, 1, 1, 7));
    image::write_ktx(own() / "b.ktx2", TextureData(PixelFormat::R8, 64, 64, 1, 1, 1));
    const std::string reason =
        "plugin: plugins/odd/b.ktx2: expected 64 x 64 texels of 1 bytes in 7 levels as in "
        "plugins/odd/a.ktx2 but got 64 x 64 texels of 1 bytes in 1 levels";
    const Result run = capture();
    EXPECT_EQ(run.status, 0);
    EXPECT_EQ(run.err,
              "relevo: warning: odd is off: " + reason + "; --disable odd silences this\n");
    EXPECT_TRUE(drawn());
    const Result named = capture({"--enable", "odd"});
    EXPECT_EQ(named.status, 3);
    EXPECT_EQ(named.err, "relevo: error: effects: odd: it cannot be switched on: " + reason +
                             "; take it out of --enable\n");
    EXPECT_FALSE(drawn());
    EXPECT_EQ(capture({"--disable", "odd"}).err, "");
}

TEST_F(Plugins, ATextureThatTheDeviceDoesNotTakeLeavesThePluginOut) {
    make("uniform sampler2D odd_map;\n" + kNothing,
         R"("textures": {"map": {"kind": "2d", "file": "a.png", "encoding": "linear"}})");
    image::write(own() / "a.png", image::Image8(32768, 1, 1));
    const Result run = capture();
    EXPECT_EQ(run.status, 0);
    EXPECT_THAT(run.err, StartsWith("relevo: warning: odd is off: plugin: "
                                    "plugins/odd/a.png: expected at most "));
    EXPECT_TRUE(drawn());
    EXPECT_EQ(capture({"--only", "odd"}).status, 3);
    EXPECT_FALSE(drawn());
}

TEST_F(Plugins, WhatTheDriverRefusesIsNamedWithItsLineAndHowToGoOn) {
    make("void odd_on_albedo(inout Surface s) {\n    s.diffuse = odd_nowhere;\n}\n");
    const std::filesystem::path dump = folder_ / "dump";
    const Result run = capture({"--dump-shaders", dump.string()});
    EXPECT_EQ(run.status, 1);
    EXPECT_THAT(run.err, StartsWith("relevo: error: render: program terrain: fragment side: the "
                                    "driver refuses it\nplugins/odd/odd.glsl:2: error: "));
    EXPECT_TRUE(run.err.ends_with("\n--disable odd goes on without it\n")) << run.err;
    EXPECT_FALSE(drawn());
    EXPECT_GT(std::filesystem::file_size(dump / "terrain.frag.glsl"), 0u);
    EXPECT_GT(std::filesystem::file_size(dump / "background.vert.glsl"), 0u);
}

TEST_F(Plugins, WhatTheStitcherRefusesSaysHowToGoOn) {
    make("void odd_on_albedo(inout Surface s) { s.diffuse *= float(gl_VertexID); }\n");
    const Result run = capture();
    EXPECT_EQ(run.status, 3);
    EXPECT_THAT(run.err, StartsWith("relevo: error: shader: plugins/odd/odd.glsl:1: "));
    EXPECT_TRUE(run.err.ends_with("; --disable odd goes on without it\n")) << run.err;
}

TEST_F(Plugins, DiscardIsRefused) {
    make("void odd_on_albedo(inout Surface s) {\n    if (s.height_m < 400.0) discard;\n}\n");
    const Result run = capture();
    EXPECT_EQ(run.status, 0);
    EXPECT_EQ(run.err,
              "relevo: warning: shader: plugins/odd/odd.glsl:2: discard: every pixel must be "
              "written, or it shows an earlier frame; leave the arguments unchanged instead; "
              "--disable odd silences this\n");
}

/// Statements that keep a device busy. llvmpipe leaves every loop after 65535 turns in all, which
/// is no end that anybody would wait for only where a turn is long.
std::string long_turn(const std::string& value) {
    std::string text = "{ ";
    for (int i = 0; i < 500; ++i)
        text += value + " = sin(" + value + " + float(k));";
    return text + " }";
}

TEST_F(Plugins, AnEndlessLoopEndsTheProgram) {
    make(
        "float odd_turns(in float x) {\n"
        "    for (uint i = 0u; i < 4000000000u; ++i)\n"
        "        for (uint k = 0u; k < 4000000000u; ++k) " +
        long_turn("x") +
        "\n"
        "    return x;\n"
        "}\n"
        "void odd_on_albedo(inout Surface s) { s.diffuse *= odd_turns(s.height_m); }\n");
    const Result run = capture({}, {"RELEVO_PATIENCE_S=1"});
    EXPECT_EQ(run.status, 1);
    EXPECT_EQ(run.err,
              "relevo: error: render: program terrain: the device took more than 1 s; "
              "plugins/odd/odd.glsl:2, plugins/odd/odd.glsl:3 may never end; --disable odd "
              "goes on without it\n");
    EXPECT_FALSE(drawn());
}

TEST_F(Plugins, AnEndlessLoopOfAVertexHookEndsTheProgram) {
    make(
        "void odd_on_displace(in VertexFrame v, inout vec3 position_m) {\n"
        "    for (uint i = 0u; i < 4000000000u; ++i)\n"
        "        for (uint k = 0u; k < 4000000000u; ++k) " +
            long_turn("position_m.z") + "\n}\n",
        R"("displaces": {"up_m": 10})");
    const Result run = capture({}, {"RELEVO_PATIENCE_S=1"});
    EXPECT_EQ(run.status, 1);
    EXPECT_THAT(run.err, HasSubstr("--disable odd goes on without it"));
    EXPECT_FALSE(drawn());
}

TEST_F(Plugins, AnEndlessLoopOfAPassEndsTheProgram) {
    const std::string loops =
        "    float x = 0.5;\n"
        "    for (uint i = 0u; i < 4000000000u; ++i)\n"
        "        for (uint k = 0u; k < 4000000000u; ++k) " +
        long_turn("x") + "\n";
    const std::string read =
        "void odd_on_albedo(inout Surface s) { s.diffuse *= float(texelFetch(odd_sum, 0).r); }\n";
    make("uniform samplerBuffer odd_sum;\n" + read + "void odd_pass_sum(in Invocation i) {\n" +
             loops + "    odd_sum_out[0] = x;\n}\n",
         R"("passes": {"sum": {"kind": "compute", "writes": "floats", "count": 1,
                               "local_size": [64], "over": "frame"}})");
    const Result run = capture({}, {"RELEVO_PATIENCE_S=1"});
    EXPECT_EQ(run.status, 1);
    EXPECT_EQ(run.err,
              "relevo: error: render: program odd.sum: the device took more than 1 s; "
              "plugins/odd/odd.glsl:5, plugins/odd/odd.glsl:6 may never end; --disable odd "
              "goes on without it\n");
    EXPECT_FALSE(drawn());
}

/// GLSL that is small, and of which a driver makes more than it can hold.
std::vector<std::pair<const char*, std::string>> bombs() {
    std::string doubled = "#define odd_m0 s.diffuse.x +=\\\n 0.1;\n";
    std::string chain = "float odd_c0(in float x) { return sin(x) + 0.1; }\n";
    for (int i = 1; i <= 25; ++i) {
        if (i <= 24) doubled += fmt::format("#define odd_m{0} odd_m{1} odd_m{1}\n", i, i - 1);
        chain += fmt::format(
            "float odd_c{0}(in float x) {{ return odd_c{1}(x) + odd_c{1}(x + 1.0); "
            "}}\n",
            i, i - 1);
    }
    const std::string albedo = "void odd_on_albedo(inout Surface s) { ";
    return {{"array", albedo + "float a[2000000000]; a[int(s.height_m)] = 1.0; s.diffuse.x = "
                               "a[int(s.height_m * 2.0)]; }\n"},
            {"constant array", "const int odd_n = 2000000000;\n" + albedo +
                                   "float a[odd_n]; a[int(s.height_m)] = 1.0; s.diffuse.x = "
                                   "a[int(s.height_m * 2.0)]; }\n"},
            {"macro", doubled + albedo + "odd_m24 }\n"},
            {"calls", chain + albedo + "s.diffuse.x *= odd_c25(s.height_m); }\n"}};
}

TEST_F(Plugins, GlslThatGrowsBeyondWhatADriverHoldsIsNamed) {
    for (const auto& [what, glsl] : bombs()) {
        make(glsl);
        const Result run = capture();
        EXPECT_TRUE(run.status == 0 || run.status == 1 || run.status == 3) << what << run.status;
        EXPECT_THAT(run.err, HasSubstr("plugins/odd/odd.glsl:")) << what;
        EXPECT_TRUE(run.err.find("--disable odd silences this\n") != std::string::npos ||
                    run.err.find("--disable odd goes on without it\n") != std::string::npos)
            << what << run.err;
    }
}

// ---- native modules

TEST_F(Plugins, AModuleThatFailsItsTrialIsOffAloud) {
    make_native();
    const std::string reason =
        "plugin: plugins/native/native.so: its prepare() ended in a segmentation fault";
    const std::vector<std::string> fault{"RELEVO_TEST_FAULT=prepare crash"};
    const Result run = capture({}, fault);
    EXPECT_EQ(run.status, 0);
    EXPECT_EQ(run.err,
              "relevo: warning: native is off: " + reason + "; --disable native silences this\n");
    EXPECT_TRUE(drawn());
    for (const char* option : {"--only", "--enable"}) {
        const Result named = capture({option, "native"}, fault);
        EXPECT_EQ(named.status, 3);
        EXPECT_EQ(named.err, "relevo: error: effects: native: it cannot be switched on: " + reason +
                                 "; take it out of " + option + "\n");
        EXPECT_FALSE(drawn());
    }
}

TEST_F(Plugins, AModuleThatEndsTheProgramIsNamed) {
    make_native();
    const std::pair<const char*, const char*> cases[] = {
        {"load exit later", "its registration ended the program"},
        {"load under later", "its registration ended the program"},
        {"register exit later", "its registration ended the program"},
        {"register under later", "its registration ended the program"},
        {"register Under later", "its registration ended the program"},
        {"register quick later", "its registration ended the program"},
        {"register crash later", "its registration ended in a segmentation fault"},
        {"create crash later", "its create() ended in a segmentation fault"},
        {"prepare crash later", "its prepare() ended in a segmentation fault"},
        {"prepare overflow later", "its prepare() ended in a segmentation fault"},
        {"prepare abort later", "its prepare() ended in an abort"},
        {"prepare exit later", "its prepare() ended the program"},
        {"prepare quick later", "its prepare() ended the program"},
        {"prepare under later", "its prepare() ended the program"},
        {"prepare Under later", "its prepare() ended the program"},
        {"prepare thread later", "its prepare() ended the program"},
        {"prepare hang later", "its prepare() took more than 1 s"},
        {"prepare log later", "its prepare() took more than 1 s"}};
    for (const auto& [fault, what] : cases) {
        const Result run =
            capture({}, {std::string("RELEVO_TEST_FAULT=") + fault, "RELEVO_PATIENCE_S=1"});
        EXPECT_EQ(run.status, 1) << fault;
        EXPECT_EQ(run.err, fmt::format("relevo: error: effect: plugins/native/native.so: {}; "
                                       "--disable native goes on without it\n",
                                       what));
        EXPECT_FALSE(drawn()) << fault;
    }
}

TEST_F(Plugins, AModuleThatThrowsOrFailsIsNamed) {
    make_native();
    const std::tuple<const char*, const char*, const char*> cases[] = {
        {"create throw later", "it cannot start", "its create() threw an exception: no good today"},
        {"prepare throw later", "it cannot prepare a frame",
         "its prepare() threw an exception: no good today"},
        {"create fail", "it cannot start", "the moon is not full"},
        {"prepare fail", "it cannot prepare a frame", "the moon is not full"}};
    for (const auto& [fault, what, why] : cases) {
        const Result run = capture({}, {std::string("RELEVO_TEST_FAULT=") + fault});
        EXPECT_EQ(run.status, 1) << fault;
        EXPECT_EQ(run.err, fmt::format("relevo: error: render: plugins/native/native.so: {}: {}; "
                                       "--disable native goes on without it\n",
                                       what, why));
        EXPECT_FALSE(drawn()) << fault;
    }
}

TEST_F(Plugins, ACrashAfterThePictureIsStillNamed) {
    make_native();
    const Result run = capture({}, {"RELEVO_TEST_FAULT=destroy crash later"});
    EXPECT_EQ(run.status, 1);
    EXPECT_EQ(run.err,
              "relevo: error: effect: plugins/native/native.so: its destroy() ended in a "
              "segmentation fault; --disable native goes on without it\n");
    EXPECT_EQ(image::read(picture()).width, 64);
}

// ---- listing

TEST_F(Plugins, OneBadByteLeavesTheListWhole) {
    write("plugin.json",
          "{\"format\": 1, \"id\": \"odd\", \"name\": \"\xff\", \"version\": \"1\"}");
    write("odd.glsl", kNothing);
    // A folder whose name is no UTF-8.
    const std::filesystem::path other = folder_ /
                                        "plugins/fr\xfc"
                                        "h";
    std::filesystem::create_directories(other);
    std::ofstream(other / "plugin.json")
        << R"({"format": 1, "id": "early", "name": "E", "version": "1"})";
    std::ofstream(other / "early.glsl") << "void early_on_albedo(inout Surface s) {}\n";
    const Result run =
        relevo({"plugins", "--json", "--plugin-path", (folder_ / "plugins").string()});
    EXPECT_EQ(run.status, 1);
    EXPECT_THAT(run.err, ::testing::MatchesRegex(
                             "relevo: error: plugins: 1 of [0-9]+ cannot be used: odd\n"));
    const nlohmann::json json = nlohmann::json::parse(run.out);
    ASSERT_EQ(json["broken"].size(), 1u);
    EXPECT_EQ(json["broken"][0]["id"], "odd");
    bool early = false;
    for (const nlohmann::json& plugin : json["plugins"])
        early = early || plugin["id"] == "early";
    EXPECT_TRUE(early);
}

TEST_F(Plugins, APresetThatIsNoFileIsRefused) {
    make(kNothing);
    const std::string pipe = (folder_ / "pipe.json").string();
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    for (const std::string& preset : {pipe, std::string("/dev/zero")}) {
        const Result run = capture({"--preset", preset});
        EXPECT_EQ(run.status, 3);
        EXPECT_THAT(run.err, HasSubstr("cannot be read, it is not a regular file"));
    }
}

}  // namespace
}  // namespace relevo::test::test_plugins
