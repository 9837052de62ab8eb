#include <array>
#include <cmath>
#include <thread>

#include <gdal.h>

#include "dem/fixture.h"
#include "dem/source.h"
#include "support/support.h"

namespace relevo::dem::test_read {
namespace {

using test::Raster;
using test::write_raster;

using test::folder;

double ground(int column, int row) {
    return 500 + 200 * std::sin(column * 0.05) + 100 * std::cos(row * 0.07) + 0.5 * column;
}

Raster hills(int columns, int rows) {
    Raster raster;
    raster.columns = columns;
    raster.rows = rows;
    raster.value = [](int column, int row, int) { return ground(column, row); };
    return raster;
}

/// The mean over a rectangle of cells of which each counts by its area inside, written out.
double mean_of(const Array2d<float>& h, double c0, double c1, double r0, double r1) {
    double sum = 0;
    double area = 0;
    for (int r = static_cast<int>(r0); r < std::ceil(r1 - 1e-9); ++r)
        for (int c = static_cast<int>(c0); c < std::ceil(c1 - 1e-9); ++c) {
            if (std::isnan(h.at(c, r))) continue;
            const double weight = (std::min(c1, c + 1.0) - std::max(c0, double(c))) *
                                  (std::min(r1, r + 1.0) - std::max(r0, double(r)));
            sum += weight * h.at(c, r);
            area += weight;
        }
    return area >= 0.5 * (c1 - c0) * (r1 - r0) ? sum / area : std::nan("");
}

TEST(Read, WindowHasThePostsAsStored) {
    const Source source = Source::open(write_raster(folder() / "window.tif", hills(300, 200)));
    const Array2d<float> all = source.read();
    const Array2d<float> part = source.read({17, 33, 120, 90}, 120, 90);
    ASSERT_EQ(part.width(), 120);
    ASSERT_EQ(part.height(), 90);
    for (int r = 0; r < 90; ++r)
        for (int c = 0; c < 120; ++c)
            ASSERT_EQ(part.at(c, r), all.at(c + 17, r + 33));
    EXPECT_EQ(all.at(299, 199), static_cast<float>(ground(299, 199)));
}

TEST(Read, SeveralThreadsGiveWhatOneGives) {
    // Strips, tiles, and sizes that are no multiple of a tile; more posts than one piece holds.
    const std::vector<std::string> kinds[] = {
        {"COMPRESS=DEFLATE"},
        {"COMPRESS=LZW", "TILED=YES", "BLOCKXSIZE=64", "BLOCKYSIZE=64"},
        {"TILED=YES", "BLOCKXSIZE=256", "BLOCKYSIZE=128"},
    };
    for (const auto& options : kinds) {
        Raster raster = hills(700, 613);
        raster.options = options;
        const Source source = Source::open(write_raster(folder() / "threads.tif", raster));
        const Array2d<float> h = source.read();
        for (int r = 0; r < 613; ++r)
            for (int c = 0; c < 700; ++c)
                ASSERT_EQ(h.at(c, r), static_cast<float>(ground(c, r))) << c << " " << r;
        const Array2d<float> part = source.read({1, 2, 698, 600}, 698, 600);
        EXPECT_EQ(part.at(0, 0), h.at(1, 2));
        EXPECT_EQ(part.at(697, 599), h.at(698, 601));
    }
}

TEST(Read, FewerPostsAreMeansByArea) {
    // 800 x 400 are more cells than are read at once.
    const Source source = Source::open(write_raster(folder() / "means.tif", hills(800, 400)));
    const Array2d<float> all = source.read();
    const struct {
        Window window;
        int columns, rows;
    } cases[] = {
        {{0, 0, 800, 400}, 400, 200},  // whole cells
        {{0, 0, 800, 400}, 70, 33},    // parts of cells
        {{11, 7, 200, 150}, 60, 149}, {{0, 0, 800, 400}, 1, 1}, {{0, 0, 800, 400}, 799, 400},
    };
    for (const auto& k : cases) {
        const Array2d<float> h = source.read(k.window, k.columns, k.rows);
        ASSERT_EQ(h.width(), k.columns);
        ASSERT_EQ(h.height(), k.rows);
        const double per_column = k.window.columns / double(k.columns);
        const double per_row = k.window.rows / double(k.rows);
        for (int r = 0; r < k.rows; ++r)
            for (int c = 0; c < k.columns; ++c)
                ASSERT_NEAR(h.at(c, r),
                            mean_of(all, k.window.column + c * per_column,
                                    k.window.column + (c + 1) * per_column,
                                    k.window.row + r * per_row, k.window.row + (r + 1) * per_row),
                            1e-4)
                    << c << " " << r;
    }
}

TEST(Read, MeansLeaveHolesOut) {
    Raster raster;
    raster.columns = 8;
    raster.rows = 4;
    raster.nodata = -9999;
    // 2 x 2 cells with 0, 1, 2 and 3 holes, one pair of columns each.
    raster.value = [](int column, int row, int) {
        const int index = column % 2 + 2 * (row % 2);
        return index < column / 2 ? -9999.0 : 100.0 * index;
    };
    const Source source = Source::open(write_raster(folder() / "holes.tif", raster));
    const Array2d<float> h = source.read({0, 0, 8, 4}, 4, 2);
    EXPECT_FLOAT_EQ(h.at(0, 0), 150);
    EXPECT_FLOAT_EQ(h.at(1, 0), 200);
    EXPECT_FLOAT_EQ(h.at(2, 0), 250);  // half is enough
    EXPECT_TRUE(std::isnan(h.at(3, 0)));
    EXPECT_TRUE(std::isnan(h.at(3, 1)));
}

TEST(Read, MeansAreThoseOfTheGridsPart) {
    // A plane: what is read at a post of the part is the plane at that post's place.
    Raster raster;
    raster.columns = 90;
    raster.rows = 70;
    raster.value = [](int column, int row, int) { return 3.0 * column - 2.0 * row; };
    const Source source = Source::open(write_raster(folder() / "plane.tif", raster));
    const Window window{10, 5, 70, 60};  // in parts of 5 x 4
    const Array2d<float> h = source.read(window, 14, 15);
    const Grid part = source.grid().part(window, 14, 15);
    for (int r = 0; r < 15; ++r)
        for (int c = 0; c < 14; ++c) {
            const glm::dvec2 post = source.grid().affine().inverse(part.affine()(c, r));
            ASSERT_NEAR(h.at(c, r), 3 * post.x - 2 * post.y, 1e-4);
        }
}

TEST(Read, OverviewsAreTakenWhereTheyAreFineEnough) {
    const std::string path = write_raster(folder() / "overviews.tif", hills(256, 128));
    // Overviews that cannot be mistaken for means: 2 in the half size, 4 in the quarter.
    GDALDatasetH dataset = GDALOpen(path.c_str(), GA_Update);
    const int levels[] = {2, 4};
    ASSERT_EQ(GDALBuildOverviews(dataset, "NEAREST", 2, levels, 0, nullptr, nullptr, nullptr),
              CE_None);
    for (int i = 0; i < 2; ++i)
        GDALFillRaster(GDALGetOverview(GDALGetRasterBand(dataset, 1), i), levels[i], 0);
    GDALClose(dataset);
    const Source source = Source::open(path);
    const auto value = [&](const Window& w, int columns, int rows) {
        return source.read(w, columns, rows).at(0, 0);
    };
    EXPECT_EQ(value({0, 0, 256, 128}, 256, 128), static_cast<float>(ground(0, 0)));
    EXPECT_GT(value({0, 0, 256, 128}, 129, 64), 100);  // half the columns are too few
    EXPECT_EQ(value({0, 0, 256, 128}, 128, 64), 2);
    EXPECT_EQ(value({0, 0, 256, 128}, 100, 40), 2);
    EXPECT_EQ(value({0, 0, 256, 128}, 64, 32), 4);
    EXPECT_EQ(value({0, 0, 256, 128}, 5, 3), 4);
    EXPECT_EQ(value({64, 32, 64, 64}, 32, 32), 2);
    EXPECT_GT(value({64, 32, 64, 64}, 32, 33), 100);
}

TEST(Read, ManyThreadsMayReadAtOnce) {
    Raster raster = hills(300, 200);
    raster.options = {"COMPRESS=DEFLATE", "TILED=YES", "BLOCKXSIZE=64", "BLOCKYSIZE=64"};
    const Source source = Source::open(write_raster(folder() / "at_once.tif", raster));
    std::vector<int> wrong(6, 0);
    {
        std::vector<std::jthread> threads;
        for (std::size_t t = 0; t < wrong.size(); ++t)
            threads.emplace_back([&, t] {
                for (int i = 0; i < 40; ++i) {
                    const int column =
                        static_cast<int>((t * 37 + static_cast<std::size_t>(i) * 11) % 200);
                    const Array2d<float> h = source.read({column, i, 90, 90}, 90, 90);
                    wrong[t] += h.at(3, 4) != static_cast<float>(ground(column + 3, i + 4));
                    wrong[t] += h.at(89, 89) != static_cast<float>(ground(column + 89, i + 89));
                }
            });
    }
    EXPECT_EQ(wrong, std::vector<int>(6, 0));
}

TEST(Read, MeansOfWideRastersAreThoseOfTheirPosts) {
    // Wider than what is summed up at once, in tiles and in strips; parts of no whole posts too.
    for (const bool tiled : {true, false}) {
        Raster raster;
        raster.type = "Int16";
        raster.columns = 2'400'000;
        raster.rows = 8;
        raster.crs = "EPSG:4326";
        raster.geotransform = {{0, 1e-5, 0, 1, 0, -1e-5}};
        raster.nodata = -9999;
        raster.value = [](int column, int row, int) {
            return column % 7777 < 3 ? -9999.0 : (column * 31LL + row * 17) % 4099;
        };
        if (tiled) raster.options = {"TILED=YES", "COMPRESS=DEFLATE", "BLOCKYSIZE=16"};
        const Source source = Source::open(write_raster(folder() / "wide.tif", raster));
        const Array2d<float> posts = source.read();
        for (const int columns : {1'200'000, 1'000'001, 17}) {
            const Array2d<float> means = source.read({0, 0, raster.columns, 8}, columns, 2);
            const double each = raster.columns / double(columns);
            for (int row = 0; row < 2; ++row)
                for (int column = 0; column < columns; column += 1 + columns / 20'000) {
                    const double expected =
                        mean_of(posts, column * each, (column + 1) * each, row * 4, row * 4 + 4);
                    if (std::isnan(expected))
                        ASSERT_TRUE(std::isnan(means.at(column, row))) << column;
                    else
                        ASSERT_NEAR(means.at(column, row), expected, 0.01) << column;
                }
        }
    }
}

TEST(Read, MeansOfWhatIsHardlyStoredAreThoseOfItsPosts) {
    Raster raster;
    raster.type = "Int16";
    raster.columns = raster.rows = 20'000;
    raster.crs = "EPSG:4326";
    raster.geotransform = {{0, 1e-4, 0, 10, 0, -1e-4}};
    raster.options = {"TILED=YES", "SPARSE_OK=YES", "COMPRESS=DEFLATE"};
    std::vector<std::array<double, 3>> stored;
    for (int i = 0; i < 900; ++i)
        stored.push_back({8000.0 + i * 3, 12'345.0 + i % 60, 100.0 + i});
    const Source source = Source::open(
        test::write_sparse_raster(folder() / "hardly.tif", raster, stored), {.no_nodata = true});
    const Window window{7900, 12'300, 3000, 150};
    const Array2d<float> posts = source.read(window, window.columns, window.rows);
    const Array2d<float> few = source.read(window, 300, 15);
    const Array2d<float> all = source.read({0, 0, 20'000, 20'000}, 2000, 2000);
    double sum = 0;
    for (int row = 0; row < 15; ++row)
        for (int column = 0; column < 300; ++column) {
            const double expected =
                mean_of(posts, column * 10, column * 10 + 10, row * 10, row * 10 + 10);
            ASSERT_NEAR(few.at(column, row), expected, 1e-3);
            ASSERT_EQ(all.at(790 + column, 1230 + row), few.at(column, row));
            sum += expected;
        }
    EXPECT_NEAR(sum * 100, 900 * 100 + 899 * 450, 1);
}

}  // namespace
}  // namespace relevo::dem::test_read
