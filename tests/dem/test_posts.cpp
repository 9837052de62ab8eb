#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <thread>

#include "base/log.h"
#include "dem/content_sum.h"
#include "dem/fixture.h"
#include "dem/load.h"
#include "dem/posts.h"
#include "dem/tile_cache.h"
#include "support/support.h"

namespace relevo::dem::test_posts {
namespace {

using test::error_of;
using test::Raster;
using test::write_raster;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
/// Posts that are allowed: 32 tiles, so that most of what is read has been driven out again.
constexpr std::int64_t kFew = 1 << 17;

using test::folder;

/// Rough ground of no whole number of tiles, blocks or slabs, with a lone summit and holes.
Raster rough(int columns, int rows) {
    Raster raster;
    raster.columns = columns;
    raster.rows = rows;
    raster.nodata = -9999;
    raster.value = [=](int column, int row, int) {
        if (column > 400 && column < 480 && row > 70 && row < 75) return -9999.0;
        if (column == columns - 1 && row == 333) return 4000.25;
        if (column == 17 && row == rows - 1) return -77.5;
        return 800 + 300 * std::sin(column * 0.11) * std::cos(row * 0.07) + (column * row) % 37;
    };
    return raster;
}

struct Both {
    explicit Both(const std::vector<std::string>& paths)
        : source(Source::open(paths)),
          field(load(source, MemoryBudget::of_posts(std::int64_t{1} << 28))) {}
    Source source;
    Heightfield field;
    Posts whole{field};
    Posts few{source, kFew};
};

TEST(Posts, AreThoseOfTheFileHoweverLittleMemoryThereIs) {
    const Both dem({write_raster(folder() / "rough.tif", rough(701, 515))});
    EXPECT_TRUE(dem.whole.in_memory());
    EXPECT_FALSE(dem.few.in_memory());
    EXPECT_EQ(dem.few.about().statistics, dem.field.about.statistics);
    EXPECT_EQ(dem.few.highest_m(), 4000.25f);
    EXPECT_EQ(dem.few.lowest_m(), -77.5f);
    EXPECT_EQ(dem.few.about().assumptions, dem.field.about.assumptions);

    std::mt19937 random(5);
    const auto up_to = [&](int most) { return std::uniform_int_distribution<>(0, most)(random); };
    std::vector<float> buffer;
    for (int i = 0; i < 3000; ++i) {
        const int column = up_to(700), row = up_to(514);
        const Window window{column, row, 1 + up_to(std::min(150, 700 - column)),
                            1 + up_to(std::min(150, 514 - row))};
        const Posts::View view = dem.few.view(window, buffer);
        for (int r = row; r < row + window.rows; ++r)
            for (int c = column; c < column + window.columns; ++c) {
                const float is = *view.at(c, r), wanted = dem.field.height_m.at(c, r);
                ASSERT_TRUE(is == wanted || (std::isnan(is) && std::isnan(wanted)))
                    << c << " " << r;
            }
    }
    for (int i = 0; i < 300; ++i) {
        const double column = up_to(7000) / 10.0, row = up_to(5140) / 10.0;
        const double is = dem.few.height_at(column, row);
        const double wanted = dem.field.height_at(column, row);
        EXPECT_TRUE(is == wanted || (std::isnan(is) && std::isnan(wanted))) << column << " " << row;
    }
    EXPECT_TRUE(std::isnan(dem.few.height_at(700.01, 3)));
    EXPECT_TRUE(std::isnan(dem.few.height_at(3, -0.01)));

    // Every second post, of which one is never farther away than the next.
    ASSERT_EQ(dem.few.thinning(), 2);
    for (int row = 0; row < 515; ++row)
        for (int column = 0; column < 701; ++column) {
            const float is = dem.few.thinned_m(column, row);
            const float whole = dem.whole.thinned_m(column, row);
            const float wanted = dem.field.height_m.at((column + 1) / 2 * 2, (row + 1) / 2 * 2);
            ASSERT_TRUE(is == whole || (std::isnan(is) && std::isnan(whole)));
            ASSERT_TRUE(is == wanted || (std::isnan(is) && std::isnan(wanted)));
        }
}

TEST(Posts, TheirContentIsThatOfAllHeightsHoweverTheyAreRead) {
    const Raster ground = rough(701, 515);
    const Both dem({write_raster(folder() / "rough.tif", ground)});
    EXPECT_EQ(dem.whole.content(), dem.few.content());
    Raster changed = ground;
    changed.value = [&](int column, int row, int band) {
        return ground.value(column, row, band) + (column == 300 && row == 200 ? 0.5 : 0);
    };
    const Both other({write_raster(folder() / "changed.tif", changed)});
    EXPECT_EQ(other.field.about.statistics, dem.field.about.statistics);
    EXPECT_NE(other.whole.content(), dem.whole.content());
    EXPECT_EQ(other.whole.content(), other.few.content());
    const Array2d<float> level(80, 50, 12.5F);
    EXPECT_EQ(content_of({level.data(), 80, 7, 3}, {7, 3, 80, 50}),
              content_of(12.5F, {7, 3, 80, 50}));
}

TEST(Posts, NoPostOfABoxIsAboveItsBound) {
    const Both dem({write_raster(folder() / "bound.tif", rough(701, 515))});
    std::mt19937 random(6);
    const auto up_to = [&](int most) { return std::uniform_int_distribution<>(0, most)(random); };
    for (const Posts* posts : {&dem.whole, &dem.few})
        for (int i = 0; i < 500; ++i) {
            const int c1 = up_to(699), r1 = up_to(513);
            const int c2 = c1 + up_to(std::min(90, 699 - c1)),
                      r2 = r1 + up_to(std::min(90, 513 - r1));
            float highest_m = -std::numeric_limits<float>::infinity();
            bool hole = false;
            for (int r = r1; r <= r2 + 1; ++r)
                for (int c = c1; c <= c2 + 1; ++c) {
                    const float h = dem.field.height_m.at(c, r);
                    hole = hole || std::isnan(h);
                    highest_m = std::max(highest_m, h);
                }
            const float bound_m = posts->bound_m(c1, c2, r1, r2);
            EXPECT_GE(bound_m, highest_m);
            if (hole) {
                EXPECT_EQ(bound_m, 4000.25f);
            }
        }
    // A bound that is no use would be slow: far from the summit and the holes it is near.
    EXPECT_LT(dem.few.bound_m(100, 120, 300, 310), 1140);
}

TEST(Posts, BoundsAreTheSameWhereABlockIsMoreThanMemoryHolds) {
    const std::string path = write_raster(folder() / "blocks.tif", rough(1301, 715));
    const Source source = Source::open(path);
    const Heightfield field = load(path);
    // So few that a block has 128 and more posts a side, and is gone through in parts.
    const Posts few(source, 264);
    EXPECT_EQ(few.about().statistics, field.about.statistics);
    for (int row = 0; row < 714; row += 128)
        for (int column = 0; column < 1300; column += 128) {
            float highest_m = -std::numeric_limits<float>::infinity();
            bool hole = false;
            for (int r = row; r <= std::min(row + 128, 714); ++r)
                for (int c = column; c <= std::min(column + 128, 1300); ++c) {
                    hole = hole || std::isnan(field.height_m.at(c, r));
                    highest_m = std::max(highest_m, field.height_m.at(c, r));
                }
            EXPECT_EQ(few.bound_m(column, column, row, row), hole ? 4000.25f : highest_m)
                << column << " " << row;
        }
}

TEST(Posts, WhatAFileDoesNotStoreIsNotRead) {
    Raster raster;
    raster.type = "Int16";
    raster.crs = "EPSG:4326";
    raster.columns = raster.rows = 200'000;
    raster.geotransform = {{0, 0.0001, 0, 20, 0, -0.0001}};
    raster.options = {"TILED=YES", "SPARSE_OK=YES", "BLOCKXSIZE=1024", "BLOCKYSIZE=1024"};
    for (const bool holes : {true, false}) {
        raster.nodata = holes ? std::optional(-9999.0) : std::nullopt;
        const Source source = Source::open(
            test::write_sparse_raster(folder() / "sparse.tif", raster, {{123'456, 77'777, 321}}),
            {.no_nodata = !holes});
        for (const std::int64_t max_posts : {1 << 18, 1 << 22}) {
            const Posts posts(source, max_posts);
            const std::int64_t all = 200'000LL * 200'000;
            EXPECT_EQ(posts.about().statistics, holes ? (Statistics{321, 321, 1, all - 1, 0})
                                                      : (Statistics{0, 321, all, 0, 0}));
            EXPECT_EQ(posts.bound_m(123'456, 123'456, 77'777, 77'777), 321);
            EXPECT_EQ(posts.bound_m(5, 5, 5, 5), holes ? 321 : 0);
            EXPECT_EQ(posts.bound_m(199'990, 199'998, 199'990, 199'998), holes ? 321 : 0);
        }
    }
}

TEST(Posts, OfSeveralFilesAreThoseOfOne) {
    Raster left = rough(333, 515), right = rough(400, 515);
    right.geotransform = {{500000 + 30.0 * 301, 30, 0, 5200000, 0, -30}};
    // Off the grid of the others: it is resampled to theirs.
    Raster shifted = rough(200, 200);
    shifted.geotransform = {{500000 + 30.0 * 250.4, 30, 0, 5200000 - 30.0 * 100.3, 0, -30}};
    const Both dem({write_raster(folder() / "left.tif", left),
                    write_raster(folder() / "right.tif", right),
                    write_raster(folder() / "shifted.tif", shifted)});
    EXPECT_EQ(dem.few.about().statistics, dem.field.about.statistics);
    std::vector<float> buffer;
    for (int row = 0; row < dem.field.grid.rows(); row += 3)
        for (int column = 0; column < dem.field.grid.columns(); column += 7) {
            const float is = *dem.few.view({column, row, 1, 1}, buffer).at(column, row);
            const float wanted = dem.field.height_m.at(column, row);
            ASSERT_TRUE(is == wanted || (std::isnan(is) && std::isnan(wanted)))
                << column << " " << row << ": " << is << " for " << wanted;
        }
}

TEST(Posts, AreReadBySeveralThreadsAtOnce) {
    const Both dem({write_raster(folder() / "threads.tif", rough(701, 515))});
    std::vector<std::jthread> threads;
    std::array<int, 4> wrong{};
    for (std::size_t i = 0; i < wrong.size(); ++i)
        threads.emplace_back([&, i] {
            std::mt19937 random(static_cast<unsigned>(i));
            std::vector<float> buffer;
            for (int n = 0; n < 2000; ++n) {
                const int c = std::uniform_int_distribution<>(0, 665)(random);
                const int r = std::uniform_int_distribution<>(80, 479)(random);
                const Posts::View view = dem.few.view({c, r, 36, 36}, buffer);
                for (int k = 0; k < 36; ++k)
                    wrong[i] += *view.at(c + k, r + k) != dem.field.height_m.at(c + k, r + k);
            }
        });
    threads.clear();
    EXPECT_EQ(wrong, (std::array<int, 4>{}));
}

TEST(Posts, SayWhatLooksWrongAsAWholeDemDoes) {
    Raster turned;
    turned.columns = turned.rows = 600;
    turned.value = [](int column, int row, int) {
        const double x = column - 300, y = row - 300;
        if (x == 5 && y == 5) return 20000.0;
        return std::abs(x) + std::abs(y) > 290 ? 700.0 : 800.0;
    };
    const std::string path = write_raster(folder() / "turned.tif", turned);
    const auto said = [&](const auto& body) {
        std::vector<std::string> lines;
        log::set_sink([&](log::Level, std::string_view text) { lines.emplace_back(text); });
        body();
        log::set_sink({});
        return lines;
    };
    LoadOptions all;
    all.unit = "m";  // else the spike is refused
    LoadOptions few = all;
    few.memory = MemoryBudget::of_posts(kFew);
    const std::vector<std::string> whole =
        said([&] { EXPECT_TRUE(Posts::load(std::span(&path, 1), all).in_memory()); });
    const std::vector<std::string> parts =
        said([&] { EXPECT_FALSE(Posts::load(std::span(&path, 1), few).in_memory()); });
    EXPECT_EQ(parts, whole);
    ASSERT_EQ(parts.size(), 2U);
    EXPECT_EQ(parts[0], path +
                            ": the whole edge is 700 m high and differs from its neighbours by 100 "
                            "m, perhaps fill of a rotated raster; --nodata 700 marks it as void");

    Raster empty = turned;
    empty.nodata = 7;
    empty.value = [](int, int, int) { return 7.0; };
    const std::string nothing = write_raster(folder() / "empty.tif", empty);
    EXPECT_EQ(error_of([&] { Posts::load(std::span(&nothing, 1), few); }),
              "exit 3: " + nothing + ": no valid height: all 360000 posts are voids (nodata 7)");
}

TEST(Posts, OfADamagedFileAreAnErrorAndNotAPart) {
    const std::string path = write_raster(folder() / "short.tif", rough(701, 515));
    test::cut_short(path, 1000000);
    LoadOptions few;
    few.memory = MemoryBudget::of_posts(kFew);
    const std::string error = error_of([&] { Posts::load(std::span(&path, 1), few); });
    EXPECT_TRUE(error.starts_with("exit 3: " + path + ": its heights cannot be read, ")) << error;
}

TEST(TileCache, KeepsNoMoreThanItIsAllowed) {
    const std::string path = write_raster(folder() / "cache.tif", rough(701, 515));
    const Source source = Source::open(path);
    for (const std::int64_t max_posts : {std::int64_t{0}, kFew, std::int64_t{1} << 24}) {
        TileCache cache(source, max_posts);
        std::vector<float> buffer(701 * 515);
        cache.copy({0, 0, 701, 515}, buffer.data());
        constexpr std::int64_t kTile = TileCache::kSide * TileCache::kSide;
        EXPECT_LE(cache.posts(), std::max(kTile, max_posts));
        EXPECT_GE(cache.posts(), std::min(std::int64_t{701} * 515, max_posts / 2));
        EXPECT_EQ(buffer.back(), source.read().at(700, 514));
    }
}

}  // namespace
}  // namespace relevo::dem::test_posts
