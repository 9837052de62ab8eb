// Walls below the ground's edge, by the corners that their triangles have.
#include <algorithm>
#include <array>
#include <cmath>
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

}  // namespace
}  // namespace relevo::render::test_sides
