#include <gtest/gtest.h>

#include "dem/clip.h"
#include "support/support.h"

namespace relevo::dem {
namespace {

/// 10 x 8 posts, 100 m apart, of which the first is at 500000, 5200000.
Grid grid() {
    return {10, 8, {500000, 100, 0, 5200000, 0, -100}, geo::Crs::parse("EPSG:32632", "test")};
}

void expect_posts(const char* text, const Window& posts) {
    const Window found = window_of(grid(), parse_clip(text, "--clip"), "--clip");
    EXPECT_EQ(found.column, posts.column) << text;
    EXPECT_EQ(found.row, posts.row) << text;
    EXPECT_EQ(found.columns, posts.columns) << text;
    EXPECT_EQ(found.rows, posts.rows) << text;
}

TEST(Clip, HasThePostsOnItsSidesAndBetween) {
    // From the third column to the seventh, from the fourth row to the sixth.
    expect_posts("500200,5199500,500600,5199700", {2, 3, 5, 3});
    expect_posts("500150,5199450,500650,5199750", {2, 3, 5, 3});
}

TEST(Clip, EndsWithTheDem) {
    expect_posts("400000,5000000,600000,5300000", {0, 0, 10, 8});
    expect_posts("500850,5000000,600000,5199350", {9, 7, 1, 1});
}

}  // namespace
}  // namespace relevo::dem
