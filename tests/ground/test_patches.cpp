#include <cmath>

#include <glm/gtc/packing.hpp>

#include "patches.h"
#include "support/support.h"

namespace relevo::ground {
namespace {

const image::TextureData& patches() {
    static const image::TextureData texture =
        image::read_ktx(test::build_dir() / "share/relevo/data/noise/patches.ktx2");
    return texture;
}

double value(int channel, int column, int row) {
    const int n = patches().width();
    const auto at = static_cast<std::size_t>(4 * ((row & (n - 1)) * n + (column & (n - 1))));
    return std::to_integer<int>(patches().level(0)[at + static_cast<std::size_t>(channel)]) / 255.0;
}

TEST(Patches, TonesAndHueKeepTheirMeanOnEveryLevel) {
    for (int level = 0; level < patches().levels(); ++level) {
        const auto bytes = patches().level(level);
        const double texels = static_cast<double>(bytes.size()) / 4;
        for (const std::size_t channel : {0, 1, 3}) {
            double sum = 0;
            for (std::size_t i = channel; i < bytes.size(); i += 4)
                sum += std::to_integer<int>(bytes[i]) / 255.0;
            EXPECT_NEAR(sum / texels, 0.5, 0.002 + 1.0 / 255 / std::sqrt(texels))
                << "channel " << channel << ", level " << level;
        }
    }
}

TEST(Regions, AreAsThePatchesAndKeepAMeanOfZeroOnEveryLevel) {
    const image::TextureData regions =
        image::read_ktx(test::build_dir() / "share/relevo/data/noise/regions.ktx2");
    const auto at = [&](int level, std::size_t i) {
        const auto bytes = regions.level(level);
        return glm::unpackHalf1x16(static_cast<std::uint16_t>(
            std::to_integer<int>(bytes[2 * i]) | std::to_integer<int>(bytes[2 * i + 1]) << 8));
    };
    for (int level = 0; level < regions.levels(); ++level) {
        const std::size_t values = regions.level(level).size() / 2;
        for (const std::size_t channel : {0, 1, 3}) {
            double sum = 0;
            for (std::size_t i = channel; i < values; i += 4)
                sum += at(level, i);
            EXPECT_NEAR(sum / static_cast<double>(values / 4), 0, 0.002)
                << "channel " << channel << ", level " << level;
        }
    }
    // Texel by texel, where the patches' next level is as large: the rest is what finer noise
    // averages to.
    const auto patch = patches().level(1);
    ASSERT_EQ(patch.size(), regions.level(0).size() / 2);
    double difference = 0;
    for (std::size_t i = 0; i < patch.size(); i += 4)
        difference += std::abs(std::to_integer<int>(patch[i]) / 255.0 - 0.5 - at(0, i));
    EXPECT_LT(difference / (static_cast<double>(patch.size()) / 4), 0.03);
}

TEST(Patches, ShrubsCoverAFifthToTwoFifths) {
    const int n = patches().width();
    double sum = 0;
    for (int row = 0; row < n; ++row)
        for (int column = 0; column < n; ++column)
            sum += value(2, column, row);
    EXPECT_GT(sum / n / n, 0.2);
    EXPECT_LT(sum / n / n, 0.4);
}

TEST(Patches, GoOnAcrossTheSeamAsAnywhereElse) {
    const int n = patches().width();
    for (const int channel : {0, 1, 2, 3}) {
        double inside = 0, across = 0;
        for (int i = 0; i < n; ++i) {
            across += std::abs(value(channel, n - 1, i) - value(channel, n, i)) +
                      std::abs(value(channel, i, n - 1) - value(channel, i, n));
            for (int j = 0; j + 1 < n; ++j)
                inside += (std::abs(value(channel, j, i) - value(channel, j + 1, i)) +
                           std::abs(value(channel, i, j) - value(channel, i, j + 1))) /
                          (n - 1);
        }
        EXPECT_NEAR(across / inside, 1, 0.2) << channel;
    }
}

}  // namespace
}  // namespace relevo::ground
