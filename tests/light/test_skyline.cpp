#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "light/point/skyline.h"
#include "support/support.h"

namespace relevo::light::test_skyline {
namespace {

TEST(Skyline, RangesAreThoseOfEveryEntryInThem) {
    // No power of two, and no symmetry.
    constexpr int kCount = 77;
    std::vector<double> elevation_rad;
    for (int i = 0; i < kCount; ++i)
        elevation_rad.push_back(std::sin(i * 1.7) + 0.3 * std::sin(i * i));
    const Skyline skyline(elevation_rad);
    EXPECT_EQ(skyline.count(), kCount);
    for (double azimuth = -7; azimuth < 14; azimuth += 0.37)
        for (const double half : {0.0, 0.01, 0.3, 1.0, 2.9, 3.2}) {
            double lowest = 10, highest = -10;
            for (int i = -3 * kCount; i < 4 * kCount; ++i) {
                const double at = i * skyline.step_rad();
                // The ends of the stretch, and the next entries outside of them.
                if (at <= azimuth - half - skyline.step_rad() ||
                    at >= azimuth + half + skyline.step_rad())
                    continue;
                const double e = elevation_rad[static_cast<std::size_t>((i + 3 * kCount) % kCount)];
                lowest = std::min(lowest, e);
                highest = std::max(highest, e);
            }
            const Skyline::Range range = skyline.range(azimuth, half);
            EXPECT_EQ(range.lowest_rad, lowest) << azimuth << " " << half;
            EXPECT_EQ(range.highest_rad, highest) << azimuth << " " << half;
        }
}

TEST(Skyline, IsLinearBetweenEntries) {
    const Skyline skyline({0.1, 0.3, -0.2, 0.5});
    EXPECT_EQ(skyline.elevation_rad(0), 0.1);
    EXPECT_NEAR(skyline.elevation_rad(kPi / 4), 0.2, 1e-15);
    EXPECT_NEAR(skyline.elevation_rad(kPi * 1.75), 0.3, 1e-15);
    EXPECT_NEAR(skyline.elevation_rad(-kPi / 8), 0.2, 1e-15);
    EXPECT_NEAR(skyline.elevation_rad(2 * kPi * 5 + kPi / 2), 0.3, 1e-14);
}

}  // namespace
}  // namespace relevo::light::test_skyline
