#include <numeric>

#include "base/array2d.h"
#include "support/support.h"

namespace relevo {
namespace {

TEST(Array2d, IsRowMajor) {
    Array2d<int> grid(3, 2);
    std::iota(grid.begin(), grid.end(), 0);
    EXPECT_EQ(grid.at(2, 0), 2);
    EXPECT_EQ(grid.at(0, 1), 3);
    EXPECT_EQ(grid.row(1)[2], 5);
    EXPECT_EQ(grid.size(), 6u);
}

TEST(Array2d, StartsWithTheGivenValue) {
    const Array2d<float> grid(4, 4, 1.5f);
    for (const float value : grid)
        EXPECT_EQ(value, 1.5f);
}

}  // namespace
}  // namespace relevo
