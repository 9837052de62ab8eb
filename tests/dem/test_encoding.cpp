#include <array>
#include <cmath>
#include <vector>

#include "dem/encoding.h"
#include "support/support.h"

namespace relevo::dem::test_encoding {
namespace {

// docs.mapbox.com, "Access elevation data": height = -10000 + ((R * 256 * 256 + G * 256 + B) *
// 0.1).
TEST(Encoding, TerrainRgbIsMapboxs) {
    EXPECT_EQ(decoded_m(Encoding::TerrainRgb, 1, 134, 160), 0);
    EXPECT_EQ(decoded_m(Encoding::TerrainRgb, 1, 134, 161), 0.1F);
    EXPECT_EQ(decoded_m(Encoding::TerrainRgb, 2, 224, 68), 8848.4F);
    EXPECT_EQ(decoded_m(Encoding::TerrainRgb, 0, 0, 0), -10000);
}

// github.com/tilezen/joerd, docs/formats.md: (red * 256 + green + blue / 256) - 32768.
TEST(Encoding, TerrariumIsMapzens) {
    EXPECT_EQ(decoded_m(Encoding::Terrarium, 128, 0, 0), 0);
    EXPECT_EQ(decoded_m(Encoding::Terrarium, 128, 0, 1), 1.0F / 256);
    EXPECT_EQ(decoded_m(Encoding::Terrarium, 162, 144, 128), 8848.5F);
    EXPECT_EQ(decoded_m(Encoding::Terrarium, 0, 0, 0), -32768);
}

using Picture = std::array<std::vector<std::uint8_t>, 3>;
constexpr int kWidth = 32;

template <typename Code>
Picture picture(const Code& code) {
    Picture p;
    for (int i = 0; i < kWidth * kWidth; ++i) {
        const int value = code(i % kWidth, i / kWidth);
        for (int band = 0; band < 3; ++band)
            p[static_cast<std::size_t>(band)].push_back(
                static_cast<std::uint8_t>(value >> (8 * (2 - band))));
    }
    return p;
}

std::optional<Encoding> guessed(const Picture& p) {
    return plausible_encoding(p[0], p[1], p[2], kWidth);
}

TEST(PlausibleEncoding, TellsHeightsFromPhotographs) {
    const auto rough_m = [](int x, int y) {
        return 2000 + 200 * std::sin(x * 0.3) * std::cos(y * 0.21) + 10 * ((x * 7 + y * 13) % 3);
    };
    EXPECT_EQ(guessed(picture(
                  [&](int x, int y) { return static_cast<int>((rough_m(x, y) + 10000) * 10); })),
              Encoding::TerrainRgb);
    EXPECT_EQ(guessed(picture(
                  [&](int x, int y) { return static_cast<int>((rough_m(x, y) + 32768) * 256); })),
              Encoding::Terrarium);
    // A smooth grey gradient, as skies and shades are; a field of noise; one colour.
    EXPECT_EQ(guessed(picture([](int x, int y) { return (100 + x + y) * 0x10101; })), std::nullopt);
    EXPECT_EQ(guessed(picture([](int x, int y) { return (x * 7919 + y * 104729) * 31; })),
              std::nullopt);
    EXPECT_EQ(guessed(picture([](int, int) { return 0x018700; })), std::nullopt);
}

}  // namespace
}  // namespace relevo::dem::test_encoding
