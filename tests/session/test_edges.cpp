// Whether edges in a picture are blended: along walls, rims and water few pixels jump from one
// side's colour to the other's.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "session/session.h"
#include "support/support.h"

namespace relevo::session {
namespace {

/// Values of DataLayer::Ids.
enum Kind { kNothing, kGround, kWater, kWall };

scene::Scene scene_of(const std::filesystem::path& dem, const std::string& view) {
    scene::Scene scene;
    scene.dems = {dem.string()};
    scene.width_px = 640;
    scene.height_px = 480;
    scene.time.at = "2026-06-21T16:30:00Z";
    scene.view = scene::parse_view(view);
    return scene;
}

image::Image8 picture_of(const scene::Scene& scene) {
    FilesInUse files;
    Session session(scene, {.device = "software", .format = PictureFormat{}}, files);
    return std::get<image::Image8>(session.make_picture().pixels);
}

std::vector<float> kinds_of(const scene::Scene& scene) {
    FilesInUse files;
    Session session(scene,
                    {.device = "software",
                     .radiance = true,
                     .format = PictureFormat{.layers = {DataLayer::Ids}}},
                    files);
    return session.make_picture().layers.front().values;
}

/// Borders between two kinds, and those across which the colour jumps.
struct Borders {
    int all = 0, jumps = 0;
    double share() const { return all > 0 ? static_cast<double>(jumps) / all : 0; }
};

/// Of each pair of kinds, the smaller one first. A border counts where three pixels on each side
/// are of one kind, and their colours differ by more than the ground's own: it is a jump where the
/// two pixels at the border differ by 95 % of what those two pixels away from it do.
std::map<std::pair<int, int>, Borders> borders_of(const image::Image8& picture,
                                                  const std::vector<float>& kinds) {
    constexpr int kReach = 2;
    constexpr double kLeast = 24, kJump = 0.95;
    std::map<std::pair<int, int>, Borders> found;
    const auto kind = [&](int x, int y) {
        return static_cast<int>(kinds[static_cast<std::size_t>(y * picture.width + x)]);
    };
    const auto apart = [&](int x, int y, int x2, int y2) {
        double most = 0;
        for (int c = 0; c < 3; ++c)
            most = std::max<double>(most, std::abs(picture.at(x, y, c) - picture.at(x2, y2, c)));
        return most;
    };
    for (int y = kReach; y + kReach + 1 < picture.height; ++y)
        for (int x = kReach; x + kReach + 1 < picture.width; ++x)
            for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}}) {
                const int a = kind(x, y), b = kind(x + dx, y + dy);
                bool clean = a != b;
                for (int i = 1; clean && i <= kReach; ++i)
                    clean = kind(x - i * dx, y - i * dy) == a &&
                            kind(x + (i + 1) * dx, y + (i + 1) * dy) == b;
                if (!clean) continue;
                const double whole = apart(x - kReach * dx, y - kReach * dy, x + (kReach + 1) * dx,
                                           y + (kReach + 1) * dy);
                if (whole < kLeast) continue;
                Borders& of = found[std::minmax(a, b)];
                ++of.all;
                of.jumps += apart(x, y, x + dx, y + dy) >= kJump * whole;
            }
    return found;
}

struct Case {
    std::string name, dem, view;
};

void PrintTo(const Case& of, std::ostream* out) {
    *out << of.name;
}

class Edges : public testing::TestWithParam<Case> {};

TEST_P(Edges, AlongWallsRimsAndWaterFewPixelsJump) {
    const scene::Scene scene = scene_of(test::source_dir() / GetParam().dem, GetParam().view);
    int counted = 0;
    for (const auto& [kinds, borders] : borders_of(picture_of(scene), kinds_of(scene))) {
        fmt::print("{}: kinds {} and {}: {} borders, {:.2f} % jump\n", GetParam().name, kinds.first,
                   kinds.second, borders.all, 100 * borders.share());
        counted += borders.all;
        if (borders.all >= 50) EXPECT_LT(borders.share(), 0.01) << kinds.first << kinds.second;
    }
    EXPECT_GT(counted, 100);
}

INSTANTIATE_TEST_SUITE_P(
    Views, Edges,
    testing::Values(Case{"block", "data/dem/jacksboro.tif", "az=210,el=30"},
                    Case{"block_turned", "data/dem/jacksboro.tif", "az=177,el=12"},
                    Case{"coast", "data/dem/vancouver-island.tif", "az=200,el=30"},
                    Case{"coast_near", "data/dem/vancouver-island.tif", "az=150,el=25,zoom=4"}),
    [](const auto& of) { return of.param.name; });

}  // namespace
}  // namespace relevo::session
