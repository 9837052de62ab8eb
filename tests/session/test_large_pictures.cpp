// Whether a picture that is drawn in tiles is as it would be in one large frame, whatever effect is
// on.
#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/units.h"
#include "session/picture_maker.h"
#include "session/session.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::session::test_large_pictures {
namespace {

/// Tiles of 128 pixels in frames of 384.
constexpr double kSmallFrame_px = 384 * 384;

scene::Scene scene_with(const std::string& effect, bool inside) {
    scene::Scene scene;
    scene.dems = {(test::source_dir() / "data/dem/jacksboro.tif").string()};
    scene.width_px = 451;  // no multiple of anything
    scene.height_px = 329;
    scene.time.at = "2026-06-21T22:00:00Z";
    scene.view = scene::parse_view("az=200,el=25");
    if (inside) {
        scene.view.eye = {.place = geo::geodetic_deg(36.33, -84.25, 1100)};
        scene.view.heading_deg = 200;
        scene.view.pitch_deg = -8;
    }
    if (!effect.empty()) scene.effects.switches.enable = {effect};
    return scene;
}

image::Image8 picture_of(const scene::Scene& scene, double frame_px) {
    FilesInUse files;
    Session session(scene,
                    {.device = test::gl_device(),
                     .format = PictureFormat{.frame_px = frame_px},
                     .allow_unmet = true},
                    files);
    return std::get<image::Image8>(session.make_picture().pixels);
}

class LargePictures : public testing::TestWithParam<std::string> {};

TEST_P(LargePictures, InTilesAreAsInOneFrame) {
    for (const bool inside : {false, true}) {
        const scene::Scene scene = scene_with(GetParam(), inside);
        const image::Image8 whole = picture_of(scene, render::kFrame_px);
        const image::Image8 tiled = picture_of(scene, kSmallFrame_px);
        const image::Difference off = image::compare(whole, tiled);
        fmt::print("{} {}: {:.4f} % of the values are off by more than 1/255, worst {:.0f}\n",
                   GetParam().empty() ? "default" : GetParam(), inside ? "inside" : "outside",
                   100 * off.share_over_1, off.worst);
        // Vertices are rounded to 1/256 pixel from another corner: a few pixels on silhouettes
        // change.
        EXPECT_LT(off.share_over_1, 0.0002);
    }
}

TEST(LargeMaps, AreInTilesWhereNormalsOfEachPostHaveNoRoomInOneFrame) {
    scene::Scene scene;
    scene.ortho = true;
    const auto is_tiled = [&](int side_px) {
        scene.width_px = scene.height_px = side_px;
        return frame_px(scene, {}, 16384) != glm::ivec2(side_px);
    };
    EXPECT_FALSE(is_tiled(4096));
    EXPECT_TRUE(is_tiled(4608));
    scene.ortho = false;
    EXPECT_FALSE(is_tiled(4608));
}

INSTANTIATE_TEST_SUITE_P(Effects, LargePictures,
                         testing::Values("", "bloom", "occlusion", "grade", "contours", "snowfall",
                                         "trees", "vsm", "avalanche", "wet", "tint"),
                         [](const auto& effect) {
                             return effect.param.empty() ? std::string("defaults") : effect.param;
                         });

}  // namespace
}  // namespace relevo::session::test_large_pictures
