// The ground along a line that is measured in the window.
#include <cmath>

#include <gtest/gtest.h>

#include "base/units.h"
#include "viewer/overlay.h"

namespace relevo::viewer {
namespace {

TEST(Profile, ClimbAndDescentAreThoseOnTheWayFromItsBeginning) {
    // 2 km to the north: 300 m up over the first half, 100 m down over the second.
    const geo::Geodetic from = geo::geodetic_deg(47, 9);
    const geo::Geodetic to = geo::destination(from, 0, 2000);
    Land land;
    land.height_m = [&](const geo::Geodetic& place) {
        const double way_m = geo::geodesic(from, place).distance_m;
        return way_m <= 1000 ? 500 + 0.3 * way_m : 800 - 0.1 * (way_m - 1000);
    };
    const Profile there = Profile::between(from, to, land), back = Profile::between(to, from, land);
    EXPECT_NEAR(there.up_m, 300, 0.01);
    EXPECT_NEAR(there.down_m, 100, 0.01);
    EXPECT_NEAR(back.up_m, 100, 0.01);
    EXPECT_NEAR(back.down_m, 300, 0.01);
    EXPECT_NEAR(there.level_m, 2000, 1e-3);
    EXPECT_NEAR(there.surface_m, std::hypot(1000, 300) + std::hypot(1000, 100), 0.01);
    EXPECT_NEAR(degrees(there.azimuth_rad), 0, 1e-6);
    EXPECT_NEAR(degrees(back.azimuth_rad), 180, 1e-6);
    EXPECT_NEAR(there.heights_m.front(), 500, 1e-3);
    EXPECT_NEAR(there.heights_m.back(), 700, 1e-3);
    EXPECT_FALSE(there.has_holes);
}

TEST(Profile, LeavesOutWhatLiesInAVoid) {
    // Level ground 100 m higher behind a void: what the ground does there is not known.
    const geo::Geodetic from = geo::geodetic_deg(47, 9);
    Land land;
    land.height_m = [&](const geo::Geodetic& place) {
        const double way_m = geo::geodesic(from, place).distance_m;
        if (way_m > 802.5 && way_m < 1202.5) return std::nan("");
        return way_m < 1000 ? 500.0 : 600.0;
    };
    const Profile found = Profile::between(from, geo::destination(from, kPi / 2, 2000), land);
    EXPECT_TRUE(found.has_holes);
    EXPECT_EQ(found.up_m, 0);
    EXPECT_EQ(found.down_m, 0);
    EXPECT_NEAR(found.surface_m, 1595, 1e-6);  // less 81 of 400 steps of 5 m
}

}  // namespace
}  // namespace relevo::viewer
