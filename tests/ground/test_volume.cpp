#include <array>
#include <cmath>

#include "support/support.h"
#include "volume.h"

namespace relevo::ground::test_volume {
namespace {

const image::TextureData& volume() {
    static const image::TextureData texture =
        image::read_ktx(test::build_dir() / "share/relevo/data/noise/perlin.ktx2");
    return texture;
}

/// -1..1
double value(int c, int r, int s) {
    const int n = volume().width();
    const auto i = static_cast<std::size_t>((s * n + r) * n + c);
    return std::to_integer<int>(volume().level(0)[i]) / 127.5 - 1;
}

TEST(PerlinVolume, IsAVolumeWithAFullChain) {
    EXPECT_EQ(volume().format(), PixelFormat::R8);
    EXPECT_EQ(volume().width(), 128);
    EXPECT_EQ(volume().height(), 128);
    EXPECT_EQ(volume().depth(), 128);
    EXPECT_EQ(volume().levels(), 8);
}

TEST(PerlinVolume, EveryLevelsMeanIsAHalf) {
    for (int l = 0; l < volume().levels(); ++l) {
        const auto bytes = volume().level(l);
        double sum = 0;
        for (const std::byte b : bytes)
            sum += std::to_integer<int>(b);
        // Dithering: one step, spread over so many texels.
        const double slack = 0.0005 + 2.0 / 255 / std::sqrt(static_cast<double>(bytes.size()));
        EXPECT_NEAR(sum / static_cast<double>(bytes.size()) / 255, 0.5, slack) << "level " << l;
    }
}

TEST(PerlinVolume, FillsItsRange) {
    int least = 255, greatest = 0;
    double square = 0;
    for (const std::byte b : volume().level(0)) {
        const int v = std::to_integer<int>(b);
        least = std::min(least, v);
        greatest = std::max(greatest, v);
        square += (v / 127.5 - 1) * (v / 127.5 - 1);
    }
    EXPECT_LE(std::min(least, 255 - greatest), 1);
    EXPECT_LE(least, 40);
    EXPECT_GE(greatest, 215);
    // docs/ground-materials.md states the deviation, which says how far the limits really move.
    EXPECT_NEAR(std::sqrt(square / static_cast<double>(volume().level(0).size())), 0.235, 0.01);
}

// Across the seam the noise goes on as it does anywhere else.
TEST(PerlinVolume, RepeatsWithoutASeamInAllDirections) {
    const int n = volume().width();
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> jump(static_cast<std::size_t>(n));
        for (int i = 0; i < n; ++i) {
            for (int a = 0; a < n; a += 2)
                for (int b = 0; b < n; b += 2) {
                    std::array<int, 3> p{a, a, a}, q;
                    p[static_cast<std::size_t>((axis + 1) % 3)] = b;
                    p[static_cast<std::size_t>(axis)] = i;
                    q = p;
                    q[static_cast<std::size_t>(axis)] = (i + 1) % n;
                    const double d = value(q[0], q[1], q[2]) - value(p[0], p[1], p[2]);
                    jump[static_cast<std::size_t>(i)] += d * d;
                }
        }
        const double seam = jump.back();
        jump.pop_back();
        EXPECT_LE(seam, *std::max_element(jump.begin(), jump.end())) << "axis " << axis;
        EXPECT_GE(seam, 0.8 * *std::min_element(jump.begin(), jump.end())) << "axis " << axis;
    }
}

// What trilinear filtering loses between texels is little: four texels to a cell of the finest
// octave.
TEST(PerlinVolume, IsFineEnoughToBeInterpolated) {
    const int n = volume().width();
    double error = 0, square = 0;
    for (int s = 0; s < n; s += 3)
        for (int r = 0; r < n; r += 3)
            for (int c = 0; c < n; ++c) {
                const double between =
                    0.5 * (value((c + n - 1) % n, r, s) + value((c + 1) % n, r, s));
                error += std::pow(between - value(c, r, s), 2);
                square += std::pow(value(c, r, s), 2);
            }
    // Over two texels the error is four times that over one.
    EXPECT_LT(std::sqrt(error / square) / 4, 0.05);
}

TEST(PerlinVolume, IsTheSameOnEveryRun) {
    const image::TextureData once = perlin_texture(32), again = perlin_texture(32);
    for (int l = 0; l < once.levels(); ++l)
        EXPECT_TRUE(std::ranges::equal(once.level(l), again.level(l)));
}

}  // namespace
}  // namespace relevo::ground::test_volume
