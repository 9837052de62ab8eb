// Whether edges in a picture are blended: along walls, rims and water few pixels jump from one
// side's colour to the other's.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include "session/session.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::session::test_edges {
namespace {

/// Values of DataLayer::Ids.
enum Kind { kNothing, kGround, kWater, kWall };

scene::Scene scene_of(const std::filesystem::path& dem, const std::string& view) {
    scene::Scene scene;
    scene.dems = {dem.string()};
    scene.width_px = 640;
    scene.height_px = 480;
    scene.time.at = "2026-06-21T16:30:00Z";
    scene.land_cover.climate_alone = true;  // ground that is even beside a border
    scene.view = scene::parse_view(view);
    return scene;
}

image::Image8 picture_of(const scene::Scene& scene) {
    FilesInUse files;
    Session session(scene, {.device = test::gl_device(), .format = PictureFormat{}}, files);
    return std::get<image::Image8>(session.make_picture().pixels);
}

std::vector<float> kinds_of(const scene::Scene& scene) {
    FilesInUse files;
    Session session(scene,
                    {.device = test::gl_device(),
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

class Measure {
  public:
    Measure(const image::Image8& picture, const std::vector<float>& kinds)
        : picture_(picture), kinds_(kinds) {}

    /// By pair of kinds, the smaller one first.
    std::map<std::pair<int, int>, Borders> run() {
        for (int y = kReach; y + kReach + 1 < picture_.height; ++y)
            for (int x = kReach; x + kReach + 1 < picture_.width; ++x)
                for (const glm::ivec2 step : {glm::ivec2(1, 0), {0, 1}})
                    add({x, y}, step);
        return std::move(found_);
    }

  private:
    static constexpr int kReach = 2;          // pixels behind the border
    static constexpr double kLeast = 32;      // difference of the sides: the ground's own is less
    static constexpr double kEven = 0.2;      // of it: change within a side
    static constexpr double kBlended = 0.05;  // of it

    int kind(const glm::ivec2& at) const {
        return static_cast<int>(kinds_[static_cast<std::size_t>(at.y * picture_.width + at.x)]);
    }
    glm::dvec3 colour(const glm::ivec2& at) const {
        return {picture_.at(at.x, at.y, 0), picture_.at(at.x, at.y, 1), picture_.at(at.x, at.y, 2)};
    }

    /// A border counts where three pixels on each side are of one kind. It is a jump where neither
    /// of the two pixels at it is nearer to the other side's colour than the pixel behind it.
    void add(const glm::ivec2& at, const glm::ivec2& step) {
        const int here = kind(at), there = kind(at + step);
        if (here == there) return;
        for (int i = 1; i <= kReach; ++i)
            if (kind(at - i * step) != here || kind(at + (i + 1) * step) != there) return;
        const glm::dvec3 behind = colour(at - step), beyond = colour(at + 2 * step);
        const glm::dvec3 across = beyond - behind;
        if (length(across) < kLeast) return;
        // What changes on one side by itself, as a line along the rim, is none of the border's.
        if (std::max(distance(behind, colour(at - 2 * step)),
                     distance(beyond, colour(at + 3 * step))) > kEven * length(across))
            return;
        const double near = dot(colour(at) - behind, across) / dot(across, across);
        const double far = dot(beyond - colour(at + step), across) / dot(across, across);
        Borders& of = found_[std::minmax(here, there)];
        ++of.all;
        of.jumps += std::max(near, far) < kBlended;
    }

    const image::Image8& picture_;
    const std::vector<float>& kinds_;
    std::map<std::pair<int, int>, Borders> found_;
};

/// What a border is along: a wall of a block, water, or else the rim of ground before the sky.
std::string name_of(const std::pair<int, int>& kinds) {
    if (kinds.second == kWall) return "wall";
    return kinds.second == kWater ? "water" : "rim";
}

TEST(Edges, AlongWallsRimsAndWaterFewPixelsJump) {
    std::map<std::string, Borders> found;
    for (const auto& [dem, view] : {std::pair{"jacksboro", "az=210,el=30"},
                                    {"jacksboro", "az=177,el=12"},
                                    {"vancouver-island", "az=200,el=30"},
                                    {"vancouver-island", "az=150,el=45,zoom=4"}}) {
        const scene::Scene scene =
            scene_of(test::source_dir() / fmt::format("data/dem/{}.tif", dem), view);
        const image::Image8 picture = picture_of(scene);
        const std::vector<float> kinds = kinds_of(scene);
        for (const auto& [pair, borders] : Measure(picture, kinds).run()) {
            Borders& of = found[name_of(pair)];
            of.all += borders.all;
            of.jumps += borders.jumps;
        }
    }
    for (const char* const name : {"wall", "rim", "water"}) {
        const Borders& of = found[name];
        fmt::print("[ accuracy ] along {}: {} borders, {:.2f} % jump\n", name, of.all,
                   100 * of.share());
        EXPECT_GT(of.all, 1000) << name;
        EXPECT_LT(of.share(), 0.01) << name;
    }
}

}  // namespace
}  // namespace relevo::session::test_edges
