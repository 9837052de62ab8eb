#include <limits>

#include "dem/collar.h"
#include "dem/spikes.h"
#include "support/support.h"

namespace relevo::dem::test_spikes {
namespace {

Array2d<float> slope() {
    Array2d<float> height_m(20, 20);
    for (int r = 0; r < 20; ++r)
        for (int c = 0; c < 20; ++c)
            height_m.at(c, r) = static_cast<float>(100 * c + 50 * r);
    return height_m;
}

TEST(FindSpikes, ASlopeHasNone) {
    const Spikes spikes = find_spikes(slope(), {30, 40});
    EXPECT_EQ(spikes.count, 0);
    EXPECT_EQ(spikes.limit_m, 180);  // six of the nearer spacing
    EXPECT_EQ(find_spikes(slope(), {1, 1}).limit_m, 100);
    EXPECT_EQ(find_spikes(slope(), {900, 900}).limit_m, 1500);
}

TEST(FindSpikes, FindsTheWorstOfThoseUpAndDown) {
    Array2d<float> height_m = slope();
    height_m.at(7, 8) += 500;
    height_m.at(0, 0) -= 300;
    height_m.at(19, 12) = -5000;
    height_m.at(3, 15) += 310;  // 160 above its highest neighbour
    const Spikes spikes = find_spikes(height_m, {30, 40});
    EXPECT_EQ(spikes.count, 3);
    EXPECT_EQ(spikes.worst_column, 19);
    EXPECT_EQ(spikes.worst_row, 12);
    EXPECT_EQ(spikes.worst_m, 5000 + 100 * 18 + 50 * 11);
}

TEST(FindSpikes, HolesAreNoNeighbours) {
    constexpr float kHole = std::numeric_limits<float>::quiet_NaN();
    Array2d<float> height_m(5, 5, kHole);
    height_m.at(2, 2) = 3000;
    EXPECT_EQ(find_spikes(height_m, {30, 30}).count, 0);
    height_m.at(1, 1) = height_m.at(1, 2) = 10;
    EXPECT_EQ(find_spikes(height_m, {30, 30}).count, 0);
    height_m.at(3, 3) = 10;
    EXPECT_EQ(find_spikes(height_m, {30, 30}).count, 1);
}

TEST(FindFrame, IsOneHeightAroundGroundThatIsNotItsOwn) {
    Array2d<float> height_m(30, 30, 0);
    for (int r = 3; r < 27; ++r)
        for (int c = 3; c < 27; ++c)
            height_m.at(c, r) = static_cast<float>(40 + c);
    ASSERT_TRUE(find_collar(height_m));
    EXPECT_EQ(find_collar(height_m)->height_m, 0);
    EXPECT_NEAR(find_collar(height_m)->step_m, 55, 2);
    // What is of its height inside is ground.
    height_m.at(15, 15) = height_m.at(3, 3) = 0;
    const Array2d<float> ground = without_collar(height_m, *find_collar(height_m));
    for (int r = 0; r < 30; ++r)
        for (int c = 0; c < 30; ++c) {
            const bool outside = std::min({c, r, 29 - c, 29 - r}) < 3 || (c == 3 && r == 3);
            ASSERT_EQ(std::isnan(ground.at(c, r)), outside) << c << ' ' << r;
        }
    height_m.at(15, 15) = height_m.at(3, 3) = 43;
    // An island rises from its sea by less than 20 m a post.
    for (int r = 3; r < 27; ++r)
        for (int c = 3; c < 27; ++c)
            height_m.at(c, r) =
                15.0F * static_cast<float>(std::min({c - 2, r - 2, 27 - c, 27 - r}));
    EXPECT_FALSE(find_collar(height_m));
    EXPECT_FALSE(find_collar(Array2d<float>(5, 5, 0)));
    EXPECT_FALSE(find_collar(slope()));
}

}  // namespace
}  // namespace relevo::dem::test_spikes
