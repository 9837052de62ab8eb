#include <cmath>

#include "render/overlay_raster.h"
#include "render/pages.h"
#include "support/support.h"

namespace relevo::render::test_overlay_raster {
namespace {

constexpr int kSide = 600;  // posts: three pages a side on the finest level

std::uint32_t red_of(std::uint32_t texel) {
    return texel & 255;
}

/// An overlay whose red rises by one from column to column, and green by one from row to row.
class OverlayPage : public testing::Test {
  protected:
    static OverlayRaster gradient(int columns, int rows) {
        OverlayRaster raster{Array2d<std::uint32_t>(columns, rows)};
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column)
                raster.rgba.at(column, row) = static_cast<std::uint32_t>(column % 256) |
                                              static_cast<std::uint32_t>(row % 256) << 8 |
                                              0xff000000u;
        return raster;
    }
    static std::uint32_t node(const std::vector<std::uint32_t>& page, int column, int row) {
        return page[static_cast<std::size_t>((row + 1) * kNormalPage_px + column + 1)];
    }

    Array2d<float> heights_{kSide, kSide, 0};
    dem::Pyramid pyramid_{heights_};
};

TEST_F(OverlayPage, HasThePostsOwnColoursOnTheFinestLevel) {
    const std::vector<std::uint32_t> page =
        overlay_page(gradient(kSide, kSide), pyramid_, 0, {1, 2});
    for (int i : {-1, 0, 17, 80}) {
        EXPECT_EQ(red_of(node(page, i, 0)), static_cast<std::uint32_t>((256 + i) % 256));
        EXPECT_EQ(node(page, 5, i) >> 8 & 255, static_cast<std::uint32_t>((512 + i) % 256));
    }
}

TEST_F(OverlayPage, HasMeansOfWhatANodeStandsForOnCoarserOnes) {
    OverlayRaster raster{Array2d<std::uint32_t>(kSide, kSide, 0)};
    // Columns by turns white and clear.
    for (int row = 0; row < kSide; ++row)
        for (int column = 0; column < kSide; column += 2)
            raster.rgba.at(column, row) = 0xffffffffu;
    const std::vector<std::uint32_t> page = overlay_page(raster, pyramid_, 2, {0, 0});
    for (int i : {1, 20, 100})
        EXPECT_EQ(node(page, i, i), 0x80808080u);
}

TEST_F(OverlayPage, LiesOnTheSameGroundWhateverItsOwnSize) {
    // Half as many texels, from the first post to the last.
    OverlayRaster raster{Array2d<std::uint32_t>(kSide / 2, kSide / 2)};
    for (int row = 0; row < kSide / 2; ++row)
        for (int column = 0; column < kSide / 2; ++column)
            raster.rgba.at(column, row) = overlay_texel(column / 299.0, 0, 0, 1);
    const std::vector<std::uint32_t> page = overlay_page(raster, pyramid_, 0, {1, 0});
    for (int i : {0, 100, 200})
        EXPECT_NEAR(red_of(node(page, i, 0)), 255 * (256 + i) / 599.0, 0.75) << i;
}

TEST_F(OverlayPage, TexelsArePremultiplied) {
    EXPECT_EQ(overlay_texel(1, 0.5, 0, 0.5), 0x80004080u);
    EXPECT_EQ(overlay_texel(1, 1, 1, 0), 0u);
}

}  // namespace
}  // namespace relevo::render::test_overlay_raster
