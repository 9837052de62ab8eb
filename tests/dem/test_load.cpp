#include <cmath>
#include <fstream>
#include <limits>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "base/units.h"
#include "dem/fixture.h"
#include "dem/load.h"
#include "support/support.h"

namespace relevo::dem::test_load {
namespace {

using test::Raster;
using test::write_raster;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kUnitAssumed =
    "heights are taken as metres: the file names no unit; --unit sets another";
constexpr const char* kDatumAssumed =
    "heights are taken as ellipsoidal: the file names no vertical datum";

using test::folder;

Heightfield loaded(const char* name, const Raster& raster, const LoadOptions& options = {}) {
    return load(write_raster(folder() / name, raster), options);
}

TEST(Load, ProjectedMetres) {
    const Heightfield f = loaded("projected.tif", {});
    EXPECT_EQ(f.height_m.width(), 6);
    EXPECT_EQ(f.height_m.height(), 4);
    for (int r = 0; r < 4; ++r)
        for (int c = 0; c < 6; ++c)
            EXPECT_EQ(f.height_m.at(c, r), 100.0F + static_cast<float>(c + 10 * r));
    EXPECT_EQ(f.grid.crs().code(), "EPSG:32632");
    // The post is the centre of the cell whose corner the file names.
    EXPECT_EQ(f.grid.affine(), (Affine{500015, 30, 0, 5199985, 0, -30}));
    EXPECT_EQ(f.about.driver, "GTiff");
    EXPECT_EQ(f.about.data_type, "Float32");
    EXPECT_EQ(f.about.unit, Unit{});
    EXPECT_EQ(f.about.unit_source, UnitSource::Assumed);
    EXPECT_EQ(f.about.vertical_datum, "");
    EXPECT_FALSE(f.about.nodata);
    EXPECT_EQ(f.about.statistics, (Statistics{100, 135, 24, 0, 0}));
    EXPECT_THAT(f.about.assumptions, ElementsAre(kUnitAssumed, kDatumAssumed));
}

TEST(Load, GeographicDegrees) {
    Raster raster;
    raster.crs = "EPSG:4326";
    raster.geotransform = {{11, 0.001, 0, 47, 0, -0.001}};
    const Heightfield f = loaded("geographic.tif", raster);
    EXPECT_TRUE(f.grid.crs().is_geographic());
    const geo::Geodetic first = f.place(0, 0);
    EXPECT_NEAR(degrees(first.lat_rad), 46.9995, 1e-12);
    EXPECT_NEAR(degrees(first.lon_rad), 11.0005, 1e-12);
    EXPECT_EQ(first.height_m, 100);
}

TEST(Load, SouthUpKeepsTheRowsOfTheFile) {
    Raster raster;
    raster.geotransform = {{500000, 30, 0, 5200000, 0, 30}};
    const Heightfield f = loaded("south_up.tif", raster);
    EXPECT_EQ(f.height_m.at(0, 0), 100);
    EXPECT_LT(f.place(0, 0).lat_rad, f.place(0, 3).lat_rad);
    EXPECT_GT(f.grid.extent_m().y, 80);
}

TEST(Load, TurnedGeotransform) {
    Raster raster;
    raster.geotransform = {{500000, 26, 15, 5200000, 15, -26}};
    const Heightfield f = loaded("turned.tif", raster);
    const glm::dvec2 p = f.grid.affine()(2, 3);
    EXPECT_DOUBLE_EQ(p.x, 500000 + 26 * 2.5 + 15 * 3.5);
    EXPECT_DOUBLE_EQ(p.y, 5200000 + 15 * 2.5 - 26 * 3.5);
}

TEST(Load, PixelIsPointHasItsPostsWhereTheFileSays) {
    const Heightfield area = loaded("area.tif", {.pixel_is_point = false});
    EXPECT_EQ(area.grid.affine()(0, 0), glm::dvec2(500015, 5199985));
    const Heightfield point = loaded("point.tif", {.pixel_is_point = true});
    EXPECT_EQ(point.grid.affine()(0, 0), glm::dvec2(500000, 5200000));
}

TEST(Load, FeetOfTheBandBecomeMetres) {
    Raster raster;
    raster.unit = "ft";
    const Heightfield f = loaded("feet.tif", raster);
    EXPECT_FLOAT_EQ(f.height_m.at(0, 0), 30.48F);
    EXPECT_EQ(f.about.unit, (Unit{"ft", 0.3048}));
    EXPECT_EQ(f.about.unit_source, UnitSource::Band);
    EXPECT_THAT(f.about.assumptions, ElementsAre(kDatumAssumed));
}

TEST(Load, FeetOfTheVerticalCrsBecomeMetres) {
    write_raster(folder() / "tile.tif", {.crs = ""});
    const std::filesystem::path path = folder() / "vertical.vrt";
    // NAD83 / California zone 5 (ftUS) + NAVD88 height (ftUS)
    std::ofstream(path)
        << "<VRTDataset rasterXSize=\"6\" rasterYSize=\"4\"><SRS>EPSG:2229+6360</SRS>"
           "<GeoTransform>6400000,30,0,1900000,0,-30</GeoTransform>"
           "<VRTRasterBand dataType=\"Float32\" band=\"1\"><SimpleSource>"
           "<SourceFilename relativeToVRT=\"1\">tile.tif</SourceFilename>"
           "<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>";
    const Heightfield f = load(path.string());
    EXPECT_FLOAT_EQ(f.height_m.at(0, 0), static_cast<float>(100 * kUsSurveyFoot_m));
    EXPECT_EQ(f.about.unit.name, "us-ft");
    EXPECT_EQ(f.about.unit_source, UnitSource::VerticalCrs);
    EXPECT_EQ(f.about.vertical_datum, "NAVD88 height (ftUS) (EPSG:6360)");
    EXPECT_THAT(f.about.assumptions,
                Contains("heights are above NAVD88 height (ftUS) (EPSG:6360) and are taken as "
                         "ellipsoidal: the geoid is not added"));
}

TEST(Load, BandUnitGoesBeforeTheVerticalCrs) {
    Raster raster;
    raster.crs = "EPSG:32632+5773";
    raster.unit = "cm";
    const Heightfield f = loaded("both_units.tif", raster);
    EXPECT_FLOAT_EQ(f.height_m.at(0, 0), 1.0F);
    EXPECT_EQ(f.about.unit_source, UnitSource::Band);
    EXPECT_EQ(f.about.vertical_datum, "EGM96 height (EPSG:5773)");
}

TEST(Load, UnitOptionGoesBeforeAll) {
    Raster raster;
    raster.unit = "ft";
    const Heightfield f = loaded("unit_option.tif", raster, {.unit = "km"});
    EXPECT_FLOAT_EQ(f.height_m.at(0, 0), 100'000.0F);
    EXPECT_EQ(f.about.unit_source, UnitSource::Option);
    EXPECT_THAT(f.about.assumptions, Contains("heights are in km, as given"));
}

TEST(Load, FeetOfTheDistancesAreMentionedWhereHeightsSayNothing) {
    Raster raster;
    raster.crs = "EPSG:2229";
    raster.geotransform = {{6400000, 30, 0, 1900000, 0, -30}};
    const Heightfield f = loaded("feet_crs.tif", raster);
    EXPECT_THAT(f.about.assumptions,
                Contains("heights are taken as metres: the file names no unit (distances are in US "
                         "survey foot); --unit sets another"));
}

TEST(Load, DepthsAreHeightsBelowZero) {
    Raster raster;
    raster.crs = "EPSG:4326+5715";  // MSL depth
    raster.geotransform = {{11, 0.001, 0, 43, 0, -0.001}};
    const Heightfield f = loaded("depth.tif", raster);
    EXPECT_EQ(f.height_m.at(0, 0), -100);
    EXPECT_THAT(f.about.assumptions,
                Contains("depths, positive downwards, are taken as heights below 0"));
}

TEST(Load, ScaleAndOffset) {
    Raster raster;
    raster.type = "Int16";
    raster.scale = 0.25;
    raster.offset = -50;
    raster.unit = "ft";
    raster.nodata = 111;  // a stored value
    const Heightfield f = loaded("scaled.tif", raster);
    EXPECT_FLOAT_EQ(f.height_m.at(0, 0), static_cast<float>((100 * 0.25 - 50) * kFoot_m));
    EXPECT_TRUE(std::isnan(f.height_m.at(1, 1)));
    EXPECT_EQ(f.about.statistics.holes, 1);
    EXPECT_EQ(f.about.scale, 0.25);
    EXPECT_EQ(f.about.offset, -50);
}

TEST(Load, DeclaredNodataIsAHoleInEveryType) {
    const struct {
        const char* type;
        double nodata;
    } cases[] = {
        {"Byte", 111},
        {"UInt16", 65535},
        {"Int16", -32768},
        {"Int16", 32767},
        {"Int32", -9999},
        {"UInt32", 4294967295.0},
        {"Float32", -9999},
        {"Float32", -3.4028234663852886e38},
        {"Float32", 3.4028234663852886e38},
        {"Float64", -1.7976931348623157e308},
        {"Float64", 1e-300},
        {"Int64", -9999},
    };
    for (const auto& c : cases) {
        Raster raster;
        raster.type = c.type;
        raster.nodata = c.nodata;
        raster.value = [&](int column, int row, int) {
            return column == 1 && row == 1 ? c.nodata : 100.0 + column + row;
        };
        const Heightfield f = loaded("nodata.tif", raster);
        EXPECT_TRUE(std::isnan(f.height_m.at(1, 1))) << c.type << " " << c.nodata;
        EXPECT_EQ(f.about.statistics, (Statistics{100, 108, 23, 1, 0}))
            << c.type << " " << c.nodata;
        EXPECT_EQ(f.about.nodata, c.nodata) << c.type;
    }
}

TEST(Load, NanAndInfinityAreHolesUndeclared) {
    for (const char* type : {"Float32", "Float64"})
        for (const double hole : {std::nan(""), std::numeric_limits<double>::infinity(),
                                  -std::numeric_limits<double>::infinity()}) {
            Raster raster;
            raster.type = type;
            raster.value = [&](int column, int row, int) {
                return column == 2 && row == 0 ? hole : 5;
            };
            const Heightfield f = loaded("nan.tif", raster);
            EXPECT_TRUE(std::isnan(f.height_m.at(2, 0)));
            EXPECT_EQ(f.about.statistics.holes, 1);
        }
}

TEST(Load, FloatMaxInFewDigitsStillMarksHoles) {
    Raster raster;
    raster.driver = "AAIGrid";
    raster.nodata = -3.4e38;
    raster.value = [](int column, int, int) { return column == 0 ? -3.40282306e38 : 12.0; };
    raster.options = {"DECIMAL_PRECISION=1"};
    const Heightfield f = loaded("floatmax.asc", raster);
    EXPECT_EQ(f.about.statistics, (Statistics{12, 12, 20, 4, 0}));
}

TEST(Load, NodataOptionReplacesTheDeclaredOne) {
    Raster raster;
    raster.nodata = 100;
    const Heightfield f = loaded("nodata_option.tif", raster, {.nodata = 135});
    EXPECT_EQ(f.height_m.at(0, 0), 100);
    EXPECT_TRUE(std::isnan(f.height_m.at(5, 3)));
    EXPECT_THAT(f.about.assumptions, Contains("135 marks voids, as given"));
}

TEST(Load, MaskOfTheFileMarksHoles) {
    Raster raster;
    raster.options = {};
    raster.mask = [](int column, int row) { return !(column == 4 && row == 2); };
    const Heightfield f = loaded("mask.tif", raster);
    EXPECT_TRUE(std::isnan(f.height_m.at(4, 2)));
    EXPECT_EQ(f.about.statistics.holes, 1);
}

TEST(Load, BandIsChosen) {
    Raster raster;
    raster.bands = 3;
    raster.value = [](int, int, int band) { return 100.0 * band; };
    EXPECT_EQ(loaded("bands.tif", raster, {.band = 3}).height_m.at(0, 0), 300);
    const Heightfield f = loaded("bands.tif", raster);
    EXPECT_EQ(f.height_m.at(0, 0), 100);
    EXPECT_EQ(f.about.bands, 3);
    EXPECT_THAT(f.about.assumptions,
                Contains("band 1 of 3 holds the heights; --band N selects another"));
}

TEST(Load, BandOfAPictureOnlyWhenAskedFor) {
    Raster raster;
    raster.type = "Byte";
    raster.bands = 3;
    raster.pictures = true;
    const Heightfield f = loaded("picture.tif", raster, {.band = 2});
    EXPECT_EQ(f.height_m.at(0, 0), 100);
    EXPECT_THAT(f.about.assumptions, Contains("heights are stored in 8 bits: 256 steps at most"));
}

TEST(Load, CrsOptionSaysWhatTheFileDoesNot) {
    Raster raster;
    raster.driver = "AAIGrid";
    raster.crs = "";
    raster.geotransform = {{270000, 5, 0, 370000, 0, -5}};
    const Heightfield f = loaded("no_crs.asc", raster, {.crs = "EPSG:31287"});
    EXPECT_EQ(f.grid.crs().code(), "EPSG:31287");
    EXPECT_THAT(f.about.assumptions, Contains("the CRS is MGI / Austria Lambert, as given"));
    EXPECT_THAT(f.about.assumptions,
                Contains("converted to WGS 84 by MGI to WGS 84 (3), good to 1.5 m"));
}

TEST(Load, CrsOptionReplacesTheFilesOwn) {
    const Heightfield f = loaded("other_crs.tif", {}, {.crs = "EPSG:32633"});
    EXPECT_EQ(f.grid.crs().code(), "EPSG:32633");
    EXPECT_THAT(f.about.assumptions,
                Contains("the CRS is WGS 84 / UTM zone 33N, as given, not the file's own"));
}

TEST(Load, NetcdfAxesOfDegreesAreWgs84) {
    Raster raster;
    raster.driver = "netCDF";
    raster.crs = "EPSG:4326";
    raster.geotransform = {{195, 1 / 12.0, 0, 25, 0, -1 / 12.0}};
    raster.options = {"WRITE_GDAL_TAGS=NO"};
    const std::string path = write_raster(folder() / "axes.nc", raster);
    const Heightfield f = load(path);
    EXPECT_EQ(f.grid.crs().code(), "EPSG:4326");
    EXPECT_LT(f.grid.center().lon_rad, 0);  // 195 east is 165 west
}

TEST(Load, LargerThanTheMemoryAllowedIsReduced) {
    Raster raster;
    raster.columns = 100;
    raster.rows = 60;
    raster.value = [](int column, int row, int) { return column + 1000.0 * row; };
    const Heightfield f = loaded("large.tif", raster, {.memory = MemoryBudget::of_posts(1500)});
    EXPECT_EQ(f.grid.columns(), 50);
    EXPECT_EQ(f.grid.rows(), 30);
    // The mean of a plane over a cell is the plane in its middle.
    EXPECT_FLOAT_EQ(f.height_m.at(10, 7), 20.5F + 1000 * 14.5F);
    EXPECT_EQ(f.grid.affine()(0, 0), glm::dvec2(500030, 5199970));
    EXPECT_THAT(f.about.assumptions,
                Contains("reduced from 100 x 60 to 50 x 30 posts in memory, means of 2 x 2"));
}

TEST(Load, OtherFormats) {
    const struct {
        const char* driver;
        const char* name;
        std::vector<std::string> options;
    } cases[] = {
        {"HFA", "a.img", {}},
        {"GTiff", "tiled.tif", {"TILED=YES", "COMPRESS=DEFLATE", "PREDICTOR=3"}},
        {"GTiff", "big.tif", {"BIGTIFF=YES", "COMPRESS=LZW"}},
        {"AAIGrid", "a.asc", {}},
        {"netCDF", "a.nc", {}},
    };
    for (const auto& c : cases) {
        Raster raster;
        raster.driver = c.driver;
        raster.options = c.options;
        raster.columns = 150;
        raster.rows = 130;
        const Heightfield f = loaded(c.name, raster);
        EXPECT_EQ(f.about.driver, c.driver);
        EXPECT_EQ(f.height_m.at(149, 129), 100.0F + 149 + 1290) << c.name;
        EXPECT_EQ(f.about.statistics, (Statistics{100, 1539, 150 * 130, 0, 0})) << c.name;
    }
}

TEST(Load, InputsOfACommandLineAreNotNone) {
    EXPECT_EQ(test::error_of([&] { load(std::span<const std::string>{}); }),
              "exit 3: no DEM given; name one or more files");
}

TEST(Load, TheAdviceOnAFrameIsInStoredNumbers) {
    int count = 0;
    const auto advised = [&](const Raster& like, double frame, double inside,
                             LoadOptions options = {}) {
        Raster raster = like;
        raster.columns = raster.rows = 20;
        raster.value = [=](int column, int row, int) {
            return column < 2 || row < 2 || column > 17 || row > 17 ? frame : inside + column;
        };
        const std::string path =
            write_raster(folder() / fmt::format("frame{}.tif", ++count), raster);
        const Heightfield f = load(path, options);
        EXPECT_EQ(f.about.statistics.holes, 0);
        std::string said;
        for (const std::string& sentence : f.about.guesses)
            if (sentence.starts_with("the whole edge is ")) said = sentence;
        const std::string begin = "--nodata ", end = " marks it as void";
        const std::size_t at = said.find(begin) + begin.size();
        if (said.empty() || !said.ends_with(end)) return "none: " + said;
        const std::string text = said.substr(at, said.size() - end.size() - at);
        // It does what it is said to do.
        options.nodata = std::stod(text);
        EXPECT_EQ(load(path, options).about.statistics.holes, 20 * 20 - 16 * 16) << text;
        return text;
    };
    EXPECT_EQ(advised({}, 700, 2000), "700");
    EXPECT_EQ(advised({.unit = "ft"}, 700, 2000), "700");
    EXPECT_EQ(advised({}, 700, 2000, {.unit = "ft"}), "700");
    EXPECT_EQ(advised({}, 328.084, 2000, {.unit = "us-ft"}), "328.084");
    EXPECT_EQ(advised({}, 8191.3125, 2000, {.unit = "ft"}), "8191.3125");
    // Height = (stored * scale + offset) feet.
    EXPECT_EQ(advised({.type = "Int16", .unit = "ft", .scale = 0.5, .offset = 100}, -321, 5000),
              "-321");
    EXPECT_EQ(advised({.type = "Int32", .unit = "cm", .offset = 10}, 1'234'567, 200'000),
              "1234567");
    // Depths.
    Raster depths;
    depths.geotransform = {{9, 0.001, 0, 47, 0, -0.001}};
    depths.crs = "EPSG:4326+5831";
    depths.type = "Int16";
    depths.offset = 5;
    EXPECT_EQ(advised(depths, 12, 300), "12");
}

TEST(Load, HgtIsAboveEgm96) {
    std::string bytes(1201 * 1201 * 2, '\0');
    for (std::size_t i = 1; i < bytes.size(); i += 2)
        bytes[i] = static_cast<char>(i % 119);
    const std::filesystem::path path = folder() / "N46E008.hgt";
    std::ofstream(path, std::ios::binary) << bytes;
    const Heightfield f = load(path.string());
    EXPECT_EQ(f.about.vertical_datum, "EGM96");
    EXPECT_THAT(f.about.assumptions,
                Contains("heights are above mean sea level (EGM96, as in all .hgt files) and are "
                         "taken as ellipsoidal: the geoid is not added"));
}

}  // namespace
}  // namespace relevo::dem::test_load
