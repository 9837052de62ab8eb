#include <cmath>
#include <fstream>
#include <limits>
#include <optional>

#include <cpl_error.h>
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "base/log.h"
#include "dem/fixture.h"
#include "dem/load.h"
#include "support/support.h"

namespace relevo::dem::test_errors {
namespace {

using test::Raster;
using test::write_raster;

using test::folder;

/// The message without its beginning, "exit 3: PATH: ", which is checked.
std::string refusal(const std::string& path, const LoadOptions& options = {}) {
    const std::string message = test::error_of([&] { load(path, options); });
    const std::string begin = "exit 3: " + path + ": ";
    return message.starts_with(begin) ? message.substr(begin.size()) : "!" + message;
}

std::string refusal(const char* name, const Raster& raster, const LoadOptions& options = {}) {
    return refusal(write_raster(folder() / name, raster), options);
}

std::string written(const char* name, const std::string& text) {
    const std::filesystem::path path = folder() / name;
    std::ofstream(path, std::ios::binary) << text;
    return path;
}

TEST(LoadError, MissingFile) {
    EXPECT_EQ(refusal("/nowhere/alps.tif"), "no such file; there is no folder /nowhere");
    EXPECT_EQ(refusal("NETCDF:/nowhere/alps.nc:z"), "no such file");
    EXPECT_EQ(refusal("/vsizip//nowhere/alps.zip/alps.tif"), "no such file");
    EXPECT_EQ(test::error_of([] { load(""); }), "exit 3: \"\": no such file");
}

TEST(LoadError, WhatWasMeantIsGuessedFromTheName) {
    write_raster(folder() / "tyrol_30m.tif", {});
    EXPECT_EQ(refusal((folder() / "tyrol_30.tif").string()),
              fmt::format("no such file; did you mean {}?", (folder() / "tyrol_30m.tif").string()));
    EXPECT_EQ(refusal("el=30"),
              "no such file; an option's value is one word, as in --view az=210,el=30");
}

TEST(LoadError, AFileOfAnotherKindIsNamed) {
    const std::string places =
        "places or a track, not heights; name the DEM first, and this file as relevo sun along or "
        "--points take it";
    EXPECT_EQ(refusal(written("job.json", R"({"format": 1, "dem": {}, "sweep": []})")),
              "a job of Relevo, not a raster; draw it with relevo run");
    EXPECT_EQ(refusal(written("scene.json", R"({"format": 1, "dem": {"files": []}})")),
              "a scene of Relevo, not a raster; draw it with relevo capture --scene");
    EXPECT_EQ(refusal(written("a.geojson", R"({"type": "Point", "coordinates": [8, 46]})")),
              places);
    EXPECT_EQ(refusal(written("a.gpx", "<?xml version='1.0'?><gpx></gpx>")), places);
    EXPECT_EQ(refusal(written("a.kml", "<?xml version='1.0'?><kml></kml>")),
              "places or a track (KML), not heights; make GPX or GeoJSON of it");
    EXPECT_EQ(refusal(written("a.las", "LASF........")),
              "a point cloud, not a raster; make a raster of it first, for example with PDAL");
}

TEST(LoadError, NotARaster) {
    EXPECT_EQ(refusal(written("notes.txt", "Heights of the Alps, to be measured.\n")),
              "not a raster in any format that GDAL reads");
    EXPECT_EQ(refusal(written("empty.tif", "")), "not a raster in any format that GDAL reads");
}

TEST(LoadError, TruncatedGeoTiffNeverGivesPartOfItself) {
    for (const char* kind : {"NONE", "DEFLATE", "LZW"}) {
        Raster raster;
        raster.columns = 200;
        raster.rows = 150;
        raster.options = {std::string("COMPRESS=") + kind};
        raster.value = [](int column, int row, int) { return 0.37 * column + 1.7 * row; };
        const std::string path = write_raster(folder() / "whole.tif", raster);
        const auto size = std::filesystem::file_size(path);
        const std::string part = (folder() / "part.tif").string();
        for (int i = 0; i < 40; ++i) {
            std::filesystem::copy_file(path, part,
                                       std::filesystem::copy_options::overwrite_existing);
            test::cut_short(part, size * static_cast<unsigned>(i) / 40);
            EXPECT_THROW(load(part), Error) << kind << " " << i;
        }
        std::filesystem::copy_file(path, part, std::filesystem::copy_options::overwrite_existing);
        test::cut_short(part, size - 1);
        EXPECT_THROW(load(part), Error) << kind;
        EXPECT_NO_THROW(load(path)) << kind;
    }
}

TEST(LoadError, TruncatedGeoTiffSaysSo) {
    Raster raster;
    raster.columns = 200;
    raster.rows = 150;
    const std::string path = write_raster(folder() / "cut.tif", raster);
    test::cut_short(path, 60'000);
    EXPECT_EQ(refusal(path),
              "its heights cannot be read, IReadBlock failed at X offset 0, Y offset 7: "
              "TIFFReadEncodedStrip() failed; the file is damaged or incomplete");
    test::cut_short(path, 100);
    EXPECT_EQ(refusal(path),
              "cannot be opened as a raster, TIFFReadDirectory:Failed to read directory at offset "
              "8; the file is damaged or incomplete");
}

TEST(LoadError, TruncatedRawFilesAreNotFilledUp) {
    for (const char* driver : {"netCDF", "ENVI"}) {
        Raster raster;
        raster.driver = driver;
        raster.columns = 200;
        raster.rows = 150;
        const std::string path = write_raster(folder() / (std::string("raw.") + driver), raster);
        EXPECT_NO_THROW(load(path)) << driver;
        const auto size = std::filesystem::file_size(path);
        for (const auto bytes : {size - 1, size - 500, size * 2 / 3, size / 2}) {
            test::cut_short(path, bytes);
            EXPECT_EQ(refusal(path),
                      fmt::format("cut short, expected {} bytes but got {}; the file "
                                  "is damaged or incomplete",
                                  size, bytes))
                << driver;
        }
    }
}

TEST(LoadError, MosaicWithAMissingTileNeverGivesPartOfItself) {
    const std::string mosaic =
        written("mosaic.vrt",
                "<VRTDataset rasterXSize=\"6\" rasterYSize=\"4\"><SRS>EPSG:32632</SRS>"
                "<GeoTransform>500000,30,0,5200000,0,-30</GeoTransform>"
                "<VRTRasterBand dataType=\"Float32\" band=\"1\"><SimpleSource>"
                "<SourceFilename relativeToVRT=\"1\">tile.tif</SourceFilename>"
                "<SourceBand>1</SourceBand><SrcRect xOff=\"0\" yOff=\"0\" xSize=\"6\" ySize=\"4\"/>"
                "<DstRect xOff=\"0\" yOff=\"0\" xSize=\"6\" ySize=\"4\"/>"
                "</SimpleSource></VRTRasterBand></VRTDataset>");
    EXPECT_EQ(refusal(mosaic),
              "its heights cannot be read, " + (folder() / "tile.tif").string() +
                  ": No such file or directory; the file is damaged or incomplete");
    write_raster(folder() / "tile.tif", {});
    EXPECT_EQ(load(mosaic).height_m.at(5, 3), 135);
}

TEST(LoadError, NoCrs) {
    Raster raster;
    raster.crs = "";
    EXPECT_EQ(refusal("no_crs.tif", raster),
              "does not say its coordinate system; add --crs, for example EPSG:32632 (UTM 32 N)");
}

TEST(LoadError, UnusableCrs) {
    Raster raster;
    raster.crs = "LOCAL_CS[\"Arbitrary\",UNIT[\"metre\",1]]";
    EXPECT_EQ(refusal("local.tif", raster),
              "Arbitrary: a local (engineering) coordinate reference system, which cannot place a "
              "raster; give a geographic or projected one of the Earth with --crs EPSG:n");
    EXPECT_EQ(
        refusal("crs_option.tif", {}, {.crs = "EPSG:999999"}),
        "EPSG:999999: not a coordinate reference system that PROJ knows, crs not found; write "
        "EPSG:n, WKT or a PROJ string");
}

TEST(LoadError, WrongCrsPutsItOffTheEarth) {
    EXPECT_EQ(
        refusal("off_earth.tif", {}, {.crs = "EPSG:4326"}),
        "its middle is at 500090, 5199940, which is not on the Earth in WGS 84; pass the right "
        "one with --crs EPSG:n");
}

TEST(LoadError, NoGeoreference) {
    Raster raster;
    raster.geotransform.reset();
    EXPECT_EQ(
        refusal("no_place.tif", raster),
        "no georeference, it does not say where its posts are; give its edges in degrees with "
        "--bounds W,S,E,N");
}

TEST(LoadError, CellsWithoutArea) {
    Raster raster;
    raster.geotransform = {{500000, 30, 15, 5200000, 60, 30}};
    EXPECT_EQ(refusal("flat.tif", raster),
              "a georeference in which the cells have no area; the file is damaged");
}

TEST(LoadError, NoValidHeight) {
    Raster raster;
    raster.nodata = -9999;
    raster.value = [](int, int, int) { return -9999.0; };
    EXPECT_EQ(refusal("all_holes.tif", raster),
              "no valid height: all 24 posts are voids (nodata -9999)");
    raster.nodata.reset();
    raster.value = [](int, int, int) { return std::nan(""); };
    EXPECT_EQ(refusal("all_nan.tif", raster), "no valid height: all 24 posts are voids");
    raster.value = [](int, int, int) { return -3.4e38; };
    EXPECT_EQ(refusal("all_marked.tif", raster), "no valid height: all 24 posts are voids");
}

TEST(LoadError, HeightsBeyondTheEarth) {
    const std::string message =
        "no height that is possible on Earth: all 24 posts are voids or beyond 10 000 km (1e+09); "
        "name the band of the heights with --band N";
    Raster raster;
    raster.value = [](int column, int, int) { return column == 0 ? std::nan("") : 1e9; };
    EXPECT_EQ(refusal("beyond.tif", raster), message);
    raster.nodata = -9999;
    EXPECT_EQ(refusal("beyond_declared.tif", raster), message);
}

TEST(LoadError, TooFewPosts) {
    Raster raster;
    raster.columns = 1;
    raster.rows = 1;
    EXPECT_EQ(refusal("pixel.tif", raster), "size, expected at least 2 x 2 posts but got 1 x 1");
    raster.columns = 7;
    EXPECT_EQ(refusal("row.tif", raster), "size, expected at least 2 x 2 posts but got 7 x 1");
    raster.rows = 2;
    EXPECT_EQ(load(write_raster(folder() / "two.tif", raster)).height_m.height(), 2);
}

TEST(LoadError, BandOutOfRange) {
    EXPECT_EQ(refusal("band.tif", {}, {.band = 2}),
              "band, expected 1 to 1 but got 2; --band counts from 1");
    EXPECT_EQ(refusal("band.tif", {}, {.band = -1}),
              "band, expected 1 to 1 but got -1; --band counts from 1");
}

TEST(LoadError, UnknownUnit) {
    Raster raster;
    raster.unit = "furlong";
    EXPECT_EQ(refusal("furlong.tif", raster),
              "band 1 is in \"furlong\", expected a unit of height; if these are heights, pass "
              "--unit m, ft, us-ft, cm, mm, dm or km");
    EXPECT_NO_THROW(load((folder() / "furlong.tif").string(), {.unit = "m"}));
    const std::string path = write_raster(folder() / "unit.tif", {});
    EXPECT_EQ(test::error_of([&] { load(path, {.unit = "parsec"}); }),
              "exit 2: --unit: parsec: a unit of height, expected m, ft, us-ft, cm, mm, dm or km");
}

TEST(LoadError, UnitsInMetadataCount) {
    EXPECT_EQ(refusal("climate.tif", {.about = {{"units", "K"}}}),
              "band 1 is in \"K\", expected a unit of height; if these are heights, pass "
              "--unit m, ft, us-ft, cm, mm, dm or km");
    const std::string feet =
        write_raster(folder() / "feet.tif", {.about = {{"Units", "feet above NAVD88"}}});
    EXPECT_EQ(load(feet).about.unit.name, "ft");
    EXPECT_EQ(load(feet).about.unit_source, UnitSource::Band);
    const std::string silent =
        write_raster(folder() / "silent.tif", {.about = {{"units", "unknown"}}});
    EXPECT_EQ(load(silent).about.unit_source, UnitSource::Assumed);
    const std::string radar = test::small_case("grib/gfs.t06z.pgrb2.10p0.f010.grib2");
    EXPECT_EQ(test::error_of([&] { load(radar); }),
              "exit 3: " + radar +
                  ": band 1 is in \"[dB]\", expected a unit of height; if these are heights, pass "
                  "--unit m, ft, us-ft, cm, mm, dm or km");
}

/// A photograph, as far as neighbours go: each colour is its own affair.
double photograph(int column, int row, int band) {
    return (column * 97 + row * 61 + band * 131 + column * row * 7) % 256;
}

TEST(LoadError, NumbersThatMakeNoHeights) {
    const auto refusal = [](std::optional<double> scale, std::optional<double> offset) {
        Raster raster;
        raster.scale = scale;
        raster.offset = offset;
        const std::string path = write_raster(folder() / "scaled.tif", raster);
        const std::string message = test::error_of([&] { load(path); });
        const std::string begin = "exit 3: " + path + ": ";
        return message.starts_with(begin) ? message.substr(begin.size()) : message;
    };
    const auto what = [](const char* scale, const char* offset) {
        return std::string("a scale of ") + scale + " and an offset of " + offset +
               ", which make no heights; the file is damaged";
    };
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(refusal(0, {}), what("0", "0"));
    EXPECT_EQ(refusal(std::nan(""), {}), what("nan", "0"));
    EXPECT_EQ(refusal(kInfinity, 5), what("inf", "5"));
    EXPECT_EQ(refusal({}, std::nan("")), what("1", "nan"));
    EXPECT_EQ(refusal(2, 1e308), what("2", "1e+308"));
    EXPECT_EQ(refusal(-1, -100), "no error");
    // A word of a unit without end.
    Raster raster;
    raster.unit = std::string(5000, 'q');
    EXPECT_LT(test::error_of([&] { load(write_raster(folder() / "word.tif", raster)); }).size(),
              400u);
    // Cells that doubles cannot tell apart.
    raster = {};
    raster.crs = "EPSG:4326";
    raster.geotransform = {{7, 1e-17, 0, 46, 0, -1e-17}};
    const std::string path = write_raster(folder() / "small_cells.tif", raster);
    EXPECT_EQ(test::error_of([&] { load(path); }),
              "exit 3: " + path + ": cells so small that neighbouring posts are at the same place");
}

TEST(LoadError, Picture) {
    Raster raster;
    raster.type = "Byte";
    raster.bands = 3;
    raster.columns = raster.rows = 64;
    raster.value = photograph;
    raster.options = {"PHOTOMETRIC=MINISBLACK"};
    constexpr const char* kRemedy =
        ", expected heights; if its colours encode heights pass --encoding terrain-rgb or "
        "terrarium, if one band holds them --band N";
    // Colours that nobody noted are colours all the same.
    EXPECT_EQ(refusal("bands.tif", raster), "a picture (3 bands of 8 bits)" + std::string(kRemedy));
    raster.pictures = true;
    raster.options = {};
    EXPECT_EQ(refusal("picture.tif", raster),
              "a picture (red, green and blue bands of 8 bits)" + std::string(kRemedy));
    raster.bands = 4;
    EXPECT_EQ(refusal("picture_alpha.tif", raster),
              "a picture (red, green and blue bands of 8 bits)" + std::string(kRemedy));
    raster.type = "UInt16";
    EXPECT_EQ(refusal("picture16.tif", raster),
              "a picture (red, green and blue bands of 16 bits)" + std::string(kRemedy));
}

TEST(LoadError, PictureOfHeightsSaysInWhichEncoding) {
    Raster raster;
    raster.type = "Byte";
    raster.bands = 3;
    raster.pictures = true;
    raster.columns = raster.rows = 64;
    const auto height_m = [](int column, int row) { return 1500 + 7 * column + 3 * row; };
    raster.value = [&](int column, int row, int band) {
        const int code = (height_m(column, row) + 10000) * 10;
        return code >> (8 * (3 - band)) & 255;
    };
    EXPECT_EQ(refusal("terrain_rgb.tif", raster),
              "a picture (red, green and blue bands of 8 bits) whose colours look like heights in "
              "Terrain-RGB; if they are, pass --encoding terrain-rgb");
    raster.value = [&](int column, int row, int band) {
        const int code = (height_m(column, row) + 32768) * 256;
        return code >> (8 * (3 - band)) & 255;
    };
    EXPECT_EQ(refusal("terrarium.tif", raster),
              "a picture (red, green and blue bands of 8 bits) whose colours look like heights in "
              "Terrarium; if they are, pass --encoding terrarium");
}

TEST(LoadError, EncodingOfWhatIsNoPicture) {
    EXPECT_EQ(refusal("heights.tif", {}, {.encoding = Encoding::TerrainRgb}),
              "--encoding terrain-rgb, expected red, green and blue bands of 8 bits but got one "
              "band of Float32");
}

TEST(LoadError, BoundsOutsideOfTheCrs) {
    Raster raster;
    raster.geotransform.reset();
    EXPECT_EQ(
        refusal("bounds.tif", raster, {.crs = "EPSG:32632", .bounds = Bounds{100, 0, 101, 1}}),
        "--bounds 100,0,101,1 are not within WGS 84 / UTM zone 32N; pass the right CRS with "
        "--crs EPSG:n");
}

TEST(LoadError, DegreesInACrsOfMetres) {
    Raster raster;
    raster.geotransform = {{11, 0.001, 0, 47, 0, -0.001}};
    EXPECT_EQ(refusal("degrees.tif", raster),
              "its coordinates look like degrees, but the unit of WGS 84 / UTM zone 32N is metre; "
              "pass the right CRS with --crs, perhaps EPSG:4326");
    EXPECT_NO_THROW(load((folder() / "degrees.tif").string(), {.crs = "EPSG:4326"}));
}

/// Replaces bytes of a file by as many others.
void replace_bytes(const std::string& path, const std::string& from, const std::string& to) {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(file)), {});
    const std::size_t at = bytes.find(from);
    ASSERT_NE(at, std::string::npos);
    ASSERT_EQ(from.size(), to.size());
    file.clear();
    file.seekp(static_cast<std::streamoff>(at));
    file << to;
}

TEST(LoadError, GeoKeysOfAnUnknownCode) {
    const std::string path = write_raster(folder() / "keys.tif", {});
    // The key of the projected CRS (3072, one short number) gets a code that EPSG does not have.
    const auto key = [](std::uint16_t code) {
        const std::uint16_t numbers[] = {3072, 0, 1, code};
        return std::string(reinterpret_cast<const char*>(numbers), sizeof numbers);
    };
    replace_bytes(path, key(32632), key(29999));
    // The name is left.
    const Heightfield f = load(path);
    EXPECT_EQ(f.grid.crs().code(), "EPSG:32632");
    EXPECT_EQ(f.about.guesses,
              (std::vector<std::string>{"the CRS is WGS 84 / UTM zone 32N, by its name: the file "
                                        "does not define it; --crs sets another"}));
    replace_bytes(path, "WGS 84 / UTM zone 32N", "WGS 84 / UTM zone 92N");
    EXPECT_EQ(refusal(path),
              "WGS 84 / UTM zone 92N: a local (engineering) coordinate reference system, which "
              "cannot place a raster; give a geographic or projected one of the Earth with --crs "
              "EPSG:n");
    EXPECT_EQ(load(path, {.crs = "EPSG:32632"}).grid.crs().code(), "EPSG:32632");
}

TEST(LoadError, ComplexNumbers) {
    Raster raster;
    raster.type = "CFloat32";
    EXPECT_EQ(refusal("complex.tif", raster), "complex numbers (CFloat32), expected heights");
}

TEST(LoadError, SeveralRastersInOneFile) {
    Raster raster;
    raster.driver = "GPKG";
    raster.type = "Byte";
    raster.columns = 256;
    raster.rows = 256;
    raster.value = [](int, int, int) { return 9.0; };
    raster.options = {"RASTER_TABLE=topo"};
    write_raster(folder() / "two.gpkg", raster);
    raster.options = {"RASTER_TABLE=slope", "APPEND_SUBDATASET=YES"};
    const std::string path = write_raster(folder() / "two.gpkg", raster);
    EXPECT_EQ(refusal(path),
              "holds 2 rasters, expected one; name one, as in 'GPKG:" + path + ":topo'");
    EXPECT_EQ(load("GPKG:" + path + ":slope", {.band = 1}).height_m.at(0, 0), 9);
}

TEST(LoadError, GdalItselfIsSilent) {
    testing::internal::CaptureStderr();
    EXPECT_THROW(load("/nowhere/alps.tif"), Error);
    EXPECT_THROW(load((folder() / "cut.tif").string()), Error);
    EXPECT_THROW(load(written("notes.txt", "text")), Error);
    // What GDAL says when nobody collects, on threads of its own for one.
    CPLError(CE_Warning, CPLE_AppDefined, "chatter");

    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(LoadError, WhatGdalSaysIsInTheDebugLog) {
    std::vector<std::string> lines;
    log::set_sink([&](log::Level, std::string_view text) { lines.emplace_back(text); });
    const log::Level before = log::level();
    log::set_level(log::Level::Debug);
    const std::string path = write_raster(folder() / "debug.tif", {.columns = 200, .rows = 150});
    test::cut_short(path, 60'000);
    EXPECT_THROW(load(path), Error);
    log::set_level(before);
    log::set_sink({});
    ASSERT_FALSE(lines.empty());
    EXPECT_TRUE(lines.front().starts_with("GDAL: ")) << lines.front();
}

}  // namespace
}  // namespace relevo::dem::test_errors
