// Which frames a picture is drawn in, and what their mean is.
#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "session/annotations.h"
#include "session/picture_tiles.h"
#include "session/sample_sum.h"

namespace relevo::session::test_picture_tiles {
namespace {

TEST(PictureTiles, CoverEachPixelOnceWithFramesThatBeginOnSteps) {
    for (const glm::ivec2 size : {glm::ivec2(1, 1), {640, 256}, {641, 999}, {30000, 517}}) {
        const std::vector<PictureTile> tiles = tiles_of(size, 256, 128);
        std::int64_t pixels = 0;
        glm::ivec2 next(0, size.y);  // rows from the top
        for (const PictureTile& tile : tiles) {
            if (next.x == size.x) next = {0, tile.rect.corner.y + tile.rect.size.y};
            EXPECT_EQ(tile.rect.corner.x, next.x);
            EXPECT_EQ(tile.rect.corner.y + tile.rect.size.y, next.y);
            next.x += tile.rect.size.x;
            pixels += std::int64_t{tile.rect.size.x} * tile.rect.size.y;
            for (int i = 0; i < 2; ++i) {
                EXPECT_EQ(tile.frame.corner[i] % kTileStep_px, 0);
                const int before = tile.rect.corner[i] - tile.frame.corner[i];
                const int end = tile.rect.corner[i] + tile.rect.size[i];
                EXPECT_EQ(before, tile.rect.corner[i] == 0 ? 0 : 128);
                EXPECT_EQ(tile.frame.corner[i] + tile.frame.size[i], std::min(end + 128, size[i]));
            }
        }
        EXPECT_EQ(pixels, std::int64_t{size.x} * size.y);
    }
}

TEST(SampleOffsets, AreSpreadOverThePixelAndHaveItsCentreForTheirMean) {
    for (const int samples : {1, 2, 3, 8, 16, 64}) {
        glm::dvec2 sum(0);
        std::array<std::vector<int>, 2> cells{std::vector<int>(samples), std::vector<int>(samples)};
        for (const glm::dvec2& at : sample_offsets(samples)) {
            sum += at;
            EXPECT_LT(std::abs(at.x), 0.5);
            EXPECT_LT(std::abs(at.y), 0.5 + 1e-9);
            ++cells[0][static_cast<std::size_t>((at.x + 0.5) * samples)];
        }
        EXPECT_NEAR(sum.x, 0, 1e-9);
        EXPECT_NEAR(sum.y, 0, 1e-9);
        for (const int count : cells[0])
            EXPECT_EQ(count, 1);
    }
    EXPECT_EQ(sample_offsets(1).front(), glm::dvec2(0));
}

TEST(SampleSum, OfBlackAndWhiteIsHalfTheLight) {
    SampleSum sum(1, 1, false);
    image::Image16 white(1, 1, 3);
    white.values = {65535, 65535, 65535};
    sum.add(white, {});
    sum.add(image::Image16(1, 1, 3), {});
    // sRGB of 0.5: 188 of 255, not 128.
    EXPECT_NEAR(sum.colours().values[0] / 257.0, 187.52, 0.05);
}

TEST(SampleSum, OfOneFrameIsThatFrame) {
    image::Image16 all(256, 256, 3);
    for (std::size_t i = 0; i < all.values.size(); ++i)
        all.values[i] = static_cast<std::uint16_t>(i);
    SampleSum sum(256, 256, false);
    sum.add(all, {});
    const image::Image16 mean = sum.colours();
    for (std::size_t i = 0; i < all.values.size(); ++i)
        ASSERT_NEAR(mean.values[i], all.values[i], 1);
}

TEST(SampleSum, LeavesTransparentSamplesOutOfColourAndAlpha) {
    const std::vector<float> ground{10}, sky{std::numeric_limits<float>::infinity()};
    image::Image16 red(1, 1, 3), blue(1, 1, 3);
    red.values = {40000, 0, 0};
    blue.values = {0, 0, 65535};
    SampleSum sum(1, 1, true);
    for (const auto* const depths_m : {&ground, &sky, &sky, &sky})
        sum.add(depths_m == &ground ? red : blue, *depths_m);
    EXPECT_NEAR(sum.colours().values[0], 40000, 1);
    EXPECT_EQ(sum.colours().values[2], 0);
    EXPECT_EQ(sum.colours().values[3], 16384);
    SampleSum light(1, 1, true);
    image::ImageF of_ground(1, 1, 3);
    of_ground.values = {8, 4, 2};
    light.add(of_ground, ground);
    light.add(of_ground, sky);
    EXPECT_EQ(light.radiance().values, (std::vector<float>{4, 2, 1, 0.5F}));  // premultiplied
}

TEST(Annotations, LieOverAPictureAsIfTheyHadBeenDrawnOnIt) {
    const auto draw = [](image::Image8& on) {
        for (std::size_t i = 0; i < 6; ++i)  // a pixel of its own colour, one half covered
            on.values[i] = static_cast<std::uint8_t>(i < 3 ? 200 : (on.values[i] + 90) / 2);
    };
    image::Image8 drawn(3, 1, 3), laid(3, 1, 3);
    for (std::size_t i = 0; i < 9; ++i)
        drawn.values[i] = laid.values[i] = static_cast<std::uint8_t>(30 * i);
    draw(drawn);
    const image::Image8 over = drawn_alone(3, 1, draw);
    lay_over(over, laid);
    for (std::size_t i = 0; i < 9; ++i)
        EXPECT_NEAR(laid.values[i], drawn.values[i], 1);
    image::Image16 nothing(3, 1, 4);  // transparent
    lay_over(over, nothing);
    EXPECT_EQ(nothing.values[3], 65535);
    EXPECT_NEAR(nothing.values[0], 200 * 257, 1);
    EXPECT_NEAR(nothing.values[7], 32768, 300);
    EXPECT_EQ(nothing.values[11], 0);
}

}  // namespace
}  // namespace relevo::session::test_picture_tiles
