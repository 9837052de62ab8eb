// What a picture, a scene or a job from somebody else may not make the program do.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "image/image.h"
#include "support/counting_server.h"
#include "support/support.h"

namespace relevo::test::test_trust {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

const json kSlow = {"block",    "bump",    "cover", "gloss",   "haze",
                    "layering", "shadows", "sky",   "skylight"};
const std::string kLeftOut = "are not used; add --plugin-path ";

class Trust : public testing::Test {
  protected:
    Trust() {
        fs::create_directories(evil() / "native");
        // Its module ends the program where it is loaded.
        fs::copy(build_dir() / "tests/modules/faulty.so", evil() / "native/native.so");
        std::ofstream(evil() / "native/plugin.json")
            << R"({"format": 1, "id": "native", "name": "N", "version": "1", "module": "native"})";
        std::ofstream(evil() / "native/native.glsl")
            << "void native_on_albedo(inout Surface s) {}\n";
        fs::create_directories(evil() / "red");
        std::ofstream(evil() / "red/plugin.json")
            << R"({"format": 1, "id": "red", "name": "R", "version": "1"})";
        std::ofstream(evil() / "red/red.glsl")
            << "void red_on_lit(in Surface s, inout vec3 radiance) { radiance.gb = vec2(0.0); }\n";
    }

    fs::path evil() const { return dir_ / "evil"; }

    /// A small scene of the bundled DEM with one more member.
    json scene(const std::string& key, const json& value) const {
        json scene = {{"format", 1},
                      {"dem", {{"files", json::array({bundled_dem()})}}},
                      {"time", {{"at", "2026-06-21T14:00Z"}}},
                      {"picture", {{"size", {64, 48}}}}};
        scene[key] = value;
        return scene;
    }
    json with_plugins(const std::string& folder) const {
        // Without what takes long, and with every other plugin.
        return scene("effects", {{"disable", kSlow}, {"plugin_path", json::array({folder})}});
    }
    std::string file(const std::string& name, const json& content) const {
        std::ofstream(dir_ / name) << content.dump(1);
        return (dir_ / name).string();
    }
    /// A picture whose record is this scene.
    std::string picture(const json& scene) const {
        image::write(dir_ / "photo.png", image::Image8(8, 8, 3),
                     {{"Software", "Relevo"}, {"relevo:scene", scene.dump()}}, true);
        return (dir_ / "photo.png").string();
    }

    Result drawn(std::vector<std::string> arguments, const std::vector<std::string>& more = {},
                 const char* fault = "create exit later") const {
        arguments.insert(arguments.begin(), "-q");
        arguments.insert(arguments.end(), more.begin(), more.end());
        fs::remove(dir_ / "out.png");
        return relevo(arguments, {std::string("RELEVO_TEST_FAULT=") + fault});
    }
    Result capture(const char* option, const std::string& from,
                   const std::vector<std::string>& more = {}) const {
        return drawn({"capture", option, from, "-o", (dir_ / "out.png").string()}, more);
    }
    bool is_there() const { return fs::exists(dir_ / "out.png"); }

    fs::path dir_ = scratch_dir("trust");
};

TEST_F(Trust, APictureRunsNoCode) {
    for (const std::string& folder : {std::string("evil"), evil().string()}) {
        const std::string photo = picture(with_plugins(folder));
        const Result run = capture("--from", photo);
        EXPECT_EQ(run.status, 0) << run.err;
        EXPECT_EQ(run.err, fmt::format("relevo: warning: --from: {0}: plugins of {1} {2}{1}, or "
                                       "--trust for all\n",
                                       photo, evil().string(), kLeftOut));
        EXPECT_TRUE(is_there());
    }
}

TEST_F(Trust, OfAPictureThatIsTrustedModulesAreNotLoaded) {
    json record = with_plugins("evil");
    record["effects"]["only"] = json::array({"red"});
    const std::string photo = picture(record);
    const Result run = capture("--from", photo, {"--trust"});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(run.err, fmt::format("relevo: warning: --from: {}: native modules of {}/native are "
                                   "not used; add --plugin-path {}/native\n",
                                   photo, evil().string(), evil().string()));
    // Other plugins are used.
    const image::Image8 image = image::read(dir_ / "out.png");
    int red = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            red += image.at(x, y, 0) > 20 && image.at(x, y, 1) < 8 && image.at(x, y, 2) < 8;
    EXPECT_GT(red, 100);
}

TEST_F(Trust, ScenesAndJobsRunNoCode) {
    const json base = with_plugins("evil");
    json plain = scene("output", "out.png");
    json in_job = plain;
    in_job["effects"] = base["effects"];
    json of_base = plain;
    of_base["scene"] = "scene.json";
    json in_shot = plain;
    in_shot["shots"].push_back(json::object({{"effects", base["effects"]}}));
    json in_sweep = plain;
    in_sweep["sweep"].push_back(json::object({{"effects", json::array({base["effects"]})}}));
    const std::string scene = file("scene.json", base);
    const auto expect_left_out = [&](const Result& run, const std::string& what) {
        EXPECT_EQ(run.status, 0) << run.err;
        EXPECT_THAT(run.err, HasSubstr(evil().string() + " " + kLeftOut + evil().string())) << what;
        EXPECT_THAT(run.err, Not(HasSubstr("native"))) << what;
        EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    };
    expect_left_out(capture("--scene", scene), "scene");
    EXPECT_EQ(capture("--scene", scene, {"--trust"}).status, 1);
    const std::pair<const char*, json> jobs[] = {
        {"job", in_job}, {"base", of_base}, {"shot", in_shot}, {"sweep", in_sweep}};
    for (const auto& [what, content] : jobs) {
        const std::string job = file("job.json", content);
        expect_left_out(drawn({"run", job}), what);
        EXPECT_TRUE(is_there()) << what;
        if (std::string_view(what) == "job")
            expect_left_out(drawn({"run", job, "--dry-run"}), what);
        const Result trusted = drawn({"run", job}, {"--trust"});
        EXPECT_NE(trusted.status, 0) << what;
        EXPECT_THAT(trusted.err, HasSubstr("native.so: its create() ended the program")) << what;
    }
}

TEST_F(Trust, WhatTheCommandLineNamesIsUsedOnce) {
    const std::string link = (dir_ / "link").string();
    fs::create_directory_symlink(evil(), link);
    json record = with_plugins("evil/");
    record["effects"] = {{"only", json::array({"red"})}, {"plugin_path", json::array({"evil/"})}};
    for (const std::string& named : {evil().string(), evil().string() + "/", link}) {
        const Result run = capture("--from", picture(record), {"--plugin-path", named});
        EXPECT_EQ(run.status, 0) << run.err;
        EXPECT_EQ(run.err, "") << named;
        EXPECT_TRUE(is_there());
    }
}

TEST_F(Trust, APictureOfAPluginPathIsMadeAgainByIt) {
    const std::string made = (dir_ / "made.png").string();
    const std::vector<std::string> path{"--plugin-path", evil().string()};
    const Result first = drawn(
        {"capture", bundled_dem(), "--size", "64x48", "--only", "red", "-o", made, "--overwrite"},
        path);
    ASSERT_EQ(first.status, 0) << first.err;
    const Result untrusted = capture("--from", made);
    EXPECT_EQ(untrusted.status, 3);  // red is asked for and not there
    EXPECT_THAT(untrusted.err, HasSubstr(kLeftOut));
    EXPECT_FALSE(is_there());
    ASSERT_EQ(capture("--from", made, path).status, 0);
    EXPECT_EQ(image::read(made).values, image::read(dir_ / "out.png").values);
}

TEST_F(Trust, NoFileAsksTheNet) {
    const CountingServer server;
    const std::string remote = server.address() + "/x.tif";
    const auto job = [&](json members) {
        members["output"] = "out.png";
        return file("job.json", members);
    };
    for (const std::string& name : {remote, "/vsicurl/" + remote, "/vsigzip//vsicurl/" + remote,
                                    "vrt://" + remote + "?bands=1", "WMTS:" + remote}) {
        const json dem = scene("dem", {{"files", json::array({name})}});
        const json overlay = scene("overlay", {{"file", name}});
        json event = scene("shots", json::array({dem}));
        event["shots"][0] = {{"dem", dem["dem"]}};
        event["time"] = {{"at", "sunset"}, {"date", "2026-06-21"}};
        std::vector<Result> runs{capture("--from", picture(dem)),
                                 capture("--scene", file("scene.json", overlay))};
        if (name == remote) {
            runs.push_back(capture("--from", picture(overlay)));
            runs.push_back(capture("--scene", file("scene.json", dem)));
            runs.push_back(drawn({"run", job(dem)}));
            runs.push_back(drawn({"run", job(overlay), "--dry-run"}));
            runs.push_back(drawn({"run", job(event)}));
        }
        for (const Result& run : runs) {
            EXPECT_EQ(run.status, 2) << run.err;
            EXPECT_THAT(run.err, HasSubstr(": '" + name +
                                           "' is not a file of this machine; name it on the "
                                           "command line, or add --trust\n"));
        }
    }
    EXPECT_EQ(server.asked(), 0);
}

TEST_F(Trust, TheCommandLineAsksTheNet) {
    const CountingServer server;
    const std::string name = "/vsicurl/" + server.address() + "/x.tif";
    int asked = 0;
    const auto expect_asked = [&](const Result& run) {
        EXPECT_EQ(run.status, 3) << run.err;
        EXPECT_THAT(run.err, HasSubstr(name + ": "));
        EXPECT_GT(server.asked(), std::exchange(asked, server.asked()));
    };
    expect_asked(drawn({"capture", name, "-o", (dir_ / "out.png").string()}));
    const std::string photo = picture(scene("dem", {{"files", json::array({name})}}));
    expect_asked(capture("--from", photo, {"--trust"}));
    expect_asked(
        capture("--from", picture(scene("stamps", {{"show", json::array({"scale"})}})), {name}));
}

}  // namespace
}  // namespace relevo::test::test_trust
