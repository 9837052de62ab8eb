#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "base/units.h"
#include "scene/camera.h"
#include "support/support.h"

namespace relevo::scene {
namespace {

/// A point in the picture: x right, y up, -1..1 at its edges.
glm::dvec2 seen(const Camera& camera, const glm::dvec3& point, double aspect) {
    const glm::dvec3 right = cross(camera.forward, camera.up);
    const glm::dvec3 to = point - camera.eye_m;
    const double tan_y = std::tan(camera.fov_y_rad / 2);
    const double depth = dot(to, camera.forward);
    return {dot(to, right) / depth / tan_y / aspect, dot(to, camera.up) / depth / tan_y};
}

const std::vector<glm::dvec3> kGround{
    {-10e3, -8e3, 200}, {10e3, -8e3, 500}, {10e3, 8e3, 900}, {-10e3, 8e3, 100}, {3e3, 1e3, 3000}};

TEST(OrbitCamera, StandsWhereItsAzimuthSays) {
    const Camera camera = orbit_camera({225, 25, 1}, kGround, radians(40), 1.25);
    EXPECT_LT(camera.eye_m.x, -10e3);  // south-west of the ground ...
    EXPECT_LT(camera.eye_m.y, -8e3);
    EXPECT_GT(camera.eye_m.z, 3000);  // ... and above it
    EXPECT_NEAR(degrees(std::asin(-camera.forward.z)), 25, 1e-9);
    EXPECT_NEAR(std::atan2(camera.forward.x, camera.forward.y), radians(45),
                1e-9);  // looks north-east
}

TEST(OrbitCamera, FillsNineteenTwentiethsOfTheWidthOrTheHeight) {
    for (const double aspect : {0.4, 1.0, 1.25, 3.0}) {
        for (const double azimuth : {0.0, 30.0, 135.0, 225.0, 300.0}) {
            for (const double elevation : {15.0, 25.0, 60.0, 90.0}) {
                const Camera camera =
                    orbit_camera({azimuth, elevation, 1}, kGround, radians(40), aspect);
                glm::dvec2 least(1e300), most(-1e300);
                for (const glm::dvec3& point : kGround) {
                    least = min(least, seen(camera, point, aspect));
                    most = max(most, seen(camera, point, aspect));
                }
                const glm::dvec2 filled = 0.5 * (most - least);
                EXPECT_NEAR(std::max(filled.x, filled.y), kFill, 1e-3)
                    << aspect << " " << azimuth << " " << elevation;
                // In the middle both ways.
                EXPECT_NEAR(least.x + most.x, 0, 2e-3);
                EXPECT_NEAR(least.y + most.y, 0, 2e-3);
            }
        }
    }
}

TEST(OrbitCamera, FillsWhatIsNotCovered) {
    const Insets insets{.left = 0.3, .right = 0.05, .bottom = 0.1, .top = 0.02};
    for (const double aspect : {0.6, 1.25, 3.0}) {
        const Camera camera = orbit_camera({205, 30, 1}, kGround, radians(40), aspect, {}, insets);
        glm::dvec2 least(1e300), most(-1e300);
        for (const glm::dvec3& point : kGround) {
            least = min(least, seen(camera, point, aspect));
            most = max(most, seen(camera, point, aspect));
        }
        const glm::dvec2 room(1 - insets.left - insets.right, 1 - insets.bottom - insets.top);
        const glm::dvec2 filled = 0.5 * (most - least) / room;
        EXPECT_NEAR(std::max(filled.x, filled.y), kFill, 1e-3) << aspect;
        // In the middle of it both ways.
        EXPECT_NEAR(0.5 * (least.x + most.x), insets.left - insets.right, 2e-3) << aspect;
        EXPECT_NEAR(0.5 * (least.y + most.y), insets.bottom - insets.top, 2e-3) << aspect;
    }
}

TEST(OrbitCamera, FromStraightAboveNorthIsUpWhenItStandsSouth) {
    const Camera camera = orbit_camera({180, 90, 1}, kGround, radians(40), 1.25);
    EXPECT_NEAR(camera.up.y, 1, 1e-9);
}

TEST(HeadingCamera, LooksAlongTheCompass) {
    const geo::Axes axes{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const Camera east = heading_camera({0, 0, 0}, axes, 90, 0, 1);
    EXPECT_NEAR(east.forward.x, 1, 1e-12);
    const Camera up = heading_camera({0, 0, 0}, axes, 0, 90, 1);
    EXPECT_NEAR(up.forward.z, 1, 1e-12);
    EXPECT_NEAR(up.up.y, -1, 1e-12);  // leaning back, what was behind is on top
}

TEST(LookAtCamera, RefusesToLookAtItself) {
    EXPECT_EQ(test::error_of([] {
                  look_at_camera({1, 2, 3}, {1, 2, 3}, {0, 0, 1}, 1);
              }),
              "exit 3: camera: --eye and --look-at are the same place; move one of them");
}

TEST(FocalLength, Of36MillimetresOnTheLongSideSees53Degrees) {
    // 2 atan(18 / 36): the textbook case, along the width of a landscape picture.
    const double fov_y = fov_y_of_focal_length(36, 1.5);
    EXPECT_NEAR(degrees(2 * std::atan(1.5 * std::tan(fov_y / 2))), 53.1301, 1e-4);
}

TEST(FocalLength, LiesAlongTheLongSideOfPortraitsToo) {
    EXPECT_NEAR(fov_y_of_focal_length(50, 36.0 / 24), 2 * std::atan(12.0 / 50), 1e-12);
    EXPECT_NEAR(fov_y_of_focal_length(50, 24.0 / 36), 2 * std::atan(18.0 / 50), 1e-12);
}

}  // namespace
}  // namespace relevo::scene
