#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dem/clip.h"
#include "support/support.h"

namespace relevo::dem::test_clip {
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

/// Posts of one degree between those longitudes, from 90 N to 90 S.
Grid degrees(int west, int east) {
    return {east - west, 180, {west + 0.5, 1, 0, 89.5, 0, -1}, geo::Crs::parse("EPSG:4326", "x")};
}

/// The first column and how many, of a rectangle in the grid's CRS and in EPSG:4326.
std::pair<int, int> columns(const Grid& grid, const char* text) {
    Clip clip = parse_clip(text, "--crop");
    const Window own = window_of(grid, clip, "--crop");
    clip.crs = geo::Crs::parse("EPSG:4326", "x");
    const Window found = window_of(grid, clip, "--crop");
    EXPECT_EQ(own, found) << text;
    return {found.column, found.columns};
}

TEST(Clip, LongitudesAreOfAnyTurn) {
    using Columns = std::pair<int, int>;
    EXPECT_EQ(columns(degrees(-180, 180), "170,-20,180,-10"), Columns(350, 10));
    EXPECT_EQ(columns(degrees(-180, 180), "190,-20,200,-10"), Columns(10, 10));
    EXPECT_EQ(columns(degrees(0, 360), "-10,-20,0,-10"), Columns(350, 10));
    EXPECT_EQ(columns(degrees(0, 360), "-190,-20,-180,-10"), Columns(170, 10));
    EXPECT_EQ(columns(degrees(-180, 180), "-180,0,0,90"), Columns(0, 180));
    EXPECT_EQ(columns(degrees(-180, 180), "0,0,180,90"), Columns(180, 180));
    EXPECT_EQ(columns(degrees(170, 200), "-175,0,-170,5"), Columns(15, 5));
    EXPECT_EQ(columns(degrees(170, 200), "-180,-90,180,90"), Columns(0, 30));
    EXPECT_EQ(columns(degrees(0, 360), "-180,-90,180,90"), Columns(0, 360));
}

TEST(Clip, IsRefusedAcrossTheEndsOfTheRows) {
    const auto error = [](const Grid& grid, const char* text) {
        Clip clip = parse_clip(text, "--crop");
        clip.crs = geo::Crs::parse("EPSG:4326", "x");
        return test::error_of([&] { window_of(grid, clip, "--crop"); });
    };
    using testing::HasSubstr;
    EXPECT_THAT(
        error(degrees(0, 360), "-10,35,30,60"),
        HasSubstr("-10,35,30,60: crosses the edge of the DEM, whose rows go from 0 to 360"));
    EXPECT_THAT(error(degrees(-180, 180), "170,-20,190,-10"),
                HasSubstr("crosses the edge of the DEM, whose rows go from -180 to 180"));
    EXPECT_THAT(error(degrees(6, 10), "-175,40,0,50"), HasSubstr("not one post of the DEM"));
    EXPECT_THAT(error(degrees(6, 10), "186,40,190,50"), HasSubstr("not one post of the DEM"));
}

}  // namespace
}  // namespace relevo::dem::test_clip
