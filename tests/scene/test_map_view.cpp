#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "scene/map_view.h"
#include "scene/scene.h"
#include "support/support.h"

namespace relevo::scene {
namespace {

const geo::Crs kUtm = geo::Crs::parse("EPSG:32632", "test");

/// 300 x 200 cells of 30 m, the first post at (400015, 5299985).
dem::Grid straight() {
    return {300, 200, {400015, 30, 0, 5299985, 0, -30}, kUtm};
}

/// The same cells, turned by 20 degrees about the first post.
dem::Grid turned() {
    const double c = 30 * std::cos(0.349), s = 30 * std::sin(0.349);
    return {300, 200, {400015, c, s, 5299985, s, -c}, kUtm};
}

TEST(MapView, EndsAtTheEdgesOfTheCells) {
    const MapArea area = map_area(straight(), 0, {600, 400});
    EXPECT_EQ(area, (MapArea{400000, 5300000, 15, 15, 600, 400}));
    EXPECT_EQ(area.geotransform(), (std::array<double, 6>{400000, 15, 0, 5300000, 0, -15}));
}

TEST(MapView, HasYUpwardsWhicheverWayRowsRun) {
    const dem::Grid northwards(300, 200, {400015, 30, 0, 5294015, 0, 30}, kUtm);
    EXPECT_EQ(map_area(northwards, 0, {600, 400}), map_area(straight(), 0, {600, 400}));
}

TEST(MapView, ContainsATurnedGrid) {
    const dem::Grid grid = turned();
    const MapArea area = map_area(grid, 10, {0, 0});
    const geo::LocalFrame frame(grid.center());
    const glm::ivec2 size = map_size(grid, 10, {0, 0});
    const MapView map(grid, frame, {area.left, area.top, 10, 10, size.x, size.y});
    for (const double column : {-0.5, 299.5})
        for (const double row : {-0.5, 199.5}) {
            const glm::dvec2 at = map.pixel({column, row});
            EXPECT_GE(at.x, -1e-6);
            EXPECT_GE(at.y, -1e-6);
            EXPECT_LE(at.x, size.x + 0.5);
            EXPECT_LE(at.y, size.y + 0.5);
        }
}

TEST(MapView, FitsIntoARoomWithTheShapeOfTheDem) {
    EXPECT_EQ(map_size(straight(), 0, {600, 600}), glm::ivec2(600, 400));
    EXPECT_EQ(map_size(straight(), 0, {600, 100}), glm::ivec2(150, 100));
    EXPECT_EQ(map_size(straight(), 20, {9, 9}), glm::ivec2(450, 300));
}

TEST(MapView, KeepsASizeThatHasBeenFitted) {
    for (int room = 100; room < 400; ++room) {
        const dem::Grid grid(331, 97, {0, 30, 0, 5300000, 0, -30}, kUtm);
        const glm::ivec2 once = map_size(grid, 0, {room, room + 7});
        EXPECT_EQ(map_size(grid, 0, once), once);
    }
}

TEST(MapView, RefusesMoreThanAPictureHas) {
    EXPECT_EQ(test::error_of([] {
                  map_size(straight(), 0.1, {0, 0});
              }),
              "exit 3: --resolution: pixels of 0.1 make a map of 90000 x 60000; expected sides of "
              "at most 65536 px, use a larger one");
}

TEST(MapView, LeavesOtherScenesAsTheyAre) {
    Scene scene;
    fit_map(scene, straight());
    EXPECT_EQ(scene.width_px, 1280);
    EXPECT_EQ(scene.height_px, 720);
    scene.ortho = true;
    fit_map(scene, straight());
    EXPECT_EQ(scene.width_px, 1080);
    EXPECT_EQ(scene.height_px, 720);
}

TEST(MapView, FindsPointsAgainAtAnyHeight) {
    const dem::Grid grid = turned();
    const geo::LocalFrame frame(grid.center());
    const MapView map(grid, frame, map_area(grid, 0, {700, 500}));
    for (const double height_m : {-400.0, 0.0, 4000.0})
        for (const glm::dvec2 at : {glm::dvec2(0, 0), glm::dvec2(350, 20), glm::dvec2(699, 499)}) {
            const glm::dvec2 again = map.pixel_of(map.point_m(at, height_m));
            EXPECT_NEAR(again.x, at.x, 1e-3);
            EXPECT_NEAR(again.y, at.y, 1e-3);
        }
}

TEST(MapView, HasItsCameraAboveItsMiddle) {
    const dem::Grid grid = straight();
    const geo::LocalFrame frame(grid.center());
    const Camera camera = map_camera(grid, frame, map_area(grid, 0, {600, 400}));
    ASSERT_TRUE(camera.map);
    // Half of 9 km, thirty times; UTM is 1.5 m off the ground on that length at its central scale.
    EXPECT_NEAR(camera.eye_m.z, 30 * 4500, 150);
    EXPECT_NEAR(std::hypot(camera.eye_m.x, camera.eye_m.y), 0, 1e-3);
    EXPECT_NEAR(camera.map_aspect, 1.5, 1e-3);
    // Grid north is 1.15 degrees off true north there: (9 - 7.7) degrees times sin(47.8).
    EXPECT_NEAR(std::abs(camera.up.x), std::sin(0.0172), 0.002);
    EXPECT_NEAR(dot(camera.up, camera.forward), 0, 1e-12);
}

}  // namespace
}  // namespace relevo::scene
