// Tables of what the classes of maps of land cover are.
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "climate/land_cover.h"
#include "support/support.h"

namespace relevo::climate::test_land_cover {
namespace {

using test::error_of;
using testing::HasSubstr;

std::string write_table(const std::string& text) {
    const std::filesystem::path path = test::scratch_dir() / "table.csv";
    std::ofstream(path) << text;
    return path.string();
}

Classes of(std::initializer_list<std::size_t> classes) {
    Classes set;
    for (const std::size_t one : classes)
        set.set(one);
    return set;
}

TEST(LandCoverTable, TheProgramsOwnSayWhatEachClassIs) {
    for (const std::string& name : LandCoverTable::names()) {
        const LandCoverTable table = LandCoverTable::named(name);
        EXPECT_GE(table.classes().count(), 11u) << name;
        const std::vector<std::uint32_t> texels = table.texels();
        ASSERT_EQ(texels.size(), 256u);
        for (std::size_t at = 0; at < texels.size(); ++at) {
            const std::uint32_t texel = texels[at];
            const unsigned sum = (texel & 255) + (texel >> 8 & 255) + (texel >> 16 & 255);
            EXPECT_LE(sum, 257u) << name << " " << at;
            EXPECT_TRUE(texel == 0 || texel >> 24 == 255) << name << " " << at;
            EXPECT_TRUE(table.classes().test(at) || texel == 0) << name << " " << at;
        }
    }
    const LandCoverTable world = LandCoverTable::named("worldcover");
    EXPECT_EQ(world.texels()[30], 0xFF00FF00u);  // grassland
    EXPECT_EQ(world.texels()[70], 0xFFFF0000u);  // snow and ice
    EXPECT_EQ(world.texels()[50], 0u);           // built-up
}

TEST(LandCoverTable, AMapIsKnownByItsClasses) {
    using Names = std::vector<std::string>;
    EXPECT_EQ(LandCoverTable::fitting(of({10, 30, 60})), Names{"worldcover"});
    EXPECT_EQ(LandCoverTable::fitting(of({0, 11, 41, 52})), Names{"nlcd"});
    EXPECT_EQ(LandCoverTable::fitting(of({2, 12, 23, 44, 48})), Names{"corine"});
    EXPECT_EQ(LandCoverTable::fitting(of({12, 23, 24, 31})), (Names{"nlcd", "corine"}));
    EXPECT_EQ(LandCoverTable::fitting(of({200})), Names{});
    EXPECT_EQ(text_of(of({3, 17, 200})), "3, 17, 200");
    EXPECT_EQ(text_of(of({3, 17, 200}), 2), "3, 17, ...");
}

TEST(LandCoverTable, ReadsATableOfOnesOwn) {
    const LandCoverTable table = LandCoverTable::read(
        write_table("# mine\n\n7, 0.5 ,0.25,0.25,mixed\r\n8,?,?,?\n9,0,0,0\n"));
    EXPECT_EQ(table.classes(), of({7, 8, 9}));
    EXPECT_EQ(table.texels()[7], 0xFF404080u);
    EXPECT_EQ(table.texels()[8], 0u);
    EXPECT_EQ(table.texels()[9], 0xFF000000u);
}

TEST(LandCoverTable, SaysWhatIsWrong) {
    const auto fault = [](const std::string& text) {
        return error_of([&] { LandCoverTable::read(write_table(text)); });
    };
    for (const char* line : {"x,0,0,0", "256,0,0,0", "-1,0,0,0", "1.5,0,0,0", "1,0,0", "1,0,0,nan",
                             "1,0.6,0.6,0", "1,-0.1,0,0", "1,?,0,0", "1,0,0,1e400"})
        EXPECT_THAT(fault(std::string("# a\n") + line + "\n"),
                    HasSubstr("table.csv:2: expected CLASS,TREES,PLANTS,ICE"))
            << line;
    EXPECT_THAT(fault("1,0,0,0\n1,0,0,0\n"), HasSubstr("table.csv:2: class 1 is there twice"));
    EXPECT_THAT(fault("# nothing\n"), HasSubstr("has no classes"));
    EXPECT_THAT(error_of([] { LandCoverTable::read("/none.csv"); }), HasSubstr("cannot be read"));
    EXPECT_EQ(error_of([] { LandCoverTable::named("moon"); }),
              "exit 3: land cover: no classes named \"moon\"; expected worldcover, nlcd, corine, "
              "or a file, whose name has a dot or a slash");
}

}  // namespace
}  // namespace relevo::climate::test_land_cover
