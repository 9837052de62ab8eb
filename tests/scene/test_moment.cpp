#include <gtest/gtest.h>

#include "base/units.h"
#include "scene/moment.h"

namespace relevo::scene {
namespace {

TEST(DefaultMoment, IsNineOnTheLongestDayByTheSunsOwnTime) {
    const auto at = [](double lat_deg, double lon_deg) {
        return sun::to_iso(default_moment({radians(lat_deg), radians(lon_deg), 0}));
    };
    EXPECT_EQ(at(46.5, 0), "2026-06-21T09:00:00Z");
    EXPECT_EQ(at(46.5, 15), "2026-06-21T08:00:00Z");
    EXPECT_EQ(at(36.4, -84), "2026-06-21T14:36:00Z");
    EXPECT_EQ(at(-34, 20.5), "2026-12-21T07:38:00Z");
    EXPECT_EQ(at(-34, -179.75), "2026-12-21T20:59:00Z");
}

}  // namespace
}  // namespace relevo::scene
