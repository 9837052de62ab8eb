#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "cli/program.h"
#include "dem/fixture.h"
#include "support/support.h"

/// What a picture takes of memory, and what is kept on disk of a large DEM.
namespace relevo::test::test_memory {
namespace {

namespace fs = std::filesystem;

std::string bytes_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// A DEM of mirrored copies of the bundled one, in strips of 64 rows, and a cache of its own.
class LargeDem : public testing::Test {
  protected:
    LargeDem() { setenv("XDG_CACHE_HOME", (folder() / "cache").c_str(), 1); }
    ~LargeDem() override { unsetenv("XDG_CACHE_HOME"); }

    static std::string make(int side) {
        const std::string path = (folder() / fmt::format("{}.tif", side)).string();
        const Result made =
            run(build_dir() / "bin/make_dem", {bundled_dem(), std::to_string(side),
                                               std::to_string(side), path, "--layout", "strips64"});
        EXPECT_EQ(made.status, 0) << made.err;
        return path;
    }
    static std::vector<std::string> capture(const std::string& dem,
                                            const std::vector<std::string>& more = {}) {
        std::vector<std::string> words{"capture",          dem,           "-o",
                                       picture().string(), "--overwrite", "--device",
                                       "software",         "--time",      "2026-06-21T12:00Z"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    static std::vector<std::string> sky_view(const std::string& dem,
                                             const std::vector<std::string>& more = {}) {
        std::vector<std::string> words{"sun", "sky-view",    dem,  "--directions",
                                       "4",   "--overwrite", "-o", (folder() / "sky.tif").string()};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    static fs::path picture() { return folder() / "picture.png"; }
    static fs::path levels() { return folder() / "cache/relevo/levels"; }
    static std::size_t entries() {
        std::error_code none;
        return static_cast<std::size_t>(std::distance(fs::directory_iterator(levels(), none), {}));
    }
};

TEST_F(LargeDem, PicturesTakeWhatMemoryAllows) {
    const std::string small = make(2), large = make(6000);
    relevo(capture(small, {"--allow-blank"}));  // the driver keeps its programs
    const int floor_mib = measured(capture(small, {"--allow-blank"})).peak_mib;
    for (const int mib : {64, 96}) {
        const std::vector<std::string> memory{"--memory", std::to_string(mib), "--no-cache",
                                              "--view", "whole"};
        const Measured found = measured(capture(large, memory));
        ASSERT_EQ(found.run.status, 0) << found.run.err;
        fmt::print("[ memory ] --memory {}: {} MiB above a floor of {}\n", mib,
                   found.peak_mib - floor_mib, floor_mib);
        constexpr int kScatter_mib = 16;  // of a renderer whose threads others keep waiting
        EXPECT_LE(found.peak_mib - floor_mib, mib * 5 / 4 + kScatter_mib);
    }
    EXPECT_EQ(entries(), 0U) << "--no-cache";
    const std::string timings = (folder() / "timings.json").string();
    ASSERT_EQ(relevo(capture(small, {"--allow-blank", "--timings", timings})).status, 0);
    const nlohmann::json memory = nlohmann::json::parse(bytes_of(timings)).at("memory_mib");
    EXPECT_EQ(memory.at("allowed"), 3072);
    EXPECT_NEAR(memory.at("peak").get<double>(), floor_mib, 0.2 * floor_mib);
    expect_failure(capture(small, {"--memory", "63"}), 3, "--memory 63: pictures need at least 64");
}

TEST_F(LargeDem, FiguresTakeWhatMemoryAllows) {
    const int floor_mib = measured(sky_view(make(2))).peak_mib;
    const std::string large = make(2000);
    std::string whole;
    // Held whole from 92 on; below, posts are read where they are needed.
    for (const int mib : {3072, 96, 88, 64, 1}) {
        const Measured found = measured(sky_view(large, {"--memory", std::to_string(mib)}));
        ASSERT_EQ(found.run.status, 0) << found.run.err;
        fmt::print("[ memory ] sky-view --memory {}: {} MiB above a floor of {}\n", mib,
                   found.peak_mib - floor_mib, floor_mib);
        constexpr int kLeast_mib = 48;  // to write the result
        EXPECT_LE(found.peak_mib - floor_mib, std::max(kLeast_mib, mib * 5 / 4));
        const std::string bytes = bytes_of(folder() / "sky.tif");
        if (whole.empty()) whole = bytes;
        EXPECT_TRUE(bytes == whole) << mib;
    }
}

TEST_F(LargeDem, ACachedDemGivesTheSamePicture) {
    const std::string dem = make(6000);
    const auto draw = [&](const std::vector<std::string>& more = {}) {
        std::vector<std::string> words{"--memory", "256"};
        words.insert(words.end(), more.begin(), more.end());
        const Result drawn = relevo(capture(dem, words));
        EXPECT_EQ(drawn.status, 0) << drawn.err;
        return std::pair(bytes_of(picture()), drawn.err);
    };
    const std::string fresh = draw({"--no-cache"}).first;
    EXPECT_EQ(entries(), 0U);
    EXPECT_TRUE(draw().first == fresh);
    EXPECT_EQ(entries(), 1U);
    const std::string after = draw({"-v"}).second;
    EXPECT_NE(after.find("averaged levels are read from"), std::string::npos) << after;
    EXPECT_TRUE(bytes_of(picture()) == fresh);
    // Near the ground, finer levels come from the file.
    const std::vector<std::string> near{"--eye", "33,-82,300agl", "--pitch", "-20"};
    const std::string cached_near = draw(near).first;
    std::vector<std::string> uncached = near;
    uncached.emplace_back("--no-cache");
    EXPECT_TRUE(draw(uncached).first == cached_near);
    const Result list = relevo({"cache"});
    EXPECT_NE(list.out.find("averaged levels of 1 DEM\n"), std::string::npos) << list.out;
    EXPECT_NE(list.out.find(fs::canonical(dem).string()), std::string::npos) << list.out;
    // A damaged entry is replaced.
    fs::resize_file(fs::directory_iterator(levels())->path(), 1000);
    const auto [repaired, told] = draw();
    EXPECT_TRUE(repaired == fresh);
    EXPECT_NE(told.find(": damaged, so the DEM is read again"), std::string::npos) << told;
    EXPECT_EQ(relevo({"cache", "--clear"}).status, 0);
    EXPECT_EQ(entries(), 0U);
    // A file lies where the folder should be; a folder that not even root may write to.
    fs::remove_all(folder() / "cache");
    std::ofstream(folder() / "cache") << "a file";
    for (const std::string& place : {(folder() / "cache").string(), std::string("/sys")}) {
        setenv("XDG_CACHE_HOME", place.c_str(), 1);
        const auto [without, why] = draw();
        EXPECT_TRUE(without == fresh);
        EXPECT_NE(why.find("averaged levels are not kept, "), std::string::npos) << why;
    }
}

}  // namespace
}  // namespace relevo::test::test_memory
