// Whole texts, compared byte by byte with tests/shader/golden. RELEVO_WRITE_GOLDENS=1 writes them
// anew; read the difference before committing it.
#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>

#include "shader/fixture.h"

namespace relevo::shader::test::test_golden {
namespace {

struct Golden {
    const char* name;
    std::vector<std::string> plugins;
    ProgramRecipe program;
};

const std::vector<std::string> kAll = {"ground", "bump", "sky", "haze", "wobble", "filmic"};

class GoldenText : public testing::TestWithParam<Golden> {};

void compare(const std::string& name, const StageText& stage) {
    const std::filesystem::path path = shader_tests() / "golden" / name;
    // The line map beside the text: plugin or core, file and line; nothing for generated lines.
    std::string text;
    const std::vector<std::string> lines = lines_of(stage.text);
    ASSERT_EQ(lines.size(), stage.lines.size() + 1);
    for (std::size_t i = 0; i < stage.lines.size(); ++i) {
        const LineOrigin& from = stage.lines[i];
        const std::string file = std::filesystem::path(from.file).filename().string();
        const std::string place =
            from.file.empty() ? "" : from.owner + ' ' + file + ':' + std::to_string(from.line);
        text += place + std::string(place.size() < 30 ? 30 - place.size() : 0, ' ') + "| " +
                lines[i] + '\n';
    }
    if (std::getenv("RELEVO_WRITE_GOLDENS")) {
        std::ofstream(path, std::ios::binary) << text;
        return;
    }
    EXPECT_EQ(text, read_text(path, "golden"));
}

TEST_P(GoldenText, IsByteForByte) {
    const Selection selection(GetParam().plugins);
    const Stitched stitched = stitch(fixture_core(), GetParam().program, selection.input());
    compare(std::string(GetParam().name) + ".vert.txt", stitched.vertex);
    compare(std::string(GetParam().name) + ".frag.txt", stitched.fragment);
    if (std::getenv("RELEVO_WRITE_GOLDENS")) GTEST_SKIP() << "written, not compared";
}

INSTANTIATE_TEST_SUITE_P(All, GoldenText,
                         testing::Values(Golden{"none_terrain", {}, terrain_program()},
                                         Golden{"haze_terrain", {"haze"}, terrain_program()},
                                         Golden{"ground_terrain", {"ground"}, terrain_program()},
                                         Golden{"bump_terrain", {"bump"}, terrain_program()},
                                         Golden{"wobble_depth", {"wobble"}, depth_program()},
                                         Golden{"all_terrain", kAll, terrain_program()},
                                         Golden{"all_depth", kAll, depth_program()},
                                         Golden{"all_sky", kAll, sky_program()},
                                         Golden{"all_post", kAll, post_program()},
                                         Golden{"all_geometry", kAll, geometry_program()},
                                         Golden{"all_shading", kAll, shading_program()}),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace relevo::shader::test::test_golden
