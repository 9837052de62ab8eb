#include <cmath>

#include <glm/geometric.hpp>

#include "base/units.h"
#include "scene/view.h"
#include "support/support.h"

namespace relevo::scene {
namespace {

double ground_m(const geo::Geodetic& place) {
    return place.lat_rad > radians(46.2) ? 2000 : 1000;
}

Camera camera_of(const View& view, double exaggeration) {
    const geo::LocalFrame frame(geo::geodetic_deg(46, 8, 0));
    const std::vector<glm::dvec3> points{{-1000, -1000, 0}, {1000, 1000, 0}};
    return make_camera(view, ground_m, frame, {points, {}}, 1.25, exaggeration);
}

geo::Geodetic eye_of(const View& view, double exaggeration) {
    return geo::LocalFrame(geo::geodetic_deg(46, 8, 0))
        .to_geodetic(camera_of(view, exaggeration).eye_m);
}

TEST(View, HeightsAboveGroundStandOnTheGroundAsItIsDrawn) {
    View view;
    view.eye = Standpoint{geo::geodetic_deg(46.1, 8, 30), true};
    for (const double exaggeration : {0.5, 1.0, 3.0})
        EXPECT_NEAR(eye_of(view, exaggeration).height_m, 1000 * exaggeration + 30, 1e-3);
    // Above the DEM's zero a height is one of the DEM's, and drawn as all of them are.
    view.eye->above_ground = false;
    view.eye->place.height_m = 1500;
    for (const double exaggeration : {1.0, 3.0})
        EXPECT_NEAR(eye_of(view, exaggeration).height_m, 1500 * exaggeration, 1e-3);
}

TEST(View, LooksAtTheGroundAsItIsDrawn) {
    const geo::LocalFrame frame(geo::geodetic_deg(46, 8, 0));
    View view;
    view.eye = Standpoint{geo::geodetic_deg(46.1, 8, 30), true};
    view.look_at = Standpoint{geo::geodetic_deg(46.3, 8, 5), true};
    for (const double exaggeration : {1.0, 3.0}) {
        const Camera camera = camera_of(view, exaggeration);
        geo::Geodetic target = view.look_at->place;
        target.height_m = 2000 * exaggeration + 5;
        EXPECT_NEAR(dot(camera.forward, normalize(frame.to_local(target) - camera.eye_m)), 1, 1e-9);
    }
}

TEST(View, AnOrbitInsideOfAMountainStandsOnItAsItIsDrawn) {
    View view;
    view.orbit = {.azimuth_deg = 180, .elevation_deg = 1, .zoom = 50};
    for (const double exaggeration : {1.0, 3.0})
        EXPECT_NEAR(eye_of(view, exaggeration).height_m, 1000 * exaggeration + 2, 1e-3);
}

TEST(View, ZoomGoesOnTowardsTheGroundInThePicturesMiddle) {
    const geo::LocalFrame frame(geo::geodetic_deg(46, 8, 0));
    // Hills, the highest in the middle: the ground there is nearer than on average.
    const auto hills_m = [](const geo::Geodetic& place) {
        const double x = (degrees(place.lon_rad) - 8) * 70, y = (degrees(place.lat_rad) - 46) * 100;
        if (std::abs(x) > 10.5 || std::abs(y) > 10) return std::nan("");  // outside the DEM
        return 1500 * std::exp(-(x * x + y * y) / 50) + 200 * std::sin(3 * x) * std::cos(2 * y);
    };
    constexpr double kHighest_m = 1700;
    Outline outline;
    for (int i = -10; i <= 10; ++i)
        for (int j = -10; j <= 10; ++j) {
            geo::Geodetic place = geo::geodetic_deg(46 + 0.01 * i, 8 + 0.015 * j, 0);
            for (const double height_m : {kHighest_m, -3000.0}) {  // with a block's base
                place.height_m = height_m;
                outline.points.push_back(frame.to_local(place));
            }
        }
    const auto above_m = [&](const glm::dvec3& point_m) {
        const geo::Geodetic place = frame.to_geodetic(point_m);
        return place.height_m - hills_m(place);
    };
    for (const double elevation_deg : {5.0, 30.0, 90.0}) {
        View view;
        view.orbit = {.azimuth_deg = 200.0, .elevation_deg = elevation_deg, .zoom = 1};
        const Camera whole = make_camera(view, hills_m, frame, outline, 1.25, 1);
        // The ground in the middle of the whole: walked to from the eye.
        double distance_m = 0;
        while (!(above_m(whole.eye_m + distance_m * whole.forward) <= 0))
            distance_m += 0.5;
        for (const double zoom : {0.5, 2.0, 5.0, 100.0}) {
            view.orbit.zoom = zoom;
            const Camera nearer = make_camera(view, hills_m, frame, outline, 1.25, 1);
            EXPECT_FALSE(above_m(nearer.eye_m) <= 0);
            const glm::dvec3 target_m = whole.eye_m + distance_m * whole.forward;
            EXPECT_LT(length(nearer.eye_m + distance_m / zoom * whole.forward - target_m), 2)
                << elevation_deg << " degrees, zoom " << zoom << " [m]";
        }
        view.orbit.zoom = kMaxZoom;
        // Before the DEM where its edge is in the middle.
        EXPECT_FALSE(above_m(make_camera(view, hills_m, frame, outline, 1.25, 1).eye_m) <= 1.9);
    }
}

TEST(View, AnglesBeyondATurnAreThoseWithin) {
    // A scene's file holds -360 to 360: what the command line takes has to be read again.
    EXPECT_EQ(parse_view("az=400").orbit.azimuth_deg, 40);
    EXPECT_EQ(parse_view("az=-725").orbit.azimuth_deg, -5);
    for (const double kept : {-360.0, -0.5, 0.0, 210.0, 360.0})
        EXPECT_EQ(within_a_turn_deg(kept), kept);
    EXPECT_LE(std::abs(within_a_turn_deg(1e308)), 360);
}

TEST(View, WhatIsLeftOutIsLeftOpen) {
    EXPECT_FALSE(parse_view("el=40").orbit.azimuth_deg);
    EXPECT_EQ(parse_view("el=40").orbit.elevation_deg, 40);
    EXPECT_FALSE(parse_view("az=10").orbit.elevation_deg);
    EXPECT_FALSE(parse_view("zoom=2").orbit.azimuth_deg);
}

TEST(View, IsAerialWithoutAnglesAndWords) {
    EXPECT_TRUE(View{}.orbit.aerial);
    EXPECT_TRUE(parse_view("zoom=2").orbit.aerial);
    EXPECT_TRUE(parse_view("aerial,az=170,el=20").orbit.aerial);
    EXPECT_EQ(parse_view("aerial,az=170,el=20").orbit.azimuth_deg, 170);
    for (const char* const text : {"whole", "whole,zoom=2", "az=170", "el=20", "north", "top"})
        EXPECT_FALSE(parse_view(text).orbit.aerial) << text;
    EXPECT_FALSE(parse_view("whole").orbit.azimuth_deg);
}

TEST(View, AWordIsTheSideThatTheCameraStandsOn) {
    const char* const words[] = {"north", "north-east", "east", "south-east",
                                 "south", "south-west", "west", "north-west"};
    for (int i = 0; i < 8; ++i) {
        const View view = parse_view(words[i]);
        EXPECT_EQ(view.orbit.azimuth_deg, 45 * i);
        EXPECT_FALSE(view.orbit.elevation_deg);
        EXPECT_EQ(view.fov_y_rad, 0);
    }
    const View both = parse_view("west,el=20,zoom=3");
    EXPECT_EQ(both.orbit.azimuth_deg, 270);
    EXPECT_EQ(both.orbit.elevation_deg, 20);
    EXPECT_EQ(both.orbit.zoom, 3);
}

TEST(View, TopIsAMap) {
    const Camera camera = camera_of(parse_view("top"), 1);
    EXPECT_NEAR(camera.forward.z, -1, 1e-12);
    EXPECT_NEAR(camera.up.y, 1, 1e-12);
    // A summit 1000 m high in the corner of ground 2 km wide leans out by its height times the
    // tangent there: 11 m, a hundredth of it.
    const glm::dvec3 foot{1000, 1000, 0}, summit{1000, 1000, 1000};
    const auto seen_x = [&](const glm::dvec3& point) {
        const glm::dvec3 to = point - camera.eye_m;
        return dot(to, cross(camera.forward, camera.up)) / dot(to, camera.forward) *
               dot(foot - camera.eye_m, camera.forward);
    };
    EXPECT_LT(seen_x(summit) - seen_x(foot), 12);
    EXPECT_GT(seen_x(summit) - seen_x(foot), 0);
}

}  // namespace
}  // namespace relevo::scene
