#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <unordered_map>
#include <vector>

#include <fmt/format.h>

#include "dem/fixture.h"
#include "dem/load.h"
#include "geo/local_frame.h"
#include "output/exported_ground.h"
#include "output/terrain_mesh.h"
#include "support/support.h"

/// Meshes of DEMs, measured with nothing but their triangles and the posts' places.
namespace relevo::output {
namespace {

namespace fs = std::filesystem;
using test::error_of;

ExportedGround ground_of(const std::string& path, const dem::LoadOptions& how = {},
                         const ExportOptions& options = {}) {
    return read_ground(dem::Source::open(path, how), how, options);
}

/// Finds triangles by the square of the frame's x and y that a vertical passes.
class Squares {
  public:
    explicit Squares(const mesh::Surface& surface) : surface_(surface) {
        glm::dvec2 low(1e30), high(-1e30);
        for (const glm::vec3& at : surface.position_m) {
            low = glm::min(low, glm::dvec2(at));
            high = glm::max(high, glm::dvec2(at));
        }
        low_ = low;
        side_ = std::sqrt((high.x - low.x) * (high.y - low.y) /
                          static_cast<double>(surface.triangles()));
        columns_ = static_cast<std::int64_t>((high.x - low.x) / side_) + 3;
        for (std::size_t t = 0; t < surface.triangles(); ++t) {
            glm::dvec2 first(1e30), last(-1e30);
            for (int k = 0; k < 3; ++k) {
                first = glm::min(first, glm::dvec2(corner(t, k)));
                last = glm::max(last, glm::dvec2(corner(t, k)));
            }
            for (std::int64_t y = index(first.y - low.y); y <= index(last.y - low.y); ++y)
                for (std::int64_t x = index(first.x - low.x); x <= index(last.x - low.x); ++x)
                    triangles_[y * columns_ + x].push_back(t);
        }
    }

    /// How far along `up` the mesh is from a point [m]; NaN where it is not there.
    double distance_m(const glm::dvec3& at, const glm::dvec3& up) const {
        const auto found = triangles_.find(index(at.y - low_.y) * columns_ + index(at.x - low_.x));
        double nearest = std::nan("");
        if (found == triangles_.end()) return nearest;
        for (const std::size_t t : found->second) {
            // Moeller, Trumbore 1997.
            const glm::dvec3 a = corner(t, 0), b = corner(t, 1) - a, c = corner(t, 2) - a;
            const glm::dvec3 p = glm::cross(up, c), s = at - a, q = glm::cross(s, b);
            const double determinant = glm::dot(b, p);
            const double u = glm::dot(s, p) / determinant, v = glm::dot(up, q) / determinant;
            if (u < -1e-6 || v < -1e-6 || u + v > 1 + 1e-6) continue;
            const double off_m = std::abs(glm::dot(c, q) / determinant);
            if (!(off_m >= nearest)) nearest = off_m;
        }
        return nearest;
    }

  private:
    glm::dvec3 corner(std::size_t triangle, int k) const {
        return surface_.position_m[surface_.corners[3 * triangle + static_cast<std::size_t>(k)]];
    }
    std::int64_t index(double offset_m) const {
        return static_cast<std::int64_t>(std::floor(offset_m / side_)) + 1;
    }

    const mesh::Surface& surface_;
    glm::dvec2 low_{};
    double side_ = 1;
    std::int64_t columns_ = 1;
    std::unordered_map<std::int64_t, std::vector<std::size_t>> triangles_;
};

/// Every post of the ground, by its own vertical. Posts of the outline may be beside the mesh by
/// less than the outline bends.
void expect_within(const ExportedGround& ground, const TerrainMesh& mesh, double error_m) {
    const dem::Grid& grid = ground.field.grid;
    const geo::LocalFrame frame(grid.center());
    const Squares squares(mesh.surface);
    const Array2d<std::uint8_t> roles = mesh::ground_roles(ground.field.height_m);
    double worst_m = 0, sum_m = 0;
    std::int64_t posts = 0, beside = 0, outline = 0;
    for (int row = 0; row < grid.rows(); ++row)
        for (int column = 0; column < grid.columns(); ++column) {
            if (!(roles.at(column, row) & mesh::kGround)) continue;
            geo::Geodetic place = grid.place(column, row);
            place.height_m = ground.field.height_m.at(column, row);
            const double off_m =
                squares.distance_m(frame.to_local(place), frame.up(place.lat_rad, place.lon_rad));
            const bool at_edge = row == 0 || column == 0 || row + 1 == grid.rows() ||
                                 column + 1 == grid.columns() ||
                                 roles.at(column, row) & mesh::kFixed;
            outline += at_edge;
            if (std::isnan(off_m)) {
                ++beside;
                EXPECT_TRUE(at_edge) << column << " " << row;
                continue;
            }
            worst_m = std::max(worst_m, off_m);
            sum_m += off_m;
            ++posts;
        }
    EXPECT_EQ(posts + beside, mesh.posts);
    EXPECT_LE(beside, outline);
    EXPECT_LE(worst_m, error_m);
    EXPECT_NEAR(worst_m, mesh.worst_m, 0.02 * error_m);
    EXPECT_NEAR(sum_m / static_cast<double>(posts), mesh.mean_m, 0.02 * error_m);
    fmt::print("[ accuracy ] {} triangles for {} posts: worst {:.3f} m, mean {:.3f} m (limit {})\n",
               mesh.surface.triangles(), mesh.posts, worst_m, sum_m / static_cast<double>(posts),
               error_m);
}

void expect_all_within(const std::string& path, double error_m) {
    const ExportedGround ground = ground_of(path);
    const TerrainMesh mesh =
        terrain_mesh(ground.field.height_m, ground.field.grid,
                     GroundFrame(ground.field.grid, false), {.error_m = error_m});
    EXPECT_LT(mesh.surface.triangles(), static_cast<std::size_t>(mesh.posts));
    expect_within(ground, mesh, error_m);
}

TEST(TerrainMesh, NoPostOfTheBundledDemIsFartherThanTheError) {
    for (const double error_m : {5.0, 40.0})
        expect_all_within((test::source_dir() / "data/dem/jacksboro.tif").string(), error_m);
}

TEST(TerrainMesh, NoPostOfOtherDemsIsFartherThanTheError) {
    SKIP_WITHOUT_TEST_DATA(data);
    for (const char* name : {"dem/hawaii_rotated20.tif", "dem/dem_RGI50-05.08389.tif",
                             "dem/SainteHelens.dem", "dem/holyroodpark.tif"})
        expect_all_within((data / name).string(), 5);
}

/// A plain on which nothing but the Earth bends: 200 km of sea.
TEST(TerrainMesh, FollowsTheBendOfTheEarth) {
    const dem::Grid grid(401, 401, {400000, 500, 0, 5300000, 0, -500},
                         geo::Crs::parse("EPSG:32632", "test"));
    const Array2d<float> sea(401, 401, 0);
    const TerrainMesh round = terrain_mesh(sea, grid, GroundFrame(grid, false), {.error_m = 2});
    EXPECT_GT(round.surface.triangles(), 1000U);
    EXPECT_GT(round.worst_m, 0.05);
    expect_within({{sea, grid, {}, 1}, {401, 401}}, round, 2);
    const TerrainMesh flat = terrain_mesh(sea, grid, GroundFrame(grid, true), {.error_m = 2});
    EXPECT_EQ(flat.surface.triangles(), 2U);
    // 141 km from the centre the ground is d^2 / 2 R lower.
    float low_m = 0;
    for (const glm::vec3& at : round.surface.position_m)
        low_m = std::min(low_m, at.z);
    EXPECT_NEAR(low_m, -2 * 1e10 / (2 * 6.38e6), 10);
}

TEST(TerrainMesh, NormalsAreThoseOfTheSlope) {
    const dem::Grid grid(50, 40, {500000, 30, 0, 5200000, 0, -30},
                         geo::Crs::parse("EPSG:32632", "test"));
    Array2d<float> height_m(50, 40);
    for (int row = 0; row < 40; ++row)
        for (int column = 0; column < 50; ++column)
            height_m.at(column, row) = static_cast<float>(12 * column - 6 * row);
    const TerrainMesh mesh = terrain_mesh(height_m, grid, GroundFrame(grid, false), {});
    // 0.4 up to the east, 0.2 up to the north.
    const glm::dvec3 expected = glm::normalize(glm::dvec3(-0.4, -0.2, 1));
    for (const glm::vec3& normal : mesh.surface.normal)
        EXPECT_GT(glm::dot(glm::dvec3(normal), expected), std::cos(0.001));
    for (std::size_t i = 0; i < mesh.surface.texture.size(); ++i) {
        const glm::vec2 texture = mesh.surface.texture[i];
        const glm::vec3 at = mesh.surface.position_m[i];
        EXPECT_NEAR(texture.x, 0.5 + at.x / 30.0 / 50, 1e-3);  // from the west
        EXPECT_NEAR(texture.y, 0.5 - at.y / 30.0 / 40, 1e-3);  // from the north
    }
}

/// One mountain, stored in every order that rows and columns have.
TEST(TerrainMesh, StandsUprightHoweverTheGridRuns) {
    struct Way {
        const char* name;
        bool swap, flip_x, flip_y;
    };
    for (const Way& way :
         {Way{"north up", false, false, false}, Way{"south up", false, false, true},
          Way{"mirrored", false, true, false}, Way{"half a turn", false, true, true},
          Way{"quarter", true, false, false}, Way{"quarter, south", true, false, true},
          Way{"quarter, mirrored", true, true, false}, Way{"three quarters", true, true, true}}) {
        SCOPED_TRACE(way.name);
        constexpr int kColumns = 40, kRows = 30;
        test::Raster raster;
        const double x = way.flip_x ? 500000 + 30 * kColumns : 500000;
        const double y = way.flip_y ? 5200000 - 30 * kRows : 5200000;
        const double dx = way.flip_x ? -30 : 30, dy = way.flip_y ? 30 : -30;
        raster.columns = way.swap ? kRows : kColumns;
        raster.rows = way.swap ? kColumns : kRows;
        raster.geotransform = way.swap ? std::array<double, 6>{x, 0, dx, y, dy, 0}
                                       : std::array<double, 6>{x, dx, 0, y, 0, dy};
        raster.value = [&](int column, int row, int) {
            int c = way.swap ? row : column, r = way.swap ? column : row;
            if (way.flip_x) c = kColumns - 1 - c;
            if (way.flip_y) r = kRows - 1 - r;
            return 100 + 500 * std::exp(-0.02 * ((c - 30) * (c - 30) + (r - 8) * (r - 8)));
        };
        const ExportedGround ground =
            ground_of(test::write_raster(test::folder() / "turned.tif", raster));
        ASSERT_EQ(ground.field.grid.columns(), kColumns);
        ASSERT_EQ(ground.field.grid.rows(), kRows);
        EXPECT_FLOAT_EQ(ground.field.height_m.at(30, 8), 600);
        EXPECT_NEAR(ground.field.grid.affine().x0, 500015, 1e-6);
        EXPECT_NEAR(ground.field.grid.affine().y0, 5199985, 1e-6);
        const TerrainMesh mesh = terrain_mesh(ground.field.height_m, ground.field.grid,
                                              GroundFrame(ground.field.grid, false), {});
        const auto top = std::ranges::max_element(mesh.surface.position_m, {}, &glm::vec3::z);
        EXPECT_NEAR(top->x, (30 - 19.5) * 30, 0.5);  // east of the middle
        EXPECT_NEAR(top->y, (14.5 - 8) * 30, 0.5);   // north of it
        for (std::size_t i = 0; i < mesh.surface.corners.size(); i += 3) {
            const auto at = [&](std::size_t k) {
                return glm::dvec3(mesh.surface.position_m[mesh.surface.corners[i + k]]);
            };
            EXPECT_GT(glm::cross(at(1) - at(0), at(2) - at(0)).z, 0);
        }
        EXPECT_GT(mesh.surface.normal.front().z, 0);
    }
}

TEST(TerrainMesh, ASolidHasTheVolumeOfItsHeights) {
    const ExportedGround ground =
        ground_of((test::source_dir() / "data/dem/jacksboro.tif").string());
    const dem::Grid& grid = ground.field.grid;
    const GroundFrame frame(grid, true);
    const TerrainMesh mesh = terrain_mesh(ground.field.height_m, grid, frame,
                                          {.error_m = 2, .solid = true, .base_m = 200});
    double integral = 0;  // of heights above the base, over cells
    for (int row = 0; row + 1 < grid.rows(); ++row)
        for (int column = 0; column + 1 < grid.columns(); ++column)
            for (int k = 0; k < 4; ++k)
                integral += (ground.field.height_m.at(column + k % 2, row + k / 2) - 200) / 4;
    const glm::dvec2 spacing = grid.post_spacing_m();
    EXPECT_NEAR(mesh::volume_m3(mesh.surface) / (integral * spacing.x * spacing.y), 1, 5e-4);
    EXPECT_TRUE(mesh.surface.normal.empty());
}

TEST(TerrainMesh, CrossesTheAntimeridian) {
    const dem::Grid grid(121, 81, {179.95, 1.0 / 1200, 0, -16.9, 0, -1.0 / 1200}, geo::Crs());
    const Array2d<float> height_m(121, 81, 50);
    for (const bool flat : {false, true}) {
        const TerrainMesh mesh = terrain_mesh(height_m, grid, GroundFrame(grid, flat), {});
        float west = 0, east = 0;
        for (const glm::vec3& at : mesh.surface.position_m) {
            west = std::min(west, at.x);
            east = std::max(east, at.x);
        }
        // A tenth of a degree at 16.93 S: 111320 * cos(16.93) / 10.
        EXPECT_NEAR(east - west, 10650, 25) << flat;
    }
}

TEST(TerrainMesh, ReachesAPole) {
    // Rows at 89.9 to 90 N, all around.
    const dem::Grid grid(361, 11, {-180, 1, 0, 90, 0, -0.01}, geo::Crs());
    const Array2d<float> height_m(361, 11, 100);
    const TerrainMesh mesh =
        terrain_mesh(height_m, grid, GroundFrame(grid, false), {.error_m = 0.5});
    EXPECT_LE(mesh.worst_m, 0.5);
    for (const glm::vec3& at : mesh.surface.position_m)
        EXPECT_LT(glm::length(at), 23000);
    const dem::Grid at_pole(11, 3, {-5, 1, 0, 90, 0, -1e-5}, geo::Crs());
    EXPECT_EQ(error_of([&] { const GroundFrame frame(at_pole, true); }),
              "exit 3: --flat: WGS 84 has no plane at the DEM's centre, a pole; leave --flat and "
              "--base out, or bring it to a polar CRS with gdalwarp");
}

TEST(TerrainMesh, SaysWhatItCannotDo) {
    const geo::Crs crs = geo::Crs::parse("EPSG:32632", "test");
    const auto grid = [&](int columns, int rows) {
        return dem::Grid(columns, rows, {500000, 30, 0, 5200000, 0, -30}, crs);
    };
    const auto error = [&](Array2d<float> height_m, TerrainMeshOptions options) {
        options.name = "a.tif";
        const dem::Grid of = grid(height_m.width(), height_m.height());
        return error_of([&] {
            terrain_mesh(std::move(height_m), of, GroundFrame(of, options.solid), options);
        });
    };
    EXPECT_EQ(error(Array2d<float>(9, 1, 5), {}),
              "exit 3: a.tif: a mesh needs 2 x 2 posts, but the DEM has 9 x 1");
    Array2d<float> stripes(8, 8, 5);
    for (int row = 0; row < 8; row += 2)
        for (int column = 0; column < 8; ++column)
            stripes.at(column, row) = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(error(stripes, {}),
              "exit 3: a.tif: no four posts of a cell have heights; a mesh needs one such cell");
    EXPECT_EQ(error(Array2d<float>(9, 9, 5), {.solid = true, .base_m = 5}),
              "exit 3: --base: 5: expected a height below the lowest post, 5 m");
    EXPECT_TRUE(error(Array2d<float>(40000, 2, 5), {})
                    .starts_with("exit 3: a.tif: 40000 x 2 posts, expected at most 32768 a side"));
    Array2d<float> rough(40, 40);
    for (int row = 0; row < 40; ++row)
        for (int column = 0; column < 40; ++column)
            rough.at(column, row) = static_cast<float>((column * 7 + row * 13) % 11);
    EXPECT_EQ(error(rough, {.error_m = 0.1, .max_triangles = 100}),
              "exit 3: a.tif: 100 triangles are too few for an error of 0.1 m; pass a larger "
              "--error, --crop W,S,E,N, or a larger --memory, now 1 MiB");
    EXPECT_TRUE(error(Array2d<float>(2, 20000, 5), {.error_m = 0.01})
                    .starts_with("exit 3: --error: 0.01: smaller than what 32-bit coordinates"));
}

}  // namespace
}  // namespace relevo::output
