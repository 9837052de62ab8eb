#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/cache_folder.h"
#include "base/error.h"
#include "support/support.h"

namespace relevo {
namespace {

namespace fs = std::filesystem;

class CacheFolderTest : public testing::Test {
  protected:
    CacheFolderTest() { fs::remove_all(place_); }
    ~CacheFolderTest() override {
        std::error_code ignored;  // not every case makes the folder
        fs::permissions(place_, fs::perms::owner_all, ignored);
        fs::remove_all(place_, ignored);
    }

    /// A name such as files of a cache have.
    static std::string digest(const std::string& end) {
        return std::string(64 - end.size(), '0') + end;
    }
    static std::vector<std::uint32_t> numbers(std::size_t count) {
        std::vector<std::uint32_t> values(count);
        std::iota(values.begin(), values.end(), 7);
        return values;
    }
    static std::string store(const CacheFolder& folder, const std::string& name,
                             std::size_t count) {
        const std::vector<std::uint32_t> values = numbers(count);
        return folder.write(name, static_cast<std::int64_t>(4 * count), [&](CacheWriter& file) {
            file.write_text("what it is");
            file.write_values(values.data(), values.size());
            return true;
        });
    }
    static bool holds(const CacheFolder& folder, const std::string& name, std::size_t count) {
        std::optional<CacheReader> file = folder.open(name);
        if (!file || file->read_text(100) != "what it is") return false;
        std::vector<std::uint32_t> values(count);
        return file->read_values(values.data(), values.size()) && values == numbers(count);
    }
    std::size_t files() const {
        std::error_code ignored;
        return static_cast<std::size_t>(std::distance(fs::directory_iterator(place_, ignored), {}));
    }

    const fs::path place_ =
        fs::path(testing::TempDir()) / ("relevo_cache_" + std::to_string(getpid()));
    const CacheFolder folder_{place_ / "levels", std::int64_t{1} << 24};
    // More than one piece that has a checksum, and a part of one.
    static constexpr std::size_t kCount = (std::size_t{3} << 20) + 5;
};

TEST_F(CacheFolderTest, GivesBackWhatWasWritten) {
    EXPECT_FALSE(folder_.open(digest("a")));
    EXPECT_TRUE(folder_.entries().empty());
    EXPECT_EQ(store(folder_, digest("a"), kCount), "");
    EXPECT_EQ(store(folder_, digest("f"), 0), "");
    EXPECT_TRUE(holds(folder_, digest("a"), kCount));
    EXPECT_TRUE(holds(folder_, digest("f"), 0));
    EXPECT_FALSE(holds(folder_, digest("a"), kCount - 1)) << "another length";
    EXPECT_EQ(folder_.entries().size(), 2U);
    folder_.clear();
    EXPECT_TRUE(folder_.entries().empty());
}

TEST_F(CacheFolderTest, LeavesWhatIsNotItsOwn) {
    const fs::path other = place_ / "mine";
    fs::create_directories(other);
    fs::create_directory_symlink(other, place_ / "levels");
    const std::vector<fs::path> mine{other / "thesis.tex", other / "thesis.part",
                                     other / (digest("a") + ".tif")};
    for (const fs::path& file : mine)
        std::ofstream(file) << "mine";
    fs::create_symlink(other / "thesis.tex", other / digest("c"));
    ASSERT_EQ(store(folder_, digest("b"), kCount), "");
    EXPECT_EQ(folder_.entries().size(), 1U);
    EXPECT_EQ(folder_.clear(), "");
    EXPECT_FALSE(fs::exists(other / digest("b")));
    for (const fs::path& file : mine)
        EXPECT_TRUE(fs::exists(file)) << file;
    EXPECT_TRUE(fs::is_symlink(other / digest("c")));
}

TEST_F(CacheFolderTest, FindsEveryKindOfDamage) {
    ASSERT_EQ(store(folder_, digest("a"), kCount), "");
    const fs::path file = place_ / "levels" / digest("a");
    const auto size = static_cast<std::streamoff>(fs::file_size(file));
    // In the length and the text, in a checksum, in the first and the last byte of the numbers.
    for (const std::streamoff at :
         {std::streamoff{0}, std::streamoff{17}, std::streamoff{40}, size / 2, size - 1}) {
        std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
        bytes.seekg(at);
        const auto before = static_cast<char>(bytes.get());
        bytes.seekp(at);
        bytes.put(static_cast<char>(before ^ 0x10));
        bytes.close();
        EXPECT_FALSE(holds(folder_, digest("a"), kCount)) << "byte " << at;
        bytes.open(file, std::ios::in | std::ios::out | std::ios::binary);
        bytes.seekp(at);
        bytes.put(before);
        bytes.close();
        EXPECT_TRUE(holds(folder_, digest("a"), kCount));
    }
    for (const std::streamoff left : {std::streamoff{0}, std::streamoff{4}, size / 2, size - 1}) {
        ASSERT_EQ(store(folder_, digest("a"), kCount), "");
        fs::resize_file(file, static_cast<std::uintmax_t>(left));
        EXPECT_FALSE(holds(folder_, digest("a"), kCount)) << "cut to " << left;
    }
}

TEST_F(CacheFolderTest, RemovesWhatWasUsedLongestAgo) {
    constexpr std::size_t kThird = std::size_t{1} << 20;  // 4 of 16 MiB, and their text
    for (const char* name : {"a", "b", "c"})
        ASSERT_EQ(store(folder_, digest(name), kThird), "");
    const auto used = [&](const char* name, int hours) {
        fs::last_write_time(place_ / "levels" / digest(name),
                            fs::file_time_type::clock::now() - std::chrono::hours(hours));
    };
    used("a", 5), used("b", 7), used("c", 6);
    EXPECT_TRUE(holds(folder_, digest("b"), kThird));  // now it was used last
    EXPECT_EQ(store(folder_, digest("d"), kThird), "");
    EXPECT_TRUE(holds(folder_, digest("a"), kThird));
    EXPECT_TRUE(holds(folder_, digest("b"), kThird));
    EXPECT_FALSE(folder_.open(digest("c"))) << "used 6 hours ago";
    EXPECT_TRUE(holds(folder_, digest("d"), kThird));
    EXPECT_EQ(store(folder_, digest("e"), 5 * kThird), "it is larger than the cache");
    EXPECT_EQ(files(), 1U) << "one folder";
}

TEST_F(CacheFolderTest, SaysWhatPreventsIt) {
    EXPECT_EQ(store({{}, 100000}, digest("a"), 5), "neither XDG_CACHE_HOME nor HOME is set");
    fs::create_directories(place_);
    std::ofstream(place_ / "levels") << "no folder";
    EXPECT_NE(store(folder_, digest("a"), 5), "");
    fs::remove(place_ / "levels");
    // Also for the user root.
    EXPECT_THAT(
        store({"/sys/relevo", 100000}, digest("a"), 5),
        testing::AnyOf("Operation not permitted", "Permission denied", "Read-only file system"));
    constexpr std::int64_t kMore = std::int64_t{1} << 60;  // than disks have
    EXPECT_EQ(CacheFolder(place_ / "levels", kMore)
                  .write(digest("a"), kMore, [](CacheWriter&) { return true; }),
              "the disk would have less than 1 GiB left");
    if (geteuid() != 0) {
        fs::permissions(place_, fs::perms::owner_read | fs::perms::owner_exec);
        EXPECT_THAT(store(folder_, digest("a"), 5), testing::HasSubstr("Permission denied"));
        fs::permissions(place_, fs::perms::owner_all);
    }
    // What an exception or a false ends is not there.
    EXPECT_EQ(folder_.write(digest("a"), 5, [](CacheWriter&) -> bool { failed("no heights"); }),
              "no heights");
    EXPECT_NE(folder_.write(digest("a"), 5, [](CacheWriter&) { return false; }), "");
    EXPECT_TRUE(folder_.entries().empty());
}

TEST_F(CacheFolderTest, AFullDiskLeavesNothing) {
    const pid_t child = fork();
    if (child == 0) {
        std::signal(SIGXFSZ, SIG_IGN);
        const struct rlimit limit { 1 << 20, 1 << 20 };
        setrlimit(RLIMIT_FSIZE, &limit);
        const std::string why = store(folder_, digest("a"), kCount);
        _exit(why.ends_with("File too large") && folder_.entries().empty() ? 0 : 1);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
    EXPECT_EQ(store(folder_, digest("a"), kCount), "");
    EXPECT_TRUE(holds(folder_, digest("a"), kCount));
}

TEST_F(CacheFolderTest, KilledAtAnyMomentItBeginsAgain) {
    for (int i = 0; i < 12; ++i) {
        const pid_t child = fork();
        if (child == 0) {
            while (true)
                store(folder_, digest("a"), kCount);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(3 + 4 * i));
        kill(child, SIGKILL);
        waitpid(child, nullptr, 0);
        // Whole or absent, whenever that was.
        EXPECT_EQ(holds(folder_, digest("a"), kCount), folder_.open(digest("a")).has_value());
        EXPECT_LE(folder_.entries().size(), 2U);
    }
    EXPECT_EQ(store(folder_, digest("a"), kCount), "");
    EXPECT_TRUE(holds(folder_, digest("a"), kCount));
}

TEST_F(CacheFolderTest, TwoProcessesMayMakeTheSameFile) {
    std::vector<pid_t> children;
    for (int i = 0; i < 2; ++i) {
        const pid_t child = fork();
        if (child == 0) {
            bool fine = true;
            for (int k = 0; k < 10; ++k) {
                fine = fine && store(folder_, digest("a"), kCount).empty();
                fine = fine && holds(folder_, digest("a"), kCount);
            }
            _exit(fine ? 0 : 1);
        }
        children.push_back(child);
    }
    for (const pid_t child : children) {
        int status = 1;
        waitpid(child, &status, 0);
        EXPECT_EQ(status, 0);
    }
    EXPECT_EQ(folder_.entries().size(), 1U);
}

}  // namespace
}  // namespace relevo
