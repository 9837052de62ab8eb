#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "cli/job_fixture.h"
#include "cli/program.h"
#include "dem/fixture.h"
#include "dem/index_fixture.h"
#include "support/support.h"

/// The folder of a run's tiles, and the names that a plan writes.
namespace relevo::test::test_tile_folder {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;
using testing::HasSubstr;
using testing::StartsWith;

class TileFolder : public testing::Test {
  protected:
    Result shadow(const Words& verb, const Words& more = {}) const {
        Words words = verb;
        words.insert(words.end(), {"sun", "shadow", bundled_dem(), "--sun", "123,8", "--tiles",
                                   "200", "-o", folder_.string()});
        words.insert(words.end(), more.begin(), more.end());
        return relevo(words);
    }
    /// Expects that a plan is refused before any work: no file is there that was not there before.
    void expect_refused(const Words& more, int status, const std::string& message) const {
        const auto files = [&] {
            return std::distance(fs::recursive_directory_iterator(dir_), {});
        };
        const auto before = files();
        const Result run = shadow({"plan"}, more);
        EXPECT_EQ(run.status, status);
        EXPECT_EQ(run.err, "relevo: error: " + message + "\n");
        EXPECT_EQ(run.out, "");
        EXPECT_EQ(files(), before);
    }
    std::string path(const std::string& name) const { return (dir_ / name).string(); }

    fs::path dir_ = scratch_dir("work"), folder_ = dir_ / "out";
};

TEST_F(TileFolder, FilesOfOthersThatAreCalledAsThoseOfAPlanStay) {
    for (const std::string name : {"plan.json", "plan.tif", "plan_means.tif"}) {
        fs::create_directories(folder_);
        const std::string file = (folder_ / name).string();
        std::ofstream(file) << "{\"name\": \"mine\"}";
        const std::string before = read_text(file, "test");
        const std::string message =
            "-o: " + file +
            ": exists, and a plan of tiles needs its name; use another folder, or pass --overwrite "
            "to replace it";
        expect_refused({}, 3, message);
        const Result made = shadow({"-q"}, {"--resume"});
        EXPECT_EQ(made.status, 3);
        EXPECT_EQ(made.err, "relevo: error: " + message + "\n");
        EXPECT_EQ(read_text(file, "test"), before);
        const Result asked = shadow({"-q"}, {"--overwrite", "--halo", "2"});
        EXPECT_EQ(asked.status, 0) << asked.err;
        // No plan of a DEM in memory has a plan.tif.
        EXPECT_EQ(read_text(file, "test") == before, name == "plan.tif");
        fs::remove_all(folder_);
    }
}

// A process that ended between the files of a plan has left some of them.
TEST_F(TileFolder, FilesOfAnEarlierPlanAreReplaced) {
    ASSERT_EQ(shadow({"-q"}, {"--halo", "2"}).status, 0);
    ASSERT_TRUE(fs::exists(folder_ / "plan_means.tif"));
    fs::remove(folder_ / "plan.json");
    const Result again = shadow({"-q"}, {"--halo", "2", "--resume"});
    EXPECT_EQ(again.status, 0) << again.err;
    EXPECT_TRUE(fs::exists(folder_ / "plan.json"));
}

TEST_F(TileFolder, APlanIsOfAllTasks) {
    expect_refused({"--shard", "1/2"}, 2,
                   "--shard: a plan is of all tasks, and gives each of them its part; pass "
                   "none");
}

TEST_F(TileFolder, AMergeOfNoTileSaysSo) {
    ASSERT_EQ(shadow({"plan"}).status, 0);
    for (const Words& more : {Words{}, Words{"--allow-missing"}}) {
        Words words{"-q", "merge", folder_.string()};
        words.insert(words.end(), more.begin(), more.end());
        const Result merge = relevo(words);
        EXPECT_EQ(merge.status, 1);
        EXPECT_THAT(merge.err, HasSubstr("relevo: error: merge: none of 6 tiles is there and "
                                         "whole; make them with --resume\n"));
    }
}

TEST_F(TileFolder, NamesOfScriptsAreCheckedBeforeAnyWork) {
    for (const std::string option : {"--slurm", "--parallel"}) {
        expect_refused({option, path("gone/tasks")}, 3,
                       option + ": " + path("gone/tasks") + ": the folder " + path("gone") +
                           " does not exist; create it first");
        expect_refused({option, dir_.string()}, 3, option + ": " + dir_.string() + ": is a folder");
        expect_refused({option, bundled_dem(), "--overwrite"}, 3,
                       fmt::format("{0}: {1}: is the DEM {1}, which would be overwritten; give the "
                                   "result another name",
                                   option, bundled_dem()));
        expect_refused({option, folder_.string()}, 3,
                       "-o: " + folder_.string() +
                           ": another result has this name; give each its "
                           "own");
        std::ofstream(dir_ / "there") << "mine";
        expect_refused({option, path("there")}, 3,
                       option + ": " + path("there") + ": exists; pass --overwrite to replace it");
    }
    expect_refused({"--slurm", path("a"), "--parallel", path("a")}, 3,
                   "-o: " + path("a") + ": another result has this name; give each its own");
    // In the folder that the plan makes.
    const Result inside = shadow({"plan"}, {"--slurm", (folder_ / "submit.sh").string()});
    EXPECT_EQ(inside.status, 0) << inside.err;
    EXPECT_THAT(read_text(folder_ / "submit.sh", "test"), StartsWith("#!/bin/sh\n"));
}

// Names as no URI has them.
TEST_F(TileFolder, AStacCollectionOfOddNamesIsReadBack) {
    const std::vector<std::string> names{"a b", "\xc3\xbc#1", "50% or?", "c:d"};
    std::vector<IndexRow> rows;
    for (std::size_t i = 0; i < names.size(); ++i) {
        Raster raster;
        raster.columns = raster.rows = 70;
        raster.geotransform = {{500000 + 2100.0 * double(i), 30, 0, 5200000, 0, -30}};
        rows.push_back(row_of(write_raster(dir_ / (names[i] + ".tif"), raster)));
        rows.back().location = names[i] + ".tif";
    }
    const std::string index = write_index(dir_ / "index.gpkg", "GPKG", rows);
    const fs::path tiles = dir_ / "my tiles #2";
    const Result made = relevo({"-q", "sun", "sky-view", index, "--directions", "4", "--tiles",
                                index, "-o", tiles.string()});
    ASSERT_EQ(made.status, 0) << made.err;
    const std::string stac = path("items.json");
    const auto merge = [&](const Words& more) {
        Words words{"-q", "merge", tiles.string(), "--stac", stac, "--overwrite"};
        words.insert(words.end(), more.begin(), more.end());
        const Result run = relevo(words);
        EXPECT_EQ(run.status, 0) << run.err;
        return nlohmann::json::parse(read_text(stac, "test"))["features"];
    };
    for (const Words& base : {Words{}, Words{"--href-base", tiles.string()},
                              Words{"--href-base", "file://" + tiles.string()}}) {
        const nlohmann::json features = merge(base);
        ASSERT_EQ(features.size(), 4u);
        EXPECT_EQ(
            features[0]["stac_extensions"],
            nlohmann::json{"https://stac-extensions.github.io/projection/v1.2.0/schema.json"});
        for (const auto& feature : features)
            EXPECT_EQ(feature["assets"]["data"]["href"].get<std::string>().find_first_of(" #?\xc3"),
                      std::string::npos)
                << feature["assets"]["data"]["href"];
        const Result info = relevo({"-q", "info", stac, "--json", "--unit", "m"});
        ASSERT_EQ(info.status, 0) << info.err;
        const nlohmann::json found = nlohmann::json::parse(info.out)["tiles"];
        EXPECT_EQ(found["count"], 4);
        EXPECT_EQ(found["missing"], 0) << info.out;
    }
    EXPECT_EQ(merge({"--href-base", "https://a.org/x%20y"})[0]["assets"]["data"]["href"],
              "https://a.org/x%20y/a%20b.tif");
    expect_failure(
        {"merge", tiles.string(), "--stac", stac, "--overwrite", "--href-base", "file://tiles"}, 2,
        "--href-base: file://tiles: expected file:/// and an absolute path");
    EXPECT_EQ(merge({"--href-base", "s3://bucket/x"})[0]["assets"]["data"]["href"],
              "s3://bucket/x/a b.tif");
}

class TasksOfAJob : public JobTest {};

TEST_F(TasksOfAJob, NamesOfScriptsAreCheckedBeforeAnyWork) {
    const std::string path =
        job("\"time\": {\"at\": \"2026-06-21T12:00Z\"}, \"shots\": [{}], \"output\": \"a.png\"")
            .string();
    const auto refusal = [&](const Words& more) {
        Words words{"plan", "run", path};
        words.insert(words.end(), more.begin(), more.end());
        const Result run = relevo(words);
        EXPECT_NE(run.status, 0);
        EXPECT_EQ(run.out, "");
        return run.err;
    };
    const std::string gone = (dir_ / "gone/tasks").string(), picture = (dir_ / "a.png").string();
    EXPECT_THAT(refusal({"--slurm", gone}),
                StartsWith("relevo: error: --slurm: " + gone + ": the folder "));
    EXPECT_THAT(refusal({"--parallel", path, "--overwrite"}),
                HasSubstr("which would be overwritten"));
    EXPECT_THAT(refusal({"--parallel", picture}), HasSubstr(picture + ": another result has this"));
    EXPECT_THAT(refusal({"--shard", "1/2"}),
                StartsWith("relevo: error: --shard: a plan is of all"));
    EXPECT_FALSE(fs::exists(picture));
}

}  // namespace
}  // namespace relevo::test::test_tile_folder
