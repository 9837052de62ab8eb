// Clouds over the country that is made up around a DEM: in views from the air, and never before the
// DEM's own ground.
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/units.h"
#include "dem/fixture.h"
#include "session/session.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::session::test_far_clouds {
namespace {

/// Mountains in the middle of 20 km of plain.
scene::Scene mountains() {
    test::Raster raster;
    raster.columns = raster.rows = 200;
    raster.geotransform = {{500000, 100, 0, 5200000, 0, -100}};
    raster.value = [](int column, int row, int) {
        return 1500 * std::exp(-0.0004 * (std::pow(column - 100, 2) + std::pow(row - 100, 2)));
    };
    scene::Scene scene;
    scene.dems = {test::write_raster(test::scratch_dir("far") / "mountains.tif", raster)};
    scene.time.at = "2026-06-21T14:00Z";
    scene.width_px = 240;
    scene.height_px = 160;
    return scene;
}

image::Image8 drawn(scene::Scene scene, const std::string& clouds) {
    scene.effects.settings.push_back({"sky.clouds", clouds});
    FilesInUse files;
    Session session(scene, {.device = test::gl_device()}, files);
    session.draw();
    return session.picture();
}

/// Pixels of two pictures that differ, each as its place in the picture.
std::vector<std::size_t> different(const image::Image8& a, const image::Image8& b) {
    std::vector<std::size_t> found;
    const auto channels = static_cast<std::size_t>(a.channels);
    for (std::size_t i = 0; i < a.values.size() / channels; ++i)
        for (std::size_t c = 0; c < channels; ++c)
            if (a.values[channels * i + c] != b.values[channels * i + c]) {
                found.push_back(i);
                break;
            }
    return found;
}

TEST(FarClouds, AreOverTheCountryBeyondAlone) {
    const scene::Scene scene = mountains();
    const image::Image8 none = drawn(scene, "0");
    const auto some = different(none, drawn(scene, "0.5")).size();
    const auto more = different(none, drawn(scene, "0.8")).size();
    fmt::print("[ clouds ] {} pixels at a cover of 0.5, {} at 0.8\n", some, more);
    EXPECT_GT(some, 200U);
    EXPECT_GT(more, some + 200);

    FilesInUse files;
    scene::Scene clouded = scene;
    clouded.effects.settings.push_back({"sky.clouds", "1"});
    Session session(clouded, {.device = test::gl_device()}, files);
    session.draw();
    std::vector<float> depths_m;
    session.read_depths(depths_m);
    const image::Image8 picture = session.picture();
    const glm::dvec3 forward = session.camera().forward, up = session.camera().up;
    const double tangent = std::tan(session.camera().fov_y_rad / 2);
    int over_ground = 0, over_horizon = 0;
    for (const std::size_t i : different(none, picture)) {
        const int x = static_cast<int>(i) % picture.width, y = static_cast<int>(i) / picture.width;
        // Pixels of the edges, which are smoothed, are of both.
        bool is_ground = true;
        for (int aside = -1; aside <= 1; ++aside)
            for (int row = std::max(y - 1, 0); row <= std::min(y + 1, picture.height - 1); ++row)
                is_ground = is_ground && std::isfinite(depths_m[static_cast<std::size_t>(
                                             (picture.height - 1 - row) * picture.width +
                                             std::clamp(x + aside, 0, picture.width - 1))]);
        over_ground += is_ground;
        const double height = 1 - 2 * (y + 1.5) / picture.height;
        over_horizon += (forward + height * tangent * up).z > 0;
    }
    EXPECT_EQ(over_ground, 0);
    EXPECT_EQ(over_horizon, 0);
}

TEST(FarClouds, AreNotInBlocksNorInViewsFromTheGround) {
    for (const char* const view : {"az=210,el=30", "top"}) {
        scene::Scene scene = mountains();
        scene.view = scene::parse_view(view);
        EXPECT_TRUE(different(drawn(scene, "0"), drawn(scene, "1")).empty()) << view;
    }
    scene::Scene scene = mountains();
    scene.view.eye = {{radians(46.87), radians(9.13), 100}, /*above_ground=*/true};
    EXPECT_TRUE(different(drawn(scene, "0"), drawn(scene, "1")).empty());
}

TEST(FarClouds, FollowAReportOfTheWeather) {
    scene::Scene scene = mountains();
    const auto picture = [&](const char* report) {
        scene.weather = report;
        FilesInUse files;
        Session session(scene, {.device = test::gl_device()}, files);
        session.draw();
        return session.picture();
    };
    const image::Image8 clear = picture("LOWI 211350Z 24004KT CAVOK 24/08 Q1014");
    EXPECT_TRUE(different(clear, drawn(scene, "0")).empty());
    EXPECT_FALSE(different(clear, drawn(scene, "0.5")).empty());
}

}  // namespace
}  // namespace relevo::session::test_far_clouds
