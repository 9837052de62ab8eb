#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "base/units.h"
#include "scene/ground_path.h"
#include "scene/motion.h"
#include "scene/series.h"
#include "support/support.h"

namespace relevo::scene {
namespace {

using testing::HasSubstr;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// The largest difference between neighbours, and between neighbouring differences.
struct Steps {
    double first = 0, second = 0;
};
Steps steps_of(const std::vector<double>& values) {
    Steps steps;
    for (std::size_t i = 1; i < values.size(); ++i) {
        const double step = values[i] - values[i - 1];
        steps.first = std::max(steps.first, std::abs(step));
        if (i > 1)
            steps.second = std::max(steps.second, std::abs(step - (values[i - 1] - values[i - 2])));
    }
    return steps;
}

// --- Series

TEST(Series, EasedBeginsAndEndsAtRest) {
    EXPECT_EQ(eased(0), 0);
    EXPECT_EQ(eased(1), 1);
    EXPECT_DOUBLE_EQ(eased(0.5), 0.5);
    std::vector<double> at;
    for (int i = 0; i <= 300; ++i)
        at.push_back(eased(i / 300.0));
    EXPECT_LT(at[1], 1e-4);
    EXPECT_LT(1 - at[299], 1e-4);
    EXPECT_NEAR(steps_of(at).first, 1 / (300 * kEasedMeanSpeed), 1e-9);
    // Acceleration: 1.5 over a fifth of the time at 1.25 times the mean speed.
    EXPECT_LT(steps_of(at).second, 1.5 * 1.25 * 5 / (300.0 * 300) * 1.01);
    EXPECT_TRUE(std::ranges::is_sorted(at));
}

TEST(Series, SmoothedKeepsConstantsSlopesAndEnds) {
    std::vector<double> slope;
    for (int i = 0; i < 50; ++i)
        slope.push_back(3 * i - 7);
    const std::vector<double> same = smoothed(slope, 12, Ends::Mirrored);
    for (std::size_t i = 0; i < slope.size(); ++i)
        EXPECT_NEAR(same[i], slope[i], 1e-9);
    std::vector<double> jump(50, 0);
    std::fill(jump.begin() + 25, jump.end(), 1);
    const std::vector<double> soft = smoothed(jump, 12, Ends::Mirrored);
    EXPECT_NEAR(soft.front(), 0, 1e-12);
    EXPECT_NEAR(soft.back(), 1, 1e-12);
    EXPECT_LT(steps_of(soft).first, 0.12);
    EXPECT_LT(steps_of(soft).second, 0.025);
}

TEST(Series, SmoothAboveIsNowhereBelow) {
    std::vector<double> rough;
    unsigned seed = 1;
    for (int i = 0; i < 400; ++i) {
        seed = seed * 1664525 + 1013904223;
        rough.push_back(seed >> 24);
    }
    for (const Ends ends : {Ends::Held, Ends::Cyclic})
        for (const std::size_t radius : {1, 2, 5, 40}) {
            const std::vector<double> above = smooth_above(rough, radius, ends);
            for (std::size_t i = 0; i < rough.size(); ++i)
                EXPECT_GE(above[i], rough[i] - 1e-9) << radius << " at " << i;
            EXPECT_LT(steps_of(above).first, 260.0 / static_cast<double>(radius));
        }
}

TEST(Series, StepsAreBounded) {
    std::vector<double> turn(300, 0);
    std::fill(turn.begin() + 150, turn.end(), kPi);
    const double most = radians(30) / 30;
    const std::vector<double> slow = with_steps_up_to(turn, most);
    EXPECT_LE(steps_of(slow).first, most);
    EXPECT_NEAR(slow.front(), 0, 1e-9);
    EXPECT_NEAR(slow.back(), kPi, 1e-9);
    const std::vector<double> still(10, 2.0);
    EXPECT_EQ(with_steps_up_to(still, most), still);
}

TEST(Series, GapsAreBridged) {
    EXPECT_THAT(without_gaps({kNaN, 2, kNaN, kNaN, 5, kNaN}),
                testing::ElementsAre(2, 2, 3, 4, 5, 5));
    EXPECT_TRUE(std::isnan(without_gaps({kNaN, kNaN})[0]));
    EXPECT_THAT(unwrapped({3, -3, 3}),
                testing::ElementsAre(3, testing::DoubleNear(3.283, 1e-3), 3));
}

// --- Paths

TEST(Path, IsAsLongAsItsGeodesicAndGoesByDistance) {
    const geo::Geodetic from = geo::geodetic_deg(46.5, 8), to = geo::geodetic_deg(46.9, 8.6);
    const std::vector<geo::Geodetic> places{from, to};
    const GroundPath path(places, 400);
    const double length_m = geo::geodesic(from, to).distance_m;
    EXPECT_NEAR(path.length_m(), length_m, 0.01);
    for (const double share : {0.0, 0.25, 0.5, 1.0}) {
        const geo::Geodetic at = path.at(share * path.length_m());
        EXPECT_NEAR(geo::geodesic(from, at).distance_m, share * length_m, 0.5);
        EXPECT_EQ(at.height_m, 0);
    }
    // Beyond the end it goes straight on.
    EXPECT_NEAR(geo::geodesic(to, path.at(path.length_m() + 400)).distance_m, 400, 1);
}

TEST(Path, CrossesTheDateLine) {
    const std::vector<geo::Geodetic> places{geo::geodetic_deg(-17, 179.9),
                                            geo::geodetic_deg(-17, -179.9)};
    const GroundPath path(places, 100);
    EXPECT_NEAR(path.length_m(), geo::geodesic(places[0], places[1]).distance_m, 0.1);
    EXPECT_NEAR(std::abs(degrees(path.at(path.length_m() / 2).lon_rad)), 180, 1e-6);
}

/// Switchbacks of a hiker, fixes with noise of some metres.
std::vector<geo::Geodetic> hike() {
    std::vector<geo::Geodetic> places;
    unsigned seed = 7;
    const auto noise = [&] {
        seed = seed * 1664525 + 1013904223;
        return (static_cast<double>(seed >> 16) / 65536 - 0.5) * 1e-4;
    };
    for (int i = 0; i < 4000; ++i)
        places.push_back(geo::geodetic_deg(46.5 + i * 1e-5 + noise(),
                                           8 + 0.002 * std::asin(std::sin(i / 30.0)) + noise()));
    return places;
}

TEST(Path, SmoothingCutsBendsAndKeepsEnds) {
    const std::vector<geo::Geodetic> places = hike();
    const GroundPath path(places, 400);
    EXPECT_LT(geo::geodesic(places.front(), path.at(0)).distance_m, 0.1);
    EXPECT_LT(geo::geodesic(places.back(), path.at(path.length_m())).distance_m, 0.1);
    std::vector<double> headings;
    for (double at_m = 0; at_m + 10 < path.length_m(); at_m += 10)
        headings.push_back(geo::geodesic(path.at(at_m), path.at(at_m + 10)).azimuth_rad);
    const Steps steps = steps_of(unwrapped(headings));
    EXPECT_LT(degrees(steps.first), 4);
    EXPECT_LT(degrees(steps.second), 1);
}

TEST(Path, SaysWhatIsNone) {
    const auto error = [](const std::vector<geo::Geodetic>& places) {
        return test::error_of([&] { GroundPath(places, 400); });
    };
    const geo::Geodetic here = geo::geodetic_deg(46, 8);
    EXPECT_EQ(error({}), "exit 3: expected two places or more but got none");
    EXPECT_EQ(error({here}), "exit 3: expected two different places or more but got one");
    EXPECT_EQ(error({here, here}),
              "exit 3: expected two different places or more but got the same one again");
    EXPECT_EQ(error({here, {kNaN, 0, 0}}), "exit 3: expected places but number 2 is nan,0");
}

// --- Motions

std::vector<View> views_of(const FlightMotion& motion, const MotionGround& ground) {
    std::string warning;
    return flight_views(motion, View(), ground, warning);
}

/// Hills of 300 m, 2 km apart, with a wall of 200 m across, and no ground beyond 12 km.
MotionGround hills(double exaggeration = 1) {
    const geo::LocalFrame frame(geo::geodetic_deg(46.5, 8));
    MotionGround ground{.height_m =
                            [frame](const geo::Geodetic& at) {
                                const glm::dvec3 p = frame.to_local({at.lat_rad, at.lon_rad, 0});
                                if (std::abs(p.x) > 12000 || std::abs(p.y) > 12000) return kNaN;
                                const double wall = std::abs(p.x - 500) < 30 ? 200 : 0;
                                return 500 + 300 * std::sin(p.x / 318) * std::cos(p.y / 318) + wall;
                            },
                        .frame = frame,
                        .exaggeration = exaggeration,
                        .aspect = 16.0 / 9};
    for (const double x : {-12000., 0., 12000.})
        for (const double y : {-12000., 0., 12000.})
            ground.points.push_back({x, y, 500 * exaggeration});
    ground.camera = [frame, exaggeration, height_m = ground.height_m,
                     points = ground.points](const View& view) {
        return make_camera(view, height_m, frame, {points, {}}, 16.0 / 9, exaggeration);
    };
    return ground;
}

geo::Geodetic place(const MotionGround& ground, double x, double y) {
    geo::Geodetic at = ground.frame.to_geodetic({x, y, 0});
    at.height_m = 0;
    return at;
}

double above_m(const View& view, const MotionGround& ground) {
    return (view.eye->place.height_m - ground.height_m(view.eye->place)) * ground.exaggeration;
}

/// Headings, pitches and places of views, by their largest steps.
struct Smoothness {
    Steps heading_deg, pitch_deg, height_m, x_m, y_m;
};
Smoothness smoothness_of(const std::vector<View>& views, const MotionGround& ground) {
    std::vector<double> headings, pitches, heights, xs, ys;
    for (const View& view : views) {
        headings.push_back(radians(view.heading_deg));
        pitches.push_back(view.pitch_deg);
        heights.push_back(view.eye->place.height_m);
        const glm::dvec3 at = ground.frame.to_local(view.eye->place);
        xs.push_back(at.x);
        ys.push_back(at.y);
    }
    headings = unwrapped(headings);
    for (double& heading : headings)
        heading = degrees(heading);
    return {steps_of(headings), steps_of(pitches), steps_of(heights), steps_of(xs), steps_of(ys)};
}

TEST(Flight, AlongALineIsSmoothAndAboveTheGround) {
    for (const double exaggeration : {1.0, 2.0}) {
        const MotionGround ground = hills(exaggeration);
        FlightMotion motion{.height_m = 100, .frames = 600};
        for (const auto& [x, y] :
             {std::pair(-6000, -3000), {-2000, 1000}, {2500, -500}, {6000, 2500}})
            motion.along.push_back(place(ground, x, y));
        const std::vector<View> views = views_of(motion, ground);
        ASSERT_EQ(views.size(), 600u);
        for (const View& view : views)
            EXPECT_GE(above_m(view, ground), 100 - 0.5);
        const Smoothness smooth = smoothness_of(views, ground);
        double length_m = 0, longest_m = 0;
        for (std::size_t i = 1; i < views.size(); ++i) {
            const double step_m =
                geo::geodesic(views[i - 1].eye->place, views[i].eye->place).distance_m;
            length_m += step_m;
            longest_m = std::max(longest_m, step_m);
        }
        EXPECT_NEAR(length_m, 15010, 150);  // of the polyline
        EXPECT_LT(longest_m, 1.001 * length_m / 599 / kEasedMeanSpeed);
        EXPECT_LT(smooth.x_m.second, 0.6);
        EXPECT_LT(smooth.height_m.second, 0.7 * exaggeration);
        EXPECT_LE(smooth.heading_deg.first, 1.0001);
        EXPECT_LT(smooth.heading_deg.second, 0.06);
        EXPECT_LT(smooth.pitch_deg.second, 0.15 * exaggeration);
        EXPECT_NEAR(degrees(views.front().eye->place.lat_rad), degrees(motion.along[0].lat_rad),
                    1e-6);
        EXPECT_NEAR(degrees(views.back().eye->place.lon_rad), degrees(motion.along[3].lon_rad),
                    1e-6);
        // It looks ahead and down.
        EXPECT_NEAR(views.front().heading_deg, degrees(std::atan2(4000, 4000)), 15);
    }
}

TEST(Flight, SharpTurnsAreTakenSlowly) {
    const MotionGround ground = hills();
    FlightMotion motion{.look_ahead_m = 100, .frames = 600};
    for (const auto& [x, y] : {std::pair(-4000, 0), {4000, 0}, {-4000, 30}})
        motion.along.push_back(place(ground, x, y));
    const Smoothness smooth = smoothness_of(views_of(motion, ground), ground);
    EXPECT_LE(smooth.heading_deg.first, kMostTurn_deg_s / 30 + 1e-9);
    EXPECT_LT(smooth.heading_deg.second, 0.1);
}

View looking_from(const MotionGround& ground, double x, double y, double agl_m, double heading,
                  double pitch) {
    View view;
    view.eye = Standpoint{place(ground, x, y), true};
    view.eye->place.height_m = agl_m;
    view.heading_deg = heading;
    view.pitch_deg = pitch;
    return view;
}

TEST(Flight, ThroughViewsPassesThemAndStaysAboveTheGround) {
    const MotionGround ground = hills();
    FlightMotion motion{.frames = 450};
    motion.views = {looking_from(ground, -5000, 0, 60, 350, -5),
                    looking_from(ground, 0, 3000, 300, 20, -20),
                    looking_from(ground, 0, 3000, 300, 80, -20),  // turns on the spot
                    looking_from(ground, 5000, 100, 20, 180, 3)};
    motion.views.back().fov_y_rad = radians(20);
    const std::vector<View> views = views_of(motion, ground);
    ASSERT_EQ(views.size(), 450u);
    for (const View& view : views)
        EXPECT_GE(above_m(view, ground), 19.9);
    const Smoothness smooth = smoothness_of(views, ground);
    EXPECT_LE(smooth.heading_deg.first, 1.0001);
    EXPECT_LT(smooth.heading_deg.second, 0.1);
    EXPECT_LT(smooth.pitch_deg.second, 0.05);
    EXPECT_LT(std::hypot(smooth.x_m.second, smooth.y_m.second), 2);
    EXPECT_NEAR(views.front().heading_deg, -10, 0.01);
    EXPECT_NEAR(above_m(views.front(), ground), 60, 0.5);
    EXPECT_NEAR(views.back().pitch_deg, 3, 0.01);
    EXPECT_NEAR(degrees(views.front().fov_y_rad), kDefaultFov_deg, 1e-6);
    EXPECT_NEAR(degrees(views.back().fov_y_rad), 20, 1e-6);
    // The view in the middle is passed within some metres.
    double nearest_m = 1e9;
    for (const View& view : views)
        nearest_m =
            std::min(nearest_m, geo::geodesic(view.eye->place, place(ground, 0, 3000)).distance_m);
    EXPECT_LT(nearest_m, 40);
}

TEST(Flight, OutsideTheDem) {
    const MotionGround ground = hills();
    FlightMotion motion{.frames = 100};
    motion.along = {place(ground, 20000, 0), place(ground, 30000, 0)};
    EXPECT_EQ(test::error_of([&] { views_of(motion, ground); }),
              "exit 3: expected a line over the DEM but all of it lies outside, or in voids");
    motion.along = {place(ground, 0, 0), place(ground, 20000, 0)};
    std::string warning;
    const std::vector<View> views = flight_views(motion, View(), ground, warning);
    EXPECT_EQ(warning,
              "flight: 39 % of the line has no ground; the height is kept from the nearest that it "
              "has");
    for (const View& view : views)
        EXPECT_GT(view.eye->place.height_m, 300);
    EXPECT_LT(smoothness_of(views, ground).height_m.second, 10);  // 5 km/s
}

TEST(Flight, OneFrameAndSameViews) {
    const MotionGround ground = hills();
    FlightMotion motion{.frames = 1};
    motion.along = {place(ground, 0, 0), place(ground, 2000, 0)};
    EXPECT_EQ(views_of(motion, ground).size(), 1u);
    motion.views = {looking_from(ground, 0, 0, 60, 0, 0), looking_from(ground, 0, 0, 60, 360, 0)};
    EXPECT_THAT(test::error_of([&] { views_of(motion, ground); }),
                HasSubstr("expected two different views or more"));
}

TEST(OrbitMotion, GoesRoundAtOneDistanceAndShowsAllGround) {
    const MotionGround ground = hills();
    View view;
    view.orbit = {.azimuth_deg = 200, .elevation_deg = 30};
    const std::vector<View> views = orbit_views({.turns = 1, .frames = 72}, view, ground);
    ASSERT_EQ(views.size(), 72u);
    std::vector<double> azimuths;
    double lowest = 0, highest = 0;  // in the pictures, of their half height
    const glm::dvec3 target = ground.frame.to_local(views[0].look_at->place);
    const double far_m = distance(target, ground.frame.to_local(views[0].eye->place));
    for (const View& at : views) {
        const Camera camera = ground.camera(at);
        azimuths.push_back(std::atan2(camera.eye_m.x - target.x, camera.eye_m.y - target.y));
        EXPECT_NEAR(distance(target, camera.eye_m), far_m, 0.01);
        EXPECT_NEAR(degrees(std::asin((camera.eye_m.z - target.z) / far_m)), 30, 0.2);
        const double tan_y = std::tan(camera.fov_y_rad / 2);
        for (const glm::dvec3& point : ground.points) {
            const glm::dvec3 from = point - camera.eye_m;
            const double depth = dot(from, camera.forward);
            const double y = dot(from, camera.up) / (tan_y * depth);
            lowest = std::min(lowest, y);
            highest = std::max(highest, y);
            EXPECT_LT(std::abs(y), 0.96);
            EXPECT_LT(std::abs(dot(from, cross(camera.forward, camera.up))),
                      0.96 * tan_y * ground.aspect * depth);
        }
    }
    EXPECT_NEAR(lowest, -highest, 0.02);  // in the middle of the picture
    azimuths = unwrapped(azimuths);
    EXPECT_NEAR(degrees(azimuths[0]), -160, 0.01);
    for (std::size_t i = 1; i < azimuths.size(); ++i)
        EXPECT_NEAR(degrees(azimuths[i] - azimuths[i - 1]), 5, 0.01);  // clockwise
}

TEST(OrbitMotion, AroundATargetStaysAboveTheGround) {
    const MotionGround ground = hills();
    View view = looking_from(ground, -1500, 0, 30, 0, 0);
    view.look_at = Standpoint{place(ground, 0, 0), true};
    const std::vector<View> views =
        orbit_views({.turns = -0.5, .frames = 200, .ease = true}, view, ground);
    for (const View& at : views)
        EXPECT_GE(above_m(at, ground), kClearance_m - 0.01);
    EXPECT_LT(geo::geodesic(views.front().eye->place, view.eye->place).distance_m, 0.01);
    EXPECT_LT(geo::geodesic(views.back().eye->place, place(ground, 1500, 0)).distance_m, 1);
    EXPECT_LT(smoothness_of(views, ground).height_m.second, 3);
}

TEST(OrbitMotion, NeedsATarget) {
    const MotionGround ground = hills();
    View up = looking_from(ground, 0, 0, 100, 0, 20);
    EXPECT_THAT(test::error_of([&] { orbit_views({}, up, ground); }),
                HasSubstr("looks past all ground"));
    View map;
    map.orbit = {.azimuth_deg = 180, .elevation_deg = 90};
    EXPECT_THAT(test::error_of([&] { orbit_views({}, map, ground); }),
                HasSubstr("looks straight down"));
    up.pitch_deg = -30;
    EXPECT_EQ(orbit_views({.frames = 7}, up, ground).size(), 7u);
}

}  // namespace
}  // namespace relevo::scene
