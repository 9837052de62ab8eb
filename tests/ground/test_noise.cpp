#include <algorithm>
#include <cmath>

#include "noise.h"
#include "support/support.h"

namespace relevo::ground {
namespace {

// Places that are no special ones of any lattice.
struct Place {
    float s, t;
};
std::vector<Place> places() {
    std::vector<Place> all;
    for (int i = 0; i < 2000; ++i)
        all.push_back({hash_unit(1, i, 0), hash_unit(2, i, 0)});
    return all;
}

TEST(Hash, UniformNumbersFillTheUnitIntervalEvenly) {
    constexpr int kBins = 64, kNumbers = 1 << 20;
    std::vector<int> count(kBins);
    for (int y = 0; y < 1024; ++y)
        for (int x = 0; x < 1024; ++x)
            ++count[static_cast<std::size_t>(hash_unit(7, x, y) * kBins)];
    double chi_square = 0;
    for (const int n : count)
        chi_square += std::pow(n - kNumbers / kBins, 2) / (kNumbers / kBins);
    // 63 degrees of freedom: 99.9 % lie below 103.4 (Abramowitz and Stegun 1964, table 26.8).
    EXPECT_LT(chi_square, 103.4);
}

TEST(Hash, NeighboursAreNotCorrelated) {
    double across = 0, up = 0, through = 0, seeds = 0;
    constexpr int n = 512;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            const float here = hash_normal(3, x, y, 1);
            across += here * hash_normal(3, x + 1, y, 1);
            up += here * hash_normal(3, x, y + 1, 1);
            through += here * hash_normal(3, x, y, 2);
            seeds += here * hash_normal(4, x, y, 1);
        }
    // Of n^2 products of independent numbers the mean has standard deviation 1 / n = 0.002.
    for (const double sum : {across, up, through, seeds})
        EXPECT_NEAR(sum / (n * n), 0, 0.007);
}

TEST(Hash, NormalNumbersHaveMeanZeroAndDeviationOne) {
    double sum = 0, square = 0;
    constexpr int n = 1 << 18;
    for (int i = 0; i < n; ++i) {
        const double v = hash_normal(5, i, 1);
        sum += v;
        square += v * v;
    }
    EXPECT_NEAR(sum / n, 0, 0.006);  // three standard deviations of such a mean
    EXPECT_NEAR(square / n, 1, 0.01);
}

TEST(GradientNoise, IsZeroAtLatticePoints) {
    const Lattice lattice(9, 2, -1, 7);
    for (int j = -4; j < 12; ++j)
        for (int i = -4; i < 12; ++i)
            EXPECT_EQ(gradient_noise(3, lattice, {i, j}), 0.0f);
}

TEST(GradientNoise, HasTheRangeThatIsPromised) {
    double square = 0;
    float most = 0;
    const Lattice lattice(64);
    constexpr int n = 1024;
    for (int r = 0; r < n; ++r)
        for (int c = 0; c < n; ++c) {
            const float v = gradient_noise(8, lattice, {(c + 0.5f) * 64 / n, (r + 0.5f) * 64 / n});
            square += v * v;
            most = std::max(most, std::abs(v));
        }
    EXPECT_NEAR(std::sqrt(square / (n * n)), 0.30, 0.01);
    EXPECT_LT(most, 1.0f);
    EXPECT_GT(most, 0.8f);
}

TEST(Lattice, StepsOverTheTilesEdgesLeadToTheSameCell) {
    const Lattice lattice(17, 7, -13, 34);
    for (int j = -60; j <= 60; ++j)
        for (int i = -60; i <= 60; ++i) {
            EXPECT_EQ(lattice.wrapped(i, j), lattice.wrapped(i + 17, j - 13));
            EXPECT_EQ(lattice.wrapped(i, j), lattice.wrapped(i + 7, j + 34));
            const glm::ivec2 cell = lattice.wrapped(i, j);
            EXPECT_EQ(lattice.wrapped(cell.x, cell.y), cell);
        }
}

TEST(Lattice, HasAsManyCellsAsItsDeterminantSays) {
    const Lattice lattice(7, 3, -5, 15);
    std::vector<std::pair<int, int>> cells;
    for (int j = -30; j <= 30; ++j)
        for (int i = -30; i <= 30; ++i) {
            const glm::ivec2 cell = lattice.wrapped(i, j);
            cells.emplace_back(cell.x, cell.y);
        }
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    EXPECT_EQ(cells.size(), 7u * 15u + 3u * 5u);
}

TEST(FractalNoise, RepeatsWithTheTile) {
    for (const Lattice& lattice : {Lattice(9), Lattice(4, 1, -14, 38)})
        for (const auto& [s, t] : places()) {
            const float here = fractal_noise(5, lattice, s, t, 4);
            // 1e-3: s + 1 in single precision moves the finest octave by 2e-5 of a cell.
            EXPECT_NEAR(fractal_noise(5, lattice, s + 1, t, 4), here, 1e-3f);
            EXPECT_NEAR(fractal_noise(5, lattice, s, t - 1, 4), here, 1e-3f);
        }
}

TEST(Cells, RepeatWithTheTile) {
    const Lattice lattice(7, 3, -5, 15);
    for (const auto& [s, t] : places()) {
        const Cells here = cells(6, lattice, s, t);
        for (const Cells& there : {cells(6, lattice, s - 1, t), cells(6, lattice, s + 1, t + 1)}) {
            if (std::abs(here.edge) < 1e-4f) continue;  // either side is right
            EXPECT_EQ(there.id, here.id);
            EXPECT_NEAR(there.nearest, here.nearest, 1e-4f);
        }
    }
}

// The border's distance against a search along 64 directions for another cell.
TEST(Cells, TheBorderIsAsFarAsTheNearestOtherCell) {
    constexpr int kCells = 23;
    const Lattice lattice(kCells);
    int checked = 0;
    for (const auto& [s, t] : places()) {
        const Cells here = cells(9, lattice, s, t);
        ASSERT_GE(here.edge, 0);
        ASSERT_NE(here.id, here.other);
        const auto other_cell_within = [&](float distance) {
            for (int i = 0; i < 64; ++i) {
                const float angle = static_cast<float>(i) * 0.0981748f;
                if (cells(9, lattice, s + distance * std::cos(angle) / kCells,
                          t + distance * std::sin(angle) / kCells)
                        .id != here.id)
                    return true;
            }
            return false;
        };
        if (here.edge > 0.01f) {
            EXPECT_FALSE(other_cell_within(0.97f * here.edge));
        }
        // 64 directions miss the nearest point of a border by 0.1 % of its distance.
        if (other_cell_within(1.03f * here.edge + 0.001f)) ++checked;
    }
    // Where the border is short, the directions may go past its ends.
    EXPECT_GT(checked, 1950);
}

TEST(PerlinNoise, IsZeroAtLatticePoints) {
    for (int z = -2; z < 10; ++z)
        for (int y = -2; y < 10; ++y)
            for (int x = -2; x < 10; ++x)
                EXPECT_EQ(perlin_noise(1, x, y, z, 8), 0.0f);
}

TEST(PerlinNoise, RepeatsAfterItsPeriod) {
    for (int i = 0; i < 500; ++i) {
        const double x = 8.0 * hash_unit(1, i, 1), y = 8.0 * hash_unit(1, i, 2),
                     z = 8.0 * hash_unit(1, i, 3);
        const float here = perlin_noise(2, x, y, z, 8);
        EXPECT_NEAR(perlin_noise(2, x + 8, y, z, 8), here, 1e-6f);
        EXPECT_NEAR(perlin_noise(2, x, y - 16, z, 8), here, 1e-6f);
        EXPECT_NEAR(perlin_noise(2, x, y, z + 8, 8), here, 1e-6f);
        EXPECT_LE(std::abs(here), 1.0f);
    }
}

// Perlin 2002: the gradients are the twelve directions from a cube's centre to its edges' middles.
TEST(PerlinNoise, ItsSlopesAtLatticePointsAreTheTwelveGradients) {
    std::vector<std::vector<int>> seen;
    constexpr double h = 1e-4;
    for (int z = 0; z < 8; ++z)
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 8; ++x) {
                const auto slope = [&](double dx, double dy, double dz) {
                    const double g = (perlin_noise(4, x + dx, y + dy, z + dz, 8) -
                                      perlin_noise(4, x - dx, y - dy, z - dz, 8)) /
                                     (2 * h);
                    EXPECT_NEAR(g, std::round(g), 1e-3);
                    return static_cast<int>(std::lround(g));
                };
                std::vector<int> g{slope(h, 0, 0), slope(0, h, 0), slope(0, 0, h)};
                EXPECT_EQ(std::abs(g[0]) + std::abs(g[1]) + std::abs(g[2]), 2);
                EXPECT_LE(std::max({std::abs(g[0]), std::abs(g[1]), std::abs(g[2])}), 1);
                seen.push_back(std::move(g));
            }
    std::sort(seen.begin(), seen.end());
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
    EXPECT_EQ(seen.size(), 12u);
}

// The quintic fade has no second derivative at the lattice (Perlin 2002, section 2), so the slope
// goes on smoothly where two cells meet; the cubic fade of 1985 jumps by up to 6 per cell squared.
TEST(PerlinNoise, ItsCurvatureGoesOnFromCellToCell) {
    double jumps = 0;
    for (int i = 0; i < 64; ++i) {
        const auto curvature = [&](double x) {
            constexpr double h = 1e-2;
            const double y = 8.0 * hash_unit(1, i, 1), z = 8.0 * hash_unit(1, i, 2);
            return (perlin_noise(5, x + h, y, z, 8) - 2 * perlin_noise(5, x, y, z, 8) +
                    perlin_noise(5, x - h, y, z, 8)) /
                   (h * h);
        };
        const int cell = i % 8;
        jumps += std::abs(curvature(cell + 0.011) - curvature(cell - 0.011));
    }
    EXPECT_LT(jumps / 64, 1.0);
}

}  // namespace
}  // namespace relevo::ground
