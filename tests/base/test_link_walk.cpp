#include <filesystem>
#include <fstream>

#include <sys/stat.h>
#include <unistd.h>

#include "base/output_file.h"
#include "base/text.h"
#include "support/support.h"

namespace relevo {
namespace {

namespace fs = std::filesystem;
using test::error_of;

constexpr uid_t kAnotherUser = 65534;

/// A folder as /tmp is, and one that is ours alone.
class LinksOfOthers : public testing::Test {
  protected:
    LinksOfOthers() {
        fs::create_directory(shared_);
        fs::create_directory(ours_);
        chmod(shared_.c_str(), 0777);
        std::ofstream(ours_ / "precious.csv") << "precious";
        if (geteuid() != 0) return;
        link(ours_ / "precious.csv", shared_ / "a.csv");
        link(ours_, shared_ / "folder");
        fs::create_symlink("../shared/folder", ours_ / "way");
    }
    void SetUp() override {
        if (geteuid() != 0) GTEST_SKIP() << "not run: only root makes links of other users";
    }

    static void link(const fs::path& to, const fs::path& name) {
        fs::create_symlink(to, name);
        ASSERT_EQ(lchown(name.c_str(), kAnotherUser, kAnotherUser), 0);
    }
    std::string error(const fs::path& path) const {
        return error_of([&] { write_text(path, "new", true, "test"); });
    }
    std::string refusal(const fs::path& path, const fs::path& link) const {
        return "exit 3: test: " + path.string() + ": the link " + link.string() +
               " is another user's, in a folder that others can write to; name the place that it "
               "leads to";
    }

    fs::path dir_ = fs::canonical(test::scratch_dir("links"));
    fs::path shared_ = dir_ / "shared", ours_ = dir_ / "ours";
};

TEST_F(LinksOfOthers, AreNotFollowedInFoldersThatTheyCanWriteTo) {
    EXPECT_EQ(error(shared_ / "a.csv"), refusal(shared_ / "a.csv", shared_ / "a.csv"));
    // On the way too, and by way of a link of ours, whether the file is there or not.
    EXPECT_EQ(error(shared_ / "folder/precious.csv"),
              refusal(shared_ / "folder/precious.csv", shared_ / "folder"));
    EXPECT_EQ(error(ours_ / "way/new.csv"), refusal(ours_ / "way/new.csv", shared_ / "folder"));
    chmod(shared_.c_str(), 01770);
    EXPECT_EQ(error(shared_ / "a.csv"), refusal(shared_ / "a.csv", shared_ / "a.csv"));
    EXPECT_EQ(read_text(ours_ / "precious.csv", "test"), "precious");
    EXPECT_FALSE(fs::exists(ours_ / "new.csv"));
}

TEST_F(LinksOfOthers, AreFollowedInFoldersOfTheirOwnAndInThoseThatNobodyElseWritesTo) {
    chmod(shared_.c_str(), 0755);
    EXPECT_EQ(error(shared_ / "a.csv"), "no error");
    chmod(shared_.c_str(), 0777);
    ASSERT_EQ(chown(shared_.c_str(), kAnotherUser, kAnotherUser), 0);
    EXPECT_EQ(error(shared_ / "folder/new.csv"), "no error");
    EXPECT_EQ(read_text(ours_ / "precious.csv", "test"), "new");
    EXPECT_EQ(read_text(ours_ / "new.csv", "test"), "new");
}

}  // namespace
}  // namespace relevo
