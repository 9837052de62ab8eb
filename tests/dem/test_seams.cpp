#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "dem/fixture.h"
#include "dem/index_fixture.h"
#include "dem/load.h"
#include "support/support.h"

// Edges between tiles that are resampled to another grid.

namespace relevo::dem::test_seams {
namespace {

using test::folder;
using test::IndexLayer;
using test::IndexRow;
using test::Raster;
using test::row_of;
using test::write_index;
using test::write_raster;
using Paths = std::vector<std::string>;

/// Height of tests/data/cases/glo30_seam at degrees of longitude and latitude.
double glo30_m(const glm::dvec2& at) {
    return 1000 + 20000 * (at.x - 10) + 5000 * (at.y - 50);
}

Paths glo30() {
    Paths paths;
    for (const char* name : {"N49_E10.0", "N49_E10.02", "N50_E10.0", "N50_E10.02"})
        paths.push_back(test::small_case(fmt::format("glo30_seam/{}.tif", name)));
    return paths;
}

std::string index_of(const Paths& paths, const std::string& crs) {
    std::vector<IndexRow> rows;
    for (const std::string& path : paths)
        rows.push_back(row_of(path));
    IndexLayer layer;
    layer.crs = crs;
    return write_index(folder() / "seam.gpkg", "GPKG", rows, layer);
}

/// What heights are off from those of a plane in the CRS of the DEM, but for its outer posts.
template <typename Plane>
double worst_m(const Source& source, const Plane& plane_m, int outer = 1) {
    const Array2d<float> height_m = source.read();
    double worst = 0;
    for (int row = outer; row < height_m.height() - outer; ++row)
        for (int column = outer; column < height_m.width() - outer; ++column) {
            const double off_m =
                std::abs(height_m.at(column, row) - plane_m(source.grid().affine()(column, row)));
            worst = std::isnan(off_m) ? INFINITY : std::max(worst, off_m);
        }
    return worst;
}

/// Expects the posts of the whole in windows, and means of posts.
void expect_alike(const Source& source) {
    const Array2d<float> all = source.read();
    for (int row = 0; row < all.height(); row += 7)
        for (int column = 0; column < all.width(); column += 5) {
            const Window w{column, row, std::min(9, all.width() - column),
                           std::min(4, all.height() - row)};
            const Array2d<float> part = source.read(w, w.columns, w.rows);
            for (int r = 0; r < w.rows; ++r)
                for (int c = 0; c < w.columns; ++c)
                    ASSERT_EQ(std::memcmp(&part.at(c, r), &all.at(column + c, row + r), 4), 0)
                        << column + c << " " << row + r;
        }
    const int columns = all.width() / 2, rows = all.height() / 2;
    const Array2d<float> means = source.read({0, 0, 2 * columns, 2 * rows}, columns, rows);
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            double sum = 0;
            for (const int i : {0, 1, 2, 3})
                sum += double{all.at(2 * column + i % 2, 2 * row + i / 2)} / 4;
            if (std::isnan(sum)) continue;
            ASSERT_NEAR(means.at(column, row), sum, 1e-3) << column << " " << row;
        }
}

TEST(Seams, WhereTheSpacingChangesThereIsNoNotch) {
    Paths paths = glo30();
    do {
        const Source source = Source::open(paths);
        EXPECT_EQ(source.grid().columns(), 144);
        EXPECT_LT(worst_m(source, glo30_m), 0.1);
    } while (std::ranges::next_permutation(paths).found);
    expect_alike(Source::open(paths));
}

TEST(Seams, AnIndexHasNone) {
    for (const int first : {0, 2}) {  // the grid of its first tile: finer, coarser
        Paths paths = glo30();
        std::ranges::rotate(paths, paths.begin() + first);
        const Source source = Source::open(index_of(paths, "EPSG:4326"));
        EXPECT_NEAR(source.grid().affine().x_column, (first == 0 ? 1 : 1.5) / 3600, 1e-9);
        EXPECT_LT(worst_m(source, glo30_m), 0.1) << first;
        expect_alike(source);
    }
}

/// Tiles of a plane in zone 33, some degrees west of it, that meet.
Raster turned_tile(int column, int row) {
    Raster raster;
    raster.crs = "EPSG:32633";
    raster.columns = 20;
    raster.rows = 25;
    raster.geotransform = {{200000 + 600.0 * column, 30, 0, 5200000 - 750.0 * row, 0, -30}};
    const geo::Crs own = geo::Crs::parse(raster.crs, "test"),
                   dem = geo::Crs::parse("EPSG:32632", "test");
    const std::array<double, 6> g = *raster.geotransform;
    raster.value = [=](int c, int r, int) {
        const glm::dvec2 at =
            dem.from_geodetic(own.to_geodetic(g[0] + g[1] * (c + 0.5), g[3] + g[5] * (r + 0.5)));
        return 0.5 * (at.x - 600000) + 0.25 * (at.y - 5200000);
    };
    return raster;
}

TEST(Seams, TilesInAnotherCrsHaveNone) {
    Paths paths;
    const auto plane_m = [](const glm::dvec2& at) {
        return 0.5 * (at.x - 600000) + 0.25 * (at.y - 5200000);
    };
    glm::dvec2 middle(0);
    for (const int tile : {0, 1, 2, 3}) {
        const Raster raster = turned_tile(tile % 2, tile / 2);
        paths.push_back(write_raster(folder() / fmt::format("z33_{}.tif", tile), raster));
        const Grid grid = Source::open(paths.back()).grid();
        middle += geo::Crs::parse("EPSG:32632", "test").from_geodetic(grid.center()) / 4.0;
    }
    // A raster whose grid is that of the DEM, beside them.
    Raster beside;
    beside.columns = beside.rows = 10;
    beside.geotransform = {{std::round(middle.x) + 900, 26, 0, std::round(middle.y), 0, -26}};
    const Affine at = Affine::of_geotransform(*beside.geotransform);
    beside.value = [=](int c, int r, int) { return plane_m(at(c, r)); };
    paths.push_back(write_raster(folder() / "beside.tif", beside));
    const Source source = Source::open(paths);
    ASSERT_EQ(source.grid().affine().x_column, 26);
    const Array2d<float> height_m = source.read();
    const glm::dvec2 centre = source.grid().affine().inverse(middle);
    int compared = 0;
    // The edges between the tiles run through the middle, turned by 3 degrees.
    for (int row = -18; row <= 18; ++row)
        for (int column = -15; column <= 15; ++column) {
            const int c = static_cast<int>(centre.x) + column, r = static_cast<int>(centre.y) + row;
            ASSERT_NEAR(height_m.at(c, r), plane_m(source.grid().affine()(c, r)), 0.1)
                << column << " " << row;
            ++compared;
        }
    EXPECT_EQ(compared, 31 * 37);
    expect_alike(source);
}

TEST(Seams, AVoidBeyondAnEdgeHasNoPart) {
    // Of two coarse tiles the second begins with a void; the fine one is the grid.
    const auto coarse = [](int first, double edge_m) {
        Raster raster;
        raster.columns = 10;
        raster.rows = 8;
        raster.nodata = -1;
        raster.geotransform = {{500000 + 50.0 * first, 50, 0, 5200000, 0, -50}};
        raster.value = [=](int c, int, int) {
            return first > 0 && c == 0 ? edge_m : 100.0 + first + c;
        };
        return raster;
    };
    Raster fine;
    fine.columns = fine.rows = 10;
    fine.geotransform = {{500000, 20, 0, 5200200, 0, -20}};
    fine.value = [](int, int, int) { return 100.0; };
    const std::string grid = write_raster(folder() / "fine.tif", fine),
                      left = write_raster(folder() / "left.tif", coarse(0, 0));
    const auto row_with = [&](double edge_m) {
        const Source source = Source::open(
            Paths{grid, left, write_raster(folder() / "right.tif", coarse(10, edge_m))});
        return source.read({0, 15, source.grid().columns(), 1}, source.grid().columns(), 1);
    };
    const Array2d<float> with_void = row_with(-1), without = row_with(209);
    // The last posts of `left` are at 475 m, the first of `right` at 525 m, their edge at 500 m.
    EXPECT_EQ(with_void.at(24, 0), 109);           // 490 m
    EXPECT_TRUE(std::isnan(with_void.at(25, 0)));  // 510 m
    EXPECT_NEAR(without.at(24, 0), 109 + 0.3 * 100, 1e-3);
    EXPECT_NEAR(without.at(25, 0), 109 + 0.7 * 100, 1e-3);
}

}  // namespace
}  // namespace relevo::dem::test_seams
