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
    return make_camera(view, ground_m, frame, points, 1.25, exaggeration);
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

TEST(View, AnglesBeyondATurnAreThoseWithin) {
    // A scene's file holds -360 to 360: what the command line takes has to be read again.
    EXPECT_EQ(parse_orbit("az=400").azimuth_deg, 40);
    EXPECT_EQ(parse_orbit("az=-725").azimuth_deg, -5);
    for (const double kept : {-360.0, -0.5, 0.0, 210.0, 360.0})
        EXPECT_EQ(within_a_turn_deg(kept), kept);
    EXPECT_LE(std::abs(within_a_turn_deg(1e308)), 360);
}

}  // namespace
}  // namespace relevo::scene
