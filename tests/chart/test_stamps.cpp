#include <algorithm>

#include <gmock/gmock.h>

#include "chart/stamps.h"

namespace relevo::chart {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

image::Image8 grey(int width, int height) {
    image::Image8 picture(width, height, 3);
    std::fill(picture.values.begin(), picture.values.end(), std::uint8_t{128});
    return picture;
}

TEST(ScaleBar, IsTheLongestRoundLengthThereIsRoomFor) {
    const auto text = [](double px_per_m) { return scale_bar(px_per_m, 200).text(); };
    EXPECT_EQ(text(0.013), "10 km");
    EXPECT_EQ(text(0.00399), "50 km");
    EXPECT_EQ(text(0.1), "2 km");
    EXPECT_EQ(text(0.5), "200 m");
    EXPECT_EQ(text(399), "50 cm");
    const ScaleBar bar = scale_bar(0.013, 200);
    EXPECT_DOUBLE_EQ(bar.length_m, 10000);
    EXPECT_DOUBLE_EQ(bar.length_px, 130);
    EXPECT_LE(scale_bar(0.1, 200).length_px, 200);
}

TEST(Stamps, TheBarIsAsLongAsItsLengthIsInThePicture) {
    for (const int side : {450, 900, 1800}) {
        image::Image8 picture = grey(side, side);
        Stamps stamps;
        stamps.scale = Stamps::Scale{0.011, ""};
        EXPECT_THAT(stamp(stamps, picture), IsEmpty());
        const double unit = stamp_scale(side, side);
        const ScaleBar bar = scale_bar(0.011, std::min(200 * unit, 0.4 * side));
        // The first and the third of its four parts are black.
        int first = side, last = 0;
        for (int y = 0; y < side; ++y) {
            int from = -1, run = 0;
            for (int x = 0; x < side; ++x) {
                const bool black = picture.at(x, y, 0) < 60;
                run = black ? run + 1 : 0;
                if (run > 0.2 * bar.length_px) from = x - run + 1, first = std::min(first, from);
                if (run > 0.2 * bar.length_px) last = std::max(last, x);
            }
        }
        EXPECT_NEAR(last + 1 - first, 0.75 * bar.length_px, 2.5) << side;
    }
}

TEST(Stamps, StandAroundAMapThatLeavesTheMarginsTheyNeed) {
    Stamps stamps;
    stamps.title = "Inn valley";
    stamps.legends = {{.title = "Height", .unit = "m", .ramp = {{{0, {0x0}}, {4000, {0xffffff}}}}},
                      {.title = "Slope", .unit = "1", .ramp = {{{0, {0x0}}, {1, {0xffffff}}}}}};
    stamps.scale = Stamps::Scale{0.011, "at the picture's middle"};
    stamps.north = glm::dvec2(0, -1);
    stamps.lines = {"2026-06-21 10:12 UTC+02:00", "Sun: azimuth 114"};
    stamps.attribution = "AW3D30 (JAXA)";
    for (const glm::ivec2 size : {glm::ivec2(900, 900), {1600, 1000}, {3000, 2400}}) {
        const Margins margins = margins_for(stamps, size.x, size.y);
        const Rect map{double(margins.left), double(margins.top),
                       double(size.x - margins.left - margins.right),
                       double(size.y - margins.top - margins.bottom)};
        EXPECT_GT(map.width * map.height, 0.55 * size.x * size.y);
        image::Image8 picture = grey(size.x, size.y);
        std::vector<Rect> taken;
        EXPECT_THAT(stamp(stamps, picture, &taken, map), IsEmpty());
        EXPECT_EQ(taken.size(), 7u);
        int changed = 0, around = 0;
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const bool inside =
                    x >= map.x && x < map.x + map.width && y >= map.y && y < map.y + map.height;
                (inside ? changed : around) += picture.at(x, y, 0) != 128;
            }
        EXPECT_EQ(changed, 0);
        EXPECT_GT(around, 1000);
    }
}

TEST(Stamps, LabelsOfTheGraticuleStandAroundAMap) {
    Stamps stamps;
    stamps.title = "Inn valley";
    stamps.scale = Stamps::Scale{0.011, ""};
    stamps.north = glm::dvec2(0, -1);
    stamps.graticule = {{.words = "47°20'N"}};
    const Margins margins = margins_for(stamps, 900, 900);
    const Rect map{double(margins.left), double(margins.top),
                   double(900 - margins.left - margins.right),
                   double(900 - margins.top - margins.bottom)};
    stamps.graticule.clear();
    // Lines end where ground does, which may be some pixels within the map.
    for (int i = 1; i < 6; ++i) {
        const double share = i / 6.0;
        stamps.graticule.push_back({{map.x + 12, map.y + share * map.height}, {-1, 0}, "47°20'N"});
        stamps.graticule.push_back(
            {{map.x + share * map.width, map.y + map.height - 9}, {0.05, 0.999}, "11°20'E"});
    }
    image::Image8 picture = grey(900, 900);
    std::vector<Rect> taken;
    EXPECT_THAT(stamp(stamps, picture, &taken, map), IsEmpty());
    ASSERT_EQ(taken.size(), 13u);
    for (std::size_t i = 0; i < taken.size(); ++i) {
        EXPECT_FALSE(overlap(taken[i], map)) << i;
        for (std::size_t k = 0; k < i; ++k)
            EXPECT_FALSE(overlap(taken[i], taken[k])) << i << ", " << k;
    }
}

TEST(Stamps, AMapWithoutStampsHasANarrowMargin) {
    const Margins margins = margins_for({}, 900, 900);
    EXPECT_EQ(margins.left, 12);
    EXPECT_EQ(margins.top, 12);
    EXPECT_EQ(margins.right, 12);
    EXPECT_EQ(margins.bottom, 12);
}

TEST(Stamps, TheArrowAndItsLetterPointNorth) {
    for (const glm::dvec2 north : {glm::dvec2(0, -1), {0.6, -0.8}, {-1, 0}, {0.28, 0.96}}) {
        image::Image8 picture = grey(900, 900);
        Stamps stamps;
        stamps.north = north;
        EXPECT_THAT(stamp(stamps, picture), IsEmpty());
        const glm::dvec2 middle(12 + 26, 900 - 12 - 26), aside(-north.y, north.x);
        const auto darkest = [&](const glm::dvec2& at, int reach) {
            int least = 255;
            for (int dy = -reach; dy <= reach; ++dy)
                for (int dx = -reach; dx <= reach; ++dx)
                    least = std::min(least, int{picture.at(static_cast<int>(at.x) + dx,
                                                           static_cast<int>(at.y) + dy, 0)});
            return least;
        };
        // The letter beyond the tip, and nothing as far on the other side.
        EXPECT_LT(darkest(middle + 18.0 * north, 3), 90);
        EXPECT_GT(darkest(middle - 22.0 * north, 1), 200);
        // Half-way to the tip its dark half is as wide as an arrow's, and behind the notch it is
        // open.
        EXPECT_LT(darkest(middle + 2.0 * north + 1.5 * aside, 0), 60);
        EXPECT_GT(darkest(middle - 16.0 * north, 0), 200);
    }
}

TEST(Stamps, WhatHasNoRoomIsNamedAndNotThere) {
    Stamps stamps;
    stamps.title = "The valley of the Inn";
    stamps.lines = {"2026-06-21 08:19 UTC+02:00", "Sun: azimuth 84.54, elevation 27.52"};
    stamps.attribution = "AW3D30 (JAXA)";
    stamps.north = glm::dvec2(0, -1);
    stamps.scale = Stamps::Scale{0.02, "across the view, at the picture's middle, 80 km away"};
    stamps.legends = {{"Height", "m", named_ramp("viridis", 0, 3000)}};
    stamps.graticule = {{{20, 20}, {-1, 0}, "47°30'N"}};
    image::Image8 large = grey(1280, 800);
    EXPECT_THAT(stamp(stamps, large), ElementsAre("1 label of the graticule"));  // off the edge
    image::Image8 tiny = grey(40, 30);
    const std::vector<std::uint8_t> before = tiny.values;
    EXPECT_THAT(stamp(stamps, tiny),
                ElementsAre("legend", "title", "scale", "attribution", "date and sun", "north",
                            "1 label of the graticule"));
    EXPECT_EQ(tiny.values, before);
}

TEST(Stamps, NothingIsClipped) {
    // A frame of untouched pixels stays around all that is stamped, at any size.
    for (const auto& [width, height] :
         {std::pair(1280, 800), std::pair(640, 480), std::pair(320, 240), std::pair(160, 900)}) {
        image::Image8 picture = grey(width, height);
        Stamps stamps;
        stamps.title = "Title";
        stamps.lines = {"Sun: azimuth 84.54, elevation 27.52 (27.55 with refraction)"};
        stamps.attribution = "Data of some agency";
        stamps.north = glm::dvec2(0.6, -0.8);
        stamps.scale = Stamps::Scale{0.02, "across the view, at the picture's middle"};
        stamps.legends = {{"Slopes face", "", named_ramp("viridis", 0, 360), true}};
        for (int k = 0; k < 12; ++k)
            stamps.graticule.push_back({{k * width / 11.0, k * height / 11.0}, {0, 1}, "11°30'E"});
        stamp(stamps, picture);
        for (int x = 0; x < width; ++x)
            for (const int y : {0, height - 1})
                EXPECT_EQ(picture.at(x, y, 1), 128);
        for (int y = 0; y < height; ++y)
            for (const int x : {0, width - 1})
                EXPECT_EQ(picture.at(x, y, 1), 128);
    }
}

}  // namespace
}  // namespace relevo::chart
