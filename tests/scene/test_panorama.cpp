// Where the pixels of a panorama look.
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "base/units.h"
#include "scene/panorama.h"
#include "support/support.h"

namespace relevo::scene {
namespace {

View view_of(Panorama kind, double hfov_deg = 360) {
    View view;
    view.eye = Standpoint{geo::geodetic_deg(47, 11, 0), true};
    view.panorama = kind;
    view.hfov_rad = radians(hfov_deg);
    return view;
}

TEST(PanoramaMap, MiddleColumnIsTheHeadingAndColumnsGoClockwise) {
    for (const Panorama kind : {Panorama::Cylindrical, Panorama::Equirectangular}) {
        const PanoramaMap map(view_of(kind), {3600, 600}, radians(90), 0);
        EXPECT_NEAR(distance(map.direction({1800, 300}), glm::dvec3(1, 0, 0)), 0, 1e-12);
        EXPECT_NEAR(distance(map.direction({2700, 300}), glm::dvec3(0, -1, 0)), 0, 1e-12);
    }
}

TEST(PanoramaMap, RowsAreElevationsOrTheirTangents) {
    const PanoramaMap sphere(view_of(Panorama::Equirectangular), {3600, 1800}, 0, radians(20));
    EXPECT_NEAR(degrees(sphere.elevation_rad(0)), 90, 1e-9);  // not turned: it reaches all
    EXPECT_NEAR(degrees(sphere.elevation_rad(600)), 30, 1e-9);
    const PanoramaMap cylinder(view_of(Panorama::Cylindrical), {3600, 600}, 0, radians(10));
    EXPECT_NEAR(degrees(cylinder.elevation_rad(300)), 10, 1e-9);
    const double up_px = 300 - (std::tan(radians(20)) - std::tan(radians(10))) * 3600 / (2 * kPi);
    EXPECT_NEAR(degrees(cylinder.elevation_rad(up_px)), 20, 1e-9);
}

TEST(PanoramaMap, ProjectIsTheInverseOfDirection) {
    for (const Panorama kind : {Panorama::Cylindrical, Panorama::Equirectangular})
        for (const double hfov_deg : {360.0, 120.0}) {
            const PanoramaMap map(view_of(kind, hfov_deg), {1201, 301}, radians(250), radians(-3));
            for (const glm::dvec2 at : {glm::dvec2(1, 1), {600.5, 150.5}, {1200, 300}}) {
                const auto back = map.project(map.direction(at));
                ASSERT_TRUE(back);
                EXPECT_NEAR(distance(*back, at), 0, 1e-6);
            }
        }
}

TEST(Panorama, HasTheLensForItsHeightWhereNoSizeIsGiven) {
    EXPECT_EQ(default_panorama_px(view_of(Panorama::Equirectangular)), glm::ivec2(4096, 2048));
    EXPECT_EQ(default_panorama_px(view_of(Panorama::Equirectangular, 180)), glm::ivec2(2048, 2048));
    View view = view_of(Panorama::Cylindrical);
    view.fov_y_rad = radians(90);
    EXPECT_EQ(default_panorama_px(view), glm::ivec2(8192, std::lround(8192 / kPi)));
    const std::string dem = R"({"format": 1, "dem": {"files": ["a.tif"]}, )";
    const std::string camera = R"("camera": {"eye": [47, 11], "panorama": "equirectangular"})";
    const Scene unsized = read_scene_text(dem + camera + "}", "s.json", "");
    EXPECT_EQ(glm::ivec2(unsized.width_px, unsized.height_px), glm::ivec2(4096, 2048));
    const Scene sized =
        read_scene_text(dem + camera + R"(, "picture": {"size": [800, 300]}})", "s.json", "");
    EXPECT_EQ(glm::ivec2(sized.width_px, sized.height_px), glm::ivec2(800, 300));
}

TEST(Panorama, IsRefusedWithoutAnEyeAndBeyondThePoles) {
    Scene scene;
    scene.view = view_of(Panorama::Equirectangular);
    scene.width_px = 1000;
    scene.height_px = 500;
    EXPECT_NO_THROW(check_panorama(scene));
    scene.height_px = 501;
    EXPECT_EQ(test::error_of([&] { check_panorama(scene); }),
              "exit 3: --panorama: 1000 x 501 px across 360 degrees reach beyond the zenith and "
              "the nadir; "
              "use at most 500 px of height");
    scene.view.eye.reset();
    EXPECT_EQ(test::error_of([&] { check_panorama(scene); }),
              "exit 3: --panorama: needs a place to stand; add --eye LAT,LON");
}

}  // namespace
}  // namespace relevo::scene
