#include <filesystem>
#include <fstream>

#include "base/output_file.h"
#include "base/text.h"
#include "support/support.h"

namespace relevo {
namespace {

using test::error_of;

class OutputFile : public testing::Test {
  protected:
    std::filesystem::path dir_ = test::scratch_dir("output_file");
    std::filesystem::path path_ = dir_ / "a.csv";

    std::size_t files() const {
        return static_cast<std::size_t>(
            std::distance(std::filesystem::directory_iterator(dir_), {}));
    }
};

TEST_F(OutputFile, HasTheWholeText) {
    const std::string text = std::string("a,b\n1,2\n\0x", 10);
    write_text(path_, text, false, "test");
    EXPECT_EQ(read_text(path_, "test"), text);
    EXPECT_EQ(files(), 1U);
}

TEST_F(OutputFile, IsReplacedOnlyWhenAsked) {
    write_text(path_, "old", false, "test");
    EXPECT_EQ(error_of([&] { write_text(path_, "new", false, "test"); }),
              "exit 3: test: " + path_.string() + ": exists; pass --overwrite to replace it");
    EXPECT_EQ(read_text(path_, "test"), "old");
    write_text(path_, "new", true, "test");
    EXPECT_EQ(read_text(path_, "test"), "new");
    EXPECT_EQ(files(), 1U);
}

TEST_F(OutputFile, IsNotThereInPart) {
    {
        const PartialFile part(path_);
        std::ofstream(part.path()) << "half";
        EXPECT_EQ(part.path().parent_path(), dir_);
        EXPECT_FALSE(std::filesystem::exists(path_));
        EXPECT_EQ(files(), 1U);
    }
    EXPECT_EQ(files(), 0U);
    // The name was taken while the file was being written.
    const PartialFile part(path_);
    std::ofstream(part.path()) << "mine";
    std::ofstream(path_) << "theirs";
    EXPECT_EQ(error_of([&] { part.become(path_, false, "test"); }),
              "exit 1: test: " + path_.string() + ": cannot be written, File exists");
    EXPECT_EQ(read_text(path_, "test"), "theirs");
    part.become(path_, true, "test");
    EXPECT_EQ(read_text(path_, "test"), "mine");
}

TEST_F(OutputFile, ErrorsSayWhatIsWrong) {
    const std::filesystem::path nowhere = dir_ / "none" / "a.csv";
    EXPECT_EQ(error_of([&] { check_output_file(nowhere, true, "test"); }),
              "exit 3: test: " + nowhere.string() + ": the folder " + (dir_ / "none").string() +
                  " does not exist; make it first");
    EXPECT_EQ(error_of([&] { check_output_file(dir_, true, "test"); }),
              "exit 3: test: " + dir_.string() + ": is a folder");
}

}  // namespace
}  // namespace relevo
