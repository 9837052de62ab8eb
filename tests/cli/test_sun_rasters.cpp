#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <sched.h>

#include "base/units.h"
#include "cli/program.h"
#include "cli/raster.h"
#include "dem/fixture.h"
#include "support/support.h"

/// `relevo sun hours`, `sky-view` and `horizons`, from file to file.
namespace relevo::test::test_sun_rasters {
namespace {

double value_at(GDALDataset& dataset, int band, int column, int row) {
    float value = 0;
    EXPECT_EQ(dataset.GetRasterBand(band)->RasterIO(GF_Read, column, row, 1, 1, &value, 1, 1,
                                                    GDT_Float32, 0, 0),
              CE_None);
    return double{value};
}

std::filesystem::path folder() {
    static const std::filesystem::path made = scratch_dir("sun_rasters");
    return made;
}
std::string out(const std::string& name) {
    return (folder() / name).string();
}

std::string bytes_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// A plain at the equator in UTM with a wall of 100 m, which has a hole, along the column 60.
std::string walled() {
    Raster raster;
    raster.columns = 121;
    raster.rows = 81;
    raster.crs = "EPSG:32631";
    raster.geotransform = {{500000, 10, 0, 400, 0, -10}};
    raster.nodata = -9999;
    raster.value = [](int column, int row, int) {
        if (column == 60 && row == 40) return -9999.0;
        return column == 60 ? 600.0 : 500.0;
    };
    return write_raster(folder() / "walled.tif", raster);
}

TEST(SunHours, HasAsManyBandsAsAreAskedFor) {
    const Result run = relevo({"sun", "hours", walled(), "--date", "2026-03-20", "--tz", "UTC",
                               "--bands", "hours,first,last,spells", "-o", out("day.tif")});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.err.find("the DEM has 1 voids: they get no value and cast no shadow"),
              std::string::npos)
        << run.err;
    EXPECT_TRUE(run.out.starts_with(
        "time                2026-03-20T00:00:00+00:00 to 2026-03-21T00:00:00+00:00\nsun hours "))
        << run.out;
    const Dataset day = opened(out("day.tif"));
    ASSERT_TRUE(day);
    ASSERT_EQ(day->GetRasterCount(), 4);
    EXPECT_STREQ(day->GetMetadataItem("LAYOUT", "IMAGE_STRUCTURE"), "COG");
    EXPECT_STREQ(day->GetMetadataItem("TIME_ZONE"), "UTC");
    EXPECT_STREQ(day->GetMetadataItem("HOLES"), "1");
    EXPECT_STREQ(day->GetRasterBand(1)->GetUnitType(), "h");
    EXPECT_STREQ(day->GetRasterBand(2)->GetUnitType(), "min");
    EXPECT_STREQ(day->GetRasterBand(4)->GetDescription(), "sunshine periods");
    // 100 m before the wall in the west the sun comes over it 45 degrees high, three hours after it
    // rises in the east of it.
    const double rises_min = value_at(*day, 2, 118, 20);
    EXPECT_NEAR(value_at(*day, 2, 50, 20) - rises_min, 180, 3);
    EXPECT_NEAR(value_at(*day, 1, 50, 20), 9.1, 0.1);
    EXPECT_NEAR(value_at(*day, 3, 70, 20), value_at(*day, 3, 2, 20) - 180, 3);
    EXPECT_EQ(value_at(*day, 4, 50, 20), 1);
    for (int band = 1; band <= 4; ++band) {
        EXPECT_TRUE(std::isnan(value_at(*day, band, 60, 40))) << band;
        EXPECT_TRUE(std::isnan(day->GetRasterBand(band)->GetNoDataValue())) << band;
    }
}

TEST(SunHours, OfAYearAreOfItsDays) {
    const std::string dem = walled();
    ASSERT_EQ(relevo({"sun", "hours", dem, "--year", "2026", "-o", out("year.tif")}).status, 0);
    const Dataset year = opened(out("year.tif"));
    ASSERT_TRUE(year);
    // The zone is that of the place. Of half of all hours, and some for the air, the wall takes as
    // many as the sun needs to come over it.
    EXPECT_STREQ(year->GetMetadataItem("TIME_ZONE"), "Etc/GMT");
    EXPECT_NEAR(value_at(*year, 1, 118, 20), 4380 + 30 - 365 * degrees(std::atan(100 / 580.0)) / 15,
                45);
    EXPECT_LT(value_at(*year, 1, 59, 20), 3000);
}

TEST(SunHours, HaveTheEnergyOfClearDays) {
    const Result run = relevo({"sun", "hours", walled(), "--date", "2026-03-20", "--tz", "UTC",
                               "--bands", "global,beam,diffuse,reflected", "-o", out("e.tif")});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.out.find("Linke turbidity 3:"), std::string::npos) << run.out;
    const Dataset energy = opened(out("e.tif"));
    ASSERT_TRUE(energy);
    ASSERT_EQ(energy->GetRasterCount(), 4);
    EXPECT_STREQ(energy->GetRasterBand(1)->GetDescription(), "global irradiation");
    EXPECT_STREQ(energy->GetRasterBand(3)->GetUnitType(), "kWh/m2");
    const auto at = [&](int band, int column) { return value_at(*energy, band, column, 20); };
    EXPECT_NEAR(at(1, 2), at(2, 2) + at(3, 2) + at(4, 2), 1e-5);
    // The model by hand, with a sun that goes through the zenith, from 9.8 degrees on.
    EXPECT_NEAR(at(2, 2), 7.130, 0.01);
    // 100 m before the wall the first three hours are without sun, and a part of the sky is.
    EXPECT_NEAR(at(2, 50), 7.151 - 0.886, 0.02);
    EXPECT_LT(at(3, 50), at(3, 2) * 0.95);
    EXPECT_GT(at(4, 50), at(4, 2) + 0.05);
    for (int band = 1; band <= 4; ++band)
        EXPECT_TRUE(std::isnan(value_at(*energy, band, 60, 40))) << band;
}

TEST(SunHorizons, ABandForEachDirection) {
    const Result run =
        relevo({"sun", "horizons", walled(), "--directions", "4", "-o", out("horizons.tif")});
    ASSERT_EQ(run.status, 0) << run.err;
    const Dataset horizons = opened(out("horizons.tif"));
    ASSERT_TRUE(horizons);
    ASSERT_EQ(horizons->GetRasterCount(), 4);
    EXPECT_STREQ(horizons->GetRasterBand(2)->GetDescription(), "horizon towards azimuth 90");
    EXPECT_STREQ(horizons->GetRasterBand(2)->GetMetadataItem("AZIMUTH_DEG"), "90");
    EXPECT_NEAR(value_at(*horizons, 2, 50, 20), 45, 0.1);
    EXPECT_NEAR(value_at(*horizons, 4, 80, 20), degrees(std::atan(0.5)), 0.1);
    EXPECT_NEAR(value_at(*horizons, 4, 50, 20), 0, 0.1);
}

TEST(SunSkyView, IsAShareThatAWallTakesAway) {
    const std::string dem = walled();
    ASSERT_EQ(relevo({"sun", "sky-view", dem, "-o", out("sky.tif"), "--co", "COMPRESS=LZW"}).status,
              0);
    const Dataset sky = opened(out("sky.tif"));
    ASSERT_TRUE(sky);
    EXPECT_STREQ(sky->GetMetadataItem("COMPRESSION", "IMAGE_STRUCTURE"), "LZW");
    EXPECT_STREQ(sky->GetMetadataItem("DIRECTIONS"), "36");
    // Of a long wall 45 degrees high: (1 + cos 45 degrees) / 2 of the sky is left.
    EXPECT_NEAR(value_at(*sky, 1, 50, 20), 0.855, 0.03);
    EXPECT_NEAR(value_at(*sky, 1, 2, 20), 1, 0.02);
    ASSERT_EQ(relevo({"sun", "sky-view", dem, "--level", "-o", out("level.tif")}).status, 0);
    EXPECT_NEAR(value_at(*opened(out("level.tif")), 1, 50, 20), 0.855, 0.03);
}

/// All that a window of a file's bands holds, as bytes.
std::string bytes_in(GDALDataset& dataset, const std::array<int, 4>& window) {
    const auto [column, row, columns, rows] = window;
    std::string bytes(static_cast<std::size_t>(dataset.GetRasterCount()) *
                          static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows) *
                          sizeof(float),
                      0);
    EXPECT_EQ(dataset.RasterIO(GF_Read, column, row, columns, rows, bytes.data(), columns, rows,
                               GDT_Float32, dataset.GetRasterCount(), nullptr, 0, 0, 0, nullptr),
              CE_None);
    return bytes;
}
std::string all_bytes(GDALDataset& dataset) {
    return bytes_in(dataset, {0, 0, dataset.GetRasterXSize(), dataset.GetRasterYSize()});
}

/// Verbs under sun, and what they are asked.
const std::vector<std::vector<std::string>>& questions() {
    static const std::vector<std::vector<std::string>> all{
        {"shadow", "--sun", "135,5"},
        {"shadow", "--sun", "100,0.3", "--soft"},
        {"shadow", "--time", "2026-01-10T13:00Z", "--soft"},
        {"hours", "--date", "2026-12-21", "--tz", "UTC", "--step", "30", "--bands",
         "hours,first,last,spells"},
        {"hours", "--date", "2026-03-21", "--tz", "UTC", "--step", "60", "--bands",
         "beam,diffuse,reflected,global"},
        {"hours", "--from", "2026-12-21", "--to", "2026-12-26", "--tz", "UTC", "--bands",
         "hours,beam"},
        {"sky-view", "--directions", "12"},
        {"horizons", "--directions", "3"}};
    return all;
}

std::string said(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words)
        text += word + " ";
    return text;
}

/// Runs a question on a DEM. @return the file that it made
std::string answer(const std::vector<std::string>& question, const std::string& dem,
                   const std::string& name, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"sun"};
    arguments.insert(arguments.end(), question.begin(), question.end());
    arguments.insert(arguments.end(), {dem, "--overwrite", "-o", out(name)});
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Result run = relevo(arguments);
    EXPECT_EQ(run.status, 0) << said(arguments) << run.err;
    return out(name);
}

/// A part is the whole cut out, to the last bit.
void expect_parts_of_whole(const std::string& dem, const std::string& clip,
                           const std::array<int, 4>& window) {
    for (const std::vector<std::string>& question : questions()) {
        const Dataset whole = opened(answer(question, dem, "whole.tif"));
        const Dataset part = opened(answer(question, dem, "part.tif", {"--clip=" + clip}));
        ASSERT_TRUE(whole && part) << said(question);
        ASSERT_EQ(part->GetRasterXSize(), window[2]) << said(question);
        ASSERT_EQ(part->GetRasterYSize(), window[3]) << said(question);
        std::array<double, 6> a{}, b{};
        whole->GetGeoTransform(a.data());
        part->GetGeoTransform(b.data());
        EXPECT_NEAR(a[0] + window[0] * a[1] + window[1] * a[2], b[0], 1e-9 * std::abs(b[0]));
        EXPECT_NEAR(a[3] + window[0] * a[4] + window[1] * a[5], b[3], 1e-9 * std::abs(b[3]));
        EXPECT_TRUE(bytes_in(*whole, window) == all_bytes(*part)) << said(question);
    }
}

TEST(SunClip, APartIsTheWholeCutOut) {
    // A grid of degrees, 3 seconds apart; posts from 84.41333 W and 36.44583 N on.
    expect_parts_of_whole(bundled_dem(), "-84.3,36.2,-84.15,36.3", {136, 175, 181, 121});
    SKIP_WITHOUT_TEST_DATA(data);
    // One of metres, with long shadows from beyond the part.
    expect_parts_of_whole((data / "dem" / "srtm_bigtujunga30m_utm11.tif").string(),
                          "385000,3800000,391000,3803000", {290, 164, 200, 100});
}

/// Hills, more posts than 1 MiB has room for.
std::string hills(const std::string& name, const std::string& crs,
                  const std::array<double, 6>& geotransform) {
    Raster raster;
    raster.columns = 701;
    raster.rows = 401;
    raster.crs = crs;
    raster.geotransform = geotransform;
    raster.nodata = -9999;
    raster.value = [](int column, int row, int) {
        if (column % 97 == 5 && row % 89 == 7) return -9999.0;
        return 700 + 300 * std::sin(column / 23.0) * std::cos(row / 31.0) +
               150 * std::sin((column + 2 * row) / 11.0);
    };
    return write_raster(folder() / name, raster);
}

TEST(SunMemory, WhatABudgetIsMakesNoDifference) {
    const std::vector<std::string> dems{
        hills("metres.tif", "EPSG:32632", {{500000, 30, 0, 5300000, 0, -20}}),
        hills("turned.tif", "EPSG:32632", {{500000, 25, 9, 5300000, 8, -27}}),
        hills("degrees.tif", "EPSG:4326", {{11, 0.001, 0, 47.6, 0, -0.0007}})};
    // Of two parts of that budget, some 600 posts by 80, for the time that all would take.
    const std::vector<std::string> clips{"--clip=503000,5294000,521000,5295600",
                                         "--clip=503000,5297000,518500,5298000",
                                         "--clip=11.05,47.42,11.65,47.48"};
    for (std::size_t k = 0; k < dems.size(); ++k)
        for (const std::vector<std::string>& question : questions()) {
            if (k == 1 && question.front() == "hours") continue;  // sweeps as those of metres
            const std::string& dem = dems[k];
            const Dataset all = opened(answer(question, dem, "all.tif", {clips[k]}));
            const Dataset little =
                opened(answer(question, dem, "little.tif", {clips[k], "--memory", "1"}));
            ASSERT_TRUE(all && little) << said(question);
            EXPECT_TRUE(all_bytes(*all) == all_bytes(*little)) << dem << said(question);
            EXPECT_STREQ(all->GetMetadataItem("HOLES"), little->GetMetadataItem("HOLES"));
        }
    const Result dry = relevo(
        {"sun", "sky-view", dems.front(), "--dry-run", "--memory", "1", "-o", out("dry.tif")});
    EXPECT_TRUE(dry.out.starts_with(
        "posts               281101, in 2 parts\nmemory              some 132 MiB, 1 of "
        "them heights\n"))
        << dry.out;
}

TEST(SunClip, IsOfTheGridsCrsOrAnother) {
    const std::string dem = walled();  // 121 x 81 posts of 10 m from 500005 E, 395 N on
    const auto size = [&](const std::vector<std::string>& more) {
        const Dataset part =
            opened(answer({"shadow", "--sun", "grid:90,10"}, dem, "part.tif", more));
        return std::array{part->GetRasterXSize(), part->GetRasterYSize()};
    };
    // Posts on the sides are in it.
    EXPECT_EQ(size({"--clip", "500105,105,500195,195"}), (std::array{10, 10}));
    EXPECT_EQ(size({"--clip", "500106,106,500194,194"}), (std::array{8, 8}));
    EXPECT_EQ(size({"--clip", "0,0,1e6,1e6"}), (std::array{121, 40}));
    EXPECT_EQ(size({"--clip", "500105,105,500106,106"}), (std::array{1, 1}));
    // A degree at the equator is 110.6 km to the north and 111.3 to the east, 0.9996 of it in UTM.
    EXPECT_EQ(size({"--clip", "3.0,0.0,3.0045,0.001", "--clip-crs", "EPSG:4326"}),
              (std::array{50, 11}));
    const auto refused = [&](const std::vector<std::string>& more, int status,
                             const std::string& message) {
        std::vector<std::string> arguments{"sun", "sky-view", dem, "-o", out("x.tif")};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Result run = relevo(arguments);
        EXPECT_EQ(run.status, status);
        EXPECT_TRUE(run.err.find("error: " + message + "\n") != std::string::npos ||
                    run.err.find("error: " + message + "; see") != std::string::npos)
            << run.err;
        EXPECT_FALSE(std::filesystem::exists(out("x.tif")));
    };
    refused({"--clip", "3.0,0.0,3.0045,0.001"}, 3,
            "--clip: 3.0,0.0,3.0045,0.001: not one post of the DEM is in it; in WGS 84 / UTM zone "
            "31N they lie from 500005,-405 to 501205,395; for degrees pass --clip-crs EPSG:4326");
    refused({"--clip", "500106,106,500109,194"}, 3,
            "--clip: 500106,106,500109,194: not one post of the DEM is in it; in WGS 84 / UTM zone "
            "31N they lie from 500005,-405 to 501205,395; for degrees pass --clip-crs EPSG:4326");
    for (const std::string text : {"1,2,3", "1,2,x,4", "3,2,1,4", "1,4,3,2", "1,2,1,4"})
        refused({"--clip", text}, 2,
                fmt::format("--clip: {}: expected WEST,SOUTH,EAST,NORTH, numbers of the DEM's CRS "
                            "or of --clip-crs, west less than east and south less than north",
                            text));
    refused({"--clip-crs", "EPSG:4326"}, 2, "--clip-crs: needs --clip");
}

TEST(SunRasters, ADryRunSaysWhatARunTakesAndWritesNothing) {
    const std::string dem = bundled_dem();
    for (std::vector<std::string> arguments : questions()) {
        arguments.insert(arguments.begin(), "sun");
        arguments.insert(arguments.end(), {dem, "--dry-run", "-o", out("dry.tif")});
        const Result run = relevo(arguments);
        EXPECT_EQ(run.status, 0) << said(arguments) << run.err;
        EXPECT_TRUE(run.out.starts_with("posts               138632, in 1 part\nmemory  "))
            << run.out;
        EXPECT_NE(run.out.find("\ncomputing           some "), std::string::npos) << run.out;
        EXPECT_NE(run.out.find(" before compression"), std::string::npos) << run.out;
    }
    EXPECT_FALSE(std::filesystem::exists(out("dry.tif")));
    for (const auto& entry : std::filesystem::directory_iterator(folder()))
        EXPECT_FALSE(entry.path().filename().string().starts_with('.')) << entry.path();
}

TEST(SunRasters, TakeNoMoreMemoryThanADryRunTells) {
    // Results of many bands, which take most where they are written, and such of few.
    std::vector<std::string> many{"horizons", "--directions", "36"};
    for (std::vector<std::string> arguments :
         {questions()[0], questions()[3], questions()[4], many}) {
        arguments.insert(arguments.begin(), "sun");
        arguments.insert(arguments.end(), {bundled_dem(), "-o", out("memory.tif"), "--overwrite"});
        const Measured taken = measured(arguments);
        EXPECT_EQ(taken.run.status, 0) << taken.run.err;
        arguments.push_back("--dry-run");
        const Result dry = relevo(arguments);
        const std::size_t at = dry.out.find("\nmemory              some ");
        ASSERT_NE(at, std::string::npos) << dry.out;
        const int told_mib = std::atoi(dry.out.c_str() + at + 26);
        EXPECT_GE(told_mib, taken.peak_mib) << said(arguments);
        EXPECT_LE(told_mib, 3 * taken.peak_mib) << said(arguments);
    }
}

TEST(SunRasters, TellOfTerrainBeyondTheDemThatCouldMatter) {
    // The sun in the east, 10 degrees high: 100 m over the plain reach 567 m from the edge on.
    const std::string dem = walled();
    const std::string tells =
        "mountains outside the DEM could hide the sun at 46 % of the posts: those above 504 m, up "
        "to 1 km from the edge, if none is higher than 600 m (the DEM's highest post); at 54 %, up "
        "to 46 km, if none is higher than 8850 m (the Earth's)";
    const auto shadow = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"sun",        "shadow", dem,          "--sun",
                                           "grid:90,10", "-o",     out("b.tif"), "--overwrite"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Result run = relevo(arguments);
        EXPECT_EQ(run.status, 0) << run.err;
        return run.err;
    };
    EXPECT_NE(
        shadow({}).find("relevo: warning: mountains outside this DEM could change 46 % of the "
                        "values if as high as its highest post (600 m), 54 % of the values if 8850 "
                        "m; use a DEM 1 or 46 km larger on each side or --surroundings, or "
                        "set --highest\n"),
        std::string::npos);
    EXPECT_NE(shadow({"-v"}).find("relevo: " + tells + "\n"), std::string::npos);
    EXPECT_EQ(opened(out("b.tif"))->GetMetadataItem("BEYOND_DEM"), tells);
    EXPECT_EQ(shadow({"--highest", "500"}).find("outside"), std::string::npos);
    EXPECT_EQ(opened(out("b.tif"))->GetMetadataItem("BEYOND_DEM"), nullptr);
    EXPECT_NE(relevo({"sun", "sky-view", dem, "-o", out("v.tif")})
                  .err.find("mountains outside this DEM could change "),
              std::string::npos);
}

TEST(SunRasters, WhatMeansNothingIsRefused) {
    const std::string dem = walled();
    const auto hours = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"sun", "hours", dem, "-o", out("x.tif")};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    };
    expect_failure(hours({}), 2,
                   "--date: missing; pass --date 2026-06-21, --from and --to, or --year 2026");
    expect_failure(hours({"--from", "2026-03-20", "--to", "2026-03-10"}), 3,
                   "--from 2026-03-20 --to 2026-03-10: ends before it begins, expected the earlier "
                   "day first");
    expect_failure(hours({"--date", "2026-03-20", "--step", "0"}), 2,
                   "--step: expected 1s to 1h, such as 30s, 3min or minutes alone, but got 0");
    expect_failure(hours({"--date", "2026-03-20", "--bands", "first,first"}), 2,
                   "--bands: first is named twice");
    expect_failure(hours({"--year", "2026", "--bands", "first"}), 2,
                   "--bands: first, last and spells are available for at most 4 days");
    expect_failure(hours({"--year", "2026", "--linke", "4"}), 2,
                   "--linke: needs --bands global, beam, diffuse or reflected");
    expect_failure(hours({"--year", "2026", "--bands", "beam", "--albedo", "2"}), 2,
                   "--albedo: expected 0 to 1 but got 2; see relevo sun hours --help");
    expect_failure(hours({"--year", "2026", "--step", "1"}), 2,
                   "--step: for at most 4 days; longer periods use directions of the sun");
    expect_failure({"sun", "sky-view", dem, "-o", out("x.tif"), "--co", "ZSTD"}, 2,
                   "--co: ZSTD: expected NAME=VALUE, such as COMPRESS=ZSTD");
    const Result odd =
        relevo({"sun", "sky-view", dem, "-o", out("x.tif"), "--co", "COMPRESS=MAGIC"});
    EXPECT_EQ(odd.status, 2);
    EXPECT_EQ(odd.err.find("holes"), std::string::npos) << "said before any work: " << odd.err;
    EXPECT_NE(odd.err.find("--co: COMPRESS=MAGIC: would change the result's values"),
              std::string::npos)
        << odd.err;
    EXPECT_FALSE(std::filesystem::exists(out("x.tif")));
}

/// The verbs that write a raster, each with what it cannot do without.
const std::vector<std::vector<std::string>> kRasterVerbs{{"hours", "--date", "2026-03-20"},
                                                         {"shadow", "--sun", "135,20"},
                                                         {"sky-view"},
                                                         {"horizons", "--directions", "8"}};

std::vector<std::string> verb_to(const std::vector<std::string>& verb, const std::string& dem,
                                 const std::string& output) {
    std::vector<std::string> arguments{"-q", "sun", verb.front(), dem};
    arguments.insert(arguments.end(), verb.begin() + 1, verb.end());
    arguments.insert(arguments.end(), {"-o", output});
    return arguments;
}

std::vector<std::string> names_in(const std::filesystem::path& where) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(where))
        names.push_back(entry.path().filename().string());
    return names;
}

TEST(SunRasters, NeverReplaceTheirDem) {
    const std::string dem = walled(), before = bytes_of(dem);
    for (const std::vector<std::string>& verb : kRasterVerbs) {
        std::vector<std::string> arguments = verb_to(verb, dem, dem);
        arguments.emplace_back("--overwrite");
        expect_failure(
            arguments, 3,
            fmt::format(
                "-o: {0}: is the DEM {0}, which would be overwritten; give the result another name",
                dem));
    }
    EXPECT_EQ(bytes_of(dem), before);
}

TEST(SunRasters, NeedAFolderThatCanBeWritten) {
    const std::string dem = walled();
    const std::filesystem::path none = folder() / "none";
    for (const std::vector<std::string>& verb : kRasterVerbs)
        expect_failure(verb_to(verb, dem, (none / "a.tif").string()), 3,
                       fmt::format("-o: {}: the folder {} does not exist; create it first",
                                   (none / "a.tif").string(), none.string()));
    // A file system that takes no files, from root neither.
    for (const std::vector<std::string>& verb : kRasterVerbs)
        expect_failure(verb_to(verb, dem, "/proc/a.tif"), 1,
                       "-o: /proc/a.tif: cannot be written, No such file or directory");
}

TEST(SunRasters, OnAFullDiskAreErrorsThatLeaveNothing) {
    const std::filesystem::path where = scratch_dir("sun_rasters_full");
    const std::string output = (where / "a.tif").string(), dem = walled();
    for (const std::vector<std::string>& verb : kRasterVerbs) {
        std::vector<std::string> words{"-c", "ulimit -f 8; exec \"$0\" \"$@\"",
                                       (build_dir() / "bin/relevo").string()};
        const std::vector<std::string> arguments = verb_to(verb, dem, output);
        words.insert(words.end(), arguments.begin(), arguments.end());
        const Result result = run("/bin/sh", words);
        EXPECT_EQ(result.status, 1) << verb.front();
        EXPECT_TRUE(result.err.ends_with(
            fmt::format("relevo: error: -o: {}: cannot be written, File too large\n", output)))
            << result.err;
        EXPECT_TRUE(names_in(where).empty()) << verb.front();
    }
}

TEST(SunHours, OneThreadAndManyGiveTheSameBytes) {
    cpu_set_t all, one;
    ASSERT_EQ(sched_getaffinity(0, sizeof all, &all), 0);
    if (CPU_COUNT(&all) < 2) GTEST_SKIP() << "not run: needs two processors";
    const auto day = [&](const std::string& name) {
        const Result run =
            relevo({"-q", "sun", "hours", bundled_dem(), "--date", "2026-05-20", "--bands",
                    "hours,first,last,spells,beam", "-o", out(name), "--overwrite"});
        EXPECT_EQ(run.status, 0) << run.err;
        return bytes_of(out(name));
    };
    const std::string many = day("many.tif");
    CPU_ZERO(&one);
    for (int k = 0; k < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++k)
        if (CPU_ISSET(k, &all)) CPU_SET(k, &one);
    ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
    const std::string single = day("one.tif");
    ASSERT_EQ(sched_setaffinity(0, sizeof all, &all), 0);
    EXPECT_FALSE(many.empty());
    EXPECT_TRUE(many == single);
}

}  // namespace
}  // namespace relevo::test::test_sun_rasters
