#include <cmath>

#include <gtest/gtest.h>

#include "dem/fill_holes.h"
#include "render/pages.h"
#include "render/water_field.h"

namespace relevo::render::test_water_field {
namespace {

using dem::WaterKind;

/// A coast at a slant over a square DEM: wet where it is true.
template <typename IsWet>
dem::Water water_where(int side, WaterKind kind, const IsWet& is_wet) {
    dem::Water water;
    water.kind = Array2d<WaterKind>(side, side, WaterKind::None);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            if (is_wet(x, y)) water.kind.at(x, y) = kind;
    return water;
}

TEST(WaterField, EveryPostIsOnItsSideOfTheShore) {
    // Spits, inlets and islands a post wide are there too.
    const auto wet = [](int x, int y) {
        return (2 * x + y < 90 && !(x == 5 && y > 20)) || (y == 40 && x < 60) ||
               (x == 60 && y == 9);
    };
    const dem::Water water = water_where(65, WaterKind::Lake, wet);
    const Array2d<float> heights(65, 65, 100.0f);
    const WaterField field(heights, water, nullptr, 1);
    for (int y = 0; y < 65; ++y)
        for (int x = 0; x < 65; ++x) {
            EXPECT_EQ(field.at(0, x, y)[0] > 127, wet(x, y)) << x << ' ' << y;
            EXPECT_EQ(field.at(0, x, y)[1], 0);  // no sea
        }
}

TEST(WaterField, AShoreWithAFloorIsWhereTheHeightsCrossZero) {
    Array2d<float> heights(65, 65);
    for (int y = 0; y < 65; ++y)
        for (int x = 0; x < 65; ++x)
            heights.at(x, y) = static_cast<float>(x) - 20.25f;
    const dem::Water water =
        water_where(65, WaterKind::SeaFloor, [](int x, int) { return x <= 20; });
    const WaterField field(heights, water, nullptr, 1);
    const double wet = field.at(0, 20, 30)[0] / 255.0 - 0.5,
                 dry = 0.5 - field.at(0, 21, 30)[0] / 255.0;
    EXPECT_NEAR(wet / (wet + dry), 0.25, 0.01);
    EXPECT_EQ(field.at(0, 20, 30)[1], 255);
    EXPECT_EQ(field.at(0, 20, 30)[2], 255);
}

TEST(WaterField, ASlantedShoreIsSmooth) {
    // Its contour lies on a line within a quarter of a post's spacing; the mask's own is off by a
    // half.
    const auto wet = [](int x, int y) { return x + 3 * y < 100; };
    const dem::Water water = water_where(65, WaterKind::Sea, wet);
    const Array2d<float> heights(65, 65, 0.0f);
    const WaterField field(heights, water, nullptr, 1);
    double worst = 0;
    for (int x = 5; x < 60; ++x)
        for (int y = 1; y < 63; ++y) {
            const double here = field.at(0, x, y)[0] - 127.5,
                         below = field.at(0, x, y + 1)[0] - 127.5;
            if (here <= 0 || below > 0) continue;
            const double shore = y + here / (here - below);
            worst = std::max(worst, std::abs(shore - (99.0 / 3 - x / 3.0 + 0.5 / 3)));
        }
    EXPECT_GT(worst, 0);
    EXPECT_LT(worst, 0.3);
}

TEST(WaterField, WaterReachesTheVoidsThatItBordersOn) {
    // East of a ragged line nothing is known: sea in the north of it, land in the south.
    const auto is_void = [](int x, int y) { return x > 100 + (y * 7) % 5; };
    Array2d<float> heights(257, 257, 0.0f);
    for (int y = 0; y < 257; ++y)
        for (int x = 0; x < 257; ++x)
            if (is_void(x, y)) heights.at(x, y) = std::nanf("");
    const dem::Water water =
        water_where(257, WaterKind::Sea, [&](int x, int y) { return y < 128 && !is_void(x, y); });
    const WaterField field(heights, water, nullptr, 1);
    for (int level = 0; level < 4; ++level)
        for (int y = 0; y < 257; y += 1 << level)
            for (int x = 0; x < 107; x += 1 << level) {
                if (std::abs(y - 128) <= 2 << level) continue;
                EXPECT_EQ(field.at(level, x >> level, y >> level)[0], y < 128 ? 255 : 0)
                    << level << ' ' << x << ' ' << y;
            }
}

TEST(WaterField, CoarserLevelsKeepTheWatersArea) {
    const auto wet = [](int x, int y) { return std::hypot(x - 130, y - 120) < 70; };
    const dem::Water water = water_where(257, WaterKind::Lake, wet);
    const Array2d<float> heights(257, 257, 50.0f);
    const WaterField field(heights, water, nullptr, 1);
    const double area = 3.14159 * 70 * 70;
    for (int level = 0; level <= 4; ++level) {
        int nodes = 0;
        for (int y = 0; y <= 256 >> level; ++y)
            for (int x = 0; x <= 256 >> level; ++x)
                nodes += field.at(level, x, y)[0] > 127;
        EXPECT_NEAR(nodes * std::exp2(2 * level) / area, 1, 0.02 * std::exp2(level)) << level;
    }
}

/// Sea beyond column 120, of one kind in the upper half and of another below.
dem::Water two_waters(WaterKind upper, WaterKind lower) {
    dem::Water water = water_where(257, upper, [](int x, int) { return x > 120; });
    for (int y = 129; y < 257; ++y)
        for (int x = 121; x < 257; ++x)
            water.kind.at(x, y) = lower;
    return water;
}

TEST(WaterField, TheKindOfTheWaterIsTheSameOnAllLevels) {
    const Array2d<float> heights(257, 257, -3.0f);
    // Whether it is the sea, and whether the floor below it is known.
    const auto expect_kind = [](const WaterTexel& texel, WaterKind kind, int level) {
        EXPECT_EQ(texel[0], kind == WaterKind::None ? 0 : 255) << level;
        EXPECT_EQ(texel[1], kind == WaterKind::Sea || kind == WaterKind::SeaFloor ? 255 : 0)
            << level;
        EXPECT_EQ(texel[2], kind == WaterKind::SeaFloor ? 255 : 0) << level;
    };
    for (const auto& [upper, lower] : {std::pair(WaterKind::Sea, WaterKind::SeaFloor),
                                       {WaterKind::SeaFloor, WaterKind::Lake},
                                       {WaterKind::Lake, WaterKind::Sea}}) {
        const dem::Water water = two_waters(upper, lower);
        const WaterField field(heights, water, nullptr, 1);
        for (int level = 0; level <= 4; ++level) {
            expect_kind(field.at(level, 200 >> level, 60 >> level), upper, level);
            expect_kind(field.at(level, 200 >> level, 200 >> level), lower, level);
            expect_kind(field.at(level, 40 >> level, 60 >> level), WaterKind::None, level);
            // Along the shore there is some of it, of no other kind.
            const WaterTexel shore = field.at(level, 128 >> level, 64 >> level);
            EXPECT_EQ(shore[1], upper == WaterKind::Lake ? 0 : 255) << level;
            EXPECT_EQ(shore[2], upper == WaterKind::SeaFloor ? 255 : 0) << level;
        }
    }
}

TEST(WaterField, FilledHolesAreTold) {
    Array2d<std::uint8_t> filled(65, 65, 0);
    filled.at(7, 9) = dem::kFilled;
    filled.at(20, 9) = dem::kCovered;
    const Array2d<float> heights(65, 65, 50.0f);
    const dem::Water dry;
    const WaterField field(heights, dry, &filled, 1);
    EXPECT_EQ(field.at(0, 7, 9), (WaterTexel{0, 0, 0, 128}));
    EXPECT_EQ(field.at(0, 20, 9), (WaterTexel{0, 0, 0, 255}));
    EXPECT_EQ(field.at(0, 8, 9), (WaterTexel{0, 0, 0, 0}));
}

TEST(WaterField, MeansOfADemLieInTheMiddleOfTheirPosts) {
    // 64 means of 4 x 4 posts, wet to the left of post 128.
    const dem::Water water = water_where(64, WaterKind::Sea, [](int x, int) { return x < 32; });
    const Array2d<float> heights(64, 64, 0.0f);
    const WaterField field(heights, water, nullptr, 4);
    const Array2d<float> posts(256, 256, 0.0f);
    const dem::Pyramid pyramid(posts);
    for (int level = 0; level <= 3; ++level) {
        const auto page = field.page(pyramid, level, {0, 0});
        const int row = 20 * kNormalPage_px;
        for (int x = 0; x < kNormalPage_px; ++x) {
            const int node = std::clamp(x - 1, 0, pyramid.size(level).x - 1);
            const int post = pyramid.post(level, {node, 0}).x;
            const int off = post - 128;
            if (std::abs(off) < 1 << level) continue;
            EXPECT_EQ(page[static_cast<std::size_t>(row + x)][0] > 127, off < 0)
                << level << ' ' << post;
        }
    }
}

}  // namespace
}  // namespace relevo::render::test_water_field
