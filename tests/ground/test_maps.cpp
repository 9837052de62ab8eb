#include <cmath>
#include <numbers>

#include "maps.h"
#include "support/support.h"

namespace relevo::ground::test_maps {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// Level ground, grey, half glossy.
Material plain(int n, double tile_m) {
    Material m;
    m.name = "plain";
    m.tile_m = tile_m;
    m.shininess = 20;
    m.height_m = Field(n, n);
    m.albedo = ColourField(n, n, glm::vec3(0.2f));
    m.gloss = Field(n, n, 0.5f);
    return m;
}

glm::vec3 normal_at(const image::TextureData& texture, int level, int c, int r) {
    const auto bytes = texture.level(level);
    const auto i = static_cast<std::size_t>(4 * (r * texture.level_width(level) + c));
    const auto unit = [&](std::size_t k) {
        return 2 * static_cast<float>(std::to_integer<int>(bytes[i + k])) / 255 - 1;
    };
    return {unit(0), unit(1), unit(2)};
}

int byte_at(const image::TextureData& texture, int level, int c, int r, int channel) {
    const auto i = static_cast<std::size_t>(4 * (r * texture.level_width(level) + c) + channel);
    return std::to_integer<int>(texture.level(level)[i]);
}

TEST(NormalOfSlope, IsOneLongAndTiltsAwayFromTheRise) {
    // Rising eastwards at 45 degrees: the normal leans to the west.
    const glm::vec3 n = normal_of_slope(1, 0);
    EXPECT_FLOAT_EQ(n.x, -std::sqrt(0.5f));
    EXPECT_FLOAT_EQ(n.y, 0);
    EXPECT_FLOAT_EQ(n.z, std::sqrt(0.5f));
}

// The convention, on a bump whose sides are known: x to s (columns), y to t (rows), z out.
TEST(NormalTexture, TheEasternSideOfABumpLooksEastAndTheUpperSideUp) {
    constexpr int n = 64;
    Material m = plain(n, 2);
    m.height_m = make_field(n, [](float s, float t) {
        const float x = s - 0.5f, y = t - 0.5f;
        return 0.1f * std::exp(-(x * x + y * y) / 0.01f);
    });
    const image::TextureData texture = normal_texture(m);
    const int middle = n / 2, beside = middle + 4, before = middle - 5;
    EXPECT_GT(normal_at(texture, 0, beside, middle).x, 0.3f);
    EXPECT_LT(normal_at(texture, 0, before, middle).x, -0.3f);
    EXPECT_GT(normal_at(texture, 0, middle, beside).y, 0.3f);
    EXPECT_LT(normal_at(texture, 0, middle, before).y, -0.3f);
    EXPECT_GT(normal_at(texture, 0, beside, beside).z, 0.3f);
    EXPECT_EQ(texture.metadata.at("KTXorientation"), "ru");
    // And the height in A is greatest in the middle.
    EXPECT_EQ(byte_at(texture, 0, middle, middle, 3), 255);
    EXPECT_EQ(byte_at(texture, 0, 0, 0, 3), 0);
    // The nearest texel centre is half a texel off the top on both axes.
    EXPECT_NEAR(std::stod(texture.metadata.at("relevo.height_max_m")),
                0.1 * std::exp(-2 * std::pow(0.5 / n, 2) / 0.01), 2e-6);
}

TEST(Slopes, AreMetresPerMetre) {
    constexpr int n = 256;
    constexpr double kTile_m = 5, kHeight_m = 0.2;
    const Field height_m = make_field(
        n, [](float s, float) { return static_cast<float>(kHeight_m * std::sin(kTurn * 3 * s)); });
    const Slopes slope = slopes(height_m, kTile_m);
    const double steepest = kHeight_m * kTurn * 3 / kTile_m;
    for (int c = 0; c < n; ++c) {
        const double s = (c + 0.5) / n;
        // Central differences take sin(x) / x of a wave: 0.9991 at 3 cycles in 256.
        EXPECT_NEAR(slope.ds.at(c, 7), steepest * std::cos(kTurn * 3 * s), 1.1e-3 * steepest);
        EXPECT_EQ(slope.dt.at(c, 7), 0.0f);
    }
}

TEST(AlbedoTexture, LevelsAreAveragedInLinearLight) {
    Material m = plain(64, 1);
    for (int r = 0; r < 64; ++r)
        for (int c = 0; c < 64; ++c)
            m.albedo.at(c, r) = glm::vec3((c + r) % 2 == 0 ? 1.0f : 0.0f);
    const image::TextureData texture = albedo_texture(m);
    ASSERT_EQ(texture.levels(), 7);
    EXPECT_EQ(byte_at(texture, 0, 0, 0, 0), 255);
    EXPECT_EQ(byte_at(texture, 0, 1, 0, 0), 0);
    // sRGB of a half is 0.7354 (IEC 61966-2-1): 187.5 of 255; averaged encoded values would be 128.
    for (int l = 1; l < 7; ++l)
        EXPECT_EQ(byte_at(texture, l, 0, 0, 1), 188) << "level " << l;
}

TEST(AlbedoTexture, LevelGroundKeepsItsGloss) {
    const image::TextureData texture = albedo_texture(plain(64, 1));
    for (int l = 0; l < texture.levels(); ++l)
        EXPECT_EQ(byte_at(texture, l, 0, 0, 3), 128) << "level " << l;
}

TEST(AlbedoTexture, RoughGroundLosesGlossAsItsSlopesVanishIntoATexel) {
    constexpr int n = 64;
    Material m = plain(n, 1);
    constexpr double kHeight_m = 0.01, kCycles = 4;
    m.height_m = make_field(n, [](float s, float) {
        return static_cast<float>(kHeight_m * std::sin(kTurn * kCycles * s));
    });
    const image::TextureData texture = albedo_texture(m);
    EXPECT_EQ(byte_at(texture, 0, 5, 5, 3), 128);
    // At the top every slope is inside the texel. A wave's mean square slope is half its greatest;
    // central differences take sin(x) / x of it; the variance over both axes is half of that again.
    const double x = kTurn * kCycles / n;
    const double steepest = kHeight_m * kTurn * kCycles * std::sin(x) / x;
    const double expected = 127.5 / (1 + 4 * m.shininess * steepest * steepest / 4);
    EXPECT_NEAR(byte_at(texture, texture.levels() - 1, 0, 0, 3), expected, 0.6);
    EXPECT_LT(expected, 70);
    // Never more gloss further up.
    for (int l = 1; l < texture.levels(); ++l)
        EXPECT_LE(byte_at(texture, l, 0, 0, 3), byte_at(texture, l - 1, 0, 0, 3) + 1);
}

TEST(NormalTexture, EveryLevelIsOneLongAndTheTopIsLevel) {
    constexpr int n = 128;
    Material m = plain(n, 1);
    // A saw: long gentle slopes and short steep ones, whose mean normal, unlike the mean slope,
    // leans.
    m.height_m = make_field(n, [](float s, float t) {
        const float x = s * 8 - std::floor(s * 8);
        return 0.05f * std::min(x / 0.8f, (1 - x) / 0.2f) + 0.01f * std::sin(40 * t);
    });
    const image::TextureData texture = normal_texture(m);
    for (int l = 0; l < texture.levels(); ++l)
        for (int i = 0; i < texture.level_width(l); ++i)
            EXPECT_NEAR(glm::length(normal_at(texture, l, i, i)), 1, 0.012) << "level " << l;
    const glm::vec3 top = normal_at(texture, texture.levels() - 1, 0, 0);
    EXPECT_NEAR(top.x, 0, 0.0045);  // the nearest bytes to zero are 127 and 128
    EXPECT_NEAR(top.y, 0, 0.0045);
}

TEST(NormalTexture, DitheringKeepsTheMeanOfSlopesBelowAByte) {
    constexpr int n = 256;
    Material m = plain(n, 1);
    // Slopes of up to 0.001, a quarter of what one step of a byte says.
    m.height_m = make_field(
        n, [](float s, float) { return static_cast<float>(0.001 / kTurn * std::sin(kTurn * s)); });
    const image::TextureData texture = normal_texture(m);
    double west = 0, east = 0;
    for (int r = 0; r < n; ++r)
        for (int c = 0; c < n; ++c)
            (c < n / 4 || c >= 3 * n / 4 ? west : east) += normal_at(texture, 0, c, r).x;
    // The mean slope of a rising half wave is 2 / pi of its greatest; the mean of 32768 dithered
    // values has standard deviation 0.00392 / 181 = 0.00002.
    EXPECT_NEAR(west / (n * n / 2), -0.001 * 2 / std::numbers::pi, 0.0001);
    EXPECT_NEAR(east / (n * n / 2), 0.001 * 2 / std::numbers::pi, 0.0001);
}

TEST(Srgb, EncodesAsTheStandardSays) {
    // IEC 61966-2-1: the branches meet at 0.0031308, and mid grey of 18 % is 0.4614.
    EXPECT_NEAR(srgb_encoded(0.0031308f), 0.04045, 1e-5);
    EXPECT_NEAR(srgb_encoded(0.18f), 0.46135, 1e-4);
    EXPECT_FLOAT_EQ(srgb_encoded(1), 1);
    for (int i = 0; i <= 255; ++i)
        EXPECT_NEAR(srgb_encoded(srgb_decoded(i / 255.0f)), i / 255.0f, 1e-6);
}

}  // namespace
}  // namespace relevo::ground::test_maps
