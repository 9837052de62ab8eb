#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "dem/fixture.h"
#include "dem/surroundings.h"
#include "support/support.h"

// A site in a wider DEM; figures of both: tests/cli/test_surroundings.cpp.
namespace relevo::dem::test_surroundings {
namespace {

constexpr double kX = 500000, kY = 5200000;

double plane_m(double x, double y) {
    return 500 + 0.3 * (x - kX) + 0.2 * (y - kY);
}

/// Square posts about a point, of a plane and so much.
std::string square(const std::string& name, double step_m, int side, double higher_m,
                   bool has_void = false) {
    static const std::filesystem::path folder = test::scratch_dir("surroundings");
    test::Raster raster;
    raster.columns = raster.rows = side;
    raster.crs = "EPSG:32632";
    raster.nodata = -9999;
    const double half_m = step_m * side / 2;
    raster.geotransform = {{kX - half_m, step_m, 0, kY + half_m, 0, -step_m}};
    raster.value = [=](int column, int row, int) {
        if (has_void && column < 3 && row > 4) return -9999.0;
        return higher_m +
               plane_m(kX - half_m + step_m * (column + 0.5), kY + half_m - step_m * (row + 0.5));
    };
    return test::write_raster(folder / name, raster);
}

Posts load(const std::string& site, const std::string& around, std::int64_t mib = 64) {
    LoadOptions options;
    options.surroundings = {around};
    options.memory = MemoryBudget::of_mib(mib);
    const std::vector<std::string> paths{site};
    return Posts::load(paths, options);
}

double height_m(const Posts& posts, int column, int row) {
    std::vector<float> buffer;
    return double{*posts.view({column, row, 1, 1}, buffer).at(column, row)};
}

TEST(Surroundings, AreRaisedAndFillVoids) {
    const Posts posts = load(square("site.tif", 5, 41, 0, true), square("wide.tif", 30, 81, -48));
    ASSERT_TRUE(posts.surroundings());
    EXPECT_EQ(posts.about().statistics.holes, 0);
    EXPECT_NEAR(height_m(*posts.surroundings(), 40, 40), 500, 0.01);
    EXPECT_NEAR(height_m(posts, 1, 20), plane_m(kX - 95, kY), 0.01);
    EXPECT_NEAR(posts.surroundings()->lowest_m(), plane_m(kX - 1200, kY - 1200), 0.01);
    EXPECT_TRUE(posts.surroundings()->about().joined.starts_with("raised by 48.00 m, the median"));
}

TEST(Surroundings, ARimGoesOnWithThem) {
    const Posts posts = load(square("site.tif", 5, 41, 0), square("wide.tif", 30, 81, 0));
    // 64 cells of 30 m, which are farther than they go.
    ASSERT_EQ(posts.rim(), 384);
    const Heightfield field = rimmed(posts);
    ASSERT_EQ(field.height_m.width(), 41 + 2 * 384);
    for (const auto& [column, row] : {std::pair(384, 384), {383, 400}, {300, 250}, {500, 400}}) {
        const double x = kX + 5 * (column - 384 - 20), y = kY - 5 * (row - 384 - 20);
        EXPECT_NEAR(double{field.height_m.at(column, row)}, plane_m(x, y), 0.02) << column;
        const glm::dvec2 at = field.grid.affine()(column, row);
        EXPECT_NEAR(at.x, x, 1e-6);
        EXPECT_NEAR(at.y, y, 1e-6);
    }
    EXPECT_TRUE(std::isnan(field.height_m.at(0, 0)));
}

TEST(Surroundings, ARimHasRoomInMemory) {
    const Posts posts = load(square("site.tif", 5, 41, 0), square("wide.tif", 30, 81, 0), 1);
    const double side = 41 + 2 * posts.rim();
    EXPECT_LE(side * side, static_cast<double>(MemoryBudget::of_mib(1).whole_posts));
    EXPECT_LT(posts.rim(), 384);
}

TEST(Surroundings, TheSiteLiesInThem) {
    const std::string site = square("site.tif", 5, 41, 0);
    EXPECT_EQ(load(site, square("same.tif", 5, 41, 0)).surroundings()->grid().columns(), 41);
    EXPECT_NE(test::error_of([&] {
                  load(site, square("small.tif", 5, 39, 0));
              }).find("small.tif: end within the DEM, at "),
              std::string::npos);
}

}  // namespace
}  // namespace relevo::dem::test_surroundings
