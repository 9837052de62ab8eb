#include <cmath>
#include <limits>
#include <random>

#include <fmt/format.h>

#include "dem/fixture.h"
#include "dem/load.h"
#include "dem/pyramid.h"
#include "support/support.h"

namespace relevo::dem::test_pyramid {
namespace {

float plane_m(int column, int row) {
    return 500.0f + 0.5f * static_cast<float>(column) - 0.25f * static_cast<float>(row);
}

Array2d<float> field(int columns, int rows, const std::function<float(int, int)>& height) {
    Array2d<float> h(columns, rows);
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
            h.at(x, y) = height(x, y);
    return h;
}

constexpr float kHole = std::numeric_limits<float>::quiet_NaN();

TEST(Pyramid, NodesLieOnEverySecondPostAndOnTheRim) {
    const Array2d<float> posts =
        field(200, 131, [](int x, int y) { return static_cast<float>(x + y); });
    const Pyramid pyramid(posts);
    EXPECT_EQ(pyramid.size(0), glm::ivec2(200, 131));
    EXPECT_EQ(pyramid.size(1), glm::ivec2(101, 66));
    EXPECT_EQ(pyramid.post(1, {100, 65}), glm::ivec2(199, 130));
    EXPECT_EQ(pyramid.post(1, {7, 3}), glm::ivec2(14, 6));
    EXPECT_EQ(pyramid.size(2), glm::ivec2(51, 34));
    EXPECT_EQ(pyramid.levels(), 3);
    EXPECT_EQ(pyramid.tiles(0), glm::ivec2(4, 3));
    EXPECT_EQ(pyramid.tiles(2), glm::ivec2(1, 1));
}

TEST(Pyramid, APlaneIsTheSamePlaneOnEveryLevel) {
    // Inside; next to the rim the mean is one-sided.
    const Array2d<float> posts =
        field(257, 257, [](int x, int y) { return 3.0f * x - 2.0f * y + 100; });
    const Pyramid pyramid(posts);
    for (int level = 1; level < pyramid.levels(); ++level) {
        const glm::ivec2 size = pyramid.size(level);
        for (int y = 1; y < size.y - 1; ++y)
            for (int x = 1; x < size.x - 1; ++x)
                ASSERT_NEAR(pyramid.height(level, x, y),
                            3.0f * (x << level) - 2.0f * (y << level) + 100, 2e-3)
                    << level;
    }
}

TEST(Pyramid, HolesAndCoastsKeepTheirSize) {
    // Discs of ground in a hole, and of holes in the ground: the area at a coverage of one half or
    // more stays what it is as long as a disc is a few nodes wide.
    for (const bool island : {true, false}) {
        const Array2d<float> posts = field(513, 513, [&](int x, int y) {
            const bool inside = std::hypot(x - 250.0, y - 260.0) < 120;
            return inside == island ? 500.0f : kHole;
        });
        const Pyramid pyramid(posts);
        const double area = 3.14159265 * 120 * 120;
        for (int level = 0; level <= 3; ++level) {
            double covered = 0;
            const glm::ivec2 size = pyramid.size(level);
            for (int y = 0; y < size.y; ++y) {
                for (int x = 0; x < size.x; ++x) {
                    const bool ground = pyramid.coverage(level, x, y) >= 0.5f;
                    covered += ground == island ? std::pow(4.0, level) : 0;
                    if (pyramid.coverage(level, x, y) > 0) {
                        ASSERT_EQ(pyramid.height(level, x, y), 500.0f);
                    }
                }
            }
            EXPECT_NEAR(covered / area, 1, 0.03)
                << "level " << level << (island ? " island" : " lake");
        }
    }
}

TEST(Pyramid, BoundsHoldEveryPost) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> height(-100, 3000);
    const Array2d<float> posts = field(300, 280, [&](int x, int y) {
        return (x > 20 && x < 60 && y < 40) ? kHole : height(random);
    });
    const Pyramid pyramid(posts);
    for (int level = 0; level < pyramid.levels(); ++level) {
        const glm::ivec2 tiles = pyramid.tiles(level);
        for (int ty = 0; ty < tiles.y; ++ty) {
            for (int tx = 0; tx < tiles.x; ++tx) {
                const Pyramid::Bounds& bounds = pyramid.bounds(level, {tx, ty});
                const int span = Pyramid::kTileQuads << level;
                for (int y = ty * span; y <= std::min((ty + 1) * span, 279); ++y) {
                    for (int x = tx * span; x <= std::min((tx + 1) * span, 299); ++x) {
                        const float h = pyramid.height(0, x, y);
                        if (std::isnan(h)) continue;
                        ASSERT_GE(h, bounds.lowest_m);
                        ASSERT_LE(h, bounds.highest_m);
                    }
                }
            }
        }
    }
}

/// Height of a level's triangles at a post.
float surface_at(const Pyramid& pyramid, int level, int column, int row) {
    const int x = std::min(column >> level, pyramid.size(level).x - 2);
    const int y = std::min(row >> level, pyramid.size(level).y - 2);
    const glm::ivec2 from = pyramid.post(level, {x, y}), to = pyramid.post(level, {x + 1, y + 1});
    const float tx = static_cast<float>(column - from.x) / static_cast<float>(to.x - from.x);
    const float ty = static_cast<float>(row - from.y) / static_cast<float>(to.y - from.y);
    const float b = pyramid.height(level, x + 1, y), c = pyramid.height(level, x, y + 1);
    if (tx + ty <= 1) {
        const float a = pyramid.height(level, x, y);
        return a + tx * (b - a) + ty * (c - a);
    }
    const float d = pyramid.height(level, x + 1, y + 1);
    return d + (1 - tx) * (c - d) + (1 - ty) * (b - d);
}

TEST(Pyramid, ErrorsAreUpperBoundsOfTheDistanceToThePosts) {
    const Heightfield dem = load((test::source_dir() / "data/dem/jacksboro.tif").string());
    const Pyramid pyramid(dem.height_m);
    for (int level = 1; level < pyramid.levels(); ++level) {
        const glm::ivec2 tiles = pyramid.tiles(level);
        const int span = Pyramid::kTileQuads << level;
        double tightest = 1e9, lowest_rms = 1e9, highest_rms = 0;
        for (int ty = 0; ty < tiles.y; ++ty) {
            for (int tx = 0; tx < tiles.x; ++tx) {
                float worst = 0;
                double squares = 0;
                int posts = 0;
                for (int y = ty * span; y <= std::min((ty + 1) * span, dem.height_m.height() - 1);
                     ++y)
                    for (int x = tx * span;
                         x <= std::min((tx + 1) * span, dem.height_m.width() - 1); ++x) {
                        const float error =
                            std::abs(dem.height_m.at(x, y) - surface_at(pyramid, level, x, y));
                        worst = std::max(worst, error);
                        squares += double{error} * error;
                        ++posts;
                    }
                const double rms = std::sqrt(squares / posts);
                const float estimate = pyramid.bounds(level, {tx, ty}).rms_m;
                lowest_rms = std::min(lowest_rms, estimate / rms);
                highest_rms = std::max(highest_rms, estimate / rms);
                const float bound = pyramid.bounds(level, {tx, ty}).error_m;
                ASSERT_GE(bound * 1.0001f, worst) << level;
                if (worst > 0) tightest = std::min(tightest, static_cast<double>(bound / worst));
            }
        }
        fmt::print(
            "[ pyramid ] level {}: error bound of 98 % of tiles {:.1f} m, of all {:.1f} m, at "
            "least "
            "{:.2f} times the true one; root mean square {:.1f} m, {:.2f} to {:.2f} times the true "
            "one\n",
            level, pyramid.error_m(level, &Pyramid::Bounds::error_m, 0.98),
            pyramid.error_m(level, &Pyramid::Bounds::error_m, 1), tightest,
            pyramid.error_m(level, &Pyramid::Bounds::rms_m, 0.98), lowest_rms, highest_rms);
        EXPECT_GT(lowest_rms, 0.66);
        EXPECT_LT(highest_rms, 1.34);
    }
    EXPECT_EQ(pyramid.error_m(0, &Pyramid::Bounds::error_m, 1), 0);
}

/// A DEM of which only means of 4 x 4 posts are in memory, beside the same that is there whole.
TEST(Pyramid, LevelsThatAreReadAreThoseInMemory) {
    const std::string path = (test::source_dir() / "data/dem/jacksboro.tif").string();
    const Source source = Source::open(path);
    const Heightfield whole = load(path);
    const Heightfield means =
        load(source,
             MemoryBudget::of_posts(std::int64_t{whole.grid.columns()} * whole.grid.rows() / 16));
    ASSERT_EQ(means.reduction, 4);
    const Pyramid in_memory(whole.height_m), read(means, source);
    ASSERT_EQ(read.first_in_memory(), 3);
    ASSERT_EQ(read.levels(), in_memory.levels());
    for (int level = 0; level < read.levels(); ++level) {
        ASSERT_EQ(read.size(level), in_memory.size(level));
        // Levels 0 and 1 are read as they are averaged in memory. Coarser ones are means of
        // squares, not of tents, and differ by a part of what the level is off.
        double squares = 0;
        const glm::ivec2 size = read.size(level);
        for (const glm::ivec2 first : {glm::ivec2(-1, -1), size / 2, size - 40}) {
            const auto a = read.block(level, first, 41, 41);
            const auto b = in_memory.block(level, first, 41, 41);
            for (int y = 0; y < 41; ++y) {
                for (int x = 0; x < 41; ++x) {
                    const double d = a.height_m.at(x, y) - b.height_m.at(x, y);
                    squares += d * d / (3 * 41 * 41);
                    ASSERT_EQ(a.coverage.at(x, y), 1);
                }
            }
        }
        const double rms_m = std::sqrt(squares);
        const float off_m = in_memory.error_m(level, &Pyramid::Bounds::rms_m, 1);
        fmt::print(
            "[ pyramid ] level {}: read and in memory {:.2f} m apart, {:.2f} m off the "
            "posts, known as {:.2f} m\n",
            level, rms_m, off_m, read.error_m(level, &Pyramid::Bounds::rms_m, 1));
        if (level < 2) {
            EXPECT_LT(rms_m, 1e-3);
        } else {
            EXPECT_LT(rms_m, 0.6 * off_m);
        }
        EXPECT_GE(read.error_m(level, &Pyramid::Bounds::rms_m, 1), 0.7 * off_m);
        EXPECT_LE(read.error_m(level, &Pyramid::Bounds::rms_m, 1), 1.5 * off_m + 1e-6);
    }
}

/// A DEM so much larger than memory that pieces of its posts tell of its finest levels alone, and
/// what is known of coarser ones comes from means.
TEST(Pyramid, LevelsFarFromThePostsAreKnownByMeans) {
    constexpr int kSide = 5000, kReduction = 32;
    test::Raster raster{.type = "Int16", .columns = kSide, .rows = kSide};
    raster.value = [](int column, int row, int) {
        return std::floor(2000 + 900 * std::sin(column * 0.0021) * std::cos(row * 0.0017) +
                          90 * std::sin(column * 0.031 + row * 0.02) +
                          (column * 31 + row * 17) % 23);
    };
    const std::string path = test::write_raster(test::scratch_dir("pyramid") / "large.tif", raster);
    const Source source = Source::open(path);
    const Heightfield whole = load(path), means = load(source, MemoryBudget::of_posts(160 * 160));
    ASSERT_EQ(means.reduction, kReduction);
    for (int row = 0; row < means.height_m.height(); row += 5)
        for (int column = 0; column < means.height_m.width(); column += 5) {
            double sum = 0;
            for (int y = 0; y < kReduction; ++y)
                for (int x = 0; x < kReduction; ++x)
                    sum += whole.height_m.at(column * kReduction + x, row * kReduction + y);
            ASSERT_NEAR(means.height_m.at(column, row), sum / (kReduction * kReduction), 1e-3);
        }
    const Pyramid in_memory(whole.height_m), read(means, source);
    ASSERT_EQ(read.first_in_memory(), 6);
    for (int level = 0; level < read.levels(); ++level) {
        const double off_m = in_memory.error_m(level, &Pyramid::Bounds::rms_m, 1);
        const double known_m = read.error_m(level, &Pyramid::Bounds::rms_m, 1);
        fmt::print("[ pyramid ] level {}: {:.2f} m off the posts, known as {:.2f} m\n", level,
                   off_m, known_m);
        EXPECT_GE(known_m, 0.7 * off_m);
        EXPECT_LE(known_m, 1.5 * off_m + 1e-6);
        EXPECT_GE(read.error_m(level, &Pyramid::Bounds::error_m, 1),
                  0.7 * in_memory.error_m(level, &Pyramid::Bounds::error_m, 1));
        // Nodes read and nodes in memory, in the middle and at the far rim.
        const glm::ivec2 size = read.size(level);
        for (const glm::ivec2 first : {size / 2 - 5, size - 6}) {
            const auto a = read.block(level, first, 9, 9), b = in_memory.block(level, first, 9, 9);
            for (int y = 0; y < 9; ++y)
                for (int x = 0; x < 9; ++x)
                    ASSERT_NEAR(a.height_m.at(x, y), b.height_m.at(x, y), 1e-3 + 3 * off_m)
                        << level;
        }
    }
    // No post is outside of what its tile is said to hold.
    for (int y = 0; y < read.tiles(6).y; ++y)
        for (int x = 0; x < read.tiles(6).x; ++x) {
            const auto bounds = read.bounds(6, {x, y});
            const auto exact = in_memory.bounds(6, {x, y});
            EXPECT_LE(bounds.lowest_m, exact.lowest_m);
            EXPECT_GE(bounds.highest_m, exact.highest_m);
        }
}

TEST(Pyramid, NodesOfMeansLieOnTheirPosts) {
    // On a plane every mean is exact where its posts have their middle.
    const std::string path =
        test::write_raster(test::scratch_dir("pyramid") / "plane.tif",
                           {.columns = 1000, .rows = 700, .value = [](int column, int row, int) {
                                return plane_m(column, row);
                            }});
    const Source source = Source::open(path);
    const Heightfield means = load(source, MemoryBudget::of_posts(1000 * 700 / 64));
    ASSERT_EQ(means.reduction, 8);
    const Pyramid pyramid(means, source);
    for (int level = 0; level < pyramid.levels() - 1; ++level) {
        const glm::ivec2 size = pyramid.size(level);
        const auto block = pyramid.block(level, {0, 0}, size.x, size.y);
        for (int y = 2; y < size.y - 2; ++y) {
            for (int x = 2; x < size.x - 2; ++x) {
                const glm::ivec2 post = pyramid.post(level, {x, y});
                ASSERT_NEAR(block.height_m.at(x, y), plane_m(post.x, post.y), 0.01)
                    << level << " " << x << " " << y;
            }
        }
    }
}

TEST(Pyramid, VoidsOfLevelsThatAreReadLieBetweenTheMeansAroundThem) {
    constexpr float kVoid = -9999;
    const auto is_void = [](int column, int row) {
        return column >= 499 && column < 505 && row >= 299 && row < 305;
    };
    test::Raster raster{.columns = 1000, .rows = 700, .nodata = kVoid};
    raster.value = [&](int column, int row, int) {
        return is_void(column, row) ? double(kVoid) : plane_m(column, row);
    };
    const std::string path = test::write_raster(test::scratch_dir("pyramid") / "hole.tif", raster);
    const Source source = Source::open(path);
    const Heightfield means = load(source, MemoryBudget::of_posts(1000 * 700 / 64));
    ASSERT_EQ(means.reduction, 8);
    const auto memory = MemoryBudget::of_mib(MemoryBudget::kDefault_mib);
    for (int level = 0; level < 3; ++level) {
        const glm::ivec2 hole(502 >> level, 302 >> level);
        const Pyramid kept(means, source, memory, Pyramid::Voids::Kept);
        EXPECT_LT(kept.block(level, hole, 1, 1).coverage.at(0, 0), 1) << level;
        const Pyramid filled(means, source, memory, Pyramid::Voids::Filled);
        const Pyramid::Block block = filled.block(level, hole, 1, 1);
        EXPECT_EQ(block.coverage.at(0, 0), 1) << level;
        const glm::ivec2 post = filled.post(level, hole);
        EXPECT_NEAR(block.height_m.at(0, 0), plane_m(post.x, post.y),
                    6 * (plane_m(1, 1) - plane_m(0, 0)))
            << level;
    }
}

}  // namespace
}  // namespace relevo::dem::test_pyramid
