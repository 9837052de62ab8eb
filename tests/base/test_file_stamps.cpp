// What was read from files that have changed is not used again.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>

#include "base/file_stamps.h"
#include "support/support.h"

namespace relevo {
namespace {

void write(const std::filesystem::path& file, const char* text) {
    std::ofstream(file) << text;
}

/// Longer than the clock of a file system takes for a step.
void wait() {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
}

TEST(FileStamps, HoldUntilAFileChangesAppearsOrIsRemoved) {
    const std::filesystem::path folder = test::scratch_dir("file_stamps");
    const std::filesystem::path file = folder / "a", missing = folder / "b";
    write(file, "one");
    wait();
    const auto stamps = [&] {
        FileStamps made;
        for (const auto& path : {folder, file, missing})
            made.add(path);
        return made;
    };
    const FileStamps first = stamps();
    EXPECT_TRUE(first.hold());
    EXPECT_TRUE(first == stamps());
    const auto time = std::filesystem::last_write_time(file);
    write(file, "two");
    std::filesystem::last_write_time(file, time);  // as some editors and copies leave it
    EXPECT_FALSE(first.hold());
    EXPECT_FALSE(first == stamps());
    wait();
    const FileStamps second = stamps();
    EXPECT_TRUE(second.hold());
    write(missing, "");
    EXPECT_FALSE(second.hold());
    wait();
    const FileStamps third = stamps();
    EXPECT_TRUE(third.hold());
    std::filesystem::remove(file);
    EXPECT_FALSE(third.hold());
}

TEST(FileStamps, AFileThatChangesWhileItIsReadDoesNotHold) {
    const std::filesystem::path file = test::scratch_dir("file_stamps_read") / "a";
    write(file, "one");
    wait();
    FileStamps stamps;
    wait();
    write(file, "two");  // after it was read, before it is added
    stamps.add(file);
    EXPECT_FALSE(stamps.hold());
}

}  // namespace
}  // namespace relevo
