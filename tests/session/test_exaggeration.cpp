// Ground that is drawn higher or lower than it is: what is said of it is of the ground there is.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "dem/fixture.h"
#include "session/record.h"
#include "session/seen_ground.h"
#include "session/session.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::session::test_exaggeration {
namespace {

scene::Scene scene_of(double exaggeration) {
    scene::Scene scene;
    scene.dems = {(test::source_dir() / "data/dem/jacksboro.tif").string()};
    scene.time.at = "2026-06-21T15:30Z";
    scene.width_px = 320;
    scene.height_px = 240;
    scene.exaggeration = exaggeration;
    scene.effects.switches.only = std::vector<std::string>{};
    return scene;
}

TEST(ExaggeratedRecord, SaysTheEyesHeightAsItWasAskedFor) {
    for (const double exaggeration : {0.5, 1.0, 3.0}) {
        scene::Scene scene = scene_of(exaggeration);
        scene.view = {.eye = scene::Standpoint{geo::geodetic_deg(36.3, -84.2, 1500)},
                      .heading_deg = 300,
                      .pitch_deg = -10};
        FilesInUse files;
        Session session(scene, {.device = test::gl_device()}, files);
        session.draw();
        SceneInputs inputs("test");
        const auto json = nlohmann::json::parse(sidecar_text(session, inputs, "a.png"));
        EXPECT_NEAR(json["camera"]["height_m"], 1500, 1e-3) << exaggeration;
        EXPECT_NEAR(json["camera"]["lat_deg"], 36.3, 1e-6);
        EXPECT_NEAR(json["camera"]["lon_deg"], -84.2, 1e-6);
        EXPECT_NEAR(json["camera"]["heading_deg"], 300, 1e-6);
        EXPECT_NEAR(json["camera"]["pitch_deg"], -10, 1e-6);
        EXPECT_EQ(json["scene"]["exaggeration"].get<double>(), exaggeration);
    }
}

/// A dome of 40 x 40 posts, 800 to 2400 m high.
std::string dome(double west_deg, double north_deg) {
    test::Raster raster;
    raster.columns = raster.rows = 40;
    raster.geotransform = {{west_deg, 0.01, 0, north_deg, 0, -0.01}};
    raster.crs = "EPSG:4326";
    raster.value = [](int column, int row, int) {
        return 2400 - 1600 * std::hypot(column - 20, row - 20) / 28.3;
    };
    return test::write_raster(test::scratch_dir("domes") / fmt::format("{}.tif", north_deg),
                              raster);
}

TEST(ChosenExposure, IsLowerOnSnowAloneWhereNoneIsGiven) {
    scene::Scene scene;
    scene.width_px = 64;
    scene.height_px = 48;
    scene.chooses_exaggeration = true;
    const auto exposure_ev = [&] {
        FilesInUse files;
        return Session(scene, {.device = test::gl_device()}, files).scene().exposure_ev;
    };
    scene.dems = {dome(-40, 72)};  // the ice of Greenland
    EXPECT_NEAR(exposure_ev(), -1.4, 0.11);
    scene.exposure_ev = 0.5;
    EXPECT_EQ(exposure_ev(), 0.5);
    scene.exposure_ev = 0;
    scene.effects.switches.only = std::vector<std::string>{"sky"};  // ground of one colour
    EXPECT_EQ(exposure_ev(), 0);
    scene.effects = {};
    scene.chooses_exaggeration = false;
    EXPECT_EQ(exposure_ev(), 0);
    scene.chooses_exaggeration = true;
    scene.dems = {dome(11, 47)};  // the Alps in June
    EXPECT_EQ(exposure_ev(), 0);
}

TEST(ChosenScale, KeepsSideAndSunAndIsOfTheFirstPictureAlone) {
    scene::Scene scene = scene_of(1);
    scene.time.at.clear();
    FilesInUse files;
    Session plain(scene, {.device = test::gl_device()}, files);
    scene.chooses_exaggeration = true;
    Session chosen(scene, {.device = test::gl_device()}, files);
    EXPECT_EQ(chosen.scene().exaggeration, 2.2);  // Cumberland: relief of 754 m over 30 km
    EXPECT_FALSE(chosen.scene().chooses_exaggeration);
    EXPECT_TRUE(chosen.scene().stamps.exaggeration);
    EXPECT_EQ(chosen.time(), plain.time());
    EXPECT_EQ(chosen.scene().view.orbit.azimuth_deg, plain.scene().view.orbit.azimuth_deg);
    EXPECT_EQ(chosen.scene().view.orbit.elevation_deg, plain.scene().view.orbit.elevation_deg);
    // A picture of its record is the same, and nothing is chosen again.
    chosen.draw();
    Session again(chosen.scene(), {.device = test::gl_device()}, files);
    again.draw();
    EXPECT_EQ(chosen.picture().values, again.picture().values);
    // What is shown next has what it says.
    chosen.show(plain.scene(), plain.time());
    EXPECT_EQ(chosen.scene().exaggeration, 1);
    chosen.draw();
    plain.draw();
    EXPECT_EQ(chosen.picture().values, plain.picture().values);
}

/// Which pixels a graticule changes, and which show the DEM.
struct Lines {
    std::vector<char> drawn;
    std::vector<float> depths_m;  // rows from below
};

Lines lines_of(scene::Scene scene) {
    FilesInUse files;
    Session session(scene, {.device = test::gl_device()}, files);
    session.draw();
    const image::Image8 plain = session.picture();
    Lines lines;
    session.read_depths(lines.depths_m);
    scene = session.scene();
    scene.stamps.graticule = true;
    session.show(scene, session.time());
    session.draw();
    const image::Image8 stamped = session.picture();
    for (int y = plain.height - 1; y >= 0; --y)
        for (int x = 0; x < plain.width; ++x) {
            int off = 0;
            for (int k = 0; k < 3; ++k)
                off = std::max(off, std::abs(plain.at(x, y, k) - stamped.at(x, y, k)));
            lines.drawn.push_back(off > 8);
        }
    return lines;
}

TEST(ExaggeratedGraticule, IsOnTheGroundWhateverItsHeight) {
    for (const double exaggeration : {0.3, 1.0, 4.0}) {
        scene::Scene scene = scene_of(exaggeration);
        scene.view.orbit = {200, 60, 6};  // a pixel is some 20 m wide
        const Lines lines = lines_of(scene);
        int ground = 0, drawn = 0;
        for (std::size_t i = 0; i < lines.drawn.size(); ++i) {
            if (std::isinf(lines.depths_m[i])) continue;
            ++ground;
            drawn += lines.drawn[i];
        }
        EXPECT_GT(drawn, 0.015 * ground) << exaggeration;
        EXPECT_LT(drawn, 0.15 * ground) << exaggeration;
    }
}

TEST(ExaggeratedBlock, ItsWallsEndAtTheFloor) {
    if (!std::filesystem::exists(test::source_dir() / "plugins" / "block"))
        GTEST_SKIP() << "the plugin block is not there";
    for (const double exaggeration : {0.5, 1.0, 4.0}) {
        scene::Scene scene = scene_of(exaggeration);
        scene.effects.switches.only = std::vector<std::string>{"block"};
        scene.view.orbit = {200, 20, 1};
        FilesInUse files;
        Session session(scene, {.device = test::gl_device()}, files);
        session.draw();
        std::vector<float> depths_m;
        session.read_depths(depths_m);
        const SeenGround seen(session.camera(), scene.width_px, scene.height_px, depths_m);
        double lowest_m = 1e9;
        for (int y = 0; y < scene.height_px; ++y)
            for (int x = 0; x < scene.width_px; ++x)
                if (const auto point = seen.point(x, y))
                    lowest_m =
                        std::min(lowest_m, session.ground().frame.to_geodetic(*point).height_m);
        const render::Ground& ground = session.ground();
        // A pixel is some 150 m high there.
        EXPECT_NEAR(lowest_m, ground.base_m(exaggeration), 150) << exaggeration;
    }
}

}  // namespace
}  // namespace relevo::session::test_exaggeration
