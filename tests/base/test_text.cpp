#include <filesystem>
#include <fstream>

#include <sys/stat.h>

#include "base/paths.h"
#include "base/text.h"
#include "support/support.h"

namespace relevo {
namespace {

TEST(Text, SplitKeepsEmptyPieces) {
    EXPECT_EQ(split("a,,b", ','), (std::vector<std::string>{"a", "", "b"}));
    EXPECT_EQ(split("", ','), std::vector<std::string>{});
    EXPECT_EQ(split("a,", ','), (std::vector<std::string>{"a", ""}));
}

TEST(Text, NumbersFillTheWholeText) {
    EXPECT_EQ(parse_number("-33.9"), -33.9);
    EXPECT_EQ(parse_number("+1e3"), 1000.0);
    for (const char* text : {"", "1.5x", " 1", "nan", "inf", "1,5", "--1"})
        EXPECT_FALSE(parse_number(text)) << text;
}

TEST(Text, NearestSuggestsOnlyCloseWords) {
    const std::vector<std::string> words{"haze", "sky", "layering"};
    EXPECT_EQ(nearest("hase", words), "haze");
    EXPECT_EQ(nearest("haez", words), "haze");
    EXPECT_EQ(nearest("layerin", words), "layering");
    EXPECT_FALSE(nearest("vsm", words));
    // Minutes, if its letters were compared.
    EXPECT_FALSE(nearest(std::string(100'000'000, 'h'), words));
}

TEST(Text, ReadingAMissingFileNamesIt) {
    EXPECT_EQ(test::error_of([] { read_text("/nowhere/a.txt", "text"); }),
              "exit 3: text: /nowhere/a.txt: cannot be read, No such file or directory");
}

TEST(Text, WhatIsNoRegularFileIsNotWaitedFor) {
    const std::filesystem::path folder = test::scratch_dir("text_special");
    const std::string pipe = (folder / "pipe").string();
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    for (const std::string& path : {pipe, std::string("/dev/zero"), folder.string()})
        EXPECT_EQ(test::error_of([&] { read_text(path, "text"); }),
                  "exit 3: text: " + path + ": cannot be read, it is not a regular file");
}

TEST(Text, AGiantFileIsRefusedUnread) {
    const std::filesystem::path path = test::scratch_dir("text_giant") / "giant";
    std::ofstream(path) << "a";
    EXPECT_EQ(read_text(path, "text"), "a");
    std::filesystem::resize_file(path, kMaxTextBytes);
    EXPECT_EQ(read_text(path, "text").size(), kMaxTextBytes);
    std::filesystem::resize_file(path, std::uintmax_t{1} << 40);
    EXPECT_EQ(test::error_of([&] { read_text(path, "text"); }),
              "exit 3: text: " + path.string() +
                  ": expected a text of at most 16 MiB but got a longer one");
}

TEST(Text, FilesThatTheKernelMakesUpAreReadWhole) {
    EXPECT_NE(read_text("/proc/self/status", "text").find("Pid:"), std::string::npos);
}

TEST(Paths, AFileInsideAFolderIsNotReachedFromIt) {
    const std::filesystem::path folder = test::scratch_dir("paths_inside");
    std::filesystem::create_directories(folder / "own/deep");
    std::ofstream(folder / "secret") << "s";
    std::ofstream(folder / "own/deep/a") << "a";
    std::filesystem::create_symlink(folder / "secret", folder / "own/link");
    std::filesystem::create_symlink("deep/a", folder / "own/near");
    std::filesystem::create_symlink(folder / "own", folder / "other");
    const auto inside = [&](const char* name) {
        return file_inside(folder / "own", name).has_value();
    };
    EXPECT_TRUE(inside("deep/a"));
    EXPECT_TRUE(inside("near"));
    EXPECT_TRUE(inside("deep/../deep/a"));
    EXPECT_TRUE(inside("missing"));
    EXPECT_FALSE(inside("../secret"));
    EXPECT_FALSE(inside("deep/../../secret"));
    EXPECT_FALSE(inside("link"));
    EXPECT_FALSE(inside((folder / "own/deep/a").c_str()));
    EXPECT_FALSE(inside("."));
    EXPECT_FALSE(inside(""));
    EXPECT_EQ(file_inside(folder / "other", "deep/a"), folder / "other/deep/a");
}

TEST(Text, PrintableNamesStayOnTheirLine) {
    for (const auto& [text, expected] : std::vector<std::pair<std::string, std::string>>{
             {"", ""},
             {"Z\xc3\xbcrich \xe2\x82\xac \xf0\x9f\x8f\x94.tif",
              "Z\xc3\xbcrich \xe2\x82\xac \xf0\x9f\x8f\x94.tif"},
             {"a\nb\tc\rd", "a\\nb\\tc\\rd"},
             {std::string("\0\x1f\x7f", 3), "\\x00\\x1f\\x7f"},
             {"\xc2\x80\xc2\x9f\xc2\xa0", "\\xc2\\x80\\xc2\\x9f\xc2\xa0"},  // C1 ends at U+00A0
             {"\xc0\xaf\xe0\x80\xaf", "\\xc0\\xaf\\xe0\\x80\\xaf"},         // overlong
             {"\xed\xa0\x80\xed\x9f\xbf", "\\xed\\xa0\\x80\xed\x9f\xbf"},   // a surrogate
             {"\xf4\x90\x80\x80\xf5", "\\xf4\\x90\\x80\\x80\\xf5"},         // above U+10FFFF
             {"\xe2\x82", "\\xe2\\x82"}})
        EXPECT_EQ(printable(text), expected);
    EXPECT_EQ(printable_lines("a\nb\tc\x1b"), "a\nb\tc\\x1b");
}

}  // namespace
}  // namespace relevo
