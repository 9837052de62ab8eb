#include <cmath>

#include <fmt/format.h>
#include <gdal.h>
#include <gmock/gmock.h>

#include "dem/fixture.h"
#include "overlay/photo.h"
#include "support/support.h"

namespace relevo::overlay::test_photo {
namespace {

using test::error_of;
using test::folder;
using test::Raster;
using test::write_raster;

/// A DEM of 41 x 31 posts in UTM, 30 m apart.
dem::Grid grid() {
    return {41, 31, {500015, 30, 0, 5199985, 0, -30}, geo::Crs::parse("EPSG:32632", "test")};
}

/// An image of the DEM's extent, with pixels of 10 m. Red rises by 2 a column, green by 2 a row.
Raster image() {
    return {.type = "Byte",
            .columns = 123,
            .rows = 93,
            .bands = 3,
            .geotransform = {{500000, 10, 0, 5200000, 0, -10}},
            .value = [](int column, int row, int band) {
                return band == 1 ? 2.0 * column : band == 2 ? 2.0 * row : 7.0;
            }};
}

int channel(std::uint32_t texel, int k) {
    return static_cast<int>(texel >> 8 * k & 255);
}

std::uint32_t at_post(const Photo& photo, double column, double row) {
    return photo.read({.first_post = {column, row}}).at(0, 0);
}

/// Every post is the middle of nine pixels.
void expect_at_posts(const Photo& photo) {
    const Array2d<std::uint32_t> rgba = photo.read({.count = {41, 31}});
    for (int row = 0; row < 31; ++row)
        for (int column = 0; column < 41; ++column) {
            const std::uint32_t texel = rgba.at(column, row);
            ASSERT_NEAR(channel(texel, 0), 2 * (3 * column + 1), 1) << column << " " << row;
            ASSERT_NEAR(channel(texel, 1), 2 * (3 * row + 1), 1) << column << " " << row;
            ASSERT_EQ(channel(texel, 3), 255);
        }
}

TEST(Photo, HasThePixelsOfThePlaces) {
    const std::string path = write_raster(folder() / "photo.tif", image());
    const auto photo = Photo::open(path, grid());
    expect_at_posts(*photo);
    // A third of a post is a pixel.
    EXPECT_EQ(channel(at_post(*photo, 10 + 1 / 3.0, 5), 0), 2 * 32);
    EXPECT_NEAR(photo->pixels_per_post().x, 3, 1e-6);
    EXPECT_NEAR(photo->pixels_per_post().y, 3, 1e-6);
}

TEST(Photo, RowsFromTheSouthLieAtTheSamePlaces) {
    Raster raster = image();
    raster.geotransform = {{500000, 10, 0, 5200000 - 930, 0, 10}};
    raster.value = [](int column, int row, int band) {
        return band == 1 ? 2.0 * column : band == 2 ? 2.0 * (92 - row) : 7.0;
    };
    expect_at_posts(*Photo::open(write_raster(folder() / "south_up.tif", raster), grid()));
}

TEST(Photo, IsTransparentByAlphaMaskNodataAndOutside) {
    Raster alpha = image();
    alpha.bands = 4;
    alpha.value = [](int column, int, int band) {
        return band < 4 ? 200.0 : column < 60 ? 0.0 : 128.0;
    };
    Raster mask = image();
    mask.mask = [](int column, int) { return column >= 60; };
    Raster nodata = image();
    nodata.nodata = 9;
    // Only where all bands are nodata.
    nodata.value = [](int column, int row, int band) {
        return column < 60 || (row % 2 == 0 && band == 2) ? 9.0 : 100.0;
    };
    Raster part = image();
    part.columns = 63;
    part.geotransform = {{500600, 10, 0, 5200000, 0, -10}};
    for (const auto& [name, raster, opaque] : {std::tuple("alpha.tif", alpha, 128),
                                               {"mask.tif", mask, 255},
                                               {"nodata.tif", nodata, 255},
                                               {"part.tif", part, 255}}) {
        const auto photo = Photo::open(write_raster(folder() / name, raster), grid());
        EXPECT_EQ(at_post(*photo, 10, 10), 0u) << name;
        EXPECT_EQ(channel(at_post(*photo, 30, 10), 3), opaque) << name;
        // Premultiplied.
        if (opaque < 255) {
            EXPECT_EQ(channel(at_post(*photo, 30, 10), 0), 100);
        }
    }
}

TEST(Photo, PointsFartherApartThanPixelsHaveMeans) {
    Raster raster = image();
    // Columns by turns black and white.
    raster.value = [](int column, int, int) { return column % 2 ? 255.0 : 0.0; };
    const std::string plain = write_raster(folder() / "stripes.tif", raster),
                      overviews = write_raster(folder() / "overviews.tif", raster);
    test::add_overviews(overviews, {2, 4});
    for (const std::string& path : {plain, overviews}) {
        const auto photo = Photo::open(path, grid());
        const Array2d<std::uint32_t> rgba =
            photo->read({.first_post = {3, 3}, .step = glm::dvec2(8 / 3.0), .count = {10, 8}});
        for (const std::uint32_t texel : rgba)
            EXPECT_NEAR(channel(texel, 0), 127.5, 2) << path;
    }
}

TEST(Photo, ALargeFileWithoutOverviewsHasTheSameColoursFromItsReducedCopy) {
    // 5000 x 5000 pixels of 0.24 m, of which points 40 pixels apart are means.
    Raster raster = image();
    raster.columns = raster.rows = 5000;
    raster.geotransform = {{500000, 0.24, 0, 5200000, 0, -0.24}};
    raster.options = {"COMPRESS=DEFLATE", "TILED=YES"};
    raster.value = [](int column, int row, int band) {
        return band == 1 ? column / 20 : band == 2 ? row / 20 : 7;
    };
    const auto photo = Photo::open(write_raster(folder() / "large.tif", raster), grid());
    const double step = 40 * 0.24 / 30;
    const Array2d<std::uint32_t> rgba =
        photo->read({.first_post = {1, 1}, .step = glm::dvec2(step), .count = {60, 60}});
    for (int i = 0; i < 60; ++i) {
        const double pixel = (15 + 30 * (1 + i * step)) / 0.24 - 0.5;
        EXPECT_NEAR(channel(rgba.at(i, 5), 0), pixel / 20 - 0.5, 1);
        EXPECT_NEAR(channel(rgba.at(5, i), 1), pixel / 20 - 0.5, 1);
    }
}

TEST(Photo, OfAPaletteHasItsColours) {
    Raster raster = image();
    raster.bands = 1;
    raster.value = [](int column, int, int) { return column < 60 ? 1.0 : 2.0; };
    const std::string path = write_raster(folder() / "palette.tif", raster);
    GDALDatasetH dataset = GDALOpen(path.c_str(), GA_Update);
    GDALColorTableH table = GDALCreateColorTable(GPI_RGB);
    const GDALColorEntry red{200, 30, 10, 255}, none{9, 9, 9, 0};
    GDALSetColorEntry(table, 1, &red);
    GDALSetColorEntry(table, 2, &none);
    ASSERT_EQ(GDALSetRasterColorTable(GDALGetRasterBand(dataset, 1), table), CE_None);
    GDALDestroyColorTable(table);
    GDALClose(dataset);
    EXPECT_EQ(photo_kind(path), PhotoKind::Palette);
    const auto photo = Photo::open(path, grid());
    EXPECT_EQ(at_post(*photo, 10, 10), 0xff0a1ec8u);
    // Alpha of a TIFF's colour table is not stored.
    EXPECT_NE(at_post(*photo, 30, 10), at_post(*photo, 10, 10));
}

TEST(Photo, KindsAreByBands) {
    const auto kind = [](const char* name, const Raster& raster) {
        return photo_kind(write_raster(folder() / name, raster));
    };
    EXPECT_EQ(kind("rgb.tif", image()), PhotoKind::Colours);
    EXPECT_EQ(kind("one.tif", {.type = "Byte"}), PhotoKind::None);
    EXPECT_EQ(kind("two.tif", {.type = "Byte", .bands = 2}), PhotoKind::None);
    EXPECT_EQ(kind("floats.tif", {.bands = 3}), PhotoKind::None);
    EXPECT_EQ(kind("words.tif", {.type = "UInt16", .bands = 3}), PhotoKind::None);
    EXPECT_EQ(kind("deep.tif", {.type = "UInt16", .bands = 3, .pictures = true}), PhotoKind::Deep);
}

TEST(Photo, WhatCannotBeLaidOnTheGroundIsRefused) {
    Raster nowhere = image();
    nowhere.geotransform = {};
    nowhere.crs = "";
    const std::string a = write_raster(folder() / "nowhere.tif", nowhere);
    EXPECT_EQ(error_of([&] { Photo::open(a, grid()); }),
              "exit 3: " + a +
                  ": the raster has no georeference, its place on the ground is unknown; add one "
                  "with gdal_translate -a_srs EPSG:n -a_ullr W N E S");
    Raster unnamed = image();
    unnamed.crs = "";
    const std::string b = write_raster(folder() / "unnamed.tif", unnamed);
    EXPECT_EQ(error_of([&] { Photo::open(b, grid()); }),
              "exit 3: " + b +
                  ": the raster names no coordinate system and is not in degrees; add one with "
                  "gdal_translate -a_srs EPSG:n");
    Raster elsewhere = image();
    elsewhere.geotransform = {{520000, 10, 0, 5200000, 0, -10}};
    const std::string c = write_raster(folder() / "elsewhere.tif", elsewhere);
    EXPECT_EQ(error_of([&] { Photo::open(c, grid()); }),
              "exit 3: " + c +
                  ": the raster does not cover this DEM; it is at latitude 46.945 to 46.953, "
                  "longitude 9.263 to 9.279, the DEM at latitude 46.945 to 46.954, longitude 9.000 "
                  "to 9.016");
    const std::string d = write_raster(folder() / "short.tif", image());
    test::cut_short(d, std::filesystem::file_size(d) / 2);
    const auto damaged = Photo::open(d, grid());
    EXPECT_THAT(error_of([&] {
                    damaged->read({.count = {41, 31}});
                }),
                testing::AllOf(testing::StartsWith("exit 3: " + d + ": cannot be read, "),
                               testing::EndsWith("; the file is damaged or incomplete")));
}

}  // namespace
}  // namespace relevo::overlay::test_photo
