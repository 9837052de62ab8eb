// Lowest, highest and mean values around each cell, against all cells of the square.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "base/sliding_window.h"

namespace relevo::test_sliding_window {
namespace {

TEST(SlidingWindow, IsAllOfTheSquare) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> any(-9, 9);
    for (const auto& [width, height, reach] :
         {std::array{1, 1, 3}, std::array{17, 9, 1}, std::array{23, 31, 4}, std::array{8, 5, 7},
          std::array{12, 13, 0}, std::array{40, 3, 20}}) {
        Array2d<float> cells(width, height);
        for (float& cell : cells)
            cell = any(random);
        const Array2d<float> low = lowest_around(cells, reach), high = highest_around(cells, reach);
        const Array2d<float> mean = mean_around(cells, reach);
        for (int row = 0; row < height; ++row)
            for (int column = 0; column < width; ++column) {
                float least = 99, most = -99;
                double sum = 0, count = 0;
                for (int j = std::max(row - reach, 0); j <= std::min(row + reach, height - 1); ++j)
                    for (int i = std::max(column - reach, 0);
                         i <= std::min(column + reach, width - 1); ++i) {
                        least = std::min(least, cells.at(i, j));
                        most = std::max(most, cells.at(i, j));
                        sum += double{cells.at(i, j)};
                        ++count;
                    }
                ASSERT_EQ(low.at(column, row), least) << width << " " << column << " " << row;
                ASSERT_EQ(high.at(column, row), most) << width << " " << column << " " << row;
                ASSERT_NEAR(mean.at(column, row), sum / count, 1e-4) << column << " " << row;
            }
    }
}

}  // namespace
}  // namespace relevo::test_sliding_window
