// Pictures with a white border that has their stamps.
#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>

#include "scene/map_view.h"
#include "session/picture_file.h"
#include "session/stamps.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::session::test_margin {
namespace {

scene::Scene scene_of(int width_px, int height_px) {
    scene::Scene scene;
    scene.dems = {(test::source_dir() / "data/dem/jacksboro.tif").string()};
    scene.time.at = "2026-06-21T21:30Z";
    scene.view = scene::parse_view("top");
    scene.width_px = width_px;
    scene.height_px = height_px;
    scene.effects.presets = {"relief"};
    scene.stamps.title = scene.stamps.scale = scene.stamps.north = scene.stamps.date =
        scene.stamps.sun = scene.stamps.margin = true;
    return scene;
}

struct Drawn {
    FilesInUse files;
    Session session;
    image::Picture picture;

    explicit Drawn(const scene::Scene& scene, int bits = 8)
        : session(scene, {.device = test::gl_device(), .format = PictureFormat{.bits = bits}},
                  files),
          picture(session.make_picture()) {}

    const image::Image8& image() const { return std::get<image::Image8>(picture.pixels); }
};

/// The view within the border as a scene of its own, without stamps.
scene::Scene view_alone(const Drawn& framed) {
    scene::Scene scene = framed.session.scene();
    const chart::Margins margins =
        chart::margins_for(planned_stamps(framed.session), scene.width_px, scene.height_px);
    scene.width_px -= margins.left + margins.right;
    scene.height_px -= margins.top + margins.bottom;
    // From above it has the shape of the ground, which fills it.
    const glm::dvec2 sides_m = framed.session.dem()->source->grid().sides_m();
    const double px_per_m = std::min(scene.width_px / sides_m.x, scene.height_px / sides_m.y);
    scene.width_px = static_cast<int>(std::lround(px_per_m * sides_m.x));
    scene.height_px = static_cast<int>(std::lround(px_per_m * sides_m.y));
    scene.view.orbit.zoom = 1 / scene::kFill;
    scene.stamps = {.legend = false};
    return scene;
}

int values_that_differ(const image::Image8& view, const image::Image8& picture,
                       const glm::ivec2& corner) {
    int count = 0;
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x)
            for (int c = 0; c < 3; ++c)
                count += view.at(x, y, c) != picture.at(corner.x + x, corner.y + y, c);
    return count;
}

TEST(Margin, TheViewIsThatOfAPictureOfItsOwnAndNothingLiesOnIt) {
    const Drawn framed(scene_of(700, 600));
    EXPECT_EQ(framed.image().width, 700);
    EXPECT_EQ(framed.image().height, 600);
    EXPECT_THAT(framed.session.stamp_notes(), testing::IsEmpty());
    EXPECT_EQ(framed.session.scene().width_px, 700);  // which is recorded
    const Drawn alone(view_alone(framed));
    EXPECT_EQ(values_that_differ(alone.image(), framed.image(), framed.session.map_corner_px()), 0);
    EXPECT_EQ(framed.image().at(0, 0, 0), 255);
}

TEST(Margin, AMapSheetIsFullOfGround) {
    scene::Scene scene = scene_of(900, 700);
    scene.effects.presets = {"swiss"};
    scene.stamps.graticule = true;
    const Drawn framed(scene);
    EXPECT_THAT(framed.session.stamp_notes(), testing::IsEmpty());
    const Drawn alone(view_alone(framed));
    const image::Image8& view = alone.image();
    int white = 0;
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x)
            white += view.at(x, y, 0) == 255 && view.at(x, y, 2) == 255;
    EXPECT_LT(white, 0.03 * view.width * view.height);
    EXPECT_EQ(framed.session.scene().view, scene.view);  // which is recorded
}

TEST(Margin, PicturesOf16BitsAndTransparentOnesHaveIt) {
    scene::Scene scene = scene_of(400, 360);
    scene.view = scene::parse_view("south,el=60");
    scene.transparent = true;
    const Drawn framed(scene, 16);
    const auto& image = std::get<image::Image16>(framed.picture.pixels);
    EXPECT_EQ(image.width, 400);
    EXPECT_EQ(image.channels, 4);
    EXPECT_EQ(image.at(0, 0, 0), 65535);
    EXPECT_EQ(image.at(0, 0, 3), 65535);
    const glm::ivec2 corner = framed.session.map_corner_px();
    EXPECT_EQ(image.at(corner.x, corner.y, 3), 0);  // beside the ground
}

TEST(Margin, AMapKeepsItsShapeAndItsGeoreference) {
    scene::Scene scene = scene_of(800, 500);
    scene.ortho = true;
    const Drawn framed(scene);
    EXPECT_EQ(framed.image().width, 800);
    const scene::MapArea& area = framed.session.camera().map->area();
    EXPECT_NEAR(area.pixel_x / area.pixel_y, 1, 0.01);
    const glm::ivec2 corner = framed.session.map_corner_px();
    EXPECT_GT(corner.x, 11);
    EXPECT_GT(corner.y, 11);
    const auto g = georeference_of(framed.session)->geotransform;
    // The corner of the ground is where the DEM has it.
    EXPECT_NEAR(g[0] + corner.x * g[1], area.left, 1e-9);
    EXPECT_NEAR(g[3] + corner.y * g[5], area.top, 1e-9);
}

TEST(Margin, RefusesPicturesWithoutRoom) {
    EXPECT_EQ(test::error_of([] { Drawn framed(scene_of(120, 60)); }),
              "exit 3: --margin: stamps take all of a picture of 120 x 60 px; use a larger --size, "
              "or omit some of them");
}

}  // namespace
}  // namespace relevo::session::test_margin
