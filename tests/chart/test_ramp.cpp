#include <cmath>
#include <fstream>
#include <limits>

#include <gmock/gmock.h>

#include "chart/legend.h"
#include "chart/ramp.h"
#include "support/support.h"

namespace relevo::chart {
namespace {

using test::error_of;
using testing::DoubleNear;
using testing::ElementsAre;

TEST(Ramp, MixesWhatLiesBetweenTwoStopsAndEndsAtItsEnds) {
    const Ramp ramp{{{0, {0x000000}}, {10, {0xc86432, 0.5}}}};
    EXPECT_EQ(ramp.at(5).rgb, 0x643219u);
    EXPECT_DOUBLE_EQ(ramp.at(5).opacity, 0.75);
    EXPECT_EQ(ramp.at(-3).rgb, 0x000000u);
    EXPECT_EQ(ramp.at(12).rgb, 0xc86432u);
    EXPECT_EQ(ramp.at(std::numeric_limits<double>::quiet_NaN()).opacity, 0);
}

TEST(Ramp, ClassesHaveTheirOwnColourEach) {
    Ramp ramp{{{0, {0x112233}}, {1, {0x445566}}}};
    ramp.continuous = false;
    EXPECT_EQ(ramp.at(0.9).rgb, 0x112233u);
    EXPECT_EQ(ramp.at(1).rgb, 0x445566u);
}

TEST(Ramp, BuiltInOnesGoFromOneEndToTheOther) {
    for (const std::string& name : ramp_names()) {
        const Ramp ramp = named_ramp(name, -2, 6);
        EXPECT_EQ(ramp.stops.front().value, -2) << name;
        EXPECT_NEAR(ramp.stops.back().value, 6, 1e-12) << name;
    }
    EXPECT_EQ(error_of([] { named_ramp("rainbow", 0, 1); }),
              "exit 3: --overlay-colours: rainbow: expected sun, shade, steel, viridis, inferno, "
              "grey or a "
              "colour file of GDAL's with a slash or a dot in its name");
    EXPECT_EQ(error_of([] { named_ramp("sun", 1, 1); }),
              "exit 3: --overlay-colours: 1 to 1: expected an end over the beginning");
}

class ColourFile : public testing::Test {
  protected:
    std::string write(const std::string& text) {
        const std::string path = (dir_ / "colours.txt").string();
        std::ofstream(path) << text;
        return path;
    }
    std::filesystem::path dir_ = test::scratch_dir("colour_file");
};

TEST_F(ColourFile, HasSharesNamesAlphaAndCellsWithoutAValue) {
    const Ramp ramp = read_ramp(
        write("# heights\n100% White\r\n0 10 20 30\n\n50%\t1:2:3:51\nnv 9 8 7\n"), 0, 1000);
    ASSERT_EQ(ramp.stops.size(), 3u);
    EXPECT_EQ(ramp.stops[0].color.rgb, 0x0a141eu);
    EXPECT_EQ(ramp.stops[1].value, 500);
    EXPECT_EQ(ramp.stops[1].color.rgb, 0x010203u);
    EXPECT_DOUBLE_EQ(ramp.stops[1].color.opacity, 0.2);
    EXPECT_EQ(ramp.stops[2].value, 1000);
    EXPECT_EQ(ramp.stops[2].color.rgb, 0xffffffu);
    EXPECT_EQ(ramp.at(std::nan("")).rgb, 0x090807u);
}

TEST_F(ColourFile, WhatIsNoneIsRefusedByItsLine) {
    const auto said = [&](const std::string& text) {
        const std::string path = write(text);
        const std::string what = error_of([&] { read_ramp(path, 0, 1); });
        const std::string begin = "exit 3: --overlay-colours: " + path + ": ";
        EXPECT_EQ(what.substr(0, begin.size()), begin);
        return what.substr(begin.size());
    };
    EXPECT_EQ(said("0 1 2 3\nhigh 1 2 3\n"),
              "line 2: expected a value, a share such as 40%, or nv but got high");
    EXPECT_EQ(said("0 1 2\n"),
              "line 1: expected red, green and blue from 0 to 255, perhaps an alpha, or a colour's "
              "name, but got 1 2");
    EXPECT_EQ(said("0 1 2 300\n"),
              "line 1: expected red, green and blue from 0 to 255, perhaps an alpha, or a colour's "
              "name, but got 1 2 300");
    EXPECT_EQ(said("# nothing\n"), "expected lines of a value and a colour but got none");
}

TEST(Legend, HasRoundValues) {
    EXPECT_THAT(round_values(0, 14.3, 6),
                ElementsAre(DoubleNear(0, 1e-9), DoubleNear(5, 1e-9), DoubleNear(10, 1e-9)));
    EXPECT_THAT(round_values(-0.05, 0.21, 6),
                ElementsAre(DoubleNear(-0.05, 1e-9), DoubleNear(0, 1e-9), DoubleNear(0.05, 1e-9),
                            DoubleNear(0.1, 1e-9), DoubleNear(0.15, 1e-9), DoubleNear(0.2, 1e-9)));
    EXPECT_TRUE(round_values(1, 1, 6).empty());
}

TEST(Legend, StandsOnAPictureWithItsTitleRampAndValues) {
    const Drawing drawing = legend({"Sun hours", "h", named_ramp("sun", 0, 14)});
    std::vector<std::string> words;
    for (const Drawing::Item& item : drawing.items())
        if (const auto* text = std::get_if<Drawing::Text>(&item)) words.push_back(text->words);
    EXPECT_THAT(words, ElementsAre("Sun hours", "0", "5", "10 h"));
    image::Image8 picture(300, 300, 3);
    paint(drawing, 100, 50, 1, picture);
    // The ramp's ends, below and above; nothing outside of the panel.
    int below = 0, above = 0;
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const auto is = [&](int r, int g, int b) {
                return std::abs(picture.at(x, y, 0) - r) < 6 &&
                       std::abs(picture.at(x, y, 1) - g) < 6 &&
                       std::abs(picture.at(x, y, 2) - b) < 6;
            };
            if (is(0x1f, 0x2a, 0x50)) below = y;
            if (!above && is(0xfd, 0xf3, 0xa8)) above = y;
            if (x < 100 || y < 50) {
                EXPECT_EQ(picture.at(x, y, 0) + picture.at(x, y, 1), 0);
            }
        }
    EXPECT_GT(above, 50);
    EXPECT_GT(below, above + 130);
}

}  // namespace
}  // namespace relevo::chart
