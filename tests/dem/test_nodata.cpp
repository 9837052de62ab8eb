#include <cmath>
#include <limits>
#include <vector>

#include "dem/nodata.h"
#include "support/support.h"

namespace relevo::dem::test_nodata {
namespace {

/// Heights from `low` to `high` in steps of one, and `mark` ten times.
std::vector<double> heights_with(double low, double high, double mark) {
    std::vector<double> stored(10, mark);
    for (double height = low; height <= high; ++height)
        stored.push_back(height);
    return stored;
}

TEST(FindUndeclared, TakesWhatProgramsWriteForHoles) {
    for (const double mark : {-32768.0, -32767.0, -9999.0, -99999.0, -999999.0, 32767.0, 65535.0}) {
        EXPECT_EQ(find_undeclared(heights_with(200, 3000, mark), 1).nodata, mark);
        EXPECT_FALSE(find_undeclared(heights_with(200, 3000, mark), 1).beyond);
    }
    EXPECT_EQ(find_undeclared(heights_with(200, 3000, -5000), 1).nodata, std::nullopt);
    EXPECT_EQ(find_undeclared(heights_with(200, 3000, 8848), 1).nodata, std::nullopt);
}

TEST(FindUndeclared, ATrenchIsNoHole) {
    EXPECT_EQ(find_undeclared(heights_with(-10900, -200, -9999), 1).nodata, std::nullopt);
    EXPECT_EQ(find_undeclared(heights_with(-9499, -200, -9999), 1).nodata, std::nullopt);
    EXPECT_EQ(find_undeclared(heights_with(-9498, -200, -9999), 1).nodata, -9999);
}

TEST(FindUndeclared, ZeroIsAHoleOnlyFarFromTheSea) {
    EXPECT_EQ(find_undeclared(heights_with(100, 3000, 0), 1).nodata, 0);
    EXPECT_EQ(find_undeclared(heights_with(99, 3000, 0), 1).nodata, std::nullopt);
    EXPECT_EQ(find_undeclared(heights_with(-3000, -100, 0), 1).nodata, 0);
    std::vector<double> both = heights_with(200, 3000, 0);
    both.push_back(-200);
    EXPECT_EQ(find_undeclared(both, 1).nodata, std::nullopt);
    // In feet 300 are 91 m, in centimetres 9 999 are 100 m.
    EXPECT_EQ(find_undeclared(heights_with(300, 3000, 0), 0.3048).nodata, std::nullopt);
    EXPECT_EQ(find_undeclared(heights_with(400, 3000, 0), 0.3048).nodata, 0);
}

TEST(FindUndeclared, HugeNumbersAreNoHeights) {
    const Undeclared found = find_undeclared(heights_with(200, 3000, -3.4028234663852886e38), 1);
    EXPECT_TRUE(found.beyond);
    EXPECT_EQ(found.nodata, std::nullopt);
    EXPECT_EQ(no_height_beyond(1), 1e7);
    EXPECT_EQ(no_height_beyond(-0.001), 1e10);  // depths in millimetres
}

TEST(FindUndeclared, AFewHeightsMakeNoRule) {
    EXPECT_EQ(find_undeclared(heights_with(200, 214, -9999), 1).nodata, std::nullopt);
    EXPECT_EQ(find_undeclared(heights_with(200, 215, -9999), 1).nodata, -9999);
    EXPECT_EQ(find_undeclared({}, 1).nodata, std::nullopt);
    EXPECT_EQ(find_undeclared(std::vector<double>(100, -9999), 1).nodata, std::nullopt);
    EXPECT_EQ(find_undeclared(std::vector<double>(100, std::nan("")), 1).nodata, std::nullopt);
}

}  // namespace
}  // namespace relevo::dem::test_nodata
