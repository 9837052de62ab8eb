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
    for (const Window& hole : {Window{0, 8, 4, 3}, Window{10, 0, 4, 3},
                               Window{kColumns - 4, 8, 4, 3}, Window{10, kRows - 3, 4, 3}}) {
        const FilledHoles filled = fill_small_holes(slope_without(hole), Holes::Fill);
        EXPECT_EQ(filled.filled_posts, 0) << hole.column << " " << hole.row;
        EXPECT_EQ(filled.covered_posts, 0);
        EXPECT_EQ(filled.cut_posts, 12);
    }
    // One post from each edge it is a void among ground.
    for (const Window& hole : {Window{1, 8, 4, 3}, Window{10, 1, 4, 3},
                               Window{kColumns - 5, 8, 4, 3}, Window{10, kRows - 4, 4, 3}})
        EXPECT_EQ(fill_small_holes(slope_without(hole), Holes::Fill).filled_posts, 12);
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

}  // namespace
}  // namespace relevo::dem::test_fill_holes
