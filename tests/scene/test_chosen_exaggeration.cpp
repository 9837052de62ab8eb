// The vertical scale that a picture chooses.
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "scene/exaggeration.h"

namespace relevo::scene::test_chosen_exaggeration {
namespace {

constexpr int kPosts = 400;

/// Ground of a height at columns and rows from 0 to 1.
Array2d<float> ground(const std::function<double(double, double)>& height_m) {
    Array2d<float> result(kPosts, kPosts);
    for (int y = 0; y < kPosts; ++y)
        for (int x = 0; x < kPosts; ++x)
            result.at(x, y) = static_cast<float>(height_m((x + 0.5) / kPosts, (y + 0.5) / kPosts));
    return result;
}

/// Long waves around a height of 500 m, all of the same relief.
Array2d<float> hills(double relief_m) {
    return ground([&](double x, double y) {
        return 500 + 0.25 * relief_m * (std::sin(6.28 * x) + std::sin(6.28 * y));
    });
}

double chosen(const Array2d<float>& height_m, double side_m) {
    return chosen_exaggeration(height_m, {side_m, side_m});
}

TEST(ChosenExaggeration, IsTheGreaterTheLowerTheRelief) {
    // sqrt(0.13 width / relief), to a fifth.
    EXPECT_NEAR(chosen(hills(2600), 80e3), 2, 0.05);
    EXPECT_NEAR(chosen(hills(1000), 80e3), 3.2, 0.25);
    EXPECT_EQ(chosen(hills(300), 80e3), 4);  // the most
    EXPECT_EQ(chosen(hills(7000), 80e3), 1.2);
    EXPECT_EQ(chosen(hills(8500), 80e3), 1);
    EXPECT_EQ(chosen(hills(9800), 80e3), 1);  // of relief above 12 % of the width
}

TEST(ChosenExaggeration, MakesNoNeedlesOfAlps) {
    const auto steep = ground([](double x, double) { return 800 * std::abs(std::sin(100 * x)); });
    EXPECT_EQ(chosen(steep, 80e3), 1);             // slopes of 45 degrees
    EXPECT_NEAR(chosen(steep, 160e3), 1.9, 0.15);  // of 27 degrees
}

TEST(ChosenExaggeration, ShowsPlainsAndFloorsOfSeas) {
    EXPECT_GT(chosen(hills(8), 20e3), 10);
    EXPECT_LE(chosen(hills(0.1), 20e3), 20);
    EXPECT_EQ(chosen(hills(100), 200e3), 4);
    const auto sea = ground([](double x, double) { return -300 * x; });
    EXPECT_GT(chosen(sea, 200e3), 4);
}

TEST(ChosenExaggeration, LeavesGroundOfFinePostsAndNoGroundAsTheyAre) {
    EXPECT_EQ(chosen(hills(20), 4.9 * kPosts), 1);
    EXPECT_EQ(chosen(Array2d<float>(kPosts, kPosts, std::nanf("")), 80e3), 1);
    EXPECT_EQ(chosen(Array2d<float>(kPosts, kPosts, 7.0f), 80e3), 1);
    EXPECT_EQ(chosen(Array2d<float>(3, 3, 7.0f), 80e3), 1);
    auto holes = hills(2600);
    for (int y = 0; y < kPosts; ++y)
        for (int x = 0; x < kPosts / 2; ++x)
            holes.at(x, y) = std::nanf("");
    EXPECT_NEAR(chosen(holes, 80e3), 2.4, 0.25);  // of what is left
}

TEST(ChosenExaggeration, IsOfThePictureThatNothingIsSaidOf) {
    const Scene usual;
    EXPECT_TRUE(may_exaggerate(usual));
    const auto may = [&](const std::function<void(Scene&)>& change) {
        Scene scene = usual;
        change(scene);
        return may_exaggerate(scene);
    };
    EXPECT_FALSE(may([](Scene& s) { s.time.at = "2026-06-21T10:00Z"; }));
    EXPECT_FALSE(may([](Scene& s) { s.time.date = "2026-06-21"; }));
    EXPECT_FALSE(may([](Scene& s) { s.view.orbit.aerial = false; }));
    EXPECT_FALSE(may([](Scene& s) { s.view.eye = Standpoint{}; }));
    EXPECT_FALSE(may([](Scene& s) { s.ortho = true; }));
    EXPECT_FALSE(may([](Scene& s) { s.overlay = Overlay{.file = "hours.tif"}; }));
    EXPECT_FALSE(may([](Scene& s) { s.effects.switches.enable = {"labels"}; }));
    EXPECT_FALSE(may([](Scene& s) { s.effects.settings = {{"drape.file", "photo.tif"}}; }));
    EXPECT_TRUE(may([](Scene& s) { s.effects.switches.disable = {"haze"}; }));
    EXPECT_TRUE(may([](Scene& s) { s.width_px = 640; }));
}

}  // namespace
}  // namespace relevo::scene::test_chosen_exaggeration
