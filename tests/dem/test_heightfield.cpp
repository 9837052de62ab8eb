#include <cmath>
#include <limits>

#include "dem/heightfield.h"
#include "support/support.h"

namespace relevo::dem::test_heightfield {
namespace {

constexpr float kHole = std::numeric_limits<float>::quiet_NaN();

Heightfield field(Array2d<float> height_m) {
    Grid grid(height_m.width(), height_m.height(), {11, 0.001, 0, 47, 0, -0.001}, geo::Crs());
    return {std::move(height_m), std::move(grid), {}};
}

TEST(Statistics, HolesAreLeftOut) {
    Array2d<float> h(400, 300, 500.0F);
    h.at(3, 5) = kHole;
    h.at(399, 299) = kHole;
    h.at(7, 290) = -12.5F;
    h.at(8, 1) = 4371.0F;
    const Statistics s = statistics(h);
    EXPECT_EQ(s.min_m, -12.5F);
    EXPECT_EQ(s.max_m, 4371.0F);
    EXPECT_EQ(s.holes, 2);
    EXPECT_EQ(s.valid, 400 * 300 - 2);
    EXPECT_EQ(s.outliers, 0);
    EXPECT_DOUBLE_EQ(s.nodata_share(), 2.0 / 120000);
}

TEST(Statistics, HeightsThatTheEarthHasNotAreCounted) {
    Array2d<float> h(10, 10, 0.0F);
    h.at(0, 0) = -32768;
    h.at(1, 0) = 9999;
    h.at(2, 0) = -10935;  // Challenger Deep
    h.at(3, 0) = 8849;    // Everest
    EXPECT_EQ(statistics(h).outliers, 2);
}

TEST(Statistics, NothingValidIsNoRange) {
    const Statistics s = statistics(Array2d<float>(4, 4, kHole));
    EXPECT_EQ(s, (Statistics{0, 0, 0, 16, 0}));
    EXPECT_EQ(s.nodata_share(), 1);
}

TEST(Heightfield, HeightBetweenPostsIsBilinear) {
    Array2d<float> h(3, 2);
    for (int c = 0; c < 3; ++c) {
        h.at(c, 0) = static_cast<float>(10 * c);
        h.at(c, 1) = static_cast<float>(10 * c + 100);
    }
    const Heightfield f = field(h);
    EXPECT_DOUBLE_EQ(f.height_at(0, 0), 0);
    EXPECT_DOUBLE_EQ(f.height_at(2, 1), 120);
    EXPECT_DOUBLE_EQ(f.height_at(1.25, 0.5), 62.5);
    EXPECT_TRUE(std::isnan(f.height_at(2.01, 0)));
    EXPECT_TRUE(std::isnan(f.height_at(0, -0.01)));
    EXPECT_TRUE(std::isnan(f.height_at(std::nan(""), 0)));
}

TEST(Heightfield, HolesSpreadNoFurtherThanTheirCells) {
    Array2d<float> h(4, 4, 7.0F);
    h.at(1, 1) = kHole;
    const Heightfield f = field(h);
    EXPECT_TRUE(std::isnan(f.height_at(0.5, 0.5)));
    EXPECT_TRUE(std::isnan(f.height_at(1, 1)));
    EXPECT_EQ(f.height_at(0, 1), 7);  // its hole neighbour has no weight
    EXPECT_EQ(f.height_at(1, 0.0), 7);
    EXPECT_EQ(f.height_at(2, 2), 7);
    EXPECT_EQ(f.height_at(2, 1), 7);
    EXPECT_EQ(f.height_at(2, 1.5), 7);
}

TEST(Heightfield, PlaceOfAPostHasItsHeight) {
    Array2d<float> h(3, 2, 1500.0F);
    h.at(2, 1) = kHole;
    const Heightfield f = field(h);
    EXPECT_EQ(f.place(1, 0), geo::geodetic_deg(47, 11 + 0.001, 1500));
    EXPECT_TRUE(std::isnan(f.place(2, 1).height_m));
}

}  // namespace
}  // namespace relevo::dem::test_heightfield
