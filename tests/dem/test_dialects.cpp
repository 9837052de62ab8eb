#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>

#include <gmock/gmock.h>

#include "base/log.h"
#include "base/units.h"
#include "dem/fixture.h"
#include "dem/load.h"
#include "support/support.h"

// One small file for every dialect, written here, so that all of it runs anywhere.

namespace relevo::dem::test_dialects {
namespace {

using test::add_overviews;
using test::Raster;
using test::write_raster;
using testing::Contains;
using testing::ElementsAre;
using testing::Not;

using test::folder;

Heightfield loaded(const char* name, const Raster& raster, const LoadOptions& options = {}) {
    return load(write_raster(folder() / name, raster), options);
}

/// 20 x 20 posts of mountains with some cells that hold `mark`.
Raster with_mark(const char* type, double mark) {
    Raster raster;
    raster.type = type;
    raster.columns = raster.rows = 20;
    raster.value = [mark](int column, int row, int) {
        return column < 2 && row < 3 ? mark : 1000.0 + 10 * column + row;
    };
    return raster;
}

TEST(Dialect, UndeclaredNodataIsFoundAndSaid) {
    const struct {
        const char* type;
        double mark;
        const char* text;
    } cases[] = {{"Int16", -32768, "-32768"}, {"Int16", -9999, "-9999"},  {"Int16", 32767, "32767"},
                 {"Float32", -9999, "-9999"}, {"UInt16", 65535, "65535"}, {"Float32", 0, "0"},
                 {"Int32", -99999, "-99999"}, {"Float64", -9999, "-9999"}};
    for (const auto& c : cases) {
        const std::string path =
            write_raster(folder() / "undeclared.tif", with_mark(c.type, c.mark));
        std::vector<std::string> said;
        log::set_sink([&](log::Level, std::string_view text) { said.emplace_back(text); });
        const Heightfield f = load(path);
        log::set_sink({});
        EXPECT_EQ(f.about.statistics, (Statistics{1003, 1209, 394, 6, 0})) << c.type << c.text;
        EXPECT_EQ(f.about.nodata, c.mark);
        const std::string sentence =
            std::string(c.text) +
            " is taken as a void (not declared, far from all heights); --nodata none keeps it";
        EXPECT_THAT(f.about.assumptions, Contains(sentence));
        EXPECT_THAT(said, ElementsAre(path + ": " + sentence));
        const Heightfield all = load(path, {.no_nodata = true});
        EXPECT_EQ(all.about.statistics.holes, 0) << c.type << c.text;
        EXPECT_EQ(all.height_m.at(0, 0), static_cast<float>(c.mark));
        // A given value replaces the search.
        const Heightfield given = load(path, {.nodata = 1003});
        EXPECT_EQ(given.about.statistics.holes, 1);
    }
}

TEST(Dialect, UndeclaredHugeNumbersAreHoles) {
    const Raster raster = with_mark("Float32", -3.4028234663852886e38);
    const Heightfield f = loaded("huge.tif", raster);
    EXPECT_EQ(f.about.statistics, (Statistics{1003, 1209, 394, 6, 0}));
    EXPECT_THAT(f.about.assumptions, Contains("numbers too large for heights are taken as voids "
                                              "(not declared); --nodata none keeps them"));
    EXPECT_EQ(load((folder() / "huge.tif").string(), {.no_nodata = true}).about.statistics.holes,
              0);
}

TEST(Dialect, UndeclaredNodataOfALargeRasterIsFoundInASample) {
    Raster raster;
    raster.type = "Int16";
    raster.columns = 3000;
    raster.rows = 2500;
    // A frame of 100 posts, as turning a raster leaves it, and the rule holds in every window.
    const auto outside = [](int column, int row) {
        return column < 100 || row < 100 || column >= 2900 || row >= 2400;
    };
    raster.value = [&](int column, int row, int) {
        return outside(column, row) ? -32768.0 : 500 + (column + row) % 1000;
    };
    raster.options = {"COMPRESS=DEFLATE", "TILED=YES"};
    const Source source = Source::open(write_raster(folder() / "frame.tif", raster));
    EXPECT_EQ(source.description().nodata, -32768);
    EXPECT_TRUE(std::isnan(source.read({0, 0, 10, 10}, 10, 10).at(9, 9)));
    EXPECT_TRUE(std::isnan(source.read({99, 1000, 2, 1}, 2, 1).at(0, 0)));
    EXPECT_EQ(source.read({99, 1000, 2, 1}, 2, 1).at(1, 0), 500 + 1100 % 1000);
}

TEST(Dialect, OverviewsMadeWithoutKnowledgeOfTheHolesAreLeftAlone) {
    Raster raster = with_mark("Int16", -32768);
    raster.columns = raster.rows = 64;
    const std::string path = write_raster(folder() / "overview.tif", raster);
    add_overviews(path, {2, 4});
    const Source source = Source::open(path);
    const Array2d<float> half = source.read({0, 0, 64, 64}, 32, 32);
    // Posts (2..3, 0..1) and (2..3, 2..3): the mean of four heights, and no -32768 has part in it.
    EXPECT_FLOAT_EQ(half.at(1, 0), 1025.5F);
    EXPECT_TRUE(std::isnan(half.at(0, 0)));
    for (const float height : half)
        EXPECT_TRUE(std::isnan(height) || height >= 1000) << height;
}

TEST(Dialect, NodataNoneTakesTheDeclaredValueToo) {
    Raster raster = with_mark("Int16", 0);
    raster.nodata = 0;
    EXPECT_EQ(loaded("declared.tif", raster).about.statistics.holes, 6);
    const Heightfield f = load((folder() / "declared.tif").string(), {.no_nodata = true});
    EXPECT_EQ(f.about.statistics.holes, 0);
    EXPECT_THAT(f.about.assumptions, Contains("0 marks no void, as given"));
}

TEST(Dialect, TheSeaIsNoHole) {
    Raster raster;
    raster.type = "Int16";
    raster.columns = raster.rows = 20;
    raster.value = [](int column, int, int) { return column < 10 ? 0.0 : 15.0 * (column - 9); };
    EXPECT_EQ(loaded("coast.tif", raster).about.statistics.holes, 0);
}

TEST(Dialect, AFrameAroundATurnedRasterIsMentioned) {
    Raster raster;
    raster.type = "Int16";
    raster.columns = raster.rows = 20;
    raster.nodata = -9999;
    raster.value = [](int column, int row, int) {
        return column < 2 || row < 2 || column > 17 || row > 17 ? 0.0 : 60.0 + column;
    };
    const Heightfield f = loaded("frame_of_0.tif", raster);
    EXPECT_EQ(f.about.statistics.holes, 0);
    EXPECT_THAT(f.about.assumptions,
                Contains("the whole edge is 0 m high and differs from its neighbours by 70 m, "
                         "perhaps fill of a rotated raster; --nodata 0 marks it as void"));
    EXPECT_THAT(load((folder() / "frame_of_0.tif").string(), {.nodata = 0}).about.assumptions,
                Not(Contains(testing::HasSubstr("the whole edge is"))));
}

TEST(Dialect, AlphaMarksHoles) {
    for (const char* type : {"UInt16", "Float32", "Int16"}) {
        Raster raster;
        raster.type = type;
        raster.bands = 2;
        raster.options = {"ALPHA=YES"};
        raster.value = [](int column, int row, int band) {
            return band == 1 ? 100.0 + column + 10 * row : column == 3 ? 0 : 255;
        };
        const Heightfield f = loaded("alpha.tif", raster);
        EXPECT_EQ(f.about.statistics, (Statistics{100, 135, 20, 4, 0})) << type;
        EXPECT_TRUE(std::isnan(f.height_m.at(3, 1))) << type;
        EXPECT_THAT(f.about.assumptions, Not(Contains(testing::HasSubstr("--band"))));
    }
}

TEST(Dialect, UnitsBecomeMetres) {
    const struct {
        const char* unit;
        double metres;
    } cases[] = {{"ft", 0.3048}, {"us-ft", kUsSurveyFoot_m}, {"cm", 0.01}, {"km", 1000}, {"m", 1}};
    for (const auto& c : cases) {
        const Heightfield f = loaded("unit.tif", {}, {.unit = c.unit});
        EXPECT_FLOAT_EQ(f.height_m.at(5, 3), static_cast<float>(135 * c.metres)) << c.unit;
        Raster raster;
        raster.unit = c.unit;
        EXPECT_FLOAT_EQ(loaded("unit.tif", raster).height_m.at(5, 3),
                        static_cast<float>(135 * c.metres))
            << c.unit;
    }
}

TEST(Dialect, NonSquareCells) {
    Raster raster;
    raster.geotransform = {{500000, 30, 0, 5200000, 0, -90}};
    const Heightfield f = loaded("oblong.tif", raster);
    EXPECT_NEAR(f.grid.post_spacing_m().x, 30, 0.02);
    EXPECT_NEAR(f.grid.post_spacing_m().y, 90, 0.05);
}

TEST(Dialect, SouthUpAndTurnedPostsLieWhereTheyDoNorthUp) {
    const auto height = [](double x, double y) {
        return 100 + (x - 500000) / 30 + (5200000 - y) / 3;
    };
    for (const std::array<double, 6>& g : {std::array<double, 6>{500000, 30, 0, 5199000, 0, 30},
                                           std::array<double, 6>{500000, 26, 15, 5200000, 15, -26},
                                           std::array<double, 6>{500600, -30, 0, 5200000, 0, -30},
                                           std::array<double, 6>{500000, 0, 30, 5200000, -30, 0}}) {
        Raster raster;
        raster.columns = raster.rows = 12;
        raster.geotransform = g;
        raster.value = [&](int c, int r, int) {
            return height(g[0] + g[1] * (c + 0.5) + g[2] * (r + 0.5),
                          g[3] + g[4] * (c + 0.5) + g[5] * (r + 0.5));
        };
        const Heightfield f = loaded("turned.tif", raster);
        for (const glm::ivec2 post : {glm::ivec2(0, 0), glm::ivec2(11, 0), glm::ivec2(3, 7)}) {
            const glm::dvec2 at =
                f.grid.crs().from_geodetic(f.place(post.x, post.y));  // back in UTM
            EXPECT_NEAR(f.height_m.at(post.x, post.y), height(at.x, at.y), 1e-3);
        }
    }
}

TEST(Dialect, AcrossTheAntimeridian) {
    Raster raster;
    raster.crs = "EPSG:4326";
    raster.columns = raster.rows = 20;
    raster.geotransform = {{179, 0.1, 0, -16, 0, -0.1}};
    const Heightfield f = loaded("antimeridian.tif", raster);
    EXPECT_NEAR(std::abs(degrees(f.grid.center().lon_rad)), 180, 1e-9);
    EXPECT_NEAR(f.grid.extent_m().x, 19 * 0.1 * 111320 * std::cos(radians(17)), 300);
    EXPECT_NEAR(degrees(f.place(19, 0).lon_rad), -179.05, 1e-9);
    const glm::dvec2 post = f.grid.post(geo::geodetic_deg(-16.05, -179.05));
    EXPECT_NEAR(post.x, 19, 1e-9);
}

TEST(Dialect, PolarStereographicOverThePole) {
    Raster raster;
    raster.crs = "EPSG:3413";
    raster.columns = raster.rows = 21;
    raster.geotransform = {{-10500, 1000, 0, 10500, 0, -1000}};
    const Heightfield f = loaded("pole.tif", raster);
    EXPECT_NEAR(degrees(f.grid.center().lat_rad), 90, 1e-9);
    // True scale is at 70 N; at the pole a metre of the map is 1.03 m (Snyder 1987, eq. 21-33).
    EXPECT_NEAR(f.grid.post_spacing_m().x, 1030, 5);
    EXPECT_NEAR(f.grid.extent_m().x, 20 * 1030, 100);
    // The meridian of 45 W runs down the map.
    EXPECT_NEAR(degrees(f.place(10, 20).lon_rad), -45, 1e-9);
    EXPECT_NEAR(degrees(f.place(10, 0).lon_rad), 135, 1e-9);
    const glm::dvec2 post = f.grid.post(f.place(3, 17));
    EXPECT_NEAR(post.x, 3, 1e-6);
    EXPECT_NEAR(post.y, 17, 1e-6);
}

TEST(Dialect, LongitudesPastHalfATurn) {
    Raster raster;
    raster.driver = "netCDF";
    raster.crs = "EPSG:4326";
    raster.type = "Int16";
    raster.geotransform = {{195, 0.1, 0, 25, 0, -0.1}};
    raster.scale = 0.001;
    raster.unit = "km";
    raster.options = {"WRITE_GDAL_TAGS=NO"};
    const Heightfield f = loaded("hawaii.nc", raster);
    EXPECT_NEAR(degrees(f.place(0, 0).lon_rad), -164.95, 1e-6);
    EXPECT_FLOAT_EQ(f.about.statistics.max_m, 135);
}

TEST(Dialect, BilWithItsHeader) {
    Raster raster;
    raster.driver = "EHdr";
    raster.type = "Int16";
    raster.nodata = -9999;
    raster.value = [](int c, int r, int) { return c == 0 && r == 0 ? -9999.0 : 7.0 * c + r; };
    const Heightfield f = loaded("a.bil", raster);
    EXPECT_EQ(f.about.driver, "EHdr");
    EXPECT_EQ(f.about.statistics, (Statistics{1, 38, 23, 1, 0}));
    EXPECT_EQ(f.grid.affine(), (Affine{500015, 30, 0, 5199985, 0, -30}));
}

TEST(Dialect, EsriAsciiWithAndWithoutPrj) {
    Raster raster;
    raster.driver = "AAIGrid";
    raster.crs = "EPSG:32632";
    EXPECT_EQ(loaded("with.asc", raster).grid.crs().name(), "WGS 84 / UTM zone 32N");
    raster.crs = "";
    EXPECT_EQ(
        test::error_of([&] { loaded("without.asc", raster); }),
        "exit 3: " + (folder() / "without.asc").string() +
            ": does not say its coordinate system; add --crs, for example EPSG:32632 (UTM 32 N)");
    raster.geotransform = {{11, 0.001, 0, 47, 0, -0.001}};
    const Heightfield degrees_of = loaded("degrees.asc", raster);
    EXPECT_EQ(degrees_of.grid.crs().code(), "EPSG:4326");
    EXPECT_THAT(degrees_of.about.guesses,
                ElementsAre("the CRS is WGS 84: the file names none, and its coordinates look like "
                            "degrees; --crs sets another"));
    // Metres of a model's own origin are no degrees.
    raster.geotransform = {{0, 1, 0, 4, 0, -1}};
    EXPECT_THROW(loaded("local.asc", raster), Error);
}

TEST(Dialect, EsriAsciiByTheCentreOfItsFirstCell) {
    const std::filesystem::path path = folder() / "centre.asc";
    std::ofstream(path) << "ncols 3\nnrows 2\nxllcenter 1000\nyllcenter 2000\ncellsize 10\n"
                           "NODATA_value -9999\n1 2 3\n4 -9999 6\n";
    const Heightfield f = load(path.string(), {.crs = "EPSG:31287"});
    EXPECT_EQ(f.grid.affine()(0, 1), glm::dvec2(1000, 2000));
    EXPECT_EQ(f.about.statistics.holes, 1);
}

TEST(Dialect, HgtPlainAndZipped) {
    // 1201 x 1201 big-endian numbers; the place is the name's.
    std::string bytes(1201 * 1201 * 2, '\0');
    for (std::size_t i = 0; i < 1201 * 1201; ++i) {
        const int height = i == 5 ? -32768 : static_cast<int>(i / 1201);
        bytes[2 * i] = static_cast<char>(height >> 8);
        bytes[2 * i + 1] = static_cast<char>(height & 255);
    }
    const std::filesystem::path path = folder() / "S34E018.hgt";
    std::ofstream(path, std::ios::binary) << bytes;
    const auto check = [](const std::string& name) {
        const Heightfield f = load(name);
        EXPECT_EQ(f.about.statistics, (Statistics{0, 1200, 1201 * 1201 - 1, 1, 0})) << name;
        EXPECT_NEAR(degrees(f.place(0, 1200).lat_rad), -34, 1e-9) << name;
        EXPECT_NEAR(degrees(f.place(0, 1200).lon_rad), 18, 1e-9) << name;
    };
    check(path.string());
    ASSERT_EQ(std::system(("cd " + folder().string() +
                           " && python3 -m zipfile -c S34E018.hgt.zip S34E018.hgt"
                           " && python3 -m zipfile -c other.zip S34E018.hgt")
                              .c_str()),
              0);
    check((folder() / "S34E018.hgt.zip").string());
    check((folder() / "other.zip").string());
}

TEST(Dialect, ArchiveOfSeveralRastersNamesOne) {
    write_raster(folder() / "x.tif", {});
    write_raster(folder() / "y.tif", {});
    ASSERT_EQ(
        std::system(
            ("cd " + folder().string() + " && python3 -m zipfile -c two.zip x.tif y.tif").c_str()),
        0);
    const std::string path = (folder() / "two.zip").string();
    EXPECT_EQ(test::error_of([&] { load(path); }),
              "exit 3: " + path +
                  ": an archive of 2 rasters, expected one; name one, as in '/vsizip/" + path +
                  "/x.tif'");
    EXPECT_EQ(load("/vsizip/" + path + "/y.tif").height_m.at(5, 3), 135);
}

/// Heights in colours; column 0 is black.
Raster coded(Encoding encoding) {
    Raster raster;
    raster.type = "Byte";
    raster.bands = 3;
    raster.pictures = true;
    raster.columns = raster.rows = 16;
    raster.value = [encoding](int column, int row, int band) {
        const double height_m = -50 + 17.5 * column + row;
        const int code = column == 0 ? 0
                         : encoding == Encoding::TerrainRgb
                             ? static_cast<int>(std::lround((height_m + 10000) * 10))
                             : static_cast<int>(std::lround((height_m + 32768) * 256));
        return code >> (8 * (3 - band)) & 255;
    };
    return raster;
}

TEST(Dialect, EncodedColoursAreHeights) {
    for (const Encoding encoding : {Encoding::TerrainRgb, Encoding::Terrarium}) {
        const Heightfield f = loaded("coded.tif", coded(encoding), {.encoding = encoding});
        EXPECT_EQ(f.about.statistics, (Statistics{-32.5F, 227.5F, 240, 16, 0}));
        EXPECT_EQ(f.height_m.at(3, 2), 4.5F);
        EXPECT_EQ(f.about.unit_source, UnitSource::Encoding);
        // The value is the height's.
        EXPECT_TRUE(std::isnan(
            load((folder() / "coded.tif").string(), {.nodata = 4.5, .encoding = encoding})
                .height_m.at(3, 2)));
    }
}

TEST(Dialect, OverviewsOfColoursAreLeftAlone) {
    const std::string path =
        write_raster(folder() / "coded_overview.tif", coded(Encoding::TerrainRgb));
    add_overviews(path, {2});
    const Source source = Source::open(path, {.encoding = Encoding::TerrainRgb});
    EXPECT_FLOAT_EQ(source.read({0, 0, 16, 16}, 8, 8).at(2, 3), -50 + 17.5F * 4.5F + 6.5F);
}

TEST(Dialect, WebMapTilesLieWhereTheirPathSays) {
    const std::filesystem::path tiles = folder() / "tiles/4/8";
    std::filesystem::create_directories(tiles);
    Raster raster = coded(Encoding::Terrarium);
    raster.driver = "PNG";
    raster.crs = "";
    raster.geotransform.reset();
    const std::string path = write_raster(tiles / "5.png", raster);
    const Heightfield f = load(path, {.encoding = Encoding::Terrarium});
    EXPECT_EQ(f.grid.crs().code(), "EPSG:3857");
    // Tile 8 of 16 begins at Greenwich; 5 of 16 from the north at 55.7765730 N.
    const geo::Geodetic corner = f.grid.place(-0.5, -0.5);
    EXPECT_NEAR(degrees(corner.lon_rad), 0, 1e-9);
    EXPECT_NEAR(degrees(corner.lat_rad), 55.7765730, 1e-7);
    EXPECT_THAT(f.about.guesses, ElementsAre("the place is that of the web map tile that the path "
                                             "names, zoom/x/y with y from the north"));
    // Bounds go before the path.
    const Heightfield placed =
        load(path, {.encoding = Encoding::Terrarium, .bounds = Bounds{10, 46, 11, 47}});
    EXPECT_NEAR(degrees(placed.grid.center().lat_rad), 46.5, 1e-12);
    EXPECT_THAT(placed.about.guesses, testing::IsEmpty());
}

TEST(Dialect, BoundsReplaceTheGeoreference) {
    const Heightfield f =
        loaded("placed.tif", {}, {.crs = "EPSG:4326", .bounds = Bounds{10, 46, 10.6, 46.4}});
    EXPECT_NEAR(degrees(f.grid.center().lat_rad), 46.2, 1e-12);
    EXPECT_NEAR(degrees(f.grid.center().lon_rad), 10.3, 1e-12);
    EXPECT_NEAR(f.grid.affine().x_column, 0.1, 1e-12);
    EXPECT_THAT(f.about.assumptions,
                Contains("its edges are 10 and 10.6 degrees east, 46 and 46.4 north, as given"));
}

}  // namespace
}  // namespace relevo::dem::test_dialects
