// Walls below the ground's edge, by the corners that their triangles have.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "render/pages.h"
#include "render/sides.h"

namespace relevo::render::test_sides {
namespace {

/// A corner of a wall: column and row of the tile, and whether it is the wall's foot.
using Corner = std::array<int, 3>;
using Triangle = std::array<Corner, 3>;

/// The walls of the DEM's first tile, as side.vert.glsl takes its vertices on a rim without voids.
std::vector<Triangle> walls_of(const Array2d<float>& heights) {
    const dem::Pyramid pyramid(heights);
    Sides sides(pyramid);
    std::vector<glm::vec4> vertices;
    std::vector<std::uint16_t> indices;
    sides.add({0, {0, 0}}, 15, vertices, indices);
    const auto corner = [&](std::size_t index) -> Corner {
        const glm::vec4 ends = vertices.at(Sides::kVectors * index);
        const glm::vec4 third = vertices.at(Sides::kVectors * index + 1);
        const bool other = third.z > 0.5f;
        return {static_cast<int>(other ? ends.z : ends.x),
                static_cast<int>(other ? ends.w : ends.y), third.w > 0.5f ? 1 : 0};
    };
    std::vector<Triangle> triangles;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
        triangles.push_back({corner(indices[i]), corner(indices[i + 1]), corner(indices[i + 2])});
    return triangles;
}

/// Along the rim of a DEM of one tile each step has a wall, two triangles that reach from post to
/// post and from the ground to the foot.
void expect_a_wall_below_each_step(int columns, int rows) {
    std::map<std::set<std::array<int, 2>>, int> walls;
    for (const Triangle& triangle : walls_of(Array2d<float>(columns, rows, 100.0f))) {
        std::set<std::array<int, 2>> posts;
        int feet = 0;
        for (const Corner& corner : triangle) {
            posts.insert({corner[0], corner[1]});
            feet += corner[2];
        }
        ASSERT_EQ(posts.size(), 2u);
        EXPECT_TRUE(feet == 1 || feet == 2);
        const auto &a = *posts.begin(), &b = *posts.rbegin();
        EXPECT_EQ(std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]), 1)
            << a[0] << ',' << a[1] << " to " << b[0] << ',' << b[1];
        ++walls[posts];
    }
    EXPECT_EQ(walls.size(), static_cast<std::size_t>(2 * (columns - 1) + 2 * (rows - 1)));
    for (const auto& [posts, triangles] : walls) {
        EXPECT_EQ(triangles, 2);
        const auto &a = *posts.begin(), &b = *posts.rbegin();
        EXPECT_TRUE((a[0] == b[0] && (a[0] == 0 || a[0] == columns - 1)) ||
                    (a[1] == b[1] && (a[1] == 0 || a[1] == rows - 1)));
    }
}

TEST(Sides, EachStepAlongTheRimHasAWallOfItsOwnPosts) {
    expect_a_wall_below_each_step(65, 65);
    expect_a_wall_below_each_step(65, 33);
    expect_a_wall_below_each_step(12, 65);
}

/// Walls of all tiles of a level: along the DEM's rim, and where triangles are cut.
struct Count {
    int on_rim = 0, cut = 0;
};

template <typename IsVoid>
Count count_walls(int level, const IsVoid& is_void) {
    constexpr int kSide = 321;
    Array2d<float> heights(kSide, kSide, 100.0f);
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
            if (is_void(x, y)) heights.at(x, y) = std::numeric_limits<float>::quiet_NaN();
    const dem::Pyramid pyramid(heights);
    Sides sides(pyramid);
    Count count;
    for (int y = 0; y < pyramid.tiles(level).y; ++y)
        for (int x = 0; x < pyramid.tiles(level).x; ++x)
            for (const SideEdge& edge : sides.edges({level, {x, y}}))
                ++(edge.third.x < 0 ? count.on_rim : count.cut);
    return count;
}

bool is_within(int x, int y, int west, int north, int side) {
    return x >= west && x < west + side && y >= north && y < north + side;
}

TEST(Sides, AVoidThatGroundEnclosesHasNoWall) {
    const auto inner = [](int x, int y) { return is_within(x, y, 100, 120, 80); };
    const auto bay = [](int x, int y) { return is_within(x, y, 100, 241, 80); };
    for (const int level : {0, 1, 2}) {
        const int rim = 4 * (320 >> level);
        EXPECT_EQ(count_walls(level, inner).cut, 0) << level;
        EXPECT_EQ(count_walls(level, inner).on_rim, rim) << level;
        EXPECT_GE(count_walls(level, bay).cut, 3 * (80 >> level)) << level;
    }
}

TEST(Sides, APieceOfGroundNarrowerThanAnEighthOfTheDemHasNoWall) {
    const auto bay = [](int x, int y) { return is_within(x, y, 100, 201, 120); };
    const auto with_piece = [&](int west, int north, int side) {
        return [=](int x, int y) { return bay(x, y) && !is_within(x, y, west, north, side); };
    };
    for (const int level : {0, 1}) {
        const Count alone = count_walls(level, bay);
        EXPECT_EQ(count_walls(level, with_piece(140, 240, 38)).cut, alone.cut) << level;
        EXPECT_GT(count_walls(level, with_piece(140, 240, 42)).cut, alone.cut) << level;
    }
    // Nor where it reaches the edge of the DEM.
    const auto frame = [](int x, int y) { return y >= 240 && !is_within(x, y, 150, 301, 20); };
    EXPECT_EQ(count_walls(0, frame).on_rim, 320 + 2 * 240);
}

TEST(Sides, WallsRunAgainstTheOrderOfTheGroundsTriangles) {
    const Array2d<float> heights(65, 65, 100.0f);
    const dem::Pyramid pyramid(heights);
    Sides sides(pyramid);
    for (const SideEdge& edge : sides.edges({0, {0, 0}})) {
        const glm::vec2 along = edge.b - edge.a, inwards = glm::vec2(32) - edge.a;
        EXPECT_GT(along.x * inwards.y - along.y * inwards.x, 0) << edge.a.x << ' ' << edge.a.y;
    }
}

}  // namespace
}  // namespace relevo::render::test_sides
