#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "mesh/refine.h"
#include "mesh/spans.h"
#include "mesh/surface.h"

/// Greedy refinement, each claim tested by other means than it is made by.
namespace relevo::mesh {
namespace {

constexpr float kVoid = std::numeric_limits<float>::quiet_NaN();
constexpr std::int64_t kMany = 1 << 20;

/// Rough ground: hills and noise.
Array2d<float> hills(int columns, int rows, double noise_m = 2) {
    Array2d<float> height_m(columns, rows);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> noise(-noise_m, noise_m);
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            height_m.at(column, row) = static_cast<float>(
                300 + 80 * std::sin(column * 0.13) * std::cos(row * 0.09 + 1) + noise(random));
    return height_m;
}

/// The same with round voids, one of them at the edge, and a single one.
Array2d<float> hills_with_voids(int columns, int rows) {
    Array2d<float> height_m = hills(columns, rows);
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            if (std::hypot(column - 20, row - 15) < 7 || std::hypot(column - columns, row) < 12)
                height_m.at(column, row) = kVoid;
    height_m.at(5, 30) = kVoid;
    return height_m;
}

GridMesh refined(const Array2d<float>& height_m, double error_m) {
    Array2d<std::uint8_t> roles = ground_roles(height_m);
    std::optional<GridMesh> mesh = refine(height_m, roles, error_m, kMany);
    EXPECT_TRUE(mesh);
    return std::move(*mesh);
}

/// Twice the area on a map, whose rows count downwards.
double twice_map_area(const GridMesh& mesh, std::size_t triangle) {
    const auto at = [&](std::size_t i) { return mesh.points[mesh.corners[3 * triangle + i]]; };
    const LatticePoint a = at(0), b = at(1), c = at(2);
    return -(double(b.column - a.column) * (c.row - a.row) -
             double(b.row - a.row) * (c.column - a.column));
}

/// The height of a mesh at a place, by search through all triangles; none outside.
std::optional<double> height_at(const GridMesh& mesh, const Array2d<float>& height_m, double column,
                                double row) {
    for (std::size_t t = 0; t < mesh.triangles(); ++t) {
        const auto at = [&](std::size_t i) { return mesh.points[mesh.corners[3 * t + i]]; };
        double height = 0;
        bool inside = true;
        for (std::size_t i = 0; i < 3; ++i) {
            const LatticePoint b = at((i + 1) % 3), c = at((i + 2) % 3);
            const double part =
                ((b.row - row) * (c.column - column) - (b.column - column) * (c.row - row)) /
                twice_map_area(mesh, t);
            inside = inside && part > -1e-9;
            height += part * height_m.at(at(i).column, at(i).row);
        }
        if (inside) return height;
    }
    return std::nullopt;
}

double worst_error_m(const GridMesh& mesh, const Array2d<float>& height_m) {
    double worst_m = 0;
    for (int row = 0; row < height_m.height(); ++row)
        for (int column = 0; column < height_m.width(); ++column)
            if (const auto height = height_at(mesh, height_m, column, row))
                worst_m = std::max(worst_m, std::abs(*height - height_m.at(column, row)));
    return worst_m;
}

TEST(Delaunay, NoCircumcircleHasAPointInside) {
    Delaunay mesh(64, 48);
    std::mt19937 random(3);
    std::set<std::pair<int, int>> taken{{0, 0}, {63, 0}, {63, 47}, {0, 47}};
    std::vector<std::uint32_t> changed;
    while (taken.size() < 400) {
        const LatticePoint post{static_cast<int>(random() % 64), static_cast<int>(random() % 48)};
        if (!taken.insert({post.column, post.row}).second) continue;
        for (std::uint32_t t = 0; t < mesh.triangles(); ++t) {
            const auto [a, b, c] = mesh.corners(t);
            const Spans spans({mesh.point(a), mesh.point(b), mesh.point(c)});
            if (post.row < spans.first_row || post.row > spans.last_row) continue;
            const auto [first, last] = spans.columns(post.row);
            if (post.column < first || post.column > last) continue;
            mesh.insert(t, post, changed);
            break;
        }
    }
    ASSERT_EQ(mesh.points(), 400U);
    double area = 0;
    for (std::uint32_t t = 0; t < mesh.triangles(); ++t) {
        const auto [a, b, c] = mesh.corners(t);
        const LatticePoint p = mesh.point(a), q = mesh.point(b), r = mesh.point(c);
        const auto doubled = static_cast<double>(twice_area(p, q, r));
        ASSERT_GT(doubled, 0);
        area += doubled / 2;
        // The circumcentre, relative to p.
        const double qx = q.column - p.column, qy = q.row - p.row;
        const double rx = r.column - p.column, ry = r.row - p.row;
        const double qq = qx * qx + qy * qy, rr = rx * rx + ry * ry;
        const double x = (ry * qq - qy * rr) / (2 * doubled);
        const double y = (qx * rr - rx * qq) / (2 * doubled);
        for (std::uint32_t i = 0; i < mesh.points(); ++i)
            EXPECT_GT(
                std::hypot(mesh.point(i).column - p.column - x, mesh.point(i).row - p.row - y),
                std::hypot(x, y) - 1e-6);
    }
    EXPECT_EQ(area, 63 * 47);
}

TEST(Spans, HaveTheLatticePointsOfATriangle) {
    std::mt19937 random(5);
    for (int k = 0; k < 300; ++k) {
        std::array<LatticePoint, 3> at{};
        for (LatticePoint& point : at)
            point = {static_cast<int>(random() % 17), static_cast<int>(random() % 13)};
        if (twice_area(at[0], at[1], at[2]) < 0) std::swap(at[0], at[1]);
        if (twice_area(at[0], at[1], at[2]) == 0) continue;
        const Spans spans(at);
        for (int row = 0; row < 13; ++row)
            for (int column = 0; column < 17; ++column) {
                bool inside = true;
                for (std::size_t i = 0; i < 3; ++i)
                    inside = inside && twice_area(at[i], at[(i + 1) % 3], {column, row}) >= 0;
                const bool in_rows = row >= spans.first_row && row <= spans.last_row;
                const auto [first, last] = spans.columns(row);
                EXPECT_EQ(in_rows && column >= first && column <= last, inside);
            }
    }
}

TEST(Refine, NoPostIsFartherThanTheError) {
    const Array2d<float> height_m = hills(65, 49);
    std::size_t before = 2 * 64 * 48;
    for (const double error_m : {0.5, 2.0, 8.0, 30.0}) {
        const GridMesh mesh = refined(height_m, error_m);
        const double worst_m = worst_error_m(mesh, height_m);
        EXPECT_LE(worst_m, error_m * (1 + 1e-6));
        EXPECT_GT(worst_m, error_m / 2);  // no more triangles than that needs
        EXPECT_LT(mesh.triangles(), before);
        before = mesh.triangles();
    }
    EXPECT_LT(before, 300U);
}

TEST(Refine, APlaneIsTwoTriangles) {
    Array2d<float> height_m(50, 30);
    for (int row = 0; row < 30; ++row)
        for (int column = 0; column < 50; ++column)
            height_m.at(column, row) = static_cast<float>(3 * column - 2 * row);
    EXPECT_EQ(refined(height_m, 0.01).triangles(), 2U);
}

TEST(Refine, ASpikeIsAVertex) {
    Array2d<float> height_m(33, 33, 100);
    height_m.at(11, 22) = 150;
    const GridMesh mesh = refined(height_m, 1);
    EXPECT_TRUE(std::ranges::count(mesh.points, LatticePoint{11, 22}) == 1);
    EXPECT_LE(worst_error_m(mesh, height_m), 1);
}

TEST(Refine, CoversTheCellsOfGroundAndNothingElse) {
    const Array2d<float> height_m = hills_with_voids(60, 44);
    const GridMesh mesh = refined(height_m, 20);
    double cells = 0, area = 0;
    for (int row = 0; row + 1 < 44; ++row)
        for (int column = 0; column + 1 < 60; ++column) {
            const bool ground = is_ground_cell(height_m, column, row);
            cells += ground;
            EXPECT_EQ(height_at(mesh, height_m, column + 0.4, row + 0.3).has_value(), ground)
                << column << " " << row;
        }
    for (std::size_t t = 0; t < mesh.triangles(); ++t) {
        EXPECT_GT(twice_map_area(mesh, t), 0);
        area += twice_map_area(mesh, t) / 2;
    }
    EXPECT_EQ(area, cells);
    EXPECT_LT(cells, 59 * 43);
    EXPECT_LE(worst_error_m(mesh, height_m), 20 * (1 + 1e-6));
}

TEST(Refine, NeedsNoMoreTrianglesThanAreAllowed) {
    const Array2d<float> height_m = hills(65, 49);
    Array2d<std::uint8_t> roles = ground_roles(height_m);
    EXPECT_FALSE(refine(height_m, roles, 0.5, 100));
}

TEST(Refine, FixedPostsAreVertices) {
    const Array2d<float> height_m(40, 40, 7);
    Array2d<std::uint8_t> roles = ground_roles(height_m);
    for (int i = 0; i < 40; i += 8)
        roles.at(i, i) |= kFixed;
    const auto mesh = refine(height_m, roles, std::numeric_limits<double>::infinity(), kMany);
    ASSERT_TRUE(mesh);
    for (int i = 0; i < 40; i += 8)
        EXPECT_EQ(std::ranges::count(mesh->points, LatticePoint{i, i}), 1) << i;
    EXPECT_LE(mesh->points.size(), 9U);
}

TEST(CornerContacts, AreCutUntilThereAreNone) {
    Array2d<float> height_m = hills(12, 12);
    height_m.at(4, 6) = height_m.at(6, 4) = kVoid;  // cells of ground touch at (5, 5)
    ASSERT_GT(cut_corner_contacts(height_m), 0);
    EXPECT_TRUE(std::isnan(height_m.at(5, 5)));
    EXPECT_EQ(cut_corner_contacts(height_m), 0);
    Array2d<float> whole = hills(12, 12);
    EXPECT_EQ(cut_corner_contacts(whole), 0);
}

/// Places on a plane, 10 m apart.
glm::dvec3 place_m(const Array2d<float>& height_m, const LatticePoint& post) {
    return {10 * post.column, -10 * post.row, height_m.at(post.column, post.row)};
}

Surface solid_of(const Array2d<float>& height_m, double error_m, double base_m) {
    const GridMesh top = refined(height_m, error_m);
    Array2d<std::uint8_t> roles(height_m.width(), height_m.height());
    for (const auto& edge : top.border)
        for (const std::uint32_t point : edge)
            roles.at(top.points[point].column, top.points[point].row) = kGround | kFixed;
    const auto bottom = refine(height_m, roles, std::numeric_limits<double>::infinity(), kMany);
    return solid(
        top, *bottom, [&](const LatticePoint& post) { return place_m(height_m, post); }, base_m);
}

/// Edges that do not belong to two triangles, once in each direction.
std::size_t open_edges(const Surface& surface) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> count;
    for (std::size_t i = 0; i < surface.corners.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k)
            ++count[{surface.corners[i + k], surface.corners[i + (k + 1) % 3]}];
    std::size_t open = 0;
    for (const auto& [edge, times] : count) {
        const auto back = count.find({edge.second, edge.first});
        open += times != 1 || back == count.end() || back->second != 1;
    }
    return open;
}

TEST(Solid, IsClosedAndHasTheVolumeUnderItsTriangles) {
    for (const bool with_voids : {false, true}) {
        Array2d<float> height_m = with_voids ? hills_with_voids(60, 44) : hills(60, 44);
        cut_corner_contacts(height_m);
        const GridMesh top = refined(height_m, 10);
        const Surface surface = solid_of(height_m, 10, 100);
        EXPECT_EQ(open_edges(surface), 0U);
        // Prisms under the triangles of the top.
        double expected_m3 = 0;
        for (std::size_t t = 0; t < top.triangles(); ++t) {
            double height = 0;
            for (std::size_t i = 0; i < 3; ++i) {
                const LatticePoint at = top.points[top.corners[3 * t + i]];
                height += height_m.at(at.column, at.row) / 3.0 - 100 / 3.0;
            }
            expected_m3 += 100 * twice_map_area(top, t) / 2 * height;
        }
        EXPECT_NEAR(volume_m3(surface) / expected_m3, 1, 1e-6);
    }
}

TEST(Solid, HasTheIntegralOfItsHeights) {
    // Smooth: whichever diagonal a cell has.
    const Array2d<float> height_m = hills(120, 90, 0);
    double integral_m3 = 0;
    for (int row = 0; row + 1 < 90; ++row)
        for (int column = 0; column + 1 < 120; ++column)
            integral_m3 +=
                100 * ((height_m.at(column, row) + height_m.at(column + 1, row) +
                        height_m.at(column, row + 1) + height_m.at(column + 1, row + 1)) /
                           4.0 -
                       150);
    EXPECT_NEAR(volume_m3(solid_of(height_m, 0.5, 150)) / integral_m3, 1, 5e-4);
}

TEST(Solid, RingHasAHoleThroughIt) {
    Array2d<float> height_m(9, 9, 20);
    for (int row = 3; row < 6; ++row)
        for (int column = 3; column < 6; ++column)
            height_m.at(column, row) = kVoid;
    const Surface surface = solid_of(height_m, 1, 0);
    EXPECT_EQ(open_edges(surface), 0U);
    EXPECT_NEAR(volume_m3(surface), 100 * (64 - 16) * 20, 1);
    // V - E + F of a torus is 0.
    EXPECT_EQ(surface.position_m.size() + surface.triangles(), surface.triangles() * 3 / 2);
}

}  // namespace
}  // namespace relevo::mesh
