#include <gtest/gtest.h>

#include "dem/clip.h"
#include "support/support.h"

namespace relevo::dem {
namespace {

/// 10 x 8 posts, 100 m apart, of which the first is at 500000, 5200000.
Grid grid() {
    return {10, 8, {500000, 100, 0, 5200000, 0, -100}, geo::Crs::parse("EPSG:32632", "test")};
}

Window clipped(const char* text) {
    return window_of(grid(), parse_clip(text, "--clip"), "--clip");
}

TEST(Clip, HasThePostsOnItsSidesAndBetween) {
    // From the third column to the seventh, from the fourth row to the sixth.
    const Window exact = clipped("500200,5199500,500600,5199700");
    EXPECT_EQ(exact.column, 2);
    EXPECT_EQ(exact.row, 3);
    EXPECT_EQ(exact.columns, 5);
    EXPECT_EQ(exact.rows, 3);
    const Window between = clipped("500150,5199450,500650,5199750");
    EXPECT_EQ(between.column, 2);
    EXPECT_EQ(between.row, 3);
    EXPECT_EQ(between.columns, 5);
    EXPECT_EQ(between.rows, 3);
}

TEST(Clip, EndsWithTheDem) {
    const Window all = clipped("400000,5000000,600000,5300000");
    EXPECT_EQ(all.column, 0);
    EXPECT_EQ(all.row, 0);
    EXPECT_EQ(all.columns, 10);
    EXPECT_EQ(all.rows, 8);
    const Window corner = clipped("500850,5000000,600000,5199350");
    EXPECT_EQ(corner.column, 9);
    EXPECT_EQ(corner.row, 7);
    EXPECT_EQ(corner.columns, 1);
    EXPECT_EQ(corner.rows, 1);
}

}  // namespace
}  // namespace relevo::dem
