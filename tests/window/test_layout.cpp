// Columns and rows of the window.
#include <gtest/gtest.h>

#include "viewer/layout.h"

namespace relevo::viewer {
namespace {

double share(const Area& of, glm::vec2 window) {
    return double{of.size.x} * of.size.y / (double{window.x} * window.y);
}

TEST(Layout, LeavesThePictureTwoThirdsOfALaptopsWindow) {
    constexpr glm::vec2 kWindow(1280, 800);
    const double alone = share(lay_out(kWindow, 1, {}, Lower::Bar).picture, kWindow);
    const double with_charts = share(lay_out(kWindow, 1, {}, Lower::Charts).picture, kWindow);
    EXPECT_GE(alone, 0.65);
    EXPECT_GE(with_charts, 0.5);
    RecordProperty("picture_share", std::to_string(alone));
    RecordProperty("picture_share_with_charts", std::to_string(with_charts));
}

// Whatever the window, the text's size and what settings files say: parts fill it and overlap
// nowhere.
TEST(Layout, PartsFillTheWindowWithoutOverlap) {
    for (const glm::vec2 window : {glm::vec2(1280, 800), {800, 600}, {2560, 1600}, {300, 30}})
        for (const float unit : {0.7f, 1.0f, 2.0f})
            for (const int width : {0, 360, 5000})
                for (const int height : {0, 170, 5000})
                    for (const Lower lower : {Lower::Bar, Lower::Charts, Lower::Film}) {
                        Settings settings;
                        settings.panel_width = width;
                        settings.charts_height = height;
                        const Layout of = lay_out(window, unit, settings, lower);
                        EXPECT_FLOAT_EQ(of.side.at.x, 0);
                        EXPECT_FLOAT_EQ(of.side.end().x, of.picture.at.x);
                        EXPECT_FLOAT_EQ(of.picture.end().x, window.x);
                        EXPECT_FLOAT_EQ(of.side.at.y, of.picture.at.y);
                        EXPECT_LE(of.picture.end().y, std::max(of.charts.at.y, of.side.at.y));
                        EXPECT_FLOAT_EQ(of.charts.end().y, of.bar.at.y);
                        EXPECT_EQ(of.charts.size.y > 0, lower == Lower::Charts && window.y > 30);
                        EXPECT_EQ(of.bar.size.y > 0, lower != Lower::Film);
                        EXPECT_GE(of.picture.size.x, 0.5f * window.x);
                        const scene::Insets insets = of.insets(window);
                        EXPECT_LT(insets.left + insets.right, 1);
                        EXPECT_LT(insets.bottom + insets.top, 1);
                    }
}

TEST(Layout, WithoutPanelsThePictureIsTheWindow) {
    Settings settings;
    settings.panels = false;
    const Layout of = lay_out({1280, 800}, 1, settings, Lower::Charts);
    EXPECT_EQ(of.picture.size, glm::vec2(1280, 800));
    EXPECT_EQ(of.insets({1280, 800}), scene::Insets{});
    EXPECT_EQ(of.side.size.x + of.bar.size.y + of.charts.size.y, 0);
}

}  // namespace
}  // namespace relevo::viewer
