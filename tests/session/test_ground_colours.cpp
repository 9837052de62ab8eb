// Colours on the ground: the legend's are those of the picture, where they belong.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "base/units.h"
#include "dem/fixture.h"
#include "session/active_effects.h"
#include "session/colour_legends.h"
#include "session/seen_ground.h"
#include "session/session.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::session::test_ground_colours {
namespace {

constexpr int kSide = 129;
constexpr double kSpacing_m = 30;

/// A DEM at the equator in UTM, where the grid runs along the compass.
scene::Scene scene_of(const std::string& name, const std::function<double(int, int)>& height_m,
                      std::vector<std::string> effects) {
    test::Raster raster;
    raster.columns = raster.rows = kSide;
    raster.crs = "EPSG:32631";
    raster.geotransform = {{500000, kSpacing_m, 0, 2000, 0, -kSpacing_m}};
    raster.nodata = -9999;
    raster.value = [&](int column, int row, int) { return height_m(column, row); };
    scene::Scene scene;
    scene.dems = {test::write_raster(test::scratch_dir("ground_colours") / name, raster)};
    scene.time.at = "2026-06-21T10:00Z";
    scene.view.orbit = {180, 90, 1};
    scene.width_px = 260;
    scene.height_px = 240;
    scene.effects.switches.only = std::move(effects);
    return scene;
}

/// What a pixel of a picture shows: the column and row of the DEM.
class Pixels {
  public:
    explicit Pixels(const Session& session) : session_(session) {
        std::vector<float> depths_m;
        session.read_depths(depths_m);
        seen_.emplace(session.camera(), session.scene().width_px, session.scene().height_px,
                      std::move(depths_m));
    }
    /// Only well within the DEM, where a pixel shows nothing else.
    std::optional<glm::dvec2> post(int x, int y) const {
        const auto point = seen_->point(x, y);
        if (!point) return std::nullopt;
        const glm::dvec2 post =
            session_.dem()->field.grid.post(session_.ground().frame.to_geodetic(*point));
        if (std::min(post.x, post.y) < 3 || std::max(post.x, post.y) > kSide - 4)
            return std::nullopt;
        return post;
    }

  private:
    const Session& session_;
    std::optional<SeenGround> seen_;
};

int apart(const image::Image8& picture, int x, int y, std::uint32_t rgb) {
    int most = 0;
    for (unsigned k = 0; k < 3; ++k)
        most = std::max(most, std::abs(picture.at(x, y, static_cast<int>(k)) -
                                       static_cast<int>(rgb >> (16 - 8 * k) & 255)));
    return most;
}

/// Pixels whose colour is that of the legend for a value, among all.
/// @param value  of the legend at a post, NaN where none is told
double share_right(Session& session, const std::function<double(const glm::dvec2&)>& value,
                   int tolerance) {
    session.draw();
    const image::Image8 picture = session.picture();
    const Pixels pixels(session);
    const std::vector<chart::Legend> legends = session.colour_legends();
    EXPECT_EQ(legends.size(), 1u);
    int count = 0, right = 0;
    for (int y = 0; y < picture.height; y += 3)
        for (int x = 0; x < picture.width; x += 3) {
            const auto post = pixels.post(x, y);
            if (!post || std::isnan(value(*post))) continue;
            ++count;
            right += apart(picture, x, y, legends.front().ramp.at(value(*post)).rgb) <= tolerance;
        }
    EXPECT_GT(count, 1000);
    return static_cast<double>(right) / count;
}

void tint_by(scene::Scene& scene, const char* what) {
    scene.stamps.legend = false;
    scene.effects.settings = {{"tint.by", what}, {"tint.lit", "false"}};
}

TEST(ColourLegend, OfDirectionsIsThePictures) {
    // A cone: east of its top the ground faces east.
    const double middle = (kSide - 1) / 2.0;
    scene::Scene scene = scene_of(
        "cone.tif",
        [&](int column, int row) { return 2000 - 12 * std::hypot(column - middle, row - middle); },
        {"tint"});
    tint_by(scene, "aspect");
    FilesInUse files;
    Session session(scene, {.device = test::gl_device()}, files);
    const auto azimuth_deg = [&](const glm::dvec2& post) {
        const glm::dvec2 off(post.x - middle, middle - post.y);
        if (length(off) < 8) return std::nan("");
        const double azimuth = degrees(std::atan2(off.x, off.y));
        return azimuth < 0 ? azimuth + 360 : azimuth;
    };
    EXPECT_GT(share_right(session, azimuth_deg, 8), 0.97);
}

TEST(ColourLegend, OfLandAndSeaGoesFromTheFloorToTheSummit) {
    scene::Effects relief;
    relief.presets = {"relief"};
    const auto effects = ActiveEffects::of(relief, /*report=*/false);
    const std::vector<chart::Legend> legends = colour_legends(*effects, {-2000, 1500, true});
    const auto height = std::find_if(legends.begin(), legends.end(),
                                     [](const auto& one) { return one.title == "Height"; });
    ASSERT_NE(height, legends.end());
    const chart::Ramp& ramp = height->ramp;
    EXPECT_EQ(ramp.stops.front().value, -2000);
    EXPECT_EQ(ramp.stops.back().value, 1500);
    for (std::size_t i = 1; i < ramp.stops.size(); ++i)
        EXPECT_LT(ramp.stops[i - 1].value, ramp.stops[i].value) << i;
    // The deeper, the darker; shallow water is light, and all of it is blue.
    const auto channel = [&](double height_m, int shift) {
        return static_cast<int>(ramp.at(height_m).rgb >> shift & 255);
    };
    for (const double height_m : {-2000.0, -1000.0, -10.0})
        EXPECT_GT(channel(height_m, 0), channel(height_m, 16) + 30) << height_m;
    EXPECT_LT(channel(-2000, 8) + 60, channel(-10, 8));
    EXPECT_GT(channel(300, 8), channel(300, 0)) << "land is no sea";
    // Without a floor there is no such sea.
    EXPECT_GE(colour_legends(*effects, {-2000, 1500, false}).front().ramp.stops.front().value, 0);
}

TEST(Skylight, TakesFromHollowsWhatTheGroundThatStandsThereDoesNotSend) {
    // A gorge. White ground takes nothing and sends sunlight, too; black ground takes the most;
    // grey is between.
    scene::Scene scene =
        scene_of("gorge.tif",
                 [](int column, int) { return 50.0 * std::min(std::abs(column - 64), 20); }, {});
    scene.view = {.eye = scene::Standpoint{geo::geodetic_deg(0.0006, 3.0175, 5000)},
                  .heading_deg = 0,
                  .pitch_deg = -90};
    const auto light = [&](const char* albedo) {
        scene::Scene with = scene;
        if (albedo) {
            with.effects.switches.only = std::vector<std::string>{"skylight"};
            with.effects.settings = {{"skylight.albedo", albedo}};
        }
        FilesInUse files;
        Session session(with, {.device = test::gl_device(), .radiance = true}, files);
        session.draw();
        return session.radiance();
    };
    const image::ImageF bare = light(nullptr), white = light("1"), black = light("0"),
                        grey = light("0.5");
    double most = 0, sent = 0;
    for (int y = 20; y < bare.height; y += 5)
        for (int x = 0; x < bare.width; ++x) {
            const float whole = bare.at(x, y, 2);
            EXPECT_GE(white.at(x, y, 2), 0.99f * whole);
            sent = std::max(sent, double{white.at(x, y, 2)} / double{whole} - 1);
            EXPECT_LE(black.at(x, y, 2), 1.001f * whole);
            EXPECT_NEAR(grey.at(x, y, 2), 0.5f * (white.at(x, y, 2) + black.at(x, y, 2)),
                        0.01f * whole);
            most = std::max(most, 1 - double{black.at(x, y, 2)} / double{whole});
        }
    EXPECT_GT(most, 0.1);
    EXPECT_GT(sent, 0.3);  // in the shade
}

TEST(Infill, PaintsFilledHolesAndNothingElse) {
    const auto is_hole = [](double column, double row) {
        return std::abs(column - 40) <= 3 && std::abs(row - 60) <= 3;
    };
    // With a sea beside it, which is no hole.
    scene::Scene scene = scene_of(
        "hole.tif",
        [&](int column, int row) {
            return is_hole(column, row) ? -9999.0 : column > 100 ? 0.0 : 100.0 + column % 5;
        },
        {"infill"});
    scene.effects.settings = {{"infill.colour", "0,1,0,1"}};
    FilesInUse files;
    Session session(scene, {.device = test::gl_device()}, files);
    session.draw();
    const image::Image8 picture = session.picture();
    const Pixels pixels(session);
    int painted = 0, wrong = 0;
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const auto post = pixels.post(x, y);
            if (!post) continue;
            const bool green = apart(picture, x, y, 0x00ff00) < 4;
            // Its edge lies between the posts.
            const double from_edge = std::max(std::abs(post->x - 40), std::abs(post->y - 60)) - 3;
            painted += green;
            wrong += green ? from_edge > 1 : from_edge < -0.5;
        }
    EXPECT_GT(painted, 50);
    EXPECT_EQ(wrong, 0);
}

/// A plugin that paints land by classes of height, and names two colours.
void add_classes(scene::Scene& scene) {
    const std::filesystem::path folder = test::scratch_dir("classes");
    std::filesystem::create_directories(folder / "classes");
    std::ofstream(folder / "classes" / "plugin.json")
        << R"({"format": 1, "id": "classes", "name": "Classes", "description": "Classes of height",
               "version": "1.0.0"})";
    std::ofstream(folder / "classes" / "classes.glsl")
        << "uniform int classes_by = 0; //@ enum(height, ground)\n"
           "const vec3 classes_height[3] = vec3[](vec3(0.2, 0.4, 0.2), vec3(0.8, 0.8, 0.4), "
           "vec3(0.6, 0.2, 0.0)); //@ steps(0, 400, 600, 2000) unit(m) label(\"Height\") "
           "where(by, height)\n"
           "const vec3 classes_rock[1] = vec3[](vec3(0.4, 0.4, 0.4)); //@ entries(rock) "
           "label(\"Ground\") where(by, ground)\n"
           "const vec3 classes_cold[2] = vec3[](vec3(1.0, 1.0, 1.0), vec3(0.6, 0.8, 1.0)); //@ "
           "entries(\"fresh snow\", ice) label(\"Ground\") where(by, ground)\n"
           "void classes_on_display(in Surface s, inout vec4 overlay) {\n"
           "    overlay = vec4(classes_height[s.height_m < 400.0 ? 0 : s.height_m < 600.0 ? 1 : "
           "2], 1.0);\n}\n";
    scene.effects.plugin_path = {folder.string()};
}

scene::Scene scene_of_classes(const char* by) {
    scene::Scene scene = scene_of(
        "slope.tif", [](int column, int row) { return 300 + 4 * column + row; }, {"classes"});
    add_classes(scene);
    scene.stamps.legend = false;
    scene.effects.settings = {{"classes.by", by}};
    return scene;
}

TEST(ColourLegend, OfStepsIsThePictures) {
    FilesInUse files;
    Session session(scene_of_classes("height"), {.device = test::gl_device()}, files);
    const auto height_m = [](const glm::dvec2& post) {
        const double height = 300 + 4 * post.x + post.y;
        // Not where an edge is within a pixel.
        const bool at_edge = std::min(std::abs(height - 400), std::abs(height - 600)) < 10;
        return at_edge ? std::nan("") : height;
    };
    EXPECT_GT(share_right(session, height_m, 1), 0.999);
    const std::vector<chart::Legend> legends = session.colour_legends();
    EXPECT_EQ(legends.at(0).title, "Height");
    EXPECT_EQ(legends.at(0).unit, "m");
    EXPECT_EQ(legends.at(0).edges, (std::vector<double>{0, 400, 600, 2000}));
}

TEST(ColourLegend, OfEntriesHasAllOfOneTitle) {
    FilesInUse files;
    Session session(scene_of_classes("ground"), {.device = test::gl_device()}, files);
    const std::vector<chart::Legend> legends = session.colour_legends();
    ASSERT_EQ(legends.size(), 1u);
    EXPECT_EQ(legends[0].title, "Ground");
    EXPECT_EQ(legends[0].classes,
              (std::vector<chart::Legend::Class>{
                  {"rock", {0x666666}}, {"fresh snow", {0xffffff}}, {"ice", {0x99ccff}}}));
}

TEST(ExaggeratedPicture, IsThatOfGroundAsHigh) {
    // What light and air make of the ground is of the ground as it is drawn.
    constexpr double kFactor = 5;
    const auto picture = [&](double height_factor, double exaggeration) {
        scene::Scene scene =
            scene_of(fmt::format("hills{}.tif", height_factor),
                     [&](int column, int row) {
                         return height_factor *
                                (60 + 40 * std::sin(column / 7.0) * std::sin(row / 11.0) + column);
                     },
                     {"haze", "sky", "shadows", "skylight"});
        scene.time.at = "2026-06-21T07:30Z";
        scene.exaggeration = exaggeration;
        scene.effects.settings = {{"haze.density", "0.4"}, {"haze.scale_height", "500"}};
        scene.view = {.eye = scene::Standpoint{geo::geodetic_deg(0.001, 2.997, 900 / exaggeration)},
                      .heading_deg = 80,
                      .pitch_deg = -8};
        FilesInUse files;
        Session session(scene, {.device = test::gl_device()}, files);
        session.draw();
        return session.picture();
    };
    const image::Image8 high = picture(kFactor, 1), exaggerated = picture(1, kFactor),
                        flat = picture(1, 1);
    EXPECT_GT(image::compare(high, exaggerated).psnr_db, 38);
    EXPECT_LT(image::compare(high, flat).psnr_db, 25);
}

}  // namespace
}  // namespace relevo::session::test_ground_colours
