#include <cmath>

#include <gtest/gtest.h>

#include "base/units.h"
#include "scene/aerial.h"
#include "scene/framing.h"

namespace relevo::scene {
namespace {

constexpr double kSphere_m = 6371e3;
constexpr Orbit kAerial{.aerial = true};

/// A DEM on the round Earth, 49 posts a side; x is NaN where `height_m` is.
template <typename Height>
GroundNet dem_net(double width_m, double depth_m, double turned_deg, const Height& height_m) {
    constexpr int kPosts = 49;
    GroundNet net(kPosts, kPosts);
    const double c = std::cos(radians(turned_deg)), s = std::sin(radians(turned_deg));
    for (int y = 0; y < kPosts; ++y)
        for (int x = 0; x < kPosts; ++x) {
            const double u = width_m * (x / (kPosts - 1.0) - 0.5);
            const double v = depth_m * (0.5 - y / (kPosts - 1.0));
            const double h = height_m(u / width_m, v / depth_m);
            net.at(x, y) = {std::isnan(h) ? h : c * u + s * v, c * v - s * u,
                            h - (u * u + v * v) / (2 * kSphere_m)};
        }
    return net;
}

double hills_m(double u, double v) {
    return 400 * std::sin(9 * u) * std::cos(7 * v);
}

AerialGround aerial_of(const GroundNet& net, double least_in_picture = 0.82) {
    AerialGround ground;
    for (const glm::dvec3& post : net)
        if (!std::isnan(post.x)) ground.posts.push_back(post);
    ground.least_in_picture = least_in_picture;
    return ground;
}

Camera aerial_camera_of(const Orbit& orbit, const AerialGround& ground, double aspect) {
    return aerial_camera(orbit, ground, aerial_fov_rad(aspect), aspect);
}

/// Where the Earth's edge is in the middle of the picture, from its upper edge.
double horizon_at(const Camera& camera) {
    const glm::dvec3 from_earth = camera.eye_m + glm::dvec3(0, 0, kSphere_m);
    double low = -radians(89), high = radians(89);  // below and above the optical axis
    for (int i = 0; i < 50; ++i) {
        const double middle = 0.5 * (low + high);
        const glm::dvec3 ray = std::cos(middle) * camera.forward + std::sin(middle) * camera.up;
        const double along_m = -dot(from_earth, ray);
        const bool meets = along_m > 0 && length(from_earth + along_m * ray) < kSphere_m;
        (meets ? low : high) = middle;
    }
    return 0.5 * (1 - std::tan(low) / std::tan(camera.fov_y_rad / 2));
}

TEST(Aerial, ShowsGroundHorizonAndMostPosts) {
    const DefaultDay day({radians(46), 0, 0});
    for (const double turned_deg : {0.0, 20.0, 77.0})
        for (const double width_m : {2e3, 40e3, 110e3, 500e3})
            for (const double shape : {0.7, 1.0, 1.4}) {
                const GroundNet net =
                    dem_net(width_m, shape * width_m, turned_deg,
                            [&](double u, double v) { return width_m / 50e3 * hills_m(u, v); });
                const AerialGround ground = aerial_of(net);
                const AerialFraming framing = frame_aerial(kAerial, net, ground, day);
                SCOPED_TRACE(::testing::Message() << turned_deg << " " << width_m << " " << shape);
                EXPECT_GE(framing.aspect.filled, 0.45);
                for (const double aspect : {1.0, 1.25, 16.0 / 9}) {
                    const Camera camera = aerial_camera_of(framing.orbit, ground, aspect);
                    EXPECT_GE(share_in_picture(camera, ground.posts, aspect), 0.8) << aspect;
                    EXPECT_GE(horizon_at(camera), 0.07) << aspect;
                    EXPECT_LE(horizon_at(camera), aspect > 1 ? 0.21 : 0.26) << aspect;
                }
            }
}

TEST(Aerial, StandsAFewDegreesBesideTheNormalOfASide) {
    const DefaultDay day({radians(46), 0, 0});
    for (const double turned_deg : {0.0, 12.0, 33.0, 61.0, 85.0}) {
        const GroundNet net = dem_net(60e3, 50e3, turned_deg, hills_m);
        const Orbit orbit = frame_aerial(kAerial, net, aerial_of(net), day).orbit;
        const double off = std::abs(std::remainder(*orbit.azimuth_deg - turned_deg, 90));
        EXPECT_GE(off, 2) << turned_deg;
        EXPECT_LE(off, 12) << turned_deg;
    }
}

TEST(Aerial, TheNearEdgeIsBelowThePictureAndTheFarEdgeInIt) {
    const DefaultDay day({radians(46), 0, 0});
    const GroundNet net = dem_net(60e3, 60e3, 0, hills_m);
    const AerialGround ground = aerial_of(net);
    const Orbit orbit = frame_aerial(kAerial, net, ground, day).orbit;
    for (const double aspect : {0.4, 1.0, 1.25, 2.0, 4.0}) {
        const Camera camera = aerial_camera_of(orbit, ground, aspect);
        const glm::dvec3 right = cross(camera.forward, camera.up);
        const double tan_y = std::tan(camera.fov_y_rad / 2);
        const glm::dvec3 away = normalize(glm::dvec3(camera.forward.x, camera.forward.y, 0));
        int near_edge = 0;
        for (const glm::dvec3& post : ground.posts) {
            const glm::dvec3 at = post - camera.eye_m;
            const double depth_m = dot(at, camera.forward);
            const double x = dot(at, right) / depth_m / tan_y / aspect;
            const double y = dot(at, camera.up) / depth_m / tan_y;
            EXPECT_GT(depth_m, 0);
            EXPECT_LE(y, 0.8) << aspect;
            const double across = std::max(std::abs(post.x), std::abs(post.y));
            const bool is_near =
                across > 29.9e3 && dot(normalize(glm::dvec3(post.x, post.y, 0)), away) < -0.75;
            if (!is_near || std::abs(x) > 1) continue;
            ++near_edge;
            EXPECT_LE(y, -0.95) << aspect;
        }
        EXPECT_GT(near_edge, 3) << aspect;
    }
}

// What panels leave of a small window is taller than wide, whatever the window is.
TEST(Aerial, FillsATallRoomBesidePanels) {
    const DefaultDay day({radians(46), 0, 0});
    const GroundNet net = dem_net(60e3, 60e3, 0, hills_m);
    const AerialGround ground = aerial_of(net);
    const Orbit orbit = frame_aerial(kAerial, net, ground, day).orbit;
    constexpr double kAspect = 4.0 / 3;
    const Insets insets{.left = 0.45, .bottom = 0.07, .top = 0.04};
    const Camera camera = aerial_camera(orbit, ground, aerial_fov_rad(kAspect), kAspect, insets);
    double highest = -1;
    for (const glm::dvec3& post : ground.posts) {
        const glm::dvec3 at = post - camera.eye_m;
        highest = std::max(
            highest, dot(at, camera.up) / dot(at, camera.forward) / std::tan(camera.fov_y_rad / 2));
    }
    // Of the free height, from its lower edge.
    const double filled = (0.5 * (1 + highest) - insets.bottom) / (1 - insets.bottom - insets.top);
    EXPECT_GT(filled, 0.4);
    EXPECT_LT(filled, 0.9);
}

TEST(Aerial, AnglesDependOnTheDemAloneAndGivenOnesStay) {
    const DefaultDay day({radians(46), 0, 0});
    const GroundNet net = dem_net(60e3, 50e3, 10, hills_m);
    const AerialGround ground = aerial_of(net);
    const Framing open = frame_ground(kAerial, net, ground, day);
    EXPECT_TRUE(open.orbit.aerial);
    const Framing again = frame_ground(open.orbit, net, ground, day);
    EXPECT_EQ(again.orbit.azimuth_deg, open.orbit.azimuth_deg);
    EXPECT_FALSE(again.by_relief);
    const Orbit given{.azimuth_deg = 77, .aerial = true};
    EXPECT_EQ(frame_ground(given, net, ground, day).orbit.azimuth_deg, 77);
}

TEST(Aerial, LandAloneIsInThePictureWithItsSea) {
    const DefaultDay day({0, 0, 0});
    const auto island_m = [](double u, double v) { return std::hypot(u, v) < 0.15 ? 500.0 : 0.0; };
    const GroundNet net = dem_net(100e3, 100e3, 0, island_m);
    AerialGround land{.land_alone = true};
    for (const glm::dvec3& post : net)
        if (post.z > 100) land.posts.push_back(post);
    const Orbit orbit = frame_aerial(kAerial, net, land, day).orbit;
    const Camera camera = aerial_camera_of(orbit, land, 1.25);
    EXPECT_EQ(share_in_picture(camera, land.posts, 1.25), 1);
    EXPECT_LT(distance(camera.eye_m, glm::dvec3(0)), 60e3);
}

TEST(Aerial, GlobesLinesStripsAndContinentsHaveNone) {
    const DefaultDay day({radians(46), 0, 0});
    const GroundNet wide = dem_net(3000e3, 2000e3, 0, hills_m);
    EXPECT_FALSE(frame_ground(kAerial, wide, aerial_of(wide), day).orbit.aerial);
    const GroundNet line = dem_net(3e3, 0, 0, hills_m);
    EXPECT_FALSE(frame_ground(kAerial, line, aerial_of(line), day).orbit.aerial);
    for (const double turned_deg : {0.0, 45.0}) {
        const GroundNet strip = dem_net(60e3, 17e3, turned_deg, hills_m);
        EXPECT_FALSE(frame_ground(kAerial, strip, aerial_of(strip), day).orbit.aerial);
        const GroundNet shorter = dem_net(60e3, 23e3, turned_deg, hills_m);
        EXPECT_TRUE(frame_ground(kAerial, shorter, aerial_of(shorter), day).orbit.aerial);
    }
    const GroundNet net = dem_net(60e3, 60e3, 0, hills_m);
    const DefaultDay globe({0, 0, 0}, /*globe=*/true);
    EXPECT_FALSE(frame_ground(kAerial, net, aerial_of(net), globe).orbit.aerial);
}

TEST(Aerial, VoidsAtTheEdgeLeaveEnoughPostsInThePicture) {
    const DefaultDay day({radians(46), 0, 0});
    const auto diamond_m = [](double u, double v) {
        return std::abs(u) + std::abs(v) < 0.32 ? hills_m(u, v) : std::nan("");
    };
    const GroundNet net = dem_net(20e3, 20e3, 0, diamond_m);  // 80 % voids
    const AerialGround ground = aerial_of(net);
    const AerialFraming framing = frame_aerial(kAerial, net, ground, day);
    EXPECT_GE(framing.aspect.posts, 0.8);
    // The sides of the ground, not of the grid.
    EXPECT_NEAR(std::abs(std::remainder(*framing.orbit.azimuth_deg - 45, 90)), 7, 3);
}

TEST(Aerial, WhatIsSmallAndCutOutInlandIsSeenAsAWholeAndAnIslandIsNot) {
    for (const double width_m : {3e3, 20e3})
        for (const double lowest_m : {500.0, 0.0}) {
            const auto cut_m = [&](double u, double v) {
                return std::abs(u) + std::abs(v) < 0.5 ? lowest_m + 400 + hills_m(u, v)
                                                       : std::nan("");
            };
            const GroundNet net = dem_net(width_m, width_m, 0, cut_m);  // half of it is void
            EXPECT_EQ(has_aerial_view(net, aerial_of(net)), lowest_m == 0 || width_m > 5e3);
        }
    const auto corner_m = [](double u, double v) { return u + v > 0.4 ? std::nan("") : 500.0; };
    const GroundNet most = dem_net(20e3, 20e3, 0, corner_m);
    EXPECT_TRUE(has_aerial_view(most, aerial_of(most)));
}

TEST(Aerial, LooksFromLandOverTheSeaAndKeepsSummitsInThePicture) {
    const DefaultDay day({radians(46), 0, 0});
    const auto coast_m = [](double, double v) {
        return v > 0.05 ? 400 * std::sin(kPi * (v - 0.05) / 0.45) : 0.0;
    };
    const GroundNet coast = dem_net(40e3, 40e3, 0, coast_m);
    const AerialFraming from_land = frame_aerial(kAerial, coast, aerial_of(coast), day);
    EXPECT_GT(std::cos(radians(*from_land.orbit.azimuth_deg)), 0.9) << "the land is in the north";
    EXPECT_LT(from_land.aspect.sea, 0.5);
    // A lone summit in a corner.
    const auto summit_m = [](double u, double v) {
        return 100 + 3000 * std::exp(-60 * ((u - 0.4) * (u - 0.4) + (v + 0.4) * (v + 0.4)));
    };
    const GroundNet lone = dem_net(40e3, 40e3, 0, summit_m);
    EXPECT_EQ(frame_aerial(kAerial, lone, aerial_of(lone), day).aspect.summits, 1);
}

}  // namespace
}  // namespace relevo::scene
