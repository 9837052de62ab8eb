#include <cmath>
#include <limits>

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

}  // namespace
}  // namespace relevo::dem::test_fill_holes
