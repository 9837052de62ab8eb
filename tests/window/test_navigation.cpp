// How the hand moves the camera, in numbers.
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "base/units.h"
#include "support/support.h"
#include "viewer/document.h"
#include "viewer/navigation.h"
#include "viewer/overlay.h"

namespace relevo::viewer::test_navigation {
namespace {

constexpr double kAspect = 1.5;

class Navigation : public testing::Test {
  protected:
    Navigation() {
        land_.frame = &frame_;
        land_.height_m = land_.aim_m = [](const geo::Geodetic&) { return 500.0; };
        pose_.eye_m = at(46.0, 8.0, 3000);
        pose_.heading_deg = 30;
        pose_.pitch_deg = -25;
        pose_.fov_y_rad = radians(40.0);
    }
    glm::dvec3 at(double lat_deg, double lon_deg, double height_m) const {
        return frame_.to_local(geo::geodetic_deg(lat_deg, lon_deg, height_m));
    }
    glm::dvec2 seen(const Pose& pose, const glm::dvec3& point_m) const {
        return in_picture(camera_of(pose, land_), point_m, kAspect).value();
    }
    /// Where a ray of the picture meets level ground, nearly.
    glm::dvec3 ground(const Pose& pose, glm::dvec2 in) const {
        const glm::dvec3 direction = ray(camera_of(pose, land_), in, kAspect);
        const glm::dvec3 up = land_.axes(pose.eye_m).up;
        return pose.eye_m + 2500 / -dot(direction, up) * direction;
    }

    geo::LocalFrame frame_{geo::geodetic_deg(46.1, 8.1, 0)};
    Land land_;
    Pose pose_;
};

TEST_F(Navigation, APoseComesBackFromItsCameraAndItsView) {
    const Pose back = pose_of(camera_of(pose_, land_), land_);
    EXPECT_NEAR(back.heading_deg, 30, 1e-9);
    EXPECT_NEAR(back.pitch_deg, -25, 1e-9);
    EXPECT_LT(distance(back.eye_m, pose_.eye_m), 1e-6);
    land_.exaggeration = 2;
    const scene::View view = view_of(pose_, land_);
    const scene::Camera camera =
        scene::make_camera(view, land_.height_m, frame_, {}, kAspect, land_.exaggeration);
    EXPECT_LT(distance(camera.eye_m, pose_.eye_m), 1e-6);
    EXPECT_GT(dot(camera.forward, camera_of(pose_, land_).forward), 1 - 1e-12);
    // Straight down the heading is where the top of the picture is.
    pose_.pitch_deg = -90;
    EXPECT_NEAR(pose_of(camera_of(pose_, land_), land_).heading_deg, 30, 1e-6);
}

TEST_F(Navigation, LooksAtAPointFromWhereItLooks) {
    const glm::dvec3 point = at(46.05, 8.2, 500);
    const Pose there = look_at(pose_, land_, point, 3000);
    EXPECT_NEAR(distance(there.eye_m, point), 3000, 1e-6);
    EXPECT_LT(length(seen(there, point)), 0.01);  // the Earth turns a little under the way
    EXPECT_EQ(there.heading_deg, pose_.heading_deg);
    EXPECT_EQ(there.pitch_deg, pose_.pitch_deg);
    // Whoever looks at the horizon looks down at it.
    pose_.pitch_deg = 5;
    EXPECT_EQ(look_at(pose_, land_, point, 3000).pitch_deg, -20);
    EXPECT_LT(length(seen(look_at(pose_, land_, point, 3000), point)), 0.01);
}

TEST_F(Navigation, OnlyTheGroundHasAHeightWhereItIsDrawn) {
    land_.exaggeration = 2;
    EXPECT_EQ(drawn_height_m(at(46.0, 8.0, 1000), land_, 10), 500);
    // Drawn coarsely, and on a wall below it.
    EXPECT_EQ(drawn_height_m(at(46.0, 8.0, 991), land_, 10), 500);
    EXPECT_EQ(drawn_height_m(at(46.0, 8.0, 1300), land_, 10), 500);
    EXPECT_TRUE(std::isnan(drawn_height_m(at(46.0, 8.0, 989), land_, 10)));
    // A picture whose tile pages are not all there yet may be far below the posts.
    const auto tolerance_m = [](bool is_sharp, bool has_walls) {
        return height_tolerance_m(is_sharp, has_walls, /*px_m=*/1, /*spacing_m=*/80);
    };
    EXPECT_EQ(drawn_height_m(at(46.0, 8.0, 700), land_, tolerance_m(false, false)), 500);
    EXPECT_TRUE(std::isnan(drawn_height_m(at(46.0, 8.0, 700), land_, tolerance_m(false, true))));
    EXPECT_TRUE(std::isnan(drawn_height_m(at(46.0, 8.0, 700), land_, tolerance_m(true, false))));
    land_.height_m = [](const geo::Geodetic&) { return std::nan(""); };
    EXPECT_TRUE(std::isnan(drawn_height_m(at(46.0, 8.0, 700), land_, tolerance_m(false, false))));
    EXPECT_TRUE(std::isnan(drawn_height_m(at(46.0, 8.0, 1000), land_, 10)));
}

TEST_F(Navigation, PlacesInThePictureAreWhereTheirRaysGo) {
    for (const glm::dvec2 in : {glm::dvec2(0, 0), glm::dvec2(0.7, -0.4), glm::dvec2(-1, 1)}) {
        const glm::dvec3 point = pose_.eye_m + 1234.0 * ray(camera_of(pose_, land_), in, kAspect);
        EXPECT_LT(distance(seen(pose_, point), in), 1e-9);
    }
    EXPECT_FALSE(in_picture(camera_of(pose_, land_), pose_.eye_m - camera_of(pose_, land_).forward,
                            kAspect));
}

TEST_F(Navigation, OrbitingKeepsThePointWhereItIsAndThePictureUpright) {
    const glm::dvec3 pivot = ground(pose_, {0.4, -0.3});
    const Pose turned = orbit(pose_, land_, pivot, 70, 12);
    EXPECT_LT(distance(seen(turned, pivot), seen(pose_, pivot)), 2e-3);
    EXPECT_NEAR(distance(turned.eye_m, pivot), distance(pose_.eye_m, pivot), 1e-3);
    EXPECT_NEAR(turned.pitch_deg, -37, 0.05);
    // 70 degrees to the left as seen from above, that is the camera turns that way.
    EXPECT_NEAR(turned.heading_deg, 360 + 30 - 70, 0.1);
    // Neither over the top nor through the ground.
    EXPECT_GE(orbit(pose_, land_, pivot, 0, 500).pitch_deg, -89.9);
    const Pose low = orbit(pose_, land_, pivot, 0, -500);
    EXPECT_GE(frame_.to_geodetic(low.eye_m).height_m, 500 + kClearance_m - 1e-6);
}

TEST_F(Navigation, PanningBringsTheGrabbedGroundUnderTheHand) {
    const glm::dvec3 grabbed = ground(pose_, {0.2, -0.2});
    const Pose moved = pan(pose_, land_, grabbed, {-0.3, -0.5}, kAspect);
    // The ground falls away a little over so many kilometres.
    EXPECT_LT(distance(seen(moved, grabbed), glm::dvec2(-0.3, -0.5)), 2e-3);
    EXPECT_NEAR(moved.heading_deg, pose_.heading_deg, 1e-12);
    // Not towards the sky, where there is no ground to be held.
    EXPECT_EQ(pan(pose_, land_, grabbed, {0, 3}, kAspect).eye_m, pose_.eye_m);
}

TEST_F(Navigation, ZoomingKeepsThePointUnderTheCursor) {
    const glm::dvec3 point = ground(pose_, {0.6, 0.1});
    const Pose nearer = zoom(pose_, land_, point, 0.25);
    // The horizon of the place that it comes to is a little aslant.
    EXPECT_LT(distance(seen(nearer, point), seen(pose_, point)), 5e-4);
    EXPECT_NEAR(distance(nearer.eye_m, point), 0.25 * distance(pose_.eye_m, point), 1e-3);
    // However often, it never goes through.
    Pose nearest = pose_;
    for (int i = 0; i < 100; ++i)
        nearest = zoom(nearest, land_, point, 0.5);
    EXPECT_GE(frame_.to_geodetic(nearest.eye_m).height_m, 500 + kClearance_m - 1e-6);
}

TEST_F(Navigation, WalkingStaysAtEyeHeightAndFlyingAboveTheGround) {
    // A slope up to the north.
    land_.aim_m = [](const geo::Geodetic& place) {
        return 500 + 20000 * (degrees(place.lat_rad) - 46.0);
    };
    pose_.heading_deg = 0;
    Pose walker = walk(pose_, land_, {0, 0});
    for (int i = 0; i < 50; ++i)
        walker = walk(walker, land_, {0, 20});
    const geo::Geodetic place = frame_.to_geodetic(walker.eye_m);
    EXPECT_NEAR(place.height_m, land_.aim_m(place) + kWalk_m, 1e-6);
    EXPECT_NEAR(place.lat_rad, radians(46.0) + 1000 / 6367000.0, 1e-5);
    Pose flyer = pose_;
    flyer.pitch_deg = -80;
    for (int i = 0; i < 100; ++i)
        flyer = fly(flyer, land_, {0, 100, 0});
    const geo::Geodetic down = frame_.to_geodetic(flyer.eye_m);
    EXPECT_GE(down.height_m, land_.aim_m(down) + kClearance_m - 1e-6);
    // No ground, no walk.
    land_.aim_m = [](const geo::Geodetic&) { return std::numeric_limits<double>::quiet_NaN(); };
    EXPECT_EQ(walk(pose_, land_, {0, 5}).eye_m, pose_.eye_m);
}

TEST_F(Navigation, StandsAtAPointAndTurnsToOne) {
    const glm::dvec3 point = ground(pose_, {0.3, -0.2});
    pose_.pitch_deg = -90;
    const Pose standing = stand(pose_, land_, point).value();
    const geo::Geodetic eye = frame_.to_geodetic(standing.eye_m), at = frame_.to_geodetic(point);
    EXPECT_NEAR(eye.lat_rad, at.lat_rad, 1e-12);
    EXPECT_NEAR(eye.lon_rad, at.lon_rad, 1e-12);
    EXPECT_NEAR(eye.height_m, 500 + kWalk_m, 1e-6);
    EXPECT_EQ(standing.heading_deg, pose_.heading_deg);
    EXPECT_EQ(standing.pitch_deg, 0);  // not at the feet
    const glm::dvec3 other = ground(pose_, {-0.7, 0.4});
    const Pose turned = facing(standing, land_, other);
    EXPECT_EQ(turned.eye_m, standing.eye_m);
    EXPECT_LT(distance(camera_of(turned, land_).forward, normalize(other - turned.eye_m)), 1e-9);
    land_.aim_m = [](const geo::Geodetic&) { return std::numeric_limits<double>::quiet_NaN(); };
    EXPECT_FALSE(stand(pose_, land_, point));
}

TEST_F(Navigation, APictureOfWhatThePanelsLeaveFreeHasItInItsMiddle) {
    const scene::Insets insets{.left = 0.3, .right = 0, .bottom = 0.05, .top = 0.03};
    const double window = 1.6;
    const scene::Camera before = camera_of(pose_, land_);
    for (const double picture : {0.5, 1.2, 2.0}) {
        const Pose turned = centred(pose_, land_, insets, window, picture);
        const scene::Camera camera = camera_of(turned, land_);
        EXPECT_EQ(turned.eye_m, pose_.eye_m);
        // What is as far from both ends is in the middle.
        const auto cosine = [&](glm::dvec2 at) {
            return dot(camera.forward, ray(before, at, window));
        };
        EXPECT_NEAR(cosine({-0.4, 0.02}), cosine({1, 0.02}), 2e-3);
        EXPECT_NEAR(cosine({0.3, -0.9}), cosine({0.3, 0.94}), 2e-3);
        // The ends of the free part are inside, and one pair is at the edges.
        double out = 0;
        for (const glm::dvec2 at : {glm::dvec2(-0.4, 0.02), glm::dvec2(1, 0.02),
                                    glm::dvec2(0.3, -0.9), glm::dvec2(0.3, 0.94)}) {
            const glm::dvec2 seen =
                in_picture(camera, pose_.eye_m + 1e4 * ray(before, at, window), picture).value();
            out = std::max({out, std::abs(seen.x), std::abs(seen.y)});
        }
        EXPECT_GT(out, 0.9);
        EXPECT_LT(out, 1.15);
    }
    // Without panels it is the window.
    const Pose same = centred(pose_, land_, {}, window, window);
    EXPECT_NEAR(same.heading_deg, pose_.heading_deg, 1e-6);
    EXPECT_NEAR(same.fov_y_rad, pose_.fov_y_rad, 0.02);
}

TEST_F(Navigation, StandsOnTheGroundAsItIsDrawn) {
    land_.exaggeration = 3;  // the ground is at 1500 m
    const auto height_m = [&](const Pose& pose) { return frame_.to_geodetic(pose.eye_m).height_m; };
    EXPECT_NEAR(height_m(walk(pose_, land_, {10, 20})), 1500 + kWalk_m, 1e-6);
    Pose down = pose_;
    down.pitch_deg = -80;
    for (int i = 0; i < 100; ++i)
        down = fly(down, land_, {0, 100, 0});
    EXPECT_NEAR(height_m(down), 1500 + kClearance_m, 1e-6);
    EXPECT_NEAR(land_.ground_under(pose_.eye_m), 1500, 1e-9);
    // A view that is kept is found again on ground that is drawn otherwise by then.
    Document document;
    document.pose = pose_;
    const SavedView saved = saved_view(document, land_, "kept");
    EXPECT_NEAR(saved.eye.height_m, 1000, 1e-3);
    EXPECT_LT(distance(viewer::pose_of(saved, land_).eye_m, pose_.eye_m), 1e-3);
    land_.exaggeration = 2;
    EXPECT_NEAR(height_m(viewer::pose_of(saved, land_)), 2000, 1e-3);
}

TEST_F(Navigation, ZoomingFromStraightAboveKeepsNorthUp) {
    Pose above = from_above(pose_, land_, at(46.05, 8.05, 500), 4000);
    const glm::dvec3 aside = at(46.05, 8.07, 500);
    const glm::dvec2 before = seen(above, aside);
    for (int i = 0; i < 5; ++i)
        above = zoom(above, land_, aside, 0.8);
    EXPECT_NEAR(above.heading_deg, 0, 1e-9);
    EXPECT_LT(distance(seen(above, aside), before), 2e-3);
}

TEST_F(Navigation, FromAboveNorthIsUp) {
    const glm::dvec3 point = at(46.05, 8.05, 500);
    const Pose above = from_above(pose_, land_, point, 4000);
    EXPECT_LT(length(seen(above, point)), 1e-6);
    const glm::dvec2 north = seen(above, at(46.06, 8.05, 500));
    EXPECT_NEAR(north.x, 0, 1e-3);
    EXPECT_GT(north.y, 0.5);
}

TEST(SlopeText, IsSlopeAndAspectInWords) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(slope_text(2.94, 180), "2.9 degrees, facing S");
    EXPECT_EQ(slope_text(31, -46), "31.0 degrees, facing NW");
    EXPECT_EQ(slope_text(0, none), "0.0 degrees");
    EXPECT_EQ(slope_text(none, none), "");
}

}  // namespace
}  // namespace relevo::viewer::test_navigation
