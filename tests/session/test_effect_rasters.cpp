// Rasters that users choose for effects: by file, over the ground, changed and mistaken.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/units.h"
#include "dem/fixture.h"
#include "dem/load.h"
#include "dem/source.h"
#include "light/point/horizon.h"
#include "session/session.h"
#include "sun/position.h"
#include "support/change.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::session::test_effect_rasters {
namespace {

std::string jacksboro() {
    return (test::source_dir() / "data/dem/jacksboro.tif").string();
}

/// A raster over the bundled DEM, of 40 x 40 pixels.
std::string write_over(const std::string& name, test::Raster raster) {
    const dem::Grid dem = dem::Source::open(jacksboro()).grid();
    const dem::Affine& a = dem.affine();
    const double x = a.x_column * dem.columns() / 40, y = a.y_row * dem.rows() / 40;
    raster.columns = raster.rows = 40;
    raster.geotransform = {{a.x0 - 0.5 * a.x_column, x, 0, a.y0 - 0.5 * a.y_row, 0, y}};
    raster.crs = dem.crs().text();
    return test::write_raster(test::folder() / name, raster);
}

/// Bytes of one colour.
std::string write_photo(const std::string& name, int grey) {
    return write_over(name, {.type = "Byte",
                             .bands = 3,
                             .value = [=](int, int, int) { return double(grey); },
                             .pictures = true});
}

scene::Scene from_above(const std::string& effect) {
    scene::Scene scene;
    scene.dems = {jacksboro()};
    scene.time.at = "2026-06-21T17:30Z";
    scene.effects.switches.only = std::vector<std::string>{effect};
    scene.width_px = 160;
    scene.height_px = 128;
    scene.view.orbit = {180, 89.9, 1};
    return scene;
}

scene::Scene draped(const std::string& file) {
    scene::Scene scene = from_above("drape");
    scene.effects.settings = {{"drape.file", file}, {"drape.light", "flat"}};
    return scene;
}

class EffectRasters : public testing::Test {
  protected:
    Session& open(const scene::Scene& scene) {
        session_ = std::make_unique<Session>(scene, Options{.device = test::gl_device()}, files_);
        session_->draw();
        return *session_;
    }
    int middle() {
        session_->draw();
        return session_->picture().at(80, 64, 0);
    }
    FilesInUse files_;
    std::unique_ptr<Session> session_;
};

TEST_F(EffectRasters, AreDrawnAndChangedAndSwitchedOffAndOn) {
    Session& session = open(draped(write_photo("dark.tif", 50)));
    EXPECT_NEAR(middle(), 50, 1);
    scene::Effects other = draped(write_photo("light.tif", 200)).effects;
    test::set_effects(session, other);
    EXPECT_NEAR(middle(), 200, 1);
    scene::Effects off = other;
    off.switches.only = std::vector<std::string>{};
    test::set_effects(session, off);
    EXPECT_LT(middle(), 190);
    test::set_effects(session, other);
    EXPECT_NEAR(middle(), 200, 1);
}

TEST_F(EffectRasters, AMistakeLeavesThePictureAsItWas) {
    Session& session = open(draped(write_photo("dark.tif", 50)));
    EXPECT_THAT(
        test::error_of([&] { test::set_effects(session, draped("/nowhere/photo.tif").effects); }),
        testing::StartsWith("exit 3: drape.file: /nowhere/photo.tif: "));
    EXPECT_NEAR(middle(), 50, 1);
}

TEST_F(EffectRasters, AMistakeInAFileOfLinesLeavesThePictureAsItWas) {
    scene::Scene scene = from_above("tracks");
    const std::string lines = (test::source_dir() / "tests/data/lines/jacksboro.geojson").string();
    scene.effects.settings = {{"tracks.file", lines}};
    Session& session = open(scene);
    const image::Image8 before = session.picture();
    scene::Effects other = scene.effects;
    other.settings = {{"tracks.file", "/nowhere/walk.gpx"}};
    EXPECT_THAT(test::error_of([&] { test::set_effects(session, other); }),
                testing::HasSubstr("/nowhere/walk.gpx"));
    session.draw();
    EXPECT_EQ(session.picture().values, before.values);
}

// Short lines on ground that the terrain horizon leaves in the sun, and on ground that it hides.
TEST_F(EffectRasters, LinesHaveAnotherColourWithoutDirectLight) {
    dem::Source source = dem::Source::open(jacksboro());
    const dem::Heightfield field = dem::load(source, dem::LoadOptions{}.memory);
    scene::Scene scene = from_above("tracks");
    scene.time.at = "2026-12-21T14:15Z";
    scene.width_px = 800;  // more than a pixel a post
    scene.height_px = 640;
    const sun::Instant utc = sun::parse_time(scene.time.at).utc;
    /// Of the sun over the terrain [deg].
    const auto clearance_deg = [&](int column, int row) {
        const light::TerrainHorizon horizon(field, field.grid.place(column, row),
                                            {.few_directions = true});
        const sun::Position at = sun::position(utc, horizon.place());
        return degrees(at.elevation_rad - horizon.elevation_rad(at.azimuth_rad));
    };
    int lit = 0, shaded = 0;
    for (int column = 40; column < field.grid.columns() - 40; column += 6) {
        constexpr int kRow = 200;
        std::vector<double> around_deg;  // also of the pixels that the line's width adds
        for (const int row : {kRow - 2, kRow, kRow + 2})
            for (int by = -3; by <= 3; ++by)
                around_deg.push_back(clearance_deg(column + by, row));
        const auto [least, most] = std::ranges::minmax(around_deg);
        const bool is_lit = least > 1;
        if (!is_lit && most > -1) continue;
        const std::string file = (test::folder() / "line.geojson").string();
        const auto text_of = [&](int at) {
            const geo::Geodetic place = field.grid.place(at, kRow);
            return fmt::format("[{}, {}]", degrees(place.lon_rad), degrees(place.lat_rad));
        };
        std::ofstream(file) << R"({"type": "LineString", "coordinates": [)" << text_of(column - 1)
                            << ", " << text_of(column + 1) << "]}";
        scene.effects.settings = {{"tracks.file", file},        {"tracks.colours", "light"},
                                  {"tracks.colour", "#ff0000"}, {"tracks.shade_colour", "#0000ff"},
                                  {"tracks.casing_px", "0"},    {"tracks.width_px", "3"}};
        const image::Image8 picture = open(scene).picture();
        int red = 0, blue = 0;
        for (int y = 0; y < picture.height; ++y)
            for (int x = 0; x < picture.width; ++x) {
                red += picture.at(x, y, 0) > 250 && picture.at(x, y, 2) < 5;
                blue += picture.at(x, y, 2) > 250 && picture.at(x, y, 0) < 5;
            }
        EXPECT_GT(is_lit ? red : blue, 5) << column;
        EXPECT_EQ(is_lit ? blue : red, 0) << column;
        ++(is_lit ? lit : shaded);
    }
    EXPECT_GT(lit, 2);
    EXPECT_GT(shaded, 2);
}

TEST_F(EffectRasters, FilesThatLieAreErrorsWithTheirName) {
    const auto written = [](const std::string& name, const std::string& text) {
        std::ofstream(test::folder() / name) << text;
        return (test::folder() / name).string();
    };
    const std::string far = test::write_raster(test::folder() / "far.tif", {});
    const std::string empty = write_over(
        "empty.tif", {.nodata = -9999.0, .value = [](int, int, int) { return -9999.0; }});
    const std::string nan =
        write_over("nan.tif", {.value = [](int, int, int) { return std::nan(""); }});
    for (const std::string& file : {written("text.tif", "hello"), written("none.tif", ""),
                                    test::folder().string(), far, empty, nan})
        EXPECT_THAT(test::error_of([&] { open(draped(file)); }),
                    testing::StartsWith("exit 3: drape.file: " + file + ": "))
            << file;
}

TEST_F(EffectRasters, ARasterOfOneCellCoversItsGround) {
    const dem::Grid dem = dem::Source::open(jacksboro()).grid();
    const dem::Affine& a = dem.affine();
    const std::string one = test::write_raster(
        test::folder() / "one.tif",
        {.type = "Byte",
         .columns = 1,
         .rows = 1,
         .bands = 3,
         .geotransform = {{a.x0, a.x_column * dem.columns(), 0, a.y0, 0, a.y_row * dem.rows()}},
         .crs = dem.crs().text(),
         .value = [](int, int, int) { return 90.0; },
         .pictures = true});
    open(draped(one));
    EXPECT_NEAR(middle(), 90, 1);
}

TEST_F(EffectRasters, AChangedFileIsReadAgain) {
    const scene::Scene scene = draped(write_photo("photo.tif", 50));
    Session& session = open(scene);
    EXPECT_NEAR(middle(), 50, 1);
    std::filesystem::rename(write_photo("new.tif", 120), scene.effects.settings[0].text);
    test::set_effects(session, scene.effects);
    EXPECT_NEAR(middle(), 120, 1);
}

TEST_F(EffectRasters, WithoutAFileNothingIsDrawn) {
    open(draped(""));
    const image::Image8 found = session_->picture();
    scene::Scene bare = from_above("drape");
    bare.effects.switches.only = std::vector<std::string>{};
    open(bare);
    EXPECT_EQ(found.values, session_->picture().values);
}

TEST_F(EffectRasters, OneBandIsDrawnInColoursWithALegend) {
    const std::string file = write_over(
        "band.tif", {.type = "Float32", .value = [](int column, int, int) { return column; }});
    scene::Scene scene = draped(file);
    scene.effects.settings.push_back({"drape.colours", "grey"});
    Session& session = open(scene);
    const image::Image8 picture = session.picture();
    EXPECT_GT(picture.at(100, 64, 0), picture.at(60, 64, 0) + 20);
    ASSERT_EQ(session.legends().size(), 1U);
    EXPECT_EQ(session.legends()[0].title, "band.tif");
}

/// An effect that draws values in grey: 100 and where there is none black.
std::string write_effect() {
    const std::filesystem::path folder = test::folder() / "gauge";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "plugin.json") << R"({
"format": 1, "id": "gauge", "name": "Gauge", "version": "1",
"textures": {"depth": {"kind": "raster", "from": "file", "holds": "values"}},
"texts": {"file": {"kind": "file"}}})";
    std::ofstream(folder / "gauge.glsl") << R"(
void gauge_on_display(in Surface s, inout vec4 overlay) {
    vec2 depth = gauge_depth(s);
    overlay = vec4(vec3(depth.x / 255.0), 1.0);
    if (depth.y < 0.5) overlay = vec4(0.0, 0.0, 0.0, 1.0);
}
)";
    return folder.string();
}

TEST_F(EffectRasters, ValuesAreThoseOfTheFileAndKnowWhereThereIsNone) {
    const std::string file = write_over(
        "depth.tif", {.type = "Float32", .nodata = -9999.0, .value = [](int column, int, int) {
                          return column < 20 ? -9999.0 : 100.0;
                      }});
    scene::Scene scene = from_above("gauge");
    scene.effects.plugin_path = {write_effect()};
    scene.effects.settings = {{"gauge.file", file}};
    const image::Image8 picture = open(scene).picture();
    for (int y = 40; y < 88; ++y) {
        EXPECT_EQ(picture.at(60, y, 0), 0);
        EXPECT_EQ(picture.at(110, y, 0), 100);
    }
}

TEST_F(EffectRasters, AreInputsThatNoOutputReplaces) {
    const std::string file = write_photo("photo.tif", 50);
    open(draped(file));
    EXPECT_THAT(test::error_of([&] { files_.check_planned({file}, "--output"); }),
                testing::HasSubstr("photo.tif"));
    const std::string colours = (test::folder() / "colours.txt").string();
    std::ofstream(colours) << "0 10 20 30\n40 200 100 50\n";
    const std::string band =
        write_over("band.tif", {.value = [](int column, int, int) { return double(column); }});
    scene::Scene scene = draped(band);
    scene.effects.settings.push_back({"drape.colours", colours});
    open(scene);
    EXPECT_THAT(test::error_of([&] { files_.check_planned({colours}, "--output"); }),
                testing::HasSubstr("colours.txt"));
}

}  // namespace
}  // namespace relevo::session::test_effect_rasters
