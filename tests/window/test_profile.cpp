// The ground along a line that is measured in the window.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "base/units.h"
#include "viewer/measurement.h"

namespace relevo::viewer::test_profile {
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
    const auto profile = [&](const geo::Geodetic& a, const geo::Geodetic& b) {
        return Profile::along(std::vector{a, b}, land, 5);
    };
    const Profile there = profile(from, to), back = profile(to, from);
    EXPECT_NEAR(there.up_m, 300, 0.01);
    EXPECT_NEAR(there.down_m, 100, 0.01);
    EXPECT_NEAR(back.up_m, 100, 0.01);
    EXPECT_NEAR(back.down_m, 300, 0.01);
    EXPECT_NEAR(there.level_m, 2000, 1e-3);
    EXPECT_NEAR(there.surface_m, std::hypot(1000, 300) + std::hypot(1000, 100), 0.01);
    EXPECT_NEAR(degrees(there.azimuth_rad), 0, 1e-6);
    EXPECT_NEAR(degrees(back.azimuth_rad), 180, 1e-6);
    EXPECT_NEAR(degrees(there.back_rad), 180, 1e-6);
    EXPECT_NEAR(there.points.front().place.height_m, 500, 1e-3);
    EXPECT_NEAR(there.points.back().place.height_m, 700, 1e-3);
    EXPECT_NEAR(there.points.back().distance_m, 2000, 1e-3);
    EXPECT_FALSE(there.has_voids);
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
    const Profile found =
        Profile::along(std::vector{from, geo::destination(from, kPi / 2, 2000)}, land, 5);
    EXPECT_TRUE(found.has_voids);
    EXPECT_EQ(found.up_m, 0);
    EXPECT_EQ(found.down_m, 0);
    EXPECT_NEAR(found.surface_m, 1595, 1e-6);  // less 81 of 400 steps of 5 m
}

TEST(Profile, RunsFromCornerToCornerWithAPointForEachPost) {
    const geo::Geodetic a = geo::geodetic_deg(47, 9), b = geo::destination(a, 0, 5000),
                        c = geo::destination(b, kPi / 2, 2500);
    Land land;
    land.height_m = [](const geo::Geodetic&) { return 100.0; };
    const Profile found = Profile::along(std::vector{a, b, c}, land, 10);
    EXPECT_NEAR(found.level_m, 7500, 1e-6);
    ASSERT_EQ(found.points.size(), 751U);
    EXPECT_NEAR(geo::geodesic(found.points[500].place, b).distance_m, 0, 1e-6);
    EXPECT_NEAR(found.points[600].distance_m, 6000, 1e-6);
    EXPECT_NEAR(geo::geodesic(found.points[600].place, b).distance_m, 1000, 1e-6);
    EXPECT_EQ(found.lowest_m, 100);
}

/// Level ground of 100 m with a wall after 4 of 10 km.
LineOfSight over_a_wall(double wall_m, double eye_m, double target_m) {
    const geo::Geodetic from = geo::geodetic_deg(47, 9);
    Land land;
    land.height_m = [&](const geo::Geodetic& place) {
        const double way_m = geo::geodesic(from, place).distance_m;
        return std::abs(way_m - 4000) < 5 ? 100 + wall_m : 100.0;
    };
    const Profile profile =
        Profile::along(std::vector{from, geo::destination(from, kPi / 2, 10000)}, land, 10);
    return line_of_sight(profile, eye_m, target_m).value();
}

TEST(LineOfSight, IsThatOfACircleWithRefraction) {
    // Over a circle of 6386 km, the ground falls by s^2 (1 - 0.13) / 2 r: 1.09 m after 4 km and
    // 6.81 m after 10 km. Through the top of the wall at 30 m from an eye at 2 m:
    const double falls_4 = 4e3 * 4e3 * 0.87 / 2 / 6386e3, falls_10 = 1e4 * 1e4 * 0.87 / 2 / 6386e3;
    const double needed_m = 2 + (30 - falls_4 - 2) / 4 * 10 + falls_10;
    const LineOfSight hidden = over_a_wall(30, 2, 0);
    EXPECT_NEAR(hidden.missing_m, needed_m, 0.05);
    EXPECT_NEAR(hidden.highest.distance_m, 4000, 1);
    EXPECT_NEAR(over_a_wall(30, 2, needed_m + 1).missing_m, -1, 0.05);
    // From 200 m above ground both are seen.
    EXPECT_LT(over_a_wall(30, 200, 0).missing_m, 0);
}

TEST(LineOfSight, OfGroundWithoutHeightsIsNone) {
    Land land;
    land.height_m = [](const geo::Geodetic&) { return std::nan(""); };
    const geo::Geodetic from = geo::geodetic_deg(47, 9);
    const Profile profile =
        Profile::along(std::vector{from, geo::destination(from, 0, 1000)}, land, 10);
    EXPECT_TRUE(std::isnan(profile.lowest_m));
    EXPECT_FALSE(line_of_sight(profile, 1.7, 0));
}

class Measuring : public testing::Test {
  protected:
    Measuring() {
        land_.frame = &frame_;
        land_.height_m = land_.aim_m = [](const geo::Geodetic&) { return 0.0; };
    }
    glm::dvec3 at(double east_m, double north_m) const {
        return frame_.to_local(geo::destination(geo::destination(origin_, kPi / 2, east_m),
                                                north_m < 0 ? kPi : 0, std::abs(north_m)));
    }
    void corners(const std::vector<glm::dvec2>& corners) {
        line_.start(at(corners[0].x, corners[0].y));
        line_.measure();
        for (std::size_t i = 1; i < corners.size(); ++i)
            line_.set_corner(at(corners[i].x, corners[i].y), land_, 10);
        line_.end();
    }

    geo::Geodetic origin_ = geo::geodetic_deg(47, 9);
    geo::LocalFrame frame_{origin_};
    Land land_;
    Measurement line_;
};

TEST_F(Measuring, AreaIsThatOfThePolygon) {
    corners({{0, 0}, {1000, 0}, {1000, 500}, {0, 500}});
    ASSERT_TRUE(line_.area_m2);
    // Meridians converge: the upper side is 0.08 m shorter.
    EXPECT_NEAR(*line_.area_m2, 500000, 50);
    corners({{0, 0}, {0, 500}, {1000, 500}, {1000, 0}});  // the other way round
    EXPECT_NEAR(*line_.area_m2, 500000, 50);
    corners({{0, 0}, {1000, 500}, {1000, 0}, {0, 500}});
    EXPECT_TRUE(line_.crosses_itself);
    EXPECT_FALSE(line_.area_m2);
}

TEST_F(Measuring, TheLastCornerFollowsUntilItIsSetAndCanBeDropped) {
    line_.start(at(0, 0));
    line_.measure();
    line_.follow(at(100, 0), land_, 10);
    line_.follow(at(200, 0), land_, 10);
    EXPECT_NEAR(line_.profile->level_m, 200, 1e-3);
    line_.set_corner(at(200, 0), land_, 10);
    line_.follow(at(200, 100), land_, 10);
    EXPECT_EQ(line_.corners_m.size(), 3U);
    EXPECT_NEAR(line_.profile->level_m, 300, 1e-3);
    line_.drop_corner(land_, 10);
    EXPECT_EQ(line_.corners_m.size(), 2U);
    EXPECT_NEAR(line_.profile->level_m, std::hypot(200, 100), 0.01);
    line_.end();
    line_.drop_corner(land_, 10);
    EXPECT_FALSE(line_.profile);
    line_.drop_corner(land_, 10);  // one corner stays
    EXPECT_EQ(line_.corners_m.size(), 1U);
}

TEST_F(Measuring, CsvHasARowForEachPointAndNoHeightInVoids) {
    land_.height_m = [&](const geo::Geodetic& place) {
        return geo::geodesic(origin_, place).distance_m > 995 ? std::nan("") : 12.5;
    };
    corners({{0, 0}, {1000, 0}});
    const std::string text = csv_text(*line_.profile);
    EXPECT_TRUE(
        text.starts_with("distance_m,latitude_deg,longitude_deg,height_m\n"
                         "0.000,47.00000000,9.00000000,12.500\n2.500,"))
        << text.substr(0, 120);
    EXPECT_TRUE(text.ends_with(",\n")) << text.substr(text.size() - 60);
    EXPECT_EQ(std::ranges::count(text, '\n'), 402);
}

}  // namespace
}  // namespace relevo::viewer::test_profile
