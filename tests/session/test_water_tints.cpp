// Maps have the water that the DEM has: sea and lakes are blue in every preset that colours ground,
// whatever the noise of their heights.
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
constexpr double kSpacing_m = 90;

/// Sea in the west with the noise of radar, a lake in the north-east, and a polder: dry ground
/// below 0 in the south-east. The floor of none is known.
std::filesystem::path coast() {
    const std::filesystem::path file = test::scratch_dir("coast") / "coast.asc";
    std::ofstream out(file);
    out << fmt::format("ncols {0}\nnrows {0}\nxllcorner 500000\nyllcorner 5000000\ncellsize {1}\n",
                       kPosts, kSpacing_m);
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

/// What a map shows at posts, as it is seen, 0 to 255.
class Map {
  public:
    explicit Map(const std::string& preset)
        : session_(scene(preset), {.device = test::gl_device()}, files_) {
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
    static scene::Scene scene(const std::string& preset) {
        scene::Scene scene;
        scene.dems = {coast().string()};
        scene.dem.crs = "EPSG:32633";
        scene.view = scene::parse_view("top");
        scene.time.at = "2026-06-21T12:00Z";
        scene.width_px = scene.height_px = 400;
        scene.stamps.legend = false;
        scene.effects.presets = {preset};
        scene.effects.settings = {{"tint.lit", "false"}};
        return scene;
    }

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
        Map map(preset);
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

}  // namespace
}  // namespace relevo::session::test_water_tints
