// Tiles and pictures that tasks make in an object store, without a folder that they share.
#include <filesystem>
#include <fstream>
#include <map>

#include <gmock/gmock.h>

#include "base/text.h"
#include "cli/object_store.h"
#include "cli/program.h"
#include "support/support.h"

namespace relevo::test::test_store_tiles {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;
using Objects = std::map<std::string, std::string>;
using testing::HasSubstr;

const std::string kFolder = "/vsis3/bucket/hours";

class StoreTiles : public testing::Test {
  protected:
    StoreTiles() { fs::create_directories(dir_ / "tmp"); }

    Result run(const Words& words) const {
        Words all = store_.environment();
        all.push_back("TMPDIR=" + (dir_ / "tmp").string());
        return relevo(words, all);
    }
    Result make(const std::string& folder, const Words& more = {}) const {
        Words words{"sun",    "hours", bundled_dem(), "--date", "2026-12-21", "--tz", "UTC",
                    "--step", "30",    "--tiles",     "200",    "-o",         folder};
        words.insert(words.end(), more.begin(), more.end());
        return run(words);
    }
    /// Those of one process, in a folder of this machine, under the names of the store.
    Objects tiles_of_one() const {
        const fs::path folder = dir_ / "hours";
        EXPECT_EQ(make(folder.string()).status, 0);
        Objects tiles;
        for (const auto& entry : fs::directory_iterator(folder))
            if (entry.path().filename().string().starts_with("r0"))
                tiles["/bucket/hours/" + entry.path().filename().string()] =
                    read_text(entry.path(), "test");
        return tiles;
    }
    Objects tiles() const {
        Objects all = store_.objects();
        std::erase_if(
            all, [](const auto& object) { return !object.first.starts_with("/bucket/hours/r0"); });
        return all;
    }
    std::size_t left() const {
        const fs::directory_iterator all(dir_ / "tmp");
        return static_cast<std::size_t>(std::distance(begin(all), end(all)));
    }

    fs::path dir_ = scratch_dir();
    ObjectStoreServer store_;
};

TEST_F(StoreTiles, OfTasksAreThoseOfOneProcess) {
    for (const char* const shard : {"1/3", "2/3", "3/3"}) {
        const Result made = make(kFolder, {"--shard", shard});
        ASSERT_EQ(made.status, 0) << made.err;
    }
    EXPECT_EQ(tiles(), tiles_of_one());
    EXPECT_EQ(store_.objects().count("/bucket/hours/plan.json"), 1u);
    EXPECT_EQ(left(), 0u);
    EXPECT_FALSE(fs::exists("/vsis3"));
}

TEST_F(StoreTiles, WhatIsThereIsKeptAndWhatIsMissingIsMade) {
    ASSERT_EQ(make(kFolder).status, 0);
    const Objects all = tiles();
    ASSERT_GE(all.size(), 3u);
    const auto put = [&] {
        const auto requests = store_.requests();
        return std::ranges::count(requests, "PUT", &ObjectStoreServer::Request::method);
    };
    const auto [name, content] = *all.begin();
    store_.put(name, content.substr(0, content.size() / 2));
    const Result refused = make(kFolder);
    EXPECT_EQ(refused.status, 3);
    EXPECT_THAT(refused.err, HasSubstr(": exists; pass --overwrite to replace it, or --resume"));
    const auto before = put();
    const Result resumed = make(kFolder, {"--resume"});
    ASSERT_EQ(resumed.status, 0) << resumed.err;
    EXPECT_THAT(resumed.err, HasSubstr("1 tiles in "));
    EXPECT_EQ(put() - before, 1);
    EXPECT_EQ(tiles(), all);
}

TEST_F(StoreTiles, AreMergedWhereTheyAre) {
    ASSERT_EQ(make(kFolder).status, 0);
    const std::string there = kFolder + "/all.vrt", here = (dir_ / "all.vrt").string();
    for (const std::string& name : {there, here}) {
        const Result merged = run({"merge", kFolder, "-o", name});
        ASSERT_EQ(merged.status, 0) << merged.err;
    }
    EXPECT_THAT(store_.objects().at("/bucket/hours/all.vrt"),
                HasSubstr("relativeToVRT=\"1\">r0001_c0001.tif<"));
    EXPECT_THAT(read_text(here, "test"),
                HasSubstr("relativeToVRT=\"0\">/vsis3/bucket/hours/r0001_c0001.tif<"));
    const Result read = run({"info", there, "--unit", "m"});
    EXPECT_EQ(read.status, 0) << read.err;
}

TEST_F(StoreTiles, AMissingOneFailsTheMergeByName) {
    ASSERT_EQ(make(kFolder, {"--shard", "1/2"}).status, 0);
    const Result merged = run({"merge", kFolder, "-o", kFolder + "/all.vrt"});
    EXPECT_EQ(merged.status, 1);
    EXPECT_THAT(merged.err, HasSubstr(kFolder + "/r0002_c0002.tif: is missing"));
    EXPECT_EQ(store_.objects().count("/bucket/hours/all.vrt"), 0u);
}

TEST_F(StoreTiles, FarGroundAndPlanAreReadThere) {
    const Words halo{"--halo", "2"};
    Words words{"plan", "sun",    "hours", bundled_dem(), "--date", "2026-12-21", "--tz",
                "UTC",  "--step", "30",    "--tiles",     "200",    "-o",         kFolder};
    words.insert(words.end(), halo.begin(), halo.end());
    const Result planned = run(words);
    ASSERT_EQ(planned.status, 0) << planned.err;
    EXPECT_EQ(store_.objects().count("/bucket/hours/plan_means.tif"), 1u);
    for (const char* const shard : {"1/2", "2/2"})
        ASSERT_EQ(make(kFolder, {"--halo", "2", "--resume", "--shard", shard}).status, 0);
    const fs::path here = dir_ / "near";
    ASSERT_EQ(make(here.string(), halo).status, 0);
    for (const auto& [name, content] : tiles())
        EXPECT_EQ(content, read_text(here / fs::path(name).filename(), "test")) << name;
}

TEST_F(StoreTiles, PicturesThatAreThereAreKept) {
    std::ofstream(dir_ / "job.json") << R"({"format": 1, "dem": {"files": [")" << bundled_dem()
                                     << R"("]}, "picture": {"size": [64, 48]},
        "effects": {"only": []}, "time": {"at": "12:00", "date": "2026-06-21"},
        "sweep": [{"times": {"from": "10:00", "to": "12:00", "step": "1h"}}],
        "output": "/vsis3/bucket/day/{time:%H%M}.png"})";
    const std::string job = (dir_ / "job.json").string();
    const Result part = run({"run", job, "--shard", "1/3", "--sidecar", "--trust"});
    ASSERT_EQ(part.status, 0) << part.err;
    const Result missing = run({"run", job, "--missing", "--sidecar", "--trust"});
    EXPECT_EQ(missing.status, 1);
    EXPECT_THAT(missing.err, HasSubstr("2 of 3 pictures are missing or not whole"));
    const Result resumed = run({"run", job, "--resume", "--sidecar", "--trust"});
    ASSERT_EQ(resumed.status, 0) << resumed.err;
    EXPECT_THAT(resumed.err, HasSubstr("1 were there already"));
    EXPECT_EQ(run({"run", job, "--missing", "--sidecar", "--trust"}).status, 0);
    EXPECT_EQ(store_.objects().size(), 6u);
    store_.put("/bucket/day/1100.png", "no picture");
    const Result other = run({"run", job, "--resume", "--sidecar", "--trust"});
    EXPECT_EQ(other.status, 3);
    EXPECT_THAT(other.err, HasSubstr("/vsis3/bucket/day/1100.png: it is not a complete picture"));
    EXPECT_EQ(left(), 0u);
}

}  // namespace
}  // namespace relevo::test::test_store_tiles
