// What cannot be drawn is refused by the file and the option that would help.
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "session/session.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::session::test_hostile {
namespace {

std::string error_of(const scene::Scene& scene) {
    return test::error_of([&] {
        FilesInUse files;
        const Session session(scene, {.device = test::gl_device()}, files);
    });
}

scene::Scene scene_of(const std::filesystem::path& dem) {
    scene::Scene scene;
    scene.dems = {dem.string()};
    scene.time.at = "2026-06-21T12:00Z";
    scene.width_px = scene.height_px = 16;
    scene.effects.switches.only = std::vector<std::string>{};
    return scene;
}

TEST(Hostile, AnEyeBeyondTheMoonIsRefusedByFileAndOption) {
    scene::Scene scene = scene_of(test::source_dir() / "data/dem/jacksboro.tif");
    for (const bool above_ground : {false, true}) {
        scene.view.eye = scene::Standpoint{geo::geodetic_deg(36.8, -84.2, 1e9), above_ground};
        EXPECT_EQ(error_of(scene),
                  fmt::format("exit 3: {}: --eye: a height of 1e+09 m, expected -6.4e+06 to "
                              "9e+08 m",
                              scene.dems[0]));
    }
}

TEST(Hostile, ADemOfThousandsOfKilometresIsRefusedByFileAndOption) {
    const std::filesystem::path file = test::scratch_dir() / "high.asc";
    std::ofstream(file) << "ncols 3\nnrows 3\nxllcorner 500000\nyllcorner 5000000\ncellsize 30\n"
                           "1 2 3\n1 9.9e6 3\n1 2 3\n";
    scene::Scene scene = scene_of(file);
    scene.dem.crs = "EPSG:32633";
    scene.dem.unit = "m";
    EXPECT_EQ(error_of(scene),
              fmt::format("exit 3: {}: heights of 1 to 9.9e+06 m cannot be drawn, expected -2e+06 "
                          "to 2e+06 m; --unit sets the unit, --nodata V marks voids",
                          file.string()));
}

}  // namespace
}  // namespace relevo::session::test_hostile
