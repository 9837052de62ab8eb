// A scene of the window, taken to the command line as words, is the same scene there.
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/text.h"
#include "base/units.h"
#include "scene/scene.h"
#include "support/support.h"
#include "viewer/document.h"

namespace relevo::viewer::test_copied_command {
namespace {

namespace fs = std::filesystem;

/// A DEM without a place: a grey picture of 12 x 9 posts.
std::string write_picture_dem(const fs::path& path) {
    std::ofstream file(path, std::ios::binary);
    file << "P5\n12 9\n255\n";
    for (int i = 0; i < 12 * 9; ++i)
        file.put(static_cast<char>(40 + 7 * i % 80));
    return path.string();
}

/// A raster over its place.
std::string write_overlay(const fs::path& path) {
    std::ofstream(fs::path(path).replace_extension(".prj"))
        << R"(GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],)"
        << R"(PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]])";
    std::ofstream file(path);
    file << "ncols 4\nnrows 4\nxllcorner -8.6\nyllcorner -46.3\ncellsize 0.15\n";
    for (int i = 0; i < 16; ++i)
        file << 3 * i << (i % 4 == 3 ? '\n' : ' ');
    return path.string();
}

/// The scene that the program makes of a command which was copied.
scene::Scene retold(const scene::Scene& scene, const fs::path& folder) {
    const fs::path saved = folder / "saved.json";
    fs::remove(saved);
    const std::string command = capture_command(scene, (folder / "picture.png").string());
    EXPECT_TRUE(command.starts_with("relevo "));
    const std::string line =
        fmt::format("{} -q {} --save-scene {} --overwrite --device software > {} 2>&1",
                    (test::build_dir() / "bin/relevo").string(), command.substr(7), saved.string(),
                    (folder / "said.txt").string());
    EXPECT_EQ(std::system(line.c_str()), 0) << command << "\n"
                                            << read_text(folder / "said.txt", "test");
    return scene::read_scene(saved);
}

/// Everything that has an option, and none as it would be without one.
scene::Scene unusual(const fs::path& folder) {
    scene::Scene scene;
    scene.dems = {write_picture_dem(folder / "a b's.pgm")};
    scene.dem.crs = "EPSG:4326";
    scene.dem.band = 1;
    scene.dem.unit = "feet";
    scene.dem.nodata = 3;
    scene.dem.bounds = dem::Bounds{-8.5, -46.25, -8.125, -46};
    scene.dem.memory = MemoryBudget::of_mib(77);
    scene.time.at = "2026-06-21T18:30:00+02:00";
    scene.refraction = "none";
    scene.view.eye = scene::Standpoint{geo::geodetic_deg(-46.1, -8.25, 1200), false};
    scene.view.heading_deg = 12.5;
    scene.view.pitch_deg = -30;
    scene.view.fov_y_rad = radians(40.0);
    scene.exaggeration = 2.5;
    scene.overlay = scene::Overlay{.file = write_overlay(folder / "depths.asc"),
                                   .band = 1,
                                   .colours = "inferno",
                                   .range = std::pair(-12.5, 40.0),
                                   .opacity = 0.25,
                                   .title = "Depth, at low water"};
    scene.stamps.title = scene.stamps.north = scene.stamps.attribution = true;
    scene.stamps.legend = false;
    scene.stamps.title_text = "A title's";
    scene.stamps.attribution_text = "Data: of a survey";
    scene.effects.switches.only = std::vector<std::string>{"shadows", "skylight"};
    scene.width_px = 96;
    scene.height_px = 64;
    scene.exposure_ev = -1.5;
    scene.ev100 = 12.5;
    scene.pixel_error = 7;
    return scene;
}

std::string text_of(scene::Scene scene) {
    return scene::scene_text(scene, "/");
}

TEST(CopiedCommand, IsTheSceneInAllThatHasAnOption) {
    const fs::path folder = test::scratch_dir();
    const scene::Scene scene = unusual(folder);
    const scene::Scene back = retold(scene, folder);
    ASSERT_TRUE(back.dem.bounds);
    EXPECT_EQ(back.dem.bounds->west_deg, -8.5);
    EXPECT_EQ(back.dem.bounds->south_deg, -46.25);
    EXPECT_EQ(back.dem.bounds->east_deg, -8.125);
    EXPECT_EQ(back.dem.bounds->north_deg, -46);
    EXPECT_EQ(text_of(back), text_of(scene));
}

}  // namespace
}  // namespace relevo::viewer::test_copied_command
