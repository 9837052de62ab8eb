// Tables in text files: numbers, and colours by colours.
#include <cstring>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "effect/plugins.h"
#include "effect/table_files.h"

namespace relevo::effect::test::test_table_files {
namespace {

using relevo::test::error_of;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<float> values(const image::TextureData& data) {
    std::vector<float> result(data.level(0).size() / sizeof(float));
    std::memcpy(result.data(), data.level(0).data(), data.level(0).size());
    return result;
}

class TableFiles : public testing::Test {
  protected:
    std::filesystem::path write(const std::string& name, const std::string& text) const {
        plugins_.write(name, text);
        return plugins_.folder() / name;
    }
    std::string error_of_table(const std::string& text) const {
        const auto file = write("t.csv", text);
        return plugins_.relative(error_of([&] { read_table(file); }));
    }
    std::string error_of_cube(const std::string& text) const {
        const auto file = write("t.cube", text);
        return plugins_.relative(error_of([&] { read_cube(file); }));
    }
    Plugins plugins_;
};

TEST_F(TableFiles, NumbersAreTexelsLineByLine) {
    for (const char* const text :
         {"height,share\n0,1.5\n100,-2\n200,3e2\n", "# made by hand\n0;1.5\n\n100;-2\r\n200;3e2",
          "0 1.5\n100\t-2\n 200 300"}) {
        const image::TextureData data = read_table(write("t.csv", text));
        EXPECT_EQ(data.width(), 2);
        EXPECT_EQ(data.height(), 3);
        EXPECT_THAT(values(data), ElementsAre(0, 1.5F, 100, -2, 200, 300));
    }
}

TEST_F(TableFiles, TheFirstLineIsAHeadingOnlyWithoutNumbers) {
    EXPECT_EQ(read_table(write("t.csv",
                               "\xEF\xBB\xBF"
                               "0,1\n2,3\n"))
                  .height(),
              2);
    EXPECT_EQ(read_table(write("t.csv", "slope deg,factor\n0,1\n2,3\n")).width(), 2);
    EXPECT_EQ(error_of_table("nan,1\n2,3\n"), "exit 3: plugin: t.csv:1: expected numbers");
    EXPECT_EQ(error_of_table("1,5;2,5\n"), "exit 3: plugin: t.csv:1: expected numbers");
}

TEST_F(TableFiles, WithoutAFileThereIsOneTexel) {
    EXPECT_THAT(values(read_table("")), ElementsAre(0));
    EXPECT_EQ(read_cube("").width(), 1);
}

TEST_F(TableFiles, MistakesNameTheirLine) {
    EXPECT_EQ(error_of_table("a,b\n1,2\n3,x\n"), "exit 3: plugin: t.csv:3: expected numbers");
    EXPECT_EQ(error_of_table("1,2\n3\n"),
              "exit 3: plugin: t.csv:2: expected 2 numbers as before but got 1");
    EXPECT_EQ(error_of_table("a,b\n"), "exit 3: plugin: t.csv:1: expected lines of numbers");
    EXPECT_EQ(error_of_table("1,nan\n"), "exit 3: plugin: t.csv:1: expected numbers");
    EXPECT_EQ(error_of_table("1e40\n"), "exit 3: plugin: t.csv:1: expected numbers");
    std::string tall;
    for (int i = 0; i < kMaxTableSide + 1; ++i)
        tall += "1\n";
    EXPECT_EQ(error_of_table(tall),
              "exit 3: plugin: t.csv:4097: expected at most 4096 lines and columns");
    EXPECT_THAT(error_of([] { read_table("/nowhere/t.csv"); }), HasSubstr("/nowhere/t.csv"));
}

/// A cube of 2 with red and blue exchanged.
std::string exchanged() {
    std::string text =
        "TITLE \"Exchanged\"\n# by hand\nLUT_3D_SIZE 2\nDOMAIN_MIN 0 0 0\nDOMAIN_MAX 1 1 1\n\n";
    for (int i = 0; i < 8; ++i)
        text += std::to_string(i >> 2) + ' ' + std::to_string(i >> 1 & 1) + ' ' +
                std::to_string(i & 1) + '\n';
    return text;
}

TEST_F(TableFiles, ACubeHasRedFastest) {
    const image::TextureData data = read_cube(write("t.cube", exchanged()));
    EXPECT_EQ(data.depth(), 2);
    const std::vector<float> found = values(data);
    // Red alone becomes blue alone.
    EXPECT_THAT((std::vector<float>{found[4], found[5], found[6], found[7]}),
                ElementsAre(0, 0, 1, 1));
}

TEST_F(TableFiles, MistakesInACubeNameTheirLine) {
    EXPECT_EQ(error_of_cube("0 0 0\n"),
              "exit 3: plugin: t.cube:1: expected LUT_3D_SIZE before the colours");
    EXPECT_EQ(error_of_cube("LUT_3D_SIZE 1000000000\n"),
              "exit 3: plugin: t.cube:1: expected LUT_3D_SIZE and a whole number from 2 to 128");
    EXPECT_EQ(error_of_cube("LUT_3D_SIZE 2.5\n"),
              "exit 3: plugin: t.cube:1: expected LUT_3D_SIZE and a whole number from 2 to 128");
    EXPECT_EQ(error_of_cube("LUT_1D_SIZE 2\n"),
              "exit 3: plugin: t.cube:1: expected LUT_3D_SIZE before the colours");
    EXPECT_EQ(error_of_cube("DOMAIN_MAX 2 2 2\n"),
              "exit 3: plugin: t.cube:1: expected a domain from 0 to 1");
    EXPECT_EQ(error_of_cube("LUT_3D_SIZE 2\n0 0\n"),
              "exit 3: plugin: t.cube:2: expected red, green and blue");
    EXPECT_EQ(error_of_cube("LUT_3D_SIZE 2\n0 0 0\n"),
              "exit 3: plugin: t.cube:2: expected 8 colours but got 1");
    EXPECT_EQ(error_of_cube(exchanged() + "0 0 0\n"),
              "exit 3: plugin: t.cube:15: expected 8 colours but there are more");
    EXPECT_THAT(error_of_cube(""), HasSubstr("expected LUT_3D_SIZE and colours"));
    EXPECT_THAT(error_of_cube("LUT_3D_SIZE 1e30\n"), HasSubstr("a whole number from 2 to 128"));
}

TEST_F(TableFiles, APluginHasThemByFileOrByText) {
    plugins_.write("plugins/curve/curve.csv", "0,1\n1,2\n");
    plugins_.add("curve", R"("textures": {"shipped": {"kind": "table", "file": "curve.csv"},
        "chosen": {"kind": "cube", "from": "look"}}, "texts": {"look": {"kind": "file"}})",
                 "uniform sampler2D curve_shipped;\nuniform sampler3D curve_chosen;\n"
                 "void curve_on_albedo(inout Surface s) {\n"
                 "    s.diffuse = texelFetch(curve_chosen, ivec3(0), 0).rgb * "
                 "texelFetch(curve_shipped, ivec2(0), 0).r;\n"
                 "}\n");
    const Registry registry = plugins_.load();
    ASSERT_TRUE(registry.broken().empty()) << registry.broken()[0].error;
    const Manifest& manifest = registry.effects()[0].manifest;
    EXPECT_EQ(manifest.textures[0].files.size(), 1U);
    EXPECT_EQ(manifest.textures[1].from, "curve.look");
}

}  // namespace
}  // namespace relevo::effect::test::test_table_files
