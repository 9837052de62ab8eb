// The tutorial for plugins, as it stands in docs/plugin-tutorial.md, in an empty folder.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/text.h"
#include "cli/program.h"
#include "image/image.h"
#include "support/support.h"

namespace relevo::test::test_plugin_tutorial {
namespace {

/// A fenced block of the document: "sh", or "glsl" with the name of a file.
struct Block {
    std::string kind, file, text;
};

std::vector<Block> blocks() {
    std::vector<Block> found;
    bool inside = false;
    const std::string text = read_text(source_dir() / "docs/plugin-tutorial.md", "test");
    for (const std::string& line : split(text, '\n')) {
        if (line.starts_with("```")) {
            inside = !inside;
            if (!inside) continue;
            const std::vector<std::string> words = split(line.substr(3), ' ');
            found.push_back({words.at(0), words.size() > 1 ? words[1] : "", ""});
        } else if (inside) {
            found.back().text += line + '\n';
        }
    }
    return found;
}

TEST(PluginTutorial, DoesWhatItSays) {
    const std::filesystem::path folder = scratch_dir("tutorial");
    std::filesystem::copy_file(bundled_dem(), folder / "valley.tif");
    for (const Block& block : blocks()) {
        if (block.kind == "glsl") {
            std::ofstream(folder / block.file) << block.text;
            continue;
        }
        ASSERT_EQ(block.kind, "sh");
        const Result done = run("/bin/sh", {"-ec", "cd '" + folder.string() + "'\n" + block.text},
                                {"PATH=" + (build_dir() / "bin").string() + ":/usr/bin:/bin",
                                 "XDG_DATA_HOME=" + (folder / "data").string()});
        ASSERT_EQ(done.status, 0) << block.text << done.out << done.err;
    }
    const auto picture = [&](const char* name) { return image::read(folder / name); };
    const auto blue = [](const image::Image8& of) {
        int count = 0;
        for (int y = 0; y < of.height; ++y)
            for (int x = 0; x < of.width; ++x)
                count += of.at(x, y, 2) > of.at(x, y, 0) + 60;
        return count;
    };
    EXPECT_EQ(picture("1.png").width, 480);
    const int of_air = blue(picture("1.png"));
    EXPECT_GT(blue(picture("2.png")), of_air + 2000);
    EXPECT_GT(blue(picture("3.png")), blue(picture("2.png")) + 1000);
    int yellow = 0;
    const image::Image8 lined = picture("4.png");
    for (int y = 0; y < lined.height; ++y)
        for (int x = 0; x < lined.width; ++x)
            yellow += lined.at(x, y, 0) > 240 && lined.at(x, y, 2) < 60;
    EXPECT_GT(yellow, 100);
    EXPECT_TRUE(std::filesystem::exists(folder / "level/golden.png"));
    EXPECT_GT(image::compare(picture("5.png"), picture("4.png")).worst, 20);
}

}  // namespace
}  // namespace relevo::test::test_plugin_tutorial
