// Maps have the water that the DEM has: sea and lakes are blue in every preset that colours ground,
// whatever the noise of their heights. Models have water that mirrors the sky over it.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include "session/seen_ground.h"
#include "session/session.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::session::test_water_tints {
namespace {

constexpr int kPosts = 150;

/// Sea in the west with the noise of radar, a lake in the north-east, and a polder: dry ground
/// below 0 in the south-east. The floor of none is known.
std::filesystem::path coast(double spacing_m = 90) {
    const std::filesystem::path file =
        test::scratch_dir("coast") / fmt::format("coast{}.asc", spacing_m);
    std::ofstream out(file);
    out << fmt::format("ncols {0}\nnrows {0}\nxllcorner 500000\nyllcorner 5000000\ncellsize {1}\n",
                       kPosts, spacing_m);
    std::mt19937 random(5);
    std::uniform_int_distribution<int> noise(-5, 0);
    for (int row = 0; row < kPosts; ++row) {
        for (int column = 0; column < kPosts; ++column) {
            int height_m = 5 + 3 * (column - 60);
            if (column < 60) height_m = noise(random);
            if (std::hypot(column - 110, row - 40) < 12) height_m = 100;
            if (std::hypot(column - 90, row - 110) < 6) height_m = -2;
            out << height_m << ' ';
        }
        out << '\n';
    }
    return file;
}

scene::Scene coast_seen_from(const char* view, double spacing_m = 90) {
    scene::Scene scene;
    scene.dems = {coast(spacing_m).string()};
    scene.dem.crs = "EPSG:32633";
    scene.view = scene::parse_view(view);
    scene.time.at = "2026-06-21T12:00Z";
    scene.width_px = scene.height_px = 400;
    return scene;
}

/// What a picture shows at posts, as it is seen, 0 to 255.
class Seen {
  public:
    explicit Seen(const scene::Scene& scene)
        : session_(scene, {.device = test::gl_device()}, files_) {
        session_.draw();
        picture_ = session_.picture();
        std::vector<float> depths_m;
        session_.read_depths(depths_m);
        seen_.emplace(session_.camera(), picture_.width, picture_.height, std::move(depths_m));
    }

    glm::ivec3 colour(int column, int row) {
        const dem::Heightfield& field = session_.dem()->field;
        const auto at = seen_->project(session_.ground().frame.to_local(field.place(column, row)));
        const std::uint8_t* const pixel =
            picture_.row(static_cast<int>(at->y)) + 3 * static_cast<int>(at->x);
        return {pixel[0], pixel[1], pixel[2]};
    }

  private:
    FilesInUse files_;
    Session session_;
    image::Image8 picture_;
    std::optional<SeenGround> seen_;
};

void expect_colour(const glm::ivec3& found, const glm::ivec3& expected, const std::string& where) {
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(found[i], expected[i], 2) << where << ", channel " << i;
}

TEST(WaterTints, SeaAndLakesAreWaterAndPoldersAreLand) {
    const glm::ivec3 water(159, 200, 220);  // tint_water
    for (const std::string preset : {"relief", "slope", "aspect"}) {
        scene::Scene scene = coast_seen_from("top");
        scene.stamps.legend = false;
        scene.effects.presets = {preset};
        scene.effects.settings = {{"tint.lit", "false"}};
        Seen map(scene);
        for (const int row : {10, 45, 75, 100, 140})
            for (const int column : {5, 20, 40, 57})
                expect_colour(map.colour(column, row), water,
                              fmt::format("{}: sea at {}, {}", preset, column, row));
        expect_colour(map.colour(110, 40), water, preset + ": lake");
        expect_colour(map.colour(104, 36), water, preset + ": lake");
        const glm::ivec3 polder = map.colour(90, 110);
        EXPECT_LT(polder.b, polder.g) << preset;
        if (preset == "relief") expect_colour(polder, {121, 164, 132}, "polder");
    }
}

TEST(WaterOfABlock, MirrorsTheSkyOverItHoweverFarTheEyeIs) {
    // Of 13 and of 130 km: the eye is 12 km up, and beyond the air, where the sky is black.
    const auto without_slicks = [](scene::Scene scene) {
        scene.effects.settings = {{"sea.shore", "0"}};
        return scene;
    };
    Seen near(without_slicks(coast_seen_from("az=180,el=12"))),
        far(without_slicks(coast_seen_from("az=180,el=12", 900)));
    for (const int row : {30, 75, 120}) {
        const glm::ivec3 here = near.colour(25, row), there = far.colour(25, row);
        EXPECT_GT(here.b, here.r + 10) << row;
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(here[i], there[i], 6) << row << ", channel " << i;
    }
}

}  // namespace
}  // namespace relevo::session::test_water_tints
