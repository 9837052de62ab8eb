#include <cmath>

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
