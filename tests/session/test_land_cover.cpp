// Maps of land cover: what pictures show of them, where, and what is wrong with one.
#include <filesystem>
#include <fstream>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dem/fixture.h"
#include "dem/source.h"
#include "overlay/photo.h"
#include "session/land_cover.h"
#include "session/session.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::session::test_land_cover {
namespace {

using test::error_of;
using testing::HasSubstr;

constexpr int kSide_px = 160;

std::string jacksboro() {
    return (test::source_dir() / "data/dem/jacksboro.tif").string();
}

/// Classes over the bundled DEM, of 40 x 40 pixels.
std::string write_map(const std::string& name, const std::function<double(int, int)>& value,
                      const std::string& type = "Byte") {
    const dem::Grid dem = dem::Source::open(jacksboro()).grid();
    const dem::Affine& a = dem.affine();
    const double x = a.x_column * dem.columns() / 40, y = a.y_row * dem.rows() / 40;
    return test::write_raster(
        test::folder() / name,
        {.type = type,
         .columns = 40,
         .rows = 40,
         .geotransform = {{a.x0 - 0.5 * a.x_column, x, 0, a.y0 - 0.5 * a.y_row, 0, y}},
         .crs = dem.crs().text(),
         .nodata = 0,
         .value = [=](int column, int row, int) { return value(column, row); }});
}

scene::Scene map_of(const std::string& file) {
    scene::Scene scene;
    scene.dems = {jacksboro()};
    scene.time.at = "2026-06-21T17:30Z";
    scene.width_px = scene.height_px = kSide_px;
    scene.view.orbit = {180, 89.9, 1};
    if (!file.empty()) scene.land_cover = {.file = file, .classes = "worldcover"};
    return scene;
}

/// Mean colours near the middle of a quarter of a picture of the whole DEM from above.
struct Colour {
    double red = 0, green = 0, blue = 0;
};
Colour quarter(const image::Image8& picture, bool east, bool south) {
    Colour mean;
    int count = 0;
    for (int row = 45; row < 65; ++row)
        for (int column = 45; column < 65; ++column) {
            const int x = east ? kSide_px - 1 - column : column;
            const int y = south ? kSide_px - 1 - row : row;
            mean.red += picture.at(x, y, 0);
            mean.green += picture.at(x, y, 1);
            mean.blue += picture.at(x, y, 2);
            ++count;
        }
    return {mean.red / count, mean.green / count, mean.blue / count};
}

class LandCover : public testing::Test {
  protected:
    image::Image8 picture(const scene::Scene& scene) {
        session_ = std::make_unique<Session>(scene, Options{.device = test::gl_device()}, files_);
        session_->draw();
        return session_->picture();
    }
    FilesInUse files_;
    std::unique_ptr<Session> session_;
};

TEST_F(LandCover, IsDrawnWhereItLies) {
    // North-west bare, north-east ice, south-west meadow; nothing is known of the south-east.
    const image::Image8 found = picture(map_of(write_map("quarters.tif", [](int column, int row) {
        return row < 20 ? (column < 20 ? 60 : 70) : (column < 20 ? 30 : 0);
    })));
    const image::Image8 climate = picture(map_of(""));
    const Colour bare = quarter(found, false, false), ice = quarter(found, true, false),
                 meadow = quarter(found, false, true), unknown = quarter(found, true, true),
                 forest = quarter(climate, true, true);
    EXPECT_GT(ice.blue, 180);
    EXPECT_GT(ice.blue, ice.red);
    EXPECT_LT(bare.green, 1.05 * bare.red) << "rock is grey";
    EXPECT_GT(bare.red, forest.red + 40);
    EXPECT_GT(meadow.green, 1.05 * meadow.red);
    EXPECT_GT(meadow.green, forest.green + 15) << "forest is darker than meadows";
    EXPECT_NEAR(unknown.red, forest.red, 0.5);
    EXPECT_NEAR(unknown.green, forest.green, 0.5);
}

TEST_F(LandCover, IsTakenAndLeftByALaterScene) {
    const scene::Scene with = map_of(write_map("all_bare.tif", [](int, int) { return 60; }));
    const image::Image8 bare = picture(with), climate = picture(map_of(""));
    EXPECT_GT(quarter(bare, false, false).red, quarter(climate, false, false).red + 40);
    session_->show(with, session_->time());
    session_->draw();
    EXPECT_EQ(session_->picture().values, bare.values);
    session_->show(map_of(""), session_->time());
    session_->draw();
    EXPECT_EQ(session_->picture().values, climate.values);
    scene::Scene missing = with;
    missing.land_cover.file = "/none.tif";
    missing.exaggeration = 2;
    EXPECT_THAT(error_of([&] { session_->show(missing, session_->time()); }),
                HasSubstr("/none.tif"));
    session_->draw();
    EXPECT_EQ(session_->picture().values, climate.values) << "the scene before is still there";
}

TEST_F(LandCover, FarAwayAPixelHasTheMeanOfItsShares) {
    // Columns of ice and of meadow in turn: a pixel of four columns is half of each.
    const std::string file =
        write_map("stripes.tif", [](int column, int) { return column % 2 ? 70 : 30; });
    const dem::Grid grid = dem::Source::open(jacksboro()).grid();
    const auto photo = open_land_cover({.file = file, .classes = "worldcover"}, grid);
    const double apart = grid.columns() / 10.0;
    const Array2d<std::uint32_t> texels = photo->read(
        {.first_post = glm::dvec2(2 * apart), .step = glm::dvec2(apart), .count = {6, 6}});
    for (const std::uint32_t texel : texels) {
        EXPECT_NEAR(texel >> 8 & 255, 127, 35);
        EXPECT_NEAR(texel >> 16 & 255, 127, 35);
        EXPECT_EQ(texel >> 24, 255u);
    }
}

TEST_F(LandCover, SaysWhatIsWrongWithAMap) {
    const dem::Grid grid = dem::Source::open(jacksboro()).grid();
    const auto fault = [&](const scene::LandCover& asked) {
        return error_of([&] { open_land_cover(asked, grid); });
    };
    EXPECT_THAT(fault({.file = write_map("odd.tif", [](int, int) { return 200; }), .classes = ""}),
                HasSubstr("what are its classes? --land-cover-classes NAME|FILE says it; "
                          "worldcover has no class 200; nlcd has no class 200"));
    EXPECT_THAT(
        fault({.file = write_map("either.tif", [](int, int) { return 12; }), .classes = ""}),
        HasSubstr("may be those of nlcd and of corine; --land-cover-classes NAME"));
    EXPECT_THAT(fault({.file = write_map(
                           "deep.tif", [](int, int) { return 10; }, "Int16"),
                       .classes = ""}),
                HasSubstr("the raster's classes are no bytes"));
    EXPECT_THAT(fault({.file = "", .classes = "nlcd"}), HasSubstr("there is no map"));
    const std::string elsewhere =
        test::write_raster(test::folder() / "elsewhere.tif",
                           {.type = "Byte", .value = [](int, int, int) { return 70.0; }});
    EXPECT_THAT(fault({.file = elsewhere, .classes = ""}), HasSubstr("does not cover this DEM"));
}

/// A town on a plain, of posts so far apart.
std::string town(const std::string& name, double apart_m) {
    return test::write_raster(test::folder() / name,
                              {.type = "Float32",
                               .columns = 120,
                               .rows = 120,
                               .geotransform = {{500000, apart_m, 0, 5600000, 0, -apart_m}},
                               .crs = "EPSG:32632",
                               .value = [](int column, int row, int) {
                                   return column % 12 < 6 && row % 12 < 6 ? 110.0 : 100.0;
                               }});
}

TEST_F(LandCover, HousesOfASurfaceModelAreGrey) {
    scene::Scene scene = map_of("");
    scene.dems = {town("town.tif", 2)};
    const auto greenness = [](const image::Image8& picture) {
        double sum = 0;
        for (int y = 40; y < 120; ++y)
            for (int x = 40; x < 120; ++x)
                sum += picture.at(x, y, 1) - 0.5 * (picture.at(x, y, 0) + picture.at(x, y, 2));
        return sum / 6400;
    };
    const image::Image8 meadow = picture(scene);
    EXPECT_THAT(session_->ground_notes(), testing::Contains(HasSubstr("--surface")));
    scene::Scene with = scene;
    with.land_cover.surface = true;
    session_->show(with, session_->time());
    session_->draw();
    const image::Image8 city = session_->picture();
    EXPECT_THAT(session_->ground_notes(), testing::Not(testing::Contains(HasSubstr("--surface"))));
    EXPECT_GT(greenness(meadow), greenness(city) + 5);
    EXPECT_LT(greenness(city), 2);
    session_->show(scene, session_->time());
    session_->draw();
    EXPECT_EQ(session_->picture().values, meadow.values);
    EXPECT_EQ(picture(with).values, city.values);
}

TEST_F(LandCover, HousesEndWithTheirDem) {
    scene::Scene scene = map_of("");
    scene.dems = {town("rim.tif", 2)};
    scene.view = {};  // over the near edge, to the horizon
    const image::Image8 meadow = picture(scene);
    scene.land_cover.surface = true;
    const image::Image8 city = picture(scene);
    const auto differs = [&](int from, int to) {
        int most = 0;
        for (int y = from; y < to; ++y)
            for (int x = 0; x < kSide_px; ++x)
                most = std::max(most, std::abs(int{meadow.at(x, y, 0)} - int{city.at(x, y, 0)}));
        return most;
    };
    EXPECT_GT(differs(80, 160), 20);  // the DEM
    EXPECT_LE(differs(0, 30), 4);     // sky and country
}

TEST_F(LandCover, HousesAreNotInPostsFarApart) {
    scene::Scene scene = map_of("");
    scene.dems = {town("coarse.tif", 30)};
    scene.land_cover.surface = true;
    EXPECT_THAT(error_of([&] { picture(scene); }), HasSubstr("30 m apart"));
}

}  // namespace
}  // namespace relevo::session::test_land_cover
