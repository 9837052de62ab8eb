// Whether a picture that is drawn in tiles is as it would be in one large frame, whatever effect is
// on.
#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "base/units.h"
#include "session/effect_groups.h"
#include "session/picture_maker.h"
#include "session/session.h"
#include "support/support.h"

namespace relevo::session::test_large_pictures {
namespace {

/// Every picture is larger, so that it has the smallest tiles: of 64 pixels, in frames wider by 256
/// on each side. A long and narrow picture has few, and yet frames that end before it does.
constexpr double kSmallFrame_px = 1;
constexpr int kLong_px = 389, kShort_px = 70;  // no multiples of anything

scene::Scene scene_with(const EffectGroup& effects, bool inside) {
    scene::Scene scene;
    scene.dems = {(test::source_dir() / "data/dem/jacksboro.tif").string()};
    scene.width_px = inside ? kShort_px : kLong_px;
    scene.height_px = inside ? kLong_px : kShort_px;
    scene.time.at = "2026-06-21T22:00:00Z";
    scene.view = scene::parse_view("az=200,el=25");
    if (inside) {
        scene.view.eye = {.place = geo::geodetic_deg(36.33, -84.25, 1100)};
        scene.view.heading_deg = 200;
        scene.view.pitch_deg = -8;
    }
    scene.effects.switches.enable = effects;
    return scene;
}

class LargePictures : public testing::TestWithParam<EffectGroup> {};

TEST_P(LargePictures, InTilesAreAsInOneFrame) {
    const std::vector<scene::Scene> scenes{scene_with(GetParam(), false),
                                           scene_with(GetParam(), true)};
    const std::vector<image::Image8> whole = pictures_of(scenes),
                                     tiled = pictures_of(scenes, {.frame_px = kSmallFrame_px});
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        const image::Difference off = image::compare(whole[i], tiled[i]);
        fmt::print("{} {}: {:.4f} % of the values are off by more than 1/255, worst {:.0f}\n",
                   fmt::join(GetParam(), ","), i == 1 ? "inside" : "outside",
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

INSTANTIATE_TEST_SUITE_P(Effects, LargePictures, testing::ValuesIn(kEffectGroups), name_of);

}  // namespace
}  // namespace relevo::session::test_large_pictures
