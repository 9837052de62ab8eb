#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "base/log.h"
#include "base/units.h"
#include "dem/fixture.h"
#include "dem/load.h"
#include "support/support.h"

namespace relevo::dem::test_mosaic {
namespace {

using test::add_overviews;
using test::Raster;
using test::write_raster;
using testing::Contains;
using testing::ElementsAre;
using Paths = std::vector<std::string>;

using test::folder;

/// A plane over UTM 32 N, so that any sampling of it is it.
double plane_m(double x, double y) {
    return 500 + 0.3 * (x - 500000) - 0.2 * (y - 5200000);
}

/// A tile of it, by the first column and row on a grid of 30 m.
Raster tile(int column, int row, int columns, int rows) {
    Raster raster;
    raster.columns = columns;
    raster.rows = rows;
    raster.geotransform = {{500000 + 30.0 * column, 30, 0, 5200000 - 30.0 * row, 0, -30}};
    raster.value = [=](int c, int r, int) {
        return plane_m(500000 + 30 * (column + c + 0.5), 5200000 - 30 * (row + r + 0.5));
    };
    return raster;
}

void expect_plane(const Heightfield& f, double tolerance_m) {
    for (int r = 0; r < f.grid.rows(); ++r)
        for (int c = 0; c < f.grid.columns(); ++c) {
            const glm::dvec2 at = f.grid.affine()(c, r);
            ASSERT_NEAR(f.height_m.at(c, r), plane_m(at.x, at.y), tolerance_m) << c << " " << r;
        }
}

TEST(Mosaic, TilesMeet) {
    const Paths paths{write_raster(folder() / "a.tif", tile(0, 0, 10, 8)),
                      write_raster(folder() / "b.tif", tile(10, 0, 7, 8)),
                      write_raster(folder() / "c.tif", tile(0, 8, 17, 5))};
    const Heightfield f = load(paths);
    EXPECT_EQ(f.grid.columns(), 17);
    EXPECT_EQ(f.grid.rows(), 13);
    EXPECT_EQ(f.grid.affine(), (Affine{500015, 30, 0, 5199985, 0, -30}));
    expect_plane(f, 1e-3);
    EXPECT_EQ(f.about.path, paths[0] + " and 2 more");
    EXPECT_EQ(f.about.files, paths);
    EXPECT_EQ(f.about.statistics.holes, 0);
    EXPECT_EQ(f.about.assumptions.front(),
              "3 files are joined; where they overlap, the one named last is on top");
    EXPECT_THAT(f.about.guesses, testing::IsEmpty());
}

TEST(Mosaic, TheOneNamedLastIsOnTopAndItsHolesShowWhatIsBelow) {
    Raster upper = tile(2, 0, 4, 4);
    upper.nodata = -1;
    upper.value = [](int c, int, int) { return c == 1 ? -1.0 : 77; };
    const std::string below = write_raster(folder() / "below.tif", tile(0, 0, 6, 4));
    const std::string above = write_raster(folder() / "above.tif", upper);
    const Heightfield f = load(Paths{below, above});
    EXPECT_EQ(f.height_m.at(2, 0), 77);
    EXPECT_NEAR(f.height_m.at(3, 0), plane_m(500105, 5199985), 1e-3);
    EXPECT_NE(load(Paths{above, below}).height_m.at(2, 0), 77);
}

TEST(Mosaic, EachFileKeepsItsOwnUnitAndNodata) {
    Raster feet = tile(6, 0, 6, 4);
    feet.unit = "ft";
    feet.nodata = -32768;
    feet.value = [](int c, int, int) { return c == 5 ? -32768.0 : 1000; };
    Raster metres = tile(0, 0, 6, 4);
    metres.unit = "m";
    metres.nodata = -9999;
    metres.value = [](int c, int, int) { return c == 0 ? -9999.0 : 300; };
    const Heightfield f = load(
        Paths{write_raster(folder() / "m.tif", metres), write_raster(folder() / "ft.tif", feet)});
    EXPECT_EQ(f.height_m.at(5, 0), 300);
    EXPECT_FLOAT_EQ(f.height_m.at(6, 0), 304.8F);
    EXPECT_EQ(f.about.statistics.holes, 8);
    EXPECT_THAT(f.about.guesses, ElementsAre("heights are in ft, m: each file in its own"));
    EXPECT_THAT(f.about.assumptions,
                Contains("voids are marked by -32768, -9999: each file has its own value"));
}

TEST(Mosaic, OtherGridsAreResampledToTheFinest) {
    const std::string fine = write_raster(folder() / "fine.tif", tile(0, 0, 40, 40));
    // 50 m posts that begin between two of the others, beside them.
    Raster coarse;
    coarse.columns = coarse.rows = 24;
    coarse.geotransform = {{501190, 50, 0, 5200010, 0, -50}};
    coarse.value = [](int c, int r, int) {
        return plane_m(501190 + 50 * (c + 0.5), 5200010 - 50 * (r + 0.5));
    };
    const Heightfield f = load(Paths{fine, write_raster(folder() / "coarse.tif", coarse)});
    EXPECT_NEAR(f.grid.post_spacing_m().x, 30, 0.02);
    EXPECT_EQ(f.grid.columns(), 80);  // posts to 502385, cells of the other to 502390
    EXPECT_THAT(f.about.guesses,
                ElementsAre("1 of the 2 files is resampled to the grid of " + fine));
    int compared = 0;
    for (int r = 1; r < 39; ++r)
        for (int c = 0; c < 80; ++c) {
            const glm::dvec2 at = f.grid.affine()(c, r);
            // Bilinear is exact on a plane, but for the DEM's last half cell, where it repeats the
            // rim.
            const bool rim = c > 38 && (at.x > 502365 || at.y > 5199985);
            if (rim || std::isnan(f.height_m.at(c, r))) continue;
            EXPECT_NEAR(f.height_m.at(c, r), plane_m(at.x, at.y), 0.01) << c << " " << r;
            ++compared;
        }
    EXPECT_GT(compared, 2700);
}

TEST(Mosaic, HolesOfAResampledFileStayHoles) {
    Raster other = tile(10, 0, 20, 20);
    other.crs = "EPSG:25832";  // the same places by another name, to 0.1 mm
    other.nodata = -9999;
    const auto value = other.value;
    other.value = [value](int c, int r, int b) {
        return c >= 8 && c < 12 && r >= 8 && r < 12 ? -9999.0 : value(c, r, b);
    };
    const Heightfield f = load(Paths{write_raster(folder() / "utm.tif", tile(0, 0, 10, 20)),
                                     write_raster(folder() / "etrs.tif", other)});
    EXPECT_EQ(f.grid.columns(), 30);
    EXPECT_TRUE(std::isnan(f.height_m.at(20, 10)));
    EXPECT_GE(f.about.statistics.holes, 14);
    EXPECT_LE(f.about.statistics.holes, 20);
    for (const float height : f.height_m)
        EXPECT_TRUE(std::isnan(height) || height > 400) << height;
}

TEST(Mosaic, MasksOfAResampledFileMarkHoles) {
    Raster other = tile(10, 0, 20, 20);
    other.crs = "EPSG:25832";
    other.mask = [](int c, int r) { return !(c >= 8 && c < 12 && r >= 8 && r < 12); };
    const Heightfield f = load(Paths{write_raster(folder() / "utm.tif", tile(0, 0, 10, 20)),
                                     write_raster(folder() / "masked.tif", other)});
    EXPECT_TRUE(std::isnan(f.height_m.at(20, 10)));
    EXPECT_FALSE(std::isnan(f.height_m.at(25, 10)));
}

TEST(Mosaic, AlphaOfAResampledFileMarksHoles) {
    // GDAL makes a mask of an alpha band of 16 bits and none of one of floats.
    for (const char* type : {"UInt16", "Float32"}) {
        Raster other = tile(10, 0, 20, 20);
        other.crs = "EPSG:25832";
        other.type = type;
        other.bands = 2;
        other.options = {"ALPHA=YES"};
        other.value = [height = other.value](int c, int r, int b) {
            const bool hole = c >= 8 && c < 12 && r >= 8 && r < 12;
            return b == 1 ? std::round(height(c, r, b)) : hole ? 0 : 65535;
        };
        const Heightfield f = load(Paths{write_raster(folder() / "utm.tif", tile(0, 0, 10, 20)),
                                         write_raster(folder() / "alpha.tif", other)});
        EXPECT_EQ(f.grid.columns(), 30);
        EXPECT_TRUE(std::isnan(f.height_m.at(20, 10))) << type;
        EXPECT_NEAR(f.height_m.at(25, 10), plane_m(500765, 5199685), 0.6) << type;
    }
}

TEST(Mosaic, AcrossTheAntimeridian) {
    Raster east;
    east.crs = "EPSG:4326";
    east.geotransform = {{179.4, 0.1, 0, -16, 0, -0.1}};
    Raster west = east;
    west.geotransform = {{-180, 0.1, 0, -16, 0, -0.1}};
    const Heightfield f = load(Paths{write_raster(folder() / "west.tif", west),
                                     write_raster(folder() / "east.tif", east)});
    EXPECT_EQ(f.grid.columns(), 12);
    EXPECT_EQ(f.about.statistics.holes, 0);
    EXPECT_NEAR(degrees(f.place(0, 0).lon_rad), 179.45, 1e-9);
    EXPECT_NEAR(degrees(f.place(11, 0).lon_rad), -179.45, 1e-9);
    EXPECT_EQ(f.height_m.at(6, 2), 120);
}

TEST(Mosaic, GapsAreHolesAndSaid) {
    const Heightfield f = load(Paths{write_raster(folder() / "near.tif", tile(0, 0, 6, 4)),
                                     write_raster(folder() / "far.tif", tile(100, 50, 6, 4))});
    EXPECT_EQ(f.grid.columns(), 106);
    EXPECT_EQ(f.grid.rows(), 54);
    EXPECT_EQ(f.about.statistics.valid, 48);
    EXPECT_THAT(f.about.guesses,
                ElementsAre("the files cover 0.84 % of their common extent, the rest is a void"));
}

TEST(Mosaic, FilesOnDifferentContinentsAreWarnedOf) {
    std::vector<std::string> warned;
    const auto warnings = [&](const Paths& paths) {
        warned.clear();
        log::set_sink([&](log::Level level, std::string_view text) {
            if (level == log::Level::Warning) warned.emplace_back(text);
        });
        const Source source = Source::open(paths);
        log::set_sink({});
        EXPECT_EQ(source.description().warnings, warned);
        return warned;
    };
    // A quarter of a degree each, in the Alps and in the Andes.
    Raster alps;
    alps.crs = "EPSG:4326";
    alps.columns = alps.rows = 90;
    alps.geotransform = {{8, 1 / 360.0, 0, 46.5, 0, -1 / 360.0}};
    Raster andes = alps;
    andes.geotransform = {{-70, 1 / 360.0, 0, -32.5, 0, -1 / 360.0}};
    const std::string here = write_raster(folder() / "alps.tif", alps);
    const std::string there = write_raster(folder() / "andes.tif", andes);
    const std::string said = here + " and " + there +
                             " are 11727 km apart: the files cover 0.002 % of their common extent, "
                             "the rest is a void; are they meant to be one DEM?";
    EXPECT_THAT(warnings({here, there}), ElementsAre(said));
    EXPECT_THAT(Source::open(Paths{here, there}).description().assumptions, Contains(said));
    // Of three, those two.
    Raster beside = alps;
    beside.geotransform = {{8.25, 1 / 360.0, 0, 46.5, 0, -1 / 360.0}};
    const std::string third = write_raster(folder() / "beside.tif", beside);
    ASSERT_EQ(warnings({third, there, here}).size(), 1u);
    EXPECT_THAT(warned.front(), testing::HasSubstr(there));
    EXPECT_THAT(warned.front(), testing::HasSubstr("0.003 %"));
    EXPECT_THAT(warnings({here, third}), testing::IsEmpty());
}

TEST(Mosaic, MeansAreThoseOfTheWhole) {
    // The same heights as one file and as four tiles, one with an overview.
    const auto rough = [](int c, int r) { return 400 + (c * 37 + r * 91) % 211 + 0.5 * c; };
    const auto cut = [&](int column, int row, int columns, int rows) {
        Raster raster = tile(column, row, columns, rows);
        raster.value = [=](int c, int r, int) { return rough(column + c, row + r); };
        return raster;
    };
    const Source whole = Source::open(write_raster(folder() / "whole.tif", cut(0, 0, 64, 48)));
    const Paths paths{write_raster(folder() / "nw.tif", cut(0, 0, 32, 24)),
                      write_raster(folder() / "ne.tif", cut(32, 0, 32, 24)),
                      write_raster(folder() / "sw.tif", cut(0, 24, 32, 24)),
                      write_raster(folder() / "se.tif", cut(32, 24, 32, 24))};
    const auto compare = [&](const Window& window, int columns, int rows) {
        const Source tiles = Source::open(paths);
        const Array2d<float> a = whole.read(window, columns, rows);
        const Array2d<float> b = tiles.read(window, columns, rows);
        for (int r = 0; r < rows; ++r)
            for (int c = 0; c < columns; ++c)
                ASSERT_NEAR(a.at(c, r), b.at(c, r), 1e-3) << c << " " << r;
    };
    compare({0, 0, 64, 48}, 64, 48);
    compare({30, 22, 4, 4}, 4, 4);
    for (const Window& window : {Window{0, 0, 64, 48}, Window{5, 3, 50, 40}, Window{33, 1, 9, 9}})
        for (const glm::ivec2 size : {glm::ivec2(9, 9), glm::ivec2(7, 8), glm::ivec2(1, 1)})
            compare(window, size.x, size.y);
    // Where parts do not cut its cells, an overview gives the same.
    add_overviews(paths[1], {2});
    compare({0, 0, 64, 48}, 16, 12);
    compare({0, 0, 64, 48}, 32, 24);
    compare({0, 0, 64, 48}, 1, 1);
}

TEST(Mosaic, HundredsOfTilesDoNotExhaustTheFilesOfAProcess) {
    Paths paths;
    for (int i = 0; i < 300; ++i)
        paths.push_back(write_raster(folder() / ("t" + std::to_string(i) + ".tif"),
                                     tile(4 * (i % 20), 3 * (i / 20), 4, 3)));
    const Heightfield f = load(paths);
    EXPECT_EQ(f.grid.columns(), 80);
    EXPECT_EQ(f.grid.rows(), 45);
    expect_plane(f, 1e-3);
}

TEST(Mosaic, WhatCannotBeJoinedHasItsMessage) {
    const std::string one = write_raster(folder() / "one.tif", tile(0, 0, 6, 4));
    EXPECT_EQ(test::error_of([&] {
                  load(Paths{one, one}, {.bounds = Bounds{1, 2, 3, 4}});
              }),
              "exit 2: --bounds: it says where one file is, but there are 2");
    EXPECT_EQ(test::error_of([&] {
                  load(Paths{one, "/nowhere/b.tif"});
              }),
              "exit 3: /nowhere/b.tif: no such file; there is no folder /nowhere");
    Raster turned = tile(0, 0, 6, 4);
    turned.geotransform = {{500000, 26, 15, 5200000, 15, -26}};
    Raster turned_more = turned;
    turned_more.geotransform = {{500000, 20, 15, 5200000, 15, -20}};
    const std::string a = write_raster(folder() / "turned.tif", turned);
    const std::string b = write_raster(folder() / "turned_more.tif", turned_more);
    EXPECT_EQ(test::error_of([&] {
                  load(Paths{a, b});
              }),
              "exit 3: " + a +
                  ": cannot be joined with the others: their grids differ and none of them runs "
                  "east and south; bring them to one grid with gdalwarp");
    // A turned one goes to the grid of another.
    EXPECT_NO_THROW(load(Paths{a, one}));
    // At 1 m, Kenya and Siberia.
    Raster here, there;
    here.geotransform = {{500000, 0.1, 0, 0, 0, -0.1}};
    there.geotransform = {{500000, 0.1, 0, 8000000, 0, -0.1}};
    const std::string kenya = write_raster(folder() / "here.tif", here);
    EXPECT_EQ(test::error_of([&] {
                  load(Paths{kenya, write_raster(folder() / "there.tif", there)});
              }),
              "exit 3: " + (folder() / "there.tif").string() +
                  ": cannot be resampled to the grid of " + kenya +
                  ": parts of it are not within WGS 84 / UTM zone 32N; bring them to one CRS with "
                  "gdalwarp");
    Raster coded = tile(0, 0, 6, 4);
    coded.type = "Byte";
    coded.bands = 3;
    coded.pictures = true;
    coded.value = [](int, int, int band) { return band == 1 ? 1.0 : 150; };
    const std::string p = write_raster(folder() / "p.tif", coded);
    coded.geotransform = {{500007, 20, 0, 5200000, 0, -20}};
    const std::string q = write_raster(folder() / "q.tif", coded);
    EXPECT_EQ(test::error_of([&] {
                  load(Paths{p, q}, {.encoding = Encoding::TerrainRgb});
              }),
              "exit 3: " + p + ": cannot be joined with " + q +
                  ": pictures of encoded heights must be on one grid, tiles of one zoom");
}

/// W,S,E,N around the posts of columns and rows of the plane's grid.
std::string around(const Grid& grid, glm::ivec2 first, glm::ivec2 last) {
    double west = 1e9, east = -1e9, south = 1e9, north = -1e9;
    for (const glm::dvec2& corner : {glm::dvec2(first), glm::dvec2(last),
                                     glm::dvec2(first.x, last.y), glm::dvec2(last.x, first.y)}) {
        const geo::Geodetic at = grid.place(corner.x, corner.y);
        west = std::min(west, degrees(at.lon_rad));
        east = std::max(east, degrees(at.lon_rad));
        south = std::min(south, degrees(at.lat_rad));
        north = std::max(north, degrees(at.lat_rad));
    }
    return fmt::format("{:.8f},{:.8f},{:.8f},{:.8f}", west, south, east, north);
}

TEST(Crop, LeavesThePostsOfARectangleOfOneFileAndOfSeveral) {
    const Paths one{write_raster(folder() / "whole.tif", tile(0, 0, 60, 40))};
    const Paths several{write_raster(folder() / "left.tif", tile(0, 0, 25, 40)),
                        write_raster(folder() / "right.tif", tile(25, 0, 35, 40))};
    for (const Paths& paths : {one, several}) {
        const Source all = Source::open(paths);
        LoadOptions options;
        options.crop = around(all.grid(), {10, 5}, {49, 24});
        const Source part = Source::open(paths, options);
        ASSERT_EQ(part.grid().columns(), 40);
        ASSERT_EQ(part.grid().rows(), 20);
        const Affine& a = part.grid().affine();
        EXPECT_EQ(a(0, 0), all.grid().affine()(10, 5));
        expect_plane(load(paths, options), 1e-3);
        const Array2d<float> means = part.read({0, 0, 40, 20}, 10, 5);
        const Array2d<float> same = all.read({10, 5, 40, 20}, 10, 5);
        for (int row = 0; row < 5; ++row)
            for (int column = 0; column < 10; ++column)
                EXPECT_EQ(means.at(column, row), same.at(column, row)) << column << " " << row;
        EXPECT_EQ(part.stored(3, 4), all.stored(13, 9));
    }
}

TEST(Crop, WithoutPostsOrWithNonsenseIsRefused) {
    const Paths paths{write_raster(folder() / "whole.tif", tile(0, 0, 60, 40))};
    const auto error = [&](const std::string& crop) {
        LoadOptions options;
        options.crop = crop;
        return test::error_of([&] { Source::open(paths, options); });
    };
    EXPECT_THAT(error("-80,40,-79,41"),
                testing::StartsWith("exit 3: --crop: -80,40,-79,41: not one post"));
    EXPECT_THAT(error("9,46.9,9.00001,46.90001"), testing::StartsWith("exit 3: --crop:"));
    EXPECT_THAT(error("9,46"), testing::StartsWith("exit 2: --crop: 9,46: expected WEST"));
}

}  // namespace
}  // namespace relevo::dem::test_mosaic
