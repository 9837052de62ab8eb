// Maps on paper: places of what stands around them, and their scale.
#include <cmath>

#include <gmock/gmock.h>

#include "../dem/fixture.h"
#include "scene/map_view.h"
#include "scene/sheet.h"
#include "session/picture_file.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::session::test_sheet {
namespace {

scene::Scene scene_of(const std::string& dem, const std::string& paper, double dpi) {
    scene::Scene scene;
    scene.dems = {dem};
    scene.time.at = "2026-06-21T10:00Z";
    scene.effects.presets = {"swiss"};
    scene.ortho = scene.stamps.margin = true;
    scene.sheet = {paper, 0, dpi};
    scene::show_stamps({"all"}, "test", scene.stamps);
    return scene;
}

std::string jacksboro() {
    return (test::source_dir() / "data/dem/jacksboro.tif").string();
}

struct Drawn {
    FilesInUse files;
    Session session;
    image::Picture picture;

    explicit Drawn(scene::Scene scene, bool map_alone = true)
        : session(fitted(std::move(scene)),
                  {.device = test::gl_device(), .format = PictureFormat{.map_alone = map_alone}},
                  files),
          picture(session.make_picture()) {}

    static scene::Scene fitted(scene::Scene scene) {
        scene::fit_map(scene, dem::Source::open(scene.dems, scene.dem).grid());
        return scene;
    }
};

TEST(Sheet, NothingOverlapsOnAnyPaper) {
    for (const char* const paper : {"a4-portrait", "a4-landscape", "a3-portrait", "a3-landscape",
                                    "a0-portrait", "a0-landscape"})
        for (const bool is_long : {false, true}) {
            scene::Scene scene = scene_of(jacksboro(), paper, 40);
            scene.stamps.attribution = true;
            scene.stamps.attribution_text = "AW3D30 (JAXA)";
            if (is_long) {
                scene.stamps.title_text = std::string(300, 'W');
                for (int i = 0; i < 60; ++i)
                    scene.stamps.attribution_text += " and many others";
            }
            scene.exaggeration = 2;
            const Drawn drawn(scene);
            SCOPED_TRACE(fmt::format("{}, long: {}", paper, is_long));
            EXPECT_THAT(drawn.session.stamp_notes(), testing::IsEmpty());
            const chart::PaperSheet& sheet = *drawn.session.paper_sheet();
            std::vector<chart::Rect> boxes = sheet.taken;
            ASSERT_GT(boxes.size(), 10U);
            boxes.push_back(sheet.picture);
            const double edge = 5 / 25.4 * sheet.dpi;  // that printers leave white
            const glm::dvec2 size = sheet.size_mm / 25.4 * sheet.dpi;
            for (std::size_t i = 0; i < boxes.size(); ++i) {
                EXPECT_GT(std::min(boxes[i].x, boxes[i].y), edge);
                EXPECT_LT(boxes[i].x + boxes[i].width, size.x - edge);
                EXPECT_LT(boxes[i].y + boxes[i].height, size.y - edge);
                for (std::size_t k = 0; k < i; ++k)
                    EXPECT_FALSE(chart::overlap(boxes[i], boxes[k])) << i << ", " << k;
            }
        }
}

/// The worst of both axes: the sides of the DEM on the sheet at its scale, against geodesics.
double error_of_scale(const Drawn& drawn, double scale) {
    const dem::Grid& grid = drawn.session.dem()->source->grid();
    const scene::MapView& map = *drawn.session.camera().map;
    const double columns = grid.columns() - 1.0, rows = grid.rows() - 1.0;
    const auto on_paper_m = [&](const glm::dvec2& from, const glm::dvec2& to) {
        return glm::distance(map.pixel(from), map.pixel(to)) / drawn.picture.dpi * 0.0254 * scale;
    };
    const glm::dvec2 sides_m = grid.sides_m();
    return std::max(std::abs(on_paper_m({0, rows / 2}, {columns, rows / 2}) / sides_m.x - 1),
                    std::abs(on_paper_m({columns / 2, 0}, {columns / 2, rows}) / sides_m.y - 1));
}

TEST(Sheet, TheScaleIsTrueInEveryCrs) {
    struct Case {
        const char* crs;
        std::array<double, 6> place;
    };
    // In degrees, of a Mercator's, in feet, and far from a zone's middle.
    for (const Case& c : {Case{"EPSG:4326", {10, 0.001, 0, 60, 0, -0.001}},
                          Case{"EPSG:3857", {1113000, 60, 0, 8400000, 0, -60}},
                          Case{"EPSG:2263", {980000, 100, 0, 200000, 0, -100}},
                          Case{"EPSG:32632", {200000, 30, 0, 5200000, 0, -30}}}) {
        test::Raster raster;
        raster.columns = 60;
        raster.rows = 80;
        raster.crs = c.crs;
        raster.geotransform = c.place;
        const std::string dem = test::write_raster(test::scratch_dir() / "crs.tif", raster);
        for (const double scale : {0.0, 50000.0}) {
            scene::Scene scene = scene_of(dem, "a4", 100);
            scene.sheet.scale = scale;
            const Drawn drawn(scene);
            const chart::PaperSheet& sheet = *drawn.session.paper_sheet();
            double stated = 0;
            for (const chart::Placed& placed : sheet.drawings)
                for (const chart::Drawing::Item& item : placed.drawing.items())
                    if (const auto* const text = std::get_if<chart::Drawing::Text>(&item);
                        text && text->words.starts_with("1 : ")) {
                        std::string digits = text->words.substr(4);
                        std::erase(digits, ' ');
                        stated = std::stod(digits);
                    }
            if (scale > 0) {
                EXPECT_EQ(stated, scale);
            }
            const double error = error_of_scale(drawn, stated);
            fmt::print("[ accuracy ] {} at 1 : {}: {:.4f} %\n", c.crs, stated, 100 * error);
            EXPECT_LT(error, 0.002);
        }
    }
}

TEST(Sheet, APictureOfItHasTheSameMapAtTheSamePlace) {
    const scene::Scene scene = scene_of(jacksboro(), "a4", 50);
    const Drawn alone(scene), whole(scene, /*map_alone=*/false);
    const auto& map = std::get<image::Image8>(alone.picture.pixels);
    const auto& sheet = std::get<image::Image8>(whole.picture.pixels);
    EXPECT_EQ(sheet.width, 413);  // 210 mm
    EXPECT_EQ(sheet.height, 585);
    EXPECT_EQ(whole.picture.dpi, 50);
    EXPECT_EQ(whole.session.paper_sheet(), nullptr);
    const glm::ivec2 corner = whole.session.map_corner_px();
    EXPECT_EQ(corner.x, alone.session.paper_sheet()->picture.x);
    int same = 0;
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x)
            same += map.at(x, y, 1) == sheet.at(corner.x + x, corner.y + y, 1);
    EXPECT_GT(same, 0.8 * map.width * map.height);  // lines of the graticule lie on the others
    // The georeference is that of the pixels of the sheet.
    const auto g = georeference_of(whole.session)->geotransform;
    const scene::MapArea& area = whole.session.camera().map->area();
    EXPECT_NEAR(g[0] + corner.x * g[1], area.left, 1e-9);
    EXPECT_NEAR(g[3] + corner.y * g[5], area.top, 1e-9);
    EXPECT_EQ(whole.session.scene().sheet, scene.sheet);  // which is recorded
}

TEST(Sheet, SaysWhatPartItHas) {
    scene::Scene scene = scene_of(jacksboro(), "a4", 50);
    scene.sheet.scale = 30000;
    EXPECT_THAT(Drawn(scene).session.stamp_notes(),
                testing::Contains(
                    testing::StartsWith("sheet: 1 : 30 000 has the middle of the DEM; 1 : ")));
}

TEST(Sheet, LinesOfTheGraticuleAreStraightInDegreesAndEndAtTheMap) {
    const Drawn drawn(scene_of(jacksboro(), "a4", 100));
    const chart::PaperSheet& sheet = *drawn.session.paper_sheet();
    int lines = 0;
    for (const chart::Drawing::Item& item : sheet.drawings.front().drawing.items()) {
        const auto& points = std::get<chart::Drawing::Path>(item).points;
        const glm::dvec2 way = glm::abs(points.back() - points.front());
        EXPECT_LT(std::min(way.x, way.y), 0.01);
        EXPECT_NEAR(std::max(way.x / sheet.picture.width, way.y / sheet.picture.height), 1, 1e-6);
        ++lines;
    }
    EXPECT_GT(lines, 10);
}

}  // namespace
}  // namespace relevo::session::test_sheet
