#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <string>
#include <tuple>

#include <gmock/gmock.h>

#include "base/text.h"
#include "chart/legend.h"
#include "chart/ramp.h"
#include "support/support.h"

namespace relevo::chart::test_ramp {
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
    for (const std::string& name : ramp_names())
        for (const auto& [from, to] : {std::pair(-2.0, 6.0), {0.7, 1.0}, {1200.0, 3000.0}}) {
            const Ramp ramp = named_ramp(name, from, to);
            ASSERT_GE(ramp.stops.size(), 2u);
            for (std::size_t k = 0; k < ramp.stops.size(); ++k)
                EXPECT_NEAR(ramp.stops[k].value,
                            from + (to - from) * static_cast<double>(k) /
                                       static_cast<double>(ramp.stops.size() - 1),
                            1e-9)
                    << name;
        }
    // The colours of matplotlib's viridis at its ends, dark where the values are low.
    const Ramp viridis = named_ramp("viridis", 1200, 3000);
    EXPECT_EQ(viridis.at(1200).rgb, 0x440154u);
    EXPECT_EQ(viridis.at(3000).rgb, 0xfde725u);
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

TEST_F(ColourFile, SharesAreOfTheWayFromTheLeastValueToTheGreatest) {
    const Ramp ramp =
        read_ramp(write("0% 0 0 0\n25% 10 0 0\n1500 20 0 0\n100% 30 0 0\n"), 1000, 3000);
    std::vector<double> values;
    for (const Ramp::Stop& stop : ramp.stops)
        values.push_back(stop.value);
    EXPECT_THAT(values, ElementsAre(1000, 1500, 1500, 3000));
    EXPECT_EQ(ramp.at(2250).rgb, 0x190000u);
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
              "line 2: expected a value, a share such as 40%, or nv");
    EXPECT_EQ(said("0 1 2\n"),
              "line 1: expected red, green and blue from 0 to 255, perhaps an alpha, or a colour's "
              "name");
    EXPECT_EQ(said("0 1 2 300\n"),
              "line 1: expected red, green and blue from 0 to 255, perhaps an alpha, or a colour's "
              "name");
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

TEST(Legend, OfClassesHasAnEntryEachAndNoRamp) {
    Legend mask{"direct sun", "1", named_ramp("shade", 0, 1)};
    mask.classes = {{"in the sun", {0xffffff}}, {"in the shade", {0x14224d}}};
    const Drawing drawing = legend(mask);
    std::vector<std::string> words;
    for (const Drawing::Item& item : drawing.items())
        if (const auto* text = std::get_if<Drawing::Text>(&item)) words.push_back(text->words);
    EXPECT_THAT(words, ElementsAre("direct sun", "in the sun", "in the shade"));
}

TEST(Legend, OfMinutesOfADayHasTimes) {
    Legend light{"First light", "", named_ramp("viridis", 7 * 60 + 20, 13 * 60 + 5)};
    light.clock = true;
    const Drawing drawing = legend(light);
    std::vector<std::string> words;
    for (const Drawing::Item& item : drawing.items())
        if (const auto* text = std::get_if<Drawing::Text>(&item)) words.push_back(text->words);
    EXPECT_THAT(words,
                ElementsAre("First light", "08:00", "09:00", "10:00", "11:00", "12:00", "13:00"));
    EXPECT_EQ(value_text(light, 443, 1), "07:23");
    light.clock = false;
    EXPECT_EQ(value_text(light, 443, 1), "443");
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

/// Off by how much a pixel is from a colour, of 255.
int apart(const image::Image8& picture, double x, double y, std::uint32_t rgb) {
    int most = 0;
    for (unsigned k = 0; k < 3; ++k)
        most = std::max(most, std::abs(picture.at(static_cast<int>(x), static_cast<int>(y),
                                                  static_cast<int>(k)) -
                                       static_cast<int>(rgb >> (16 - 8 * k) & 255)));
    return most;
}

TEST(Legend, AValueStandsBesideItsColour) {
    for (const auto& [from, to] : {std::pair(0.0, 14.0), {-350.0, 2600.0}, {900.0, 1400.0}}) {
        const Legend about{"Height", "m", named_ramp("viridis", from, to)};
        const Drawing drawing = legend(about);
        const image::Image8 picture = to_image(drawing);
        int values = 0;
        for (const Drawing::Item& item : drawing.items()) {
            const auto* text = std::get_if<Drawing::Text>(&item);
            if (!text) continue;
            const auto value = parse_number(text->words.substr(0, text->words.find(' ')));
            if (!value) continue;
            ++values;
            // A line leads from the middle of its letters to the bar, which is left of it.
            const double y = text->at.y - 0.36 * text->lettering.size;
            if (y < 33 || y > picture.height - 16) continue;  // at the bar's own edge
            EXPECT_LE(apart(picture, text->at.x - 16, y, about.ramp.at(*value).rgb), 12)
                << *value << " of " << from << " to " << to;
        }
        EXPECT_GE(values, 3);
    }
}

TEST(Legend, StepsHaveTheirColoursBetweenTheValuesOfTheirEdges) {
    Legend about{.title = "Slope", .unit = "deg", .edges = {0, 2.5, 10, 90}};
    about.ramp = {{{0, {0x20c040}}, {2.5, {0xf0e060}}, {10, {0xc01030}}}, {}, false};
    const Drawing drawing = legend(about);
    const image::Image8 picture = to_image(drawing);
    std::vector<std::string> words;
    std::vector<glm::dvec2> places;
    for (const Drawing::Item& item : drawing.items())
        if (const auto* text = std::get_if<Drawing::Text>(&item)) {
            words.push_back(text->words);
            places.push_back(text->at - glm::dvec2(16, 0.36 * text->lettering.size));
        }
    ASSERT_THAT(words, ElementsAre("Slope", "0", "2.5", "10", "90 deg"));
    // The bar is left of the letters; a class is between two of them.
    for (std::size_t k = 1; k + 1 < places.size(); ++k) {
        EXPECT_LE(apart(picture, places[k].x, (places[k].y + places[k + 1].y) / 2,
                        about.ramp.stops[k - 1].color.rgb),
                  2);
        EXPECT_GT(places[k].y, places[k + 1].y + 15) << "the highest above";
    }
}

TEST(Legend, ARingHasEastOnTheRightAndNorthAbove) {
    const Ramp ramp{{{0, {0xff0000}},
                     {90, {0x00ff00}},
                     {180, {0x0000ff}},
                     {270, {0xffff00}},
                     {360, {0xff0000}}}};
    const Drawing drawing = legend({"Slopes face", "", ramp, true});
    std::map<std::string, glm::dvec2> letters;
    for (const Drawing::Item& item : drawing.items())
        if (const auto* text = std::get_if<Drawing::Text>(&item)) letters[text->words] = text->at;
    const glm::dvec2 middle = (letters.at("N") + letters.at("S")) / 2.0 - glm::dvec2(0, 4);
    EXPECT_GT(letters.at("E").x, middle.x + 30);
    EXPECT_LT(letters.at("W").x, middle.x - 30);
    EXPECT_LT(letters.at("N").y, middle.y - 20);
    const image::Image8 picture = to_image(drawing);
    constexpr double kRadius = 28;  // between the ring's two circles
    for (const auto& [x, y, rgb] :
         {std::tuple(0, -1, 0xff0000u), {1, 0, 0x00ff00u}, {0, 1, 0x0000ffu}, {-1, 0, 0xffff00u}})
        EXPECT_LE(apart(picture, middle.x + kRadius * x, middle.y + kRadius * y, rgb), 40)
            << x << ' ' << y;
}

}  // namespace
}  // namespace relevo::chart::test_ramp
