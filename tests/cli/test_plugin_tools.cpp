// The tools for authors of plugins: where plugins are found, and what relevo plugins does.
#include <chrono>
#include <csignal>
#include <fstream>
#include <future>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "cli/program.h"
#include "image/image.h"
#include "support/support.h"

namespace relevo::test::test_plugin_tools {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

class PluginTools : public testing::Test {
  protected:
    PluginTools() { fs::create_directories(dir_); }

    void write(const fs::path& file, const std::string& text) const {
        fs::create_directories((dir_ / file).parent_path());
        std::ofstream(dir_ / file, std::ios::binary) << text;
    }
    /// A plugin below `folder`.
    void add(const std::string& folder, const std::string& id, const std::string& glsl,
             const std::string& members = "") const {
        const fs::path own = fs::path(folder) / id;
        write(own / "plugin.json", R"({"format": 1, "id": ")" + id + R"(", "name": ")" + id +
                                       R"(", "version": "1")" +
                                       (members.empty() ? "" : ", " + members) + "}");
        write(own / (id + ".glsl"), glsl);
    }
    std::string path(const std::string& name) const { return (dir_ / name).string(); }
    /// The text without the test's own folder.
    std::string relative(std::string text) const {
        const std::string folder = dir_.string() + "/";
        for (std::size_t at; (at = text.find(folder)) != std::string::npos;)
            text.erase(at, folder.size());
        return text;
    }
    Result capture(const std::vector<std::string>& more,
                   const std::vector<std::string>& environment = {}) const {
        std::vector<std::string> arguments{"-q",          "capture",     bundled_dem(), "-o",
                                           path("a.png"), "--overwrite", "--size",      "64x48"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return relevo(arguments, environment);
    }

    const fs::path dir_ = scratch_dir();
};

const std::string kRed =
    "void red_on_lit(in Surface s, inout vec3 radiance) { radiance.gb = vec2(0.0); }\n";

TEST_F(PluginTools, PluginsOfTheUsersFoldersAreFound) {
    add("data/relevo/plugins", "red", kRed);
    write("more/green/plugin.json", R"({"format": 1, "id": "green", "name": "G", "version": "1"})");
    write("more/green/green.glsl", "void green_on_albedo(inout Surface s) {}\n");
    const std::vector<std::string> environment{"XDG_DATA_HOME=" + path("data"),
                                               "RELEVO_PLUGIN_PATH=" + path("more")};
    const Result run = relevo({"plugins", "--json"}, environment);
    EXPECT_EQ(run.status, 0) << run.err;
    std::vector<std::string> folders;
    const nlohmann::json found = nlohmann::json::parse(run.out)["plugins"];
    for (const auto& plugin : found)
        folders.push_back(plugin["folder"]);
    EXPECT_THAT(folders,
                ::testing::IsSupersetOf({path("data/relevo/plugins/red"), path("more/green")}));
    const Result doctor = relevo({"doctor", "--json", "--device", "software"}, environment);
    const std::vector<std::string> searched =
        nlohmann::json::parse(doctor.out)["plugin_search_path"];
    EXPECT_THAT(searched, ::testing::IsSupersetOf({path("data/relevo/plugins"), path("more")}));
}

TEST_F(PluginTools, AMisspeltVariableIsAnError) {
    const Result run = capture({}, {"RELEVO_PLUGIN_PATH=/nowhere"});
    EXPECT_EQ(run.status, 3);
    EXPECT_EQ(run.err, "relevo: error: RELEVO_PLUGIN_PATH: /nowhere: no such folder\n");
}

TEST_F(PluginTools, ANamedEffectThatLacksARequirementIsAnError) {
    add("plugins", "red", kRed, R"("requires": ["materails"], "enabled_by_default": false)");
    const Result run = capture({"--plugin-path", path("plugins"), "--enable", "red"});
    EXPECT_EQ(run.status, 3);
    EXPECT_EQ(run.err,
              "relevo: error: effects: red: it cannot be switched on: it requires materails, which "
              "no plugin here provides; did you mean materials?; take it out of --enable\n");
    EXPECT_EQ(capture({"--plugin-path", path("plugins"), "--only", ""}).err, "");
}

TEST_F(PluginTools, AListWithABrokenPluginFails) {
    add("plugins", "red", "void red_on_lit() {}\n");
    const Result run = relevo({"plugins", "list", "--plugin-path", path("plugins")});
    EXPECT_EQ(run.status, 1);
    EXPECT_THAT(run.err, ::testing::MatchesRegex(
                             "relevo: error: plugins: 1 of [0-9]+ cannot be used: red\n"));
    EXPECT_THAT(relative(run.out), HasSubstr("red          -    shader: plugins/red/red.glsl:1: "));
}

// ---- new

TEST_F(PluginTools, ANewPluginLoadsAndChangesThePicture) {
    const Result made = relevo({"plugins", "new", "dust", "--into", path("mine")});
    EXPECT_EQ(made.status, 0) << made.err;
    EXPECT_EQ(relative(made.out),
              "mine/dust/plugin.json\nmine/dust/dust.glsl\nmine/dust/README.md\n");
    const std::vector<std::string> only{"--plugin-path", path("mine"), "--time",
                                        "2026-06-21T18:30-04:00", "--only"};
    const auto picture = [&](const std::string& id) {
        std::vector<std::string> arguments = only;
        arguments.push_back(id);
        const Result run = capture(arguments);
        EXPECT_EQ(run.status, 0) << run.err;
        return image::read(path("a.png"));
    };
    EXPECT_GT(image::compare(picture("dust"), picture("")).share_over_1, 0.2);
    expect_failure(
        {"plugins", "new", "dust", "--into", path("mine")}, 3,
        "plugins new: " + path("mine/dust") + ": exists already; choose another id or --into");
}

TEST_F(PluginTools, ABadIdIsAClearError) {
    expect_failure({"plugins", "new", "Dust", "--into", path("")}, 3,
                   "plugins new: Dust: expected a letter a-z and then letters and digits but got "
                   "\"Dust\"");
    expect_failure({"plugins", "new", "water", "--into", path("")}, 3,
                   "plugins new: water: water is a word of core's; choose another");
    const Result taken = relevo({"plugins", "new", "haze", "--into", path("")});
    EXPECT_EQ(taken.status, 3);
    EXPECT_THAT(taken.err, HasSubstr("plugins new: haze: this id is taken by "));
    expect_failure({"plugins", "new", "mist", "--from", "hase", "--into", path("")}, 3,
                   "plugins new: hase: no such plugin; did you mean haze?");
    EXPECT_TRUE(fs::is_empty(dir_));
}

TEST_F(PluginTools, ACopyDrawsWhatTheOriginalDraws) {
    const nlohmann::json list = nlohmann::json::parse(relevo({"plugins", "--json"}).out)["plugins"];
    std::vector<std::string> ids;
    nlohmann::json choices = nlohmann::json::array();
    for (const auto& plugin : list) {
        const std::string id = plugin["id"], copy = "copied" + id;
        const Result made =
            relevo({"plugins", "new", copy, "--from", id, "--into", path("copies")});
        if (made.status != 0) {
            EXPECT_THAT(made.err, HasSubstr("a native plugin cannot be copied")) << id;
            continue;
        }
        ids.push_back(id);
        for (const std::string& only : {id, copy})
            choices.push_back({{"name", only}, {"only", nlohmann::json::array({only})}});
        const std::string glsl = read_text(path("copies/" + copy + "/" + copy + ".glsl"), "test");
        EXPECT_EQ(glsl.find(" " + id + "_on_"), std::string::npos) << id;
    }
    ASSERT_GT(ids.size(), 2u);
    write("job.json", nlohmann::json{{"format", 1},
                                     {"dem", {{"files", {bundled_dem()}}}},
                                     {"time", {{"at", "2026-06-21T18:30-04:00"}}},
                                     {"picture", {{"size", {64, 48}}}},
                                     {"sweep", {{{"effects", choices}}}},
                                     {"output", "{effects}.png"}}
                          .dump());
    const Result run = relevo({"-q", "run", path("job.json"), "--plugin-path", path("copies")});
    ASSERT_EQ(run.status, 0) << run.err;
    for (const std::string& id : ids)
        EXPECT_EQ(image::compare(image::read(path("copied" + id + ".png")),
                                 image::read(path(id + ".png")))
                      .worst,
                  0)
            << id;
    EXPECT_EQ(relevo({"plugins", "--plugin-path", path("copies")}).status, 0);
}

TEST_F(PluginTools, ANewNativePluginIsBuiltByItsCommand) {
    ASSERT_EQ(relevo({"plugins", "new", "tide", "--native", "--into", path("mine")}).status, 0);
    const std::string source = path("mine/tide/tide.cpp"), library = path("mine/tide/tide.so");
    const Result built =
        run("/usr/bin/env", {"c++", "-std=c++20", "-shared", "-fPIC", "-I",
                             (source_dir() / "include").string(), source, "-o", library});
    ASSERT_EQ(built.status, 0) << built.err;
    const Result drawn = capture({"--plugin-path", path("mine"), "--only", "tide"});
    EXPECT_EQ(drawn.status, 0) << drawn.err;
}

// ---- test

TEST_F(PluginTools, TheGoldenTestComparesPictures) {
    ASSERT_EQ(relevo({"plugins", "new", "dust", "--into", path("")}).status, 0);
    const std::string dust = path("dust");
    expect_failure({"plugins", "test", dust}, 3,
                   "plugins test: " + dust + "/golden.png: no such file; --update writes it");
    const Result written = relevo({"plugins", "test", dust, "--update"});
    EXPECT_EQ(written.status, 0) << written.err;
    EXPECT_THAT(relative(written.out),
                ::testing::MatchesRegex("dust/golden.png is written; dust changes [0-9.]+ % of its "
                                        "values\n"));
    const Result same = relevo({"plugins", "test", dust});
    EXPECT_EQ(same.status, 0) << same.err;
    EXPECT_EQ(relative(same.out), "dust is as in dust/golden.png\n");
    std::string glsl = read_text(path("dust/dust.glsl"), "test");
    glsl.replace(glsl.find("0.5;"), 4, "0.9;");
    write("dust/dust.glsl", glsl);
    const Result other = relevo({"plugins", "test", dust});
    EXPECT_EQ(other.status, 6);
    EXPECT_THAT(relative(other.err),
                ::testing::MatchesRegex("relevo: error: plugins test: dust/golden.png: [0-9.]+ % "
                                        "of the values differ by more than 1/255, at most by "
                                        "[0-9]+/255, expected at most 0.02 % and 3/255; the "
                                        "picture is dust/found.png, --update replaces "
                                        "golden.png\n"));
    EXPECT_TRUE(fs::exists(path("dust/found.png")));
}

// ---- watch

TEST_F(PluginTools, WatchingWritesThePictureAgainAfterAChange) {
    ASSERT_EQ(relevo({"plugins", "new", "dust", "--into", path("")}).status, 0);
    const std::string program = (build_dir() / "bin/relevo").string();
    // The limit is for a program that does not end by itself when it is interrupted.
    auto watching = std::async(std::launch::async, [&] {
        return run("/bin/sh", {"-c", "echo $$ >\"$0\"; exec timeout -s KILL 120 \"$@\"",
                               path("process"), program, "capture", bundled_dem(), "-o",
                               path("a.png"), "--size", "64x48", "--device", "software", "--only",
                               "dust", "--plugin-path", path("dust"), "--watch"});
    });
    const auto wait_for = [&](const auto& condition) {
        for (int i = 0; i < 1000 && !condition(); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        return condition();
    };
    EXPECT_TRUE(wait_for([&] { return fs::exists(path("a.png")); }));
    std::error_code ignored;
    const auto first = fs::last_write_time(path("a.png"), ignored);
    const std::string glsl = read_text(path("dust/dust.glsl"), "test");
    write("dust/dust.glsl", "void dust_on_material(inout Surface s) {\n");  // a mistake
    std::this_thread::sleep_for(std::chrono::seconds(2));
    write("dust/dust.glsl", glsl + "\n");
    EXPECT_TRUE(wait_for([&] { return fs::last_write_time(path("a.png"), ignored) > first; }));
    kill(std::stoi(read_text(path("process"), "test")), SIGINT);
    const Result result = watching.get();
    EXPECT_EQ(result.status, 130) << result.err;
    EXPECT_THAT(relative(result.err), HasSubstr("shader: dust/dust.glsl:1: "));
}

TEST_F(PluginTools, WatchingReplacesNoFileOfOthers) {
    write("a.png", "precious");
    const Result result =
        run("/usr/bin/timeout",
            {"-s", "INT", "20", (build_dir() / "bin/relevo").string(), "capture", bundled_dem(),
             "-o", path("a.png"), "--size", "64x48", "--device", "software", "--watch"});
    EXPECT_EQ(result.status, 3) << result.err;
    EXPECT_THAT(result.err, HasSubstr("exists; pass --overwrite to replace it"));
    EXPECT_EQ(read_text(path("a.png"), "test"), "precious");
}

// ---- set

TEST_F(PluginTools, SeveralValuesOfOneSetAreExplained) {
    const Result run = capture({"--set", "haze.density=0.1", "haze.blue=0.2"});
    EXPECT_EQ(run.status, 2);
    EXPECT_EQ(run.err,
              "relevo: error: --set: haze.blue=0.2: --set takes one value; write --set "
              "haze.density=0.1 --set haze.blue=0.2\n");
    EXPECT_EQ(capture({"--set", "haze.densty=0.1"}).err,
              "relevo: error: parameter: haze.densty: no such parameter; did you mean "
              "haze.density?\n");
}

}  // namespace
}  // namespace relevo::test::test_plugin_tools
