#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include <cpl_conv.h>
#include <gtest/gtest.h>

#include "dem/fill_holes.h"
#include "dem/grid.h"

namespace relevo::dem::test_fill_holes {
namespace {

constexpr int kColumns = 40, kRows = 30;

/// A slope with a void in it.
Array2d<float> slope_without(const Window& hole) {
    Array2d<float> height_m(kColumns, kRows);
    for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < kColumns; ++column) {
            const bool is_void = column >= hole.column && column < hole.column + hole.columns &&
                                 row >= hole.row && row < hole.row + hole.rows;
            height_m.at(column, row) = is_void ? std::numeric_limits<float>::quiet_NaN()
                                               : static_cast<float>(100 + column + 2 * row);
        }
    return height_m;
}

TEST(FillHoles, AVoidAmongGroundIsFilledFromAroundIt) {
    const FilledHoles filled = fill_small_holes(slope_without({10, 8, 4, 3}), Holes::Fill);
    EXPECT_EQ(filled.filled_posts, 12);
    EXPECT_EQ(filled.cut_posts, 0);
    EXPECT_NEAR(filled.height_m.at(11, 9), 100 + 11 + 2 * 9, 3);
}

TEST(FillHoles, AVoidThatReachesAnEdgeIsCutOut) {
    for (const Window& hole : {Window{0, 8, 4, 9}, Window{10, 0, 12, 3},
                               Window{kColumns - 4, 8, 4, 9}, Window{10, kRows - 3, 12, 3}}) {
        const FilledHoles filled = fill_small_holes(slope_without(hole), Holes::Fill);
        EXPECT_EQ(filled.filled_posts, 0) << hole.column << " " << hole.row;
        EXPECT_EQ(filled.covered_posts, 0);
        EXPECT_EQ(filled.cut_posts, 36);
    }
    // One post from each edge it is a void among ground.
    for (const Window& hole : {Window{1, 8, 4, 9}, Window{10, 1, 12, 3},
                               Window{kColumns - 5, 8, 4, 9}, Window{10, kRows - 4, 12, 3}})
        EXPECT_EQ(fill_small_holes(slope_without(hole), Holes::Fill).filled_posts, 36);
}

TEST(FillHoles, ANarrowNotchInOneEdgeIsFilledSoThatNoSlitIsInTheWall) {
    for (const Window& hole : {Window{0, 8, 9, 3}, Window{10, 0, 5, 9},
                               Window{kColumns - 9, 8, 9, 3}, Window{10, kRows - 9, 5, 9}}) {
        const Array2d<float> given = slope_without(hole);
        const FilledHoles filled = fill_small_holes(given, Holes::Fill);
        EXPECT_EQ(filled.filled_posts, hole.columns * hole.rows);
        EXPECT_EQ(filled.cut_posts, 0);
        EXPECT_NEAR(filled.height_m.at(hole.column, hole.row), 100 + hole.column + 2 * hole.row, 9);
        EXPECT_EQ(fill_small_holes(given, Holes::Cut).cut_posts, hole.columns * hole.rows);
    }
    EXPECT_EQ(fill_small_holes(slope_without({0, 0, 3, 3}), Holes::Fill).cut_posts, 9) << "corner";
}

/// A slope with voids where a function says so.
template <typename IsVoid>
Array2d<float> slope_with(int side, const IsVoid& is_void) {
    Array2d<float> height_m(side, side);
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column)
            height_m.at(column, row) = is_void(column, row)
                                           ? std::numeric_limits<float>::quiet_NaN()
                                           : static_cast<float>(100 + column + 2 * row);
    return height_m;
}

TEST(FillHoles, ScatteredVoidsTakeNoFiles) {
    CPLSetConfigOption("CPL_TMPDIR", "/no such folder");
    const FilledHoles filled = fill_small_holes(
        slope_with(300, [](int c, int r) { return c % 4 == 2 && r % 4 == 2; }), Holes::Fill);
    CPLSetConfigOption("CPL_TMPDIR", nullptr);
    EXPECT_EQ(filled.filled_posts, 75 * 75);
    EXPECT_NEAR(filled.height_m.at(150, 150), 100 + 3 * 150, 0.05);
    EXPECT_LE(filled.worked_posts, filled.filled_posts * 17 * 17);
}

TEST(FillHoles, WideVoidsWithinEachOtherAreCoveredOnce) {
    constexpr int kSide = 400, kMiddle = kSide / 2;
    const auto radius = [](int c, int r) {
        return std::max(std::abs(c - kMiddle), std::abs(r - kMiddle));
    };
    // 20 rings from 81 to 385 posts wide, and one of them alone.
    const FilledHoles rings = fill_small_holes(
        slope_with(kSide,
                   [&](int c, int r) {
                       return radius(c, r) >= 40 && radius(c, r) <= 192 && radius(c, r) % 8 == 0;
                   }),
        Holes::Fill);
    EXPECT_GT(rings.covered_posts, 17000);
    EXPECT_EQ(rings.cut_posts, 0);
    EXPECT_LE(rings.worked_posts, 4 * kSide * kSide);
    const FilledHoles one = fill_small_holes(
        slope_with(kSide, [&](int c, int r) { return radius(c, r) == 80; }), Holes::Fill);
    EXPECT_EQ(one.worked_posts, (161 + 16) * (161 + 16));
    for (const FilledHoles* filled : {&rings, &one})
        for (const int column : {120, 150, 280})
            EXPECT_NEAR(filled->height_m.at(column, 120), 100 + column + 2 * 120, 2) << column;
}

TEST(FillHoles, AVoidAmongPostsOfOneHeightHasThatHeightHoweverWideItIs) {
    constexpr float kLake_m = 512.37f;
    for (const int side : {3, 40, 100}) {
        const auto is_void = [&](int c, int r) {
            return c >= 30 && c < 30 + side && r >= 30 && r < 30 + side;
        };
        Array2d<float> height_m = slope_with(160, is_void);
        for (int row = 25; row < 135; ++row)
            for (int column = 25; column < 135; ++column)
                if (!is_void(column, row)) height_m.at(column, row) = kLake_m;
        height_m.at(29, 31) = kLake_m + 0.0005f;
        const FilledHoles level = fill_small_holes(height_m, Holes::Fill);
        EXPECT_EQ(level.filled_posts, side * side);
        for (int row = 30; row < 30 + side; ++row)
            for (int column = 30; column < 30 + side; ++column) {
                ASSERT_EQ(level.height_m.at(column, row), kLake_m) << column << ' ' << row;
                ASSERT_EQ(level.filled.at(column, row), kFilled);
            }
        height_m.at(29, 31) = kLake_m + 10;
        const FilledHoles sloping = fill_small_holes(height_m, Holes::Fill);
        EXPECT_GT(sloping.height_m.at(30, 31), kLake_m);
        EXPECT_EQ(sloping.covered_posts, side > kSmallHole_posts ? side * side : 0);
    }
}

/// A DEM of 200 posts a side with a void in the south. In it are a post, a line two posts wide and
/// a square of three posts a side.
bool is_bay(int column, int row) {
    const bool post = column == 60 && row == 150;
    const bool line = column >= 80 && column < 82 && row >= 130;
    const bool square = column >= 120 && column < 123 && row >= 150 && row < 153;
    return row >= 120 && column >= 40 && column < 160 && !post && !line && !square;
}

TEST(FillHoles, PostsAndLinesWithinVoidsAreDroppedOnlyIfAskedFor) {
    const Array2d<float> given = slope_with(200, is_bay);
    for (const Holes holes : {Holes::Fill, Holes::Cut}) {
        EXPECT_TRUE(fill_small_holes(given, holes).height_m.empty());
        const FilledHoles drawn = fill_small_holes(given, holes, ThinGround::Dropped);
        EXPECT_EQ(drawn.dropped_posts, 1 + 2 * 70);
        ASSERT_FALSE(drawn.height_m.empty());
        for (int row = 0; row < 200; ++row)
            for (int column = 0; column < 200; ++column) {
                const bool kept = row < 120 || column < 40 || column >= 160 ||
                                  (column >= 120 && column < 123 && row >= 150 && row < 153);
                ASSERT_EQ(!std::isnan(drawn.height_m.at(column, row)), kept)
                    << column << ' ' << row;
            }
        EXPECT_NE(drawn.text(holes).find(", without 141 posts of narrow ground"),
                  std::string::npos);
    }
}

TEST(FillHoles, AnIsolatedPostDoesNotPullACoverUp) {
    // A level membrane over a wide void, were it not for one post of a tower's height.
    Array2d<float> height_m = slope_with(
        200, [](int c, int r) { return std::max(std::abs(c - 100), std::abs(r - 100)) <= 50; });
    height_m.at(100, 100) = 5000;
    const FilledHoles drawn = fill_small_holes(height_m, Holes::Fill, ThinGround::Dropped);
    EXPECT_EQ(drawn.dropped_posts, 1);
    EXPECT_EQ(drawn.covered_posts, 101 * 101 - 1);
    EXPECT_NEAR(drawn.height_m.at(100, 100), 100 + 100 + 200, 8);
    EXPECT_GT(fill_small_holes(height_m, Holes::Fill).height_m.at(101, 100), 2000);
}

TEST(FillHoles, ScatteredPostsStay) {
    const auto scattered = slope_with(200, [](int c, int r) { return (c + r) % 2 == 0; });
    EXPECT_EQ(fill_small_holes(scattered, Holes::Cut, ThinGround::Dropped).dropped_posts, 0);
}

}  // namespace
}  // namespace relevo::dem::test_fill_holes
