#include <algorithm>
#include <cmath>
#include <cstdint>
#include <ostream>

#include <gmock/gmock.h>

#include "base/text.h"
#include "base/units.h"
#include "dem/load.h"
#include "support/support.h"

namespace relevo::dem::test_real {
namespace {

/// What dem/INDEX.md of the outside test data says of a file.
struct Listed {
    const char* files;  ///< one, or more with blanks between
    const char* driver;
    const char* type;
    int columns, rows;
    const char* crs;  ///< code; empty: has none
    double lat_deg, lon_deg, tolerance_deg;
    float min_m, max_m;
    std::int64_t holes;
    float printed_m = 0;  ///< half of the last digit that the range is printed to
    LoadOptions options = {};
    const char* unit = "m";
};

void PrintTo(const Listed& listed, std::ostream* out) {
    *out << listed.files;
}

const Listed kListed[] = {
    {"tyrol_aw3d30_n47e011_1s_cog.tif", "GTiff", "Int16", 3600, 3600, "EPSG:4326", 47.5, 11.5, 1e-9,
     461, 3458, 0},
    {"highlands_srtm3/highlands_srtm3.vrt", "VRT", "Int16", 2401, 1201, "EPSG:4326", 56.5, -5.0,
     1e-9, -4, 1336, 0},
    {"highlands_srtm3/N56W005.hgt highlands_srtm3/N56W006.hgt", "SRTMHGT", "Int16", 2401, 1201,
     "EPSG:4326", 56.5, -5.0, 1e-9, -4, 1336, 0},
    {"N42E001.hgt", "SRTMHGT", "Int16", 1201, 1201, "EPSG:4326", 42.5, 1.5, 1e-9, 349, 3100, 7652},
    {"mt_rainier_90m.tif", "GTiff", "Int16", 1201, 1201, "EPSG:4326", 46.5, -121.5, 1e-9, 263, 4371,
     9033},
    {"srtm_bigtujunga30m_utm11.tif", "GTiff", "Int16", 1197, 643, "EPSG:32611", 34.32, -118.15,
     0.005, 315, 2295, 0},
    {"SainteHelens.dem", "USGSDEM", "Int16", 327, 468, "", 46.19, -122.19, 0.005, 682, 2543, 4151},
    {"n00_e006_3arc_v2.dt1", "DTED", "Int16", 1201, 1201, "EPSG:4326", 0.5, 6.5, 1e-9, -7, 1979,
     4072},
    {"n43.dt0", "DTED", "Int16", 121, 121, "EPSG:4326", 43.5, -79.5, 1e-9, 75, 460, 0},
    {"swellendam/srtm_41_19_4326.tif", "GTiff", "Float32", 919, 619, "EPSG:4326", -34.01, 20.45,
     0.005, 0, 1699, 0},
    {"colorado_tut_relief.nc", "netCDF", "Int16", 600, 600, "EPSG:4326", 37.5, -105.5, 1e-9, 1052,
     4328, 0},
    {"HI_topo_04.nc",
     "netCDF",
     "Int16",
     181,
     85,
     "EPSG:4326",
     21.5,
     -157.5,
     1e-9,
     -5784,
     2804,
     0,
     1e-3F,
     {},
     "km"},
    {"rmnp/rmnp-dem.tif", "GTiff", "UInt16", 152, 187, "EPSG:4326", 40.36, -105.70, 0.005, 2281,
     4261, 0},
    {"holyroodpark.tif", "GTiff", "Float32", 815, 563, "EPSG:27700", 55.945, -3.162, 0.0005, 33.8F,
     250.8F, 0, 0.05F},
    {"dem_RGI50-05.08389.tif", "GTiff", "Int16", 245, 302, "", 80.62, -64.16, 0.005, 202, 1062, 0},
    {"avaGar.asc",
     "AAIGrid",
     "Float32",
     520,
     387,
     "EPSG:31287",
     47.05,
     11.3,
     0.05,
     1234,
     2672,
     82888,
     0.5F,
     {.crs = "EPSG:31287"}},
    {"roi.tif", "GTiff", "Float32", 70, 100, "", 37.733, -83.766, 0.0006, 1008.6F, 1264.9F, 0,
     0.05F},
    {"roi.tif",
     "GTiff",
     "Float32",
     70,
     100,
     "",
     37.733,
     -83.766,
     0.0006,
     307.42F,
     385.54F,
     0,
     0.02F,
     {.unit = "us-ft"},
     "us-ft"},
    {"terrainrgb_z12/12/2177/1435.png terrainrgb_z12/12/2177/1436.png "
     "terrainrgb_z12/12/2178/1435.png terrainrgb_z12/12/2178/1436.png",
     "PNG",
     "Byte",
     1024,
     1024,
     "EPSG:3857",
     47.27,
     11.43,
     0.01,
     555,
     2598,
     0,
     0.5F,
     {.encoding = Encoding::TerrainRgb}},
    {"terrarium.png",
     "PNG",
     "Byte",
     256,
     256,
     "EPSG:4326",
     46.05,
     10.05,
     1e-9,
     852.1F,
     2475.1F,
     0,
     0.05F,
     {.encoding = Encoding::Terrarium, .bounds = Bounds{10, 46, 10.1, 46.1}}},
    {"missoula_valley.img", "HFA", "Int16", 714, 975, "EPSG:32611", 46.94, -114.03, 0.005, 930,
     2465, 0},
    {"monterey_bay_topobathy.tif", "GTiff", "Float32", 540, 540, "EPSG:4326", 36.68, -121.87, 0.005,
     -2805.5F, 1515.9F, 0, 0.05F},
    {"sample.bag", "BAG", "Float32", 100, 100, "", 50.118, -66.364, 0.001, 0, 99.99F, 0, 0.005F},
    {"hawaii_rotated20.tif", "GTiff", "Float32", 420, 380, "EPSG:32605", 19.81, -155.45, 0.005, 709,
     4197, 7188, 0.5F},
};

std::vector<std::string> paths_of(const std::filesystem::path& dir, const char* files) {
    std::vector<std::string> paths;
    for (const std::string& file : split(files, ' '))
        paths.push_back((dir / file).string());
    return paths;
}

class RealDem : public testing::TestWithParam<Listed> {};

TEST_P(RealDem, LoadsAsListed) {
    SKIP_WITHOUT_TEST_DATA(data);
    const Listed& listed = GetParam();
    const Heightfield f = load(paths_of(data / "dem", listed.files), listed.options);
    EXPECT_EQ(f.about.driver, listed.driver);
    EXPECT_EQ(f.about.data_type, listed.type);
    EXPECT_EQ(f.height_m.width(), listed.columns);
    EXPECT_EQ(f.height_m.height(), listed.rows);
    EXPECT_EQ(f.grid.columns(), listed.columns);
    EXPECT_EQ(f.grid.rows(), listed.rows);
    EXPECT_EQ(f.grid.crs().code(), listed.crs);
    EXPECT_NEAR(degrees(f.grid.center().lat_rad), listed.lat_deg, listed.tolerance_deg);
    EXPECT_NEAR(degrees(f.grid.center().lon_rad), listed.lon_deg, listed.tolerance_deg);
    EXPECT_NEAR(f.about.statistics.min_m, listed.min_m, listed.printed_m);
    EXPECT_NEAR(f.about.statistics.max_m, listed.max_m, listed.printed_m);
    EXPECT_EQ(f.about.statistics.holes, listed.holes);
    EXPECT_EQ(f.about.statistics.outliers, 0);
    EXPECT_EQ(f.about.unit.name, listed.unit);
    // The first row of all of these is the northern one.
    EXPECT_GT(f.grid.place(0, 0).lat_rad, f.grid.place(0, listed.rows - 1).lat_rad);
}

INSTANTIATE_TEST_SUITE_P(Index, RealDem, testing::ValuesIn(kListed),
                         [](const testing::TestParamInfo<Listed>& test) {
                             std::string name;
                             for (const char* c = test.param.files; *c; ++c)
                                 if (std::isalnum(static_cast<unsigned char>(*c))) name += *c;
                             return name + "In" + test.param.unit[0];
                         });

/// Where the highest post within `radius_m` of a place is.
geo::Geodetic summit_near(const Heightfield& f, const geo::Geodetic& place, double radius_m) {
    const glm::dvec2 middle = f.grid.post(place);
    const glm::dvec2 spacing_m = f.grid.post_spacing_m();
    geo::Geodetic best;
    best.height_m = -1e9;
    for (int r = 0; r < f.grid.rows(); ++r)
        for (int c = 0; c < f.grid.columns(); ++c) {
            const glm::dvec2 away_m = (glm::dvec2(c, r) - middle) * spacing_m;
            if (glm::length(away_m) < radius_m && f.height_m.at(c, r) > best.height_m)
                best = f.place(c, r);
        }
    return best;
}

// Summits stand where maps have them: a DEM that is shifted, turned or mirrored would fail. Places
// are those of the summits' articles in Wikipedia, good to 1"; heights of 30 m and 90 m posts are
// up to 5 % low on a peak.
TEST(RealDem, SummitsStandWhereMapsHaveThem) {
    SKIP_WITHOUT_TEST_DATA(data);
    const struct {
        const char* file;
        const char* summit;
        double lat_deg, lon_deg, height_m, off_m;
    } cases[] = {
        {"highlands_srtm3/highlands_srtm3.vrt", "Ben Nevis", 56.79686, -5.00361, 1345, 150},
        {"tyrol_aw3d30_n47e011_1s_cog.tif", "Olperer", 47.05306, 11.65889, 3476, 100},
        {"mt_rainier_90m.tif", "Mount Adams", 46.20278, -121.49083, 3743, 150},
        {"SainteHelens.dem", "Mount St. Helens", 46.19119, -122.19447, 2549, 100},
        {"N42E001.hgt", "Pica d'Estats", 42.66694, 1.39778, 3143, 150},
    };
    for (const auto& c : cases) {
        const Heightfield f = load((data / "dem" / c.file).string());
        const geo::Geodetic listed = geo::geodetic_deg(c.lat_deg, c.lon_deg);
        const geo::Geodetic found = summit_near(f, listed, 600);
        EXPECT_LT(geo::geodesic(found, listed).distance_m, c.off_m) << c.summit;
        EXPECT_NEAR(found.height_m, c.height_m, 0.05 * c.height_m) << c.summit;
    }
}

TEST(RealDem, WithoutACrsOneMustBeGiven) {
    SKIP_WITHOUT_TEST_DATA(data);
    const std::string path = (data / "dem" / "avaGar.asc").string();
    EXPECT_EQ(
        test::error_of([&] { load(path); }),
        "exit 3: " + path +
            ": does not say its coordinate system; add --crs, for example EPSG:32632 (UTM 32 N)");
    const Heightfield f = load(path, {.crs = "EPSG:31287"});
    EXPECT_NEAR(f.grid.post_spacing_m().x, 4.9977, 0.002);  // 0.03 % of scale
}

TEST(RealDem, FeetOfADistanceAreUsSurveyFeet) {
    SKIP_WITHOUT_TEST_DATA(data);
    const Heightfield f = load((data / "dem" / "roi.tif").string());
    EXPECT_NEAR(f.grid.post_spacing_m().x, 30 * kUsSurveyFoot_m, 0.002);
}

TEST(RealDem, AFrameOfZeroesIsMentioned) {
    SKIP_WITHOUT_TEST_DATA(data);
    const std::string path = (data / "dem" / "swellendam/srtm_41_19_4326.tif").string();
    EXPECT_THAT(load(path).about.guesses,
                testing::ElementsAre(testing::HasSubstr("the whole edge is 0 m high")));
    EXPECT_EQ(load(path, {.nodata = 0}).about.statistics.min_m, 4);
}

// The same ground through two encodings. Row 1 of the index was made from tiles like these by
// averaging onto 1 arc-second posts and rounding to whole metres, so the mean of the tiles over
// each of its cells is compared.
TEST(RealDem, TerrainRgbTilesAgreeWithTheModelTheyWereMadeFrom) {
    SKIP_WITHOUT_TEST_DATA(data);
    const Source model = Source::open((data / "dem/tyrol_aw3d30_n47e011_1s_cog.tif").string());
    const Source tiles =
        Source::open(paths_of(data / "dem",
                              "terrainrgb_z12/12/2177/1435.png terrainrgb_z12/12/2177/1436.png "
                              "terrainrgb_z12/12/2178/1435.png terrainrgb_z12/12/2178/1436.png"),
                     {.encoding = Encoding::TerrainRgb});
    const Array2d<float> fine = tiles.read();
    // The sum over the cells from the origin to a point between posts; bilinear inside of a cell,
    // as heights are constant there.
    Array2d<double> sums(fine.width() + 1, fine.height() + 1);
    for (int r = 0; r < fine.height(); ++r)
        for (int c = 0; c < fine.width(); ++c)
            sums.at(c + 1, r + 1) = static_cast<double>(fine.at(c, r)) + sums.at(c, r + 1) +
                                    sums.at(c + 1, r) - sums.at(c, r);
    const auto sum_to = [&](double x, double y) {
        const int c = std::min(static_cast<int>(x), fine.width() - 1);
        const int r = std::min(static_cast<int>(y), fine.height() - 1);
        const double u = x - c, v = y - r;
        return (1 - u) * (1 - v) * sums.at(c, r) + u * (1 - v) * sums.at(c + 1, r) +
               (1 - u) * v * sums.at(c, r + 1) + u * v * sums.at(c + 1, r + 1);
    };
    const glm::dvec2 north_west = model.grid().post(tiles.grid().place(-0.5, -0.5));
    const glm::dvec2 south_east =
        model.grid().post(tiles.grid().place(fine.width() - 0.5, fine.height() - 0.5));
    const Window window{static_cast<int>(north_west.x) + 2, static_cast<int>(north_west.y) + 2,
                        static_cast<int>(south_east.x - north_west.x) - 4,
                        static_cast<int>(south_east.y - north_west.y) - 4};
    const Array2d<float> coarse = model.read(window, window.columns, window.rows);
    std::vector<double> errors_m;
    for (int r = 0; r < window.rows; ++r)
        for (int c = 0; c < window.columns; ++c) {
            const glm::dvec2 post(window.column + c, window.row + r);
            const auto edge = [&](double dc, double dr) {
                return tiles.grid().post(model.grid().place(post.x + dc, post.y + dr)) + 0.5;
            };
            const glm::dvec2 a = edge(-0.5, -0.5), b = edge(0.5, 0.5);
            const double mean_m =
                (sum_to(b.x, b.y) - sum_to(a.x, b.y) - sum_to(b.x, a.y) + sum_to(a.x, a.y)) /
                ((b.x - a.x) * (b.y - a.y));
            errors_m.push_back(std::abs(mean_m - static_cast<double>(coarse.at(c, r))));
        }
    test::print_accuracy("Terrain-RGB tiles and the model they were made from", errors_m, "m", 1.1);
    EXPECT_GT(errors_m.size(), 150'000U);
    EXPECT_LT(*std::max_element(errors_m.begin(), errors_m.end()), 0.1 + 1);
}

TEST(RealDem, PicturesAreRefused) {
    SKIP_WITHOUT_TEST_DATA(data);
    for (const char* file : {"rmnp/rmnp-rgb.tif", "swellendam/3320D_2010_315_RGB_LATLNG.tif"}) {
        const std::string path = (data / "dem" / file).string();
        EXPECT_EQ(
            test::error_of([&] { load(path); }),
            "exit 3: " + path +
                ": a picture (red, green and blue bands of 8 bits), expected heights; if its "
                "colours encode heights pass --encoding terrain-rgb or terrarium, if one band "
                "holds them --band N");
    }
}

TEST(RealDem, TilesOfAMosaicMeetWhereTheyOverlap) {
    SKIP_WITHOUT_TEST_DATA(data);
    const auto path = [&](const char* name) {
        return (data / "dem" / "highlands_srtm3" / name).string();
    };
    const Heightfield whole = load(path("highlands_srtm3.vrt"));
    const Heightfield west = load(path("N56W006.hgt"));
    const Heightfield east = load(path("N56W005.hgt"));
    for (int r = 0; r < 1201; ++r) {
        ASSERT_EQ(whole.height_m.at(10, r), west.height_m.at(10, r));
        ASSERT_EQ(whole.height_m.at(2400 - 7, r), east.height_m.at(1200 - 7, r));
    }
    EXPECT_EQ(west.grid.place(1200, 5), east.grid.place(0, 5));
}

TEST(RealDem, CogOverviewsAreNearTheMeansOfItsPosts) {
    SKIP_WITHOUT_TEST_DATA(data);
    const Source source = Source::open((data / "dem" / "tyrol_aw3d30_n47e011_1s_cog.tif").string());
    const Array2d<float> all = source.read();
    const Array2d<float> eighth = source.read({0, 0, 3600, 3600}, 450, 450);
    double sum = 0;
    for (int r = 0; r < 450; ++r)
        for (int c = 0; c < 450; ++c) {
            double mean = 0;
            for (int i = 0; i < 64; ++i)
                mean += all.at(8 * c + i % 8, 8 * r + i / 8) / 64.0;
            sum += mean - eighth.at(c, r);
        }
    EXPECT_LT(std::abs(sum / (450 * 450)), 1);  // metres; rounded to whole ones by its maker
}

TEST(RealDem, SaysWhatItAssumed) {
    SKIP_WITHOUT_TEST_DATA(data);
    const Heightfield f = load((data / "dem" / "SainteHelens.dem").string());
    EXPECT_EQ(f.grid.crs().name(), "Transverse Mercator on NAD27");
    EXPECT_EQ(f.about.assumptions,
              (std::vector<std::string>{
                  "heights are taken as ellipsoidal: the file names no vertical datum",
                  "converted to WGS 84 by NAD27 to WGS 84 (6), good to 7 m"}));
    const Heightfield dted = load((data / "dem" / "n00_e006_3arc_v2.dt1").string());
    EXPECT_EQ(dted.about.vertical_datum, "EGM96");
}

}  // namespace
}  // namespace relevo::dem::test_real
