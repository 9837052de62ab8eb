#include <array>
#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "dem/fixture.h"
#include "dem/load.h"
#include "dem/posts.h"
#include "dem/summary.h"
#include "support/support.h"

namespace relevo::dem::test_unearthly {
namespace {

using test::error_of;
using test::folder;
using test::Raster;
using test::write_raster;

/// Heights from the lowest to the highest, row after row.
Raster rising(double lowest, double highest) {
    Raster raster;
    raster.columns = raster.rows = 20;
    raster.value = [=](int column, int row, int) {
        return lowest + (highest - lowest) * (row * 20 + column) / 399;
    };
    return raster;
}

/// What a DEM is refused with, where figures are to be made of it; empty if it is not.
std::string refusal(const std::string& path, const LoadOptions& options = {}) {
    const std::string said = error_of([&] { Posts::load(std::span(&path, 1), options); });
    const std::string begin = fmt::format("exit 3: {}: ", path);
    return said.starts_with(begin) ? said.substr(begin.size()) : said;
}

TEST(Unearthly, HeightsOutsideOfTheEarthsAreRefusedWithTheUnitsThatFit) {
    struct Case {
        const char* name;
        double lowest, highest;
        const char* advice;
    };
    for (const Case& c : {
             Case{"land_cm.tif", 29'332, 31'000,
                  "--unit dm (2933 to 3100 m) or cm (293 to 310 m) or mm (29 to 31 m), or "},
             {"feet.tif", 200, 28'000,
              "--unit ft (61 to 8534 m) or dm (20 to 2800 m) or cm (2 to 280 m) or mm (0 to 28 "
              "m), or "},
             {"cm.tif", 41'000, 480'900, "--unit cm (410 to 4809 m) or mm (41 to 481 m), or "},
             {"mm.tif", -100'000, 4'809'000, "--unit mm (-100 to 4809 m), or "},
             {"none.tif", -2e6, 9.5e6, ""},
         })
        EXPECT_THAT(
            refusal(write_raster(folder() / c.name, rising(c.lowest, c.highest))),
            testing::EndsWith(fmt::format(
                "heights are outside -11500 to 9000 m ({:.0f} to {:.0f} m); add {}--nodata V if "
                "the stored value V marks voids, or --unit m if they are right",
                c.lowest, c.highest, c.advice)));
}

TEST(Unearthly, ASinglePostIsNoMatterOfTheUnit) {
    Raster raster;
    raster.value = [](int column, int row, int) { return column + row == 0 ? -32000.0 : 50; };
    raster.columns = raster.rows = 20;
    EXPECT_EQ(
        refusal(write_raster(folder() / "one.tif", raster)),
        "1 of 400 heights are outside -11500 to 9000 m (-32000 to 50 m); add --nodata V if the "
        "stored value V marks voids, or --unit m if they are right");
}

TEST(Unearthly, AFewSummitsInFeetAreAMatterOfTheUnit) {
    Raster raster = rising(0, 8000);
    raster.columns = raster.rows = 100;
    raster.value = [](int column, int row, int) {
        return column + row < 7 ? 14'410.0 : 60.0 * row;  // 28 posts in 10,000
    };
    EXPECT_THAT(refusal(write_raster(folder() / "rainier.tif", raster)),
                testing::HasSubstr("28 of 10000 heights are outside -11500 to 9000 m (0 to 14410 "
                                   "m); add --unit ft (0 to 4392 m) or dm"));
}

TEST(Unearthly, AWrongEncodingIsAnsweredWithTheOtherOne) {
    Raster tile;
    tile.columns = tile.rows = 16;
    tile.bands = 3;
    tile.type = "Byte";
    // Terrarium of 500 m: 33268 = 129 * 256 + 244.
    tile.value = [](int, int, int band) { return band == 1 ? 129.0 : band == 2 ? 244.0 : 0.0; };
    EXPECT_THAT(
        refusal(write_raster(folder() / "tile.tif", tile), {.encoding = Encoding::TerrainRgb}),
        testing::HasSubstr("; try the other --encoding, or --unit m if they are right"));
}

TEST(Unearthly, GivenNodataThatReplacesTheDeclaredOneIsSaid) {
    Raster raster = rising(100, 900);
    raster.nodata = -9999;
    const std::string path = write_raster(folder() / "replaced.tif", raster);
    EXPECT_THAT(Posts::load(std::span(&path, 1), {.nodata = -32768}).about().warnings,
                testing::ElementsAre("--nodata -32768 replaces the declared -9999: posts of -9999 "
                                     "are heights now"));
    EXPECT_THAT(Posts::load(std::span(&path, 1), {.nodata = -9999}).about().warnings,
                testing::IsEmpty());
}

TEST(Unearthly, ImpossibleNumbersBesideDeclaredVoidsAreNamed) {
    const auto guesses = [](double odd, const LoadOptions& options = {}) {
        Raster raster = rising(100, 900);
        raster.nodata = -9999;
        raster.value = [value = raster.value, odd](int column, int row, int band) {
            return column == 1 ? -9999 : column == 2 && row == 2 ? odd : value(column, row, band);
        };
        const std::string path = write_raster(folder() / "odd.tif", raster);
        return Posts::load(std::span(&path, 1), options).about().guesses;
    };
    EXPECT_THAT(guesses(1e9),
                testing::ElementsAre("1e+09 is taken as a void, as the declared -9999 is: no "
                                     "height is beyond 10 000 km; --nodata none keeps both"));
    EXPECT_THAT(guesses(800), testing::IsEmpty());
    // Programs mark voids by the largest floats.
    EXPECT_THAT(guesses(-3.4e38), testing::IsEmpty());
    EXPECT_THAT(guesses(1e9, {.nodata = -9999}), testing::IsEmpty());
}

// As in a hostile file.
TEST(Unearthly, ADemOfTenThousandKilometresHeightNamesFileAndOption) {
    const std::string path = write_raster(folder() / "high.tif", rising(100, 9.99e6));
    EXPECT_EQ(error_of([&] { Posts::load(std::span(&path, 1)); }),
              fmt::format(
                  "exit 3: {}: 399 of 400 heights are outside -11500 to 9000 m (100 to 9990000 m); "
                  "add --nodata V if the stored value V marks voids, or --unit m if they are right",
                  path));
}

TEST(Unearthly, WhoSaysWhatTheHeightsAreIsBelieved) {
    const std::string path = write_raster(folder() / "given.tif", rising(29'332, 31'000));
    EXPECT_EQ(refusal(path, {.unit = "cm"}), "no error");
    EXPECT_EQ(refusal(path, {.unit = "m"}), "no error");
    EXPECT_EQ(refusal(path, {.nodata = -1}), "no error");
    EXPECT_EQ(refusal(path, {.no_nodata = true}), "no error");
    // It is said all the same.
    EXPECT_THAT(Posts::load(std::span(&path, 1), {.unit = "m"}).about().guesses,
                testing::Contains(testing::HasSubstr("outside -11500 to 9000 m")));
}

/// Sea floor with the noise of soundings, in centimetres: what stands out by 9 m does so by 900.
Raster soundings(double spacing_m, double noise) {
    Raster raster = rising(-10'000, -2000);
    raster.geotransform = {{500000, spacing_m, 0, 5200000, 0, -spacing_m}};
    const auto plain = raster.value;
    raster.value = [=](int column, int row, int band) {
        return plain(column, row, band) + (column % 3 == 1 && row % 3 == 1 ? noise : 0);
    };
    return raster;
}

TEST(Unearthly, SpikesAllOverRaiseTheQuestionOfTheUnit) {
    const std::string path = write_raster(folder() / "soundings.tif", soundings(30, 900));
    EXPECT_EQ(refusal(path),
              "49 of 400 heights differ from all neighbours by 180 m or more (-10000 to -1100 m), "
              "so the unit may be wrong; add --unit dm (-1000 to -110 m) or cm (-100 to -11 m) or "
              "mm (-10 to -1 m), or --nodata V if the stored value V marks voids, or --unit m if "
              "they are right");
    EXPECT_EQ(refusal(path, {.unit = "cm"}), "no error");
    // Also where memory does not hold all posts.
    EXPECT_THAT(refusal(path, {.memory = MemoryBudget::of_posts(300)}),
                testing::HasSubstr("differ from all neighbours"));
    // Posts so far apart may be seamounts; and a unit that the file has is its own matter.
    EXPECT_THAT(refusal(write_raster(folder() / "wide.tif", soundings(900, 2000))),
                testing::HasSubstr("differ from all neighbours"));
    EXPECT_EQ(refusal(write_raster(folder() / "wider.tif", soundings(1100, 2000))), "no error");
    Raster in_metres = soundings(30, 900);
    in_metres.unit = "m";
    EXPECT_EQ(refusal(write_raster(folder() / "metres.tif", in_metres)), "no error");
}

TEST(Unearthly, InfoSaysItAndGoesOn) {
    const std::string path = write_raster(folder() / "told.tif", rising(29'332, 31'000));
    const Summary summary = summarize(Source::open(path), 1 << 20);
    EXPECT_EQ(summary.outliers, 400);
    EXPECT_THAT(summary.assumptions, testing::Contains(testing::HasSubstr("cm (293 to 310 m)")));
    EXPECT_THAT(summarize(load(path)).assumptions,
                testing::Contains(testing::HasSubstr("cm (293 to 310 m)")));
}

TEST(Unearthly, NoRealDemIsRefusedButThatInCentimetres) {
    SKIP_WITHOUT_TEST_DATA(data);
    for (const char* name :
         {"tyrol_aw3d30_n47e011_1s_cog.tif", "highlands_srtm3/highlands_srtm3.vrt", "N42E001.hgt",
          "mt_rainier_90m.tif", "srtm_bigtujunga30m_utm11.tif", "SainteHelens.dem",
          "n00_e006_3arc_v2.dt1", "n43.dt0", "colorado_tut_relief.nc", "HI_topo_04.nc",
          "rmnp/rmnp-dem.tif", "swellendam/srtm_41_19_4326.tif", "holyroodpark.tif",
          "dem_RGI50-05.08389.tif", "roi.tif", "missoula_valley.img", "monterey_bay_topobathy.tif",
          "hawaii_rotated20.tif", "sample.bag"})
        EXPECT_EQ(refusal((data / "dem" / name).string()), "no error") << name;
    const std::string gironde = (data / "dem" / "gironde_dem_cm.tif").string();
    EXPECT_THAT(refusal(gironde), testing::HasSubstr("cm (-104 to -4 m)"));
    EXPECT_EQ(refusal(gironde, {.unit = "cm"}), "no error");
    EXPECT_EQ(
        refusal((data / "dem" / "ldem_4_reduced.cub").string()),
        "SimpleCylindrical Moon: a coordinate system of the Moon; Relevo draws only the Earth");
}

}  // namespace
}  // namespace relevo::dem::test_unearthly
