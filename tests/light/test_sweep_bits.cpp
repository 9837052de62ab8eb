// Sweeps give the same bits on every processor. tests/sweep_on_arm.sh runs this file on ARM, so it
// needs core/light/sweep and headers of core/base alone.
//
// The relief is made of whole numbers, and rays of single multiplications and divisions: libm may
// round a tangent differently elsewhere, and a compiler may contract a product and a sum.

#include <algorithm>
#include <array>
#include <cinttypes>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "base/array2d.h"
#include "light/sweep/kernels.h"
#include "light/sweep/sweep.h"

namespace relevo::light::test_sweep_bits {
namespace {

// No whole number of vectors.
constexpr int kColumns = 293, kRows = 211;
constexpr double kSpacing_m = 30, kCurvature = 0.87 / 6371000;

std::uint32_t scrambled(std::uint32_t x) {
    x = (x ^ (x >> 16)) * 0x7feb352dU;
    x = (x ^ (x >> 15)) * 0x846ca68bU;
    return x ^ (x >> 16);
}

/// Hills of up to 600 m under 8 m of noise, with many small voids and a wide one, in sixteenths of
/// a metre.
Array2d<float> relief() {
    struct Hill {
        int column, row, top, fall;
    };
    constexpr std::array kHills{Hill{60, 50, 9600, 6}, Hill{200, 140, 6400, 2},
                                Hill{250, 40, 4000, 9}, Hill{110, 170, 8000, 13}};
    Array2d<float> heights(kColumns, kRows);
    for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < kColumns; ++column) {
            const std::uint32_t noise = scrambled(static_cast<std::uint32_t>(row * 1000 + column));
            int sixteenths = static_cast<int>(noise % 128) - 64;
            for (const Hill& hill : kHills) {
                const int x = column - hill.column, y = row - hill.row;
                sixteenths += std::max(0, hill.top - (x * x + y * y) * hill.fall);
            }
            const bool is_void =
                noise % 101 == 0 || (std::abs(column - 150) < 14 && std::abs(row - 90) < 9);
            heights.at(column, row) = is_void ? std::numeric_limits<float>::quiet_NaN()
                                              : static_cast<float>(sixteenths) / 16;
        }
    return heights;
}

/// 24 directions, of which every second ray is bent; elevations from below level to steep.
std::vector<SweepSun> suns() {
    struct Way {
        double x, y, length;
    };
    std::vector<Way> ways{{1, 0, 1}, {-1, 0, 1}, {0, 1, 1}, {0, -1, 1}};
    for (const Way& way :
         {Way{3, 4, 5}, Way{12, 5, 13}, Way{20, 21, 29}, Way{9, 40, 41}, Way{1, 1, 1.4142}})
        for (const double x : {1, -1})
            for (const double y : {1, -1})
                ways.push_back({x * way.x, y * way.y, way.length});
    constexpr std::array kTangents{0.03, 0.1, 0.25, -0.01, 0.6, 1.9, 0.05};
    std::vector<SweepSun> suns;
    for (std::size_t i = 0; i < ways.size(); ++i) {
        const glm::dvec2 direction{ways[i].x / ways[i].length, ways[i].y / ways[i].length};
        SweepSun sun;
        sun.ray.reference = {140, 100};
        sun.ray.first = direction / kSpacing_m;
        sun.ray.along_columns = std::abs(ways[i].y) < std::abs(ways[i].x);
        if (i % 2 == 1) {
            const glm::dvec2 across{-direction.y, direction.x};
            sun.ray.second = across * 1e-7;
            sun.ray.third = across * -1e-11;
        }
        sun.tangent = kTangents[i % kTangents.size()];
        sun.tangent_per_post = direction * kCurvature * kSpacing_m;
        suns.push_back(sun);
    }
    return suns;
}

/// FNV-1a of the bytes of numbers.
void hash(std::uint64_t& sum, const Array2d<float>& numbers) {
    const auto* const bytes = reinterpret_cast<const unsigned char*>(numbers.data());
    for (std::size_t i = 0; i < numbers.size() * sizeof(float); ++i)
        sum = (sum ^ bytes[i]) * 0x100000001b3U;
}

struct Hashes {
    std::uint64_t shadows = 0xcbf29ce484222325U, horizons = shadows;
};

/// A window, and of it what lies between two rays of a sun.
TilePosts tile_of(const SweepSun& sun) {
    TilePosts posts{{20, 15, 250, 180}, sun.ray, sun.ray};
    posts.after->reference = {90, 70};
    posts.before->reference = sun.ray.along_columns ? glm::dvec2(90, 130) : glm::dvec2(150, 70);
    return posts;
}

Sweep::Use into(Array2d<float>& found) {
    return [&](const SweepRun& run) {
        std::copy_n(run.found, run.count, &found.at(run.column, run.row));
    };
}

Hashes swept(const Array2d<float>& heights) {
    const Sweep sweep(heights.data(), kColumns, kRows, kColumns);
    const TilePosts all{{0, 0, kColumns, kRows}};
    Hashes hashes;
    for (const SweepSun& sun : suns())
        for (const bool tile : {false, true}) {
            const TilePosts posts = tile ? tile_of(sun) : all;
            Array2d<float> shadows(kColumns, kRows), horizons = shadows;
            sweep.each_shadow(sun, posts, tile ? -200 : Sweep::kNoFloor_m, into(shadows));
            sweep.each_horizon(sun.ray, kCurvature, tile ? 3000 : 100000, posts, into(horizons));
            hash(hashes.shadows, shadows);
            hash(hashes.horizons, horizons);
        }
    return hashes;
}

TEST(SweepBits, AreTheSameOnEveryProcessor) {
    // If a sweep is changed on purpose: the hashes printed here, once tests/sweep_on_arm.sh prints
    // the same ones.
    constexpr std::uint64_t kShadows = 0xf73e8f421784c0dcU, kHorizons = 0x48539e83234c12e7U;
    const Array2d<float> heights = relief();
    for (const int floats : {1, 4, 8, kVectorFloats}) {
        set_widest_vector(floats);
        const auto [shadows, horizons] = swept(heights);
        std::printf("[ bits     ] up to %2d floats: shadows 0x%016" PRIx64
                    ", horizons 0x%016" PRIx64 "\n",
                    floats, shadows, horizons);
        EXPECT_EQ(shadows, kShadows) << floats;
        EXPECT_EQ(horizons, kHorizons) << floats;
    }
    set_widest_vector(kVectorFloats);
}

}  // namespace
}  // namespace relevo::light::test_sweep_bits
