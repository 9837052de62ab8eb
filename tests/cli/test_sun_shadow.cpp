#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <sched.h>

#include "cli/program.h"
#include "cli/raster.h"
#include "dem/fixture.h"
#include "support/support.h"

/// `relevo sun shadow`, from file to file.
namespace relevo::test::test_sun_shadow {
namespace {

std::vector<float> values_of(GDALDataset& dataset, int band = 1) {
    const int columns = dataset.GetRasterXSize(), rows = dataset.GetRasterYSize();
    std::vector<float> values(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    EXPECT_EQ(dataset.GetRasterBand(band)->RasterIO(GF_Read, 0, 0, columns, rows, values.data(),
                                                    columns, rows, GDT_Float32, 0, 0),
              CE_None);
    return values;
}

std::string bytes_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::string out(const std::string& name) {
    return (folder() / name).string();
}

/// A plain with a wall of 100 m, which has a hole, along the column 60; posts 30 by 20 m apart.
std::string walled() {
    Raster raster;
    raster.columns = 121;
    raster.rows = 81;
    raster.geotransform = {{500000, 30, 0, 5200000, 0, -20}};
    raster.nodata = -9999;
    raster.value = [](int column, int row, int) {
        if (column == 60 && row == 40) return -9999.0;
        return column == 60 ? 600.0 : 500.0 + 0.001 * (column + row);
    };
    return write_raster(folder() / "walled.tif", raster);
}

TEST(SunShadow, WritesAMaskOnTheGridOfTheDem) {
    const std::string dem = walled();
    const Result run = relevo({"sun", "shadow", dem, "--sun", "grid:90,10", "-o", out("mask.tif")});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.err.find("the DEM has 1 voids: they get no value and cast no shadow"),
              std::string::npos)
        << run.err;
    const Dataset mask = opened(out("mask.tif")), ground = opened(dem);
    ASSERT_TRUE(mask);
    std::array<double, 6> a{}, b{};
    mask->GetGeoTransform(a.data());
    ground->GetGeoTransform(b.data());
    EXPECT_EQ(a, b);
    EXPECT_TRUE(mask->GetSpatialRef()->IsSame(ground->GetSpatialRef()));
    EXPECT_EQ(mask->GetRasterBand(1)->GetRasterDataType(), GDT_Byte);
    EXPECT_EQ(mask->GetRasterBand(1)->GetNoDataValue(), 255);
    EXPECT_STREQ(mask->GetMetadataItem("LAYOUT", "IMAGE_STRUCTURE"), "COG");
    EXPECT_STREQ(mask->GetMetadataItem("SUN_APPARENT_ELEVATION_DEG"), "10.00000");
    EXPECT_TRUE(std::string(mask->GetMetadataItem("DEFINITION"))
                    .starts_with("1 where the centre of the sun is above the terrain"));
    EXPECT_TRUE(std::string(mask->GetMetadataItem("TIFFTAG_SOFTWARE")).starts_with("Relevo "));
    const std::vector<float> values = values_of(*mask);
    const auto at = [&](int column, int row) {
        return values[static_cast<std::size_t>(row * 121 + column)];
    };
    // 100 m over tan 10 degrees: 567 m, 18.9 posts.
    EXPECT_EQ(at(60 - 18, 20), 0);
    EXPECT_EQ(at(60 - 20, 20), 1);
    EXPECT_EQ(at(60 - 5, 40), 1) << "through the hole";
    EXPECT_EQ(at(60, 40), 255);
    EXPECT_EQ(at(90, 20), 1);
    // Nothing else is left there.
    for (const auto& entry : std::filesystem::directory_iterator(folder()))
        EXPECT_TRUE(entry.path().filename() == "mask.tif" ||
                    entry.path().filename() == "walled.tif")
            << entry.path();
}

TEST(SunShadow, SoftIsAShareAndHolesAreNaN) {
    const std::string dem = walled();
    ASSERT_EQ(relevo({"sun", "shadow", dem, "--sun", "grid:90,10", "--soft", "-o", out("soft.tif")})
                  .status,
              0);
    const Dataset soft = opened(out("soft.tif"));
    ASSERT_TRUE(soft);
    EXPECT_EQ(soft->GetRasterBand(1)->GetRasterDataType(), GDT_Float32);
    EXPECT_TRUE(std::isnan(soft->GetRasterBand(1)->GetNoDataValue()));
    const std::vector<float> values = values_of(*soft);
    EXPECT_TRUE(std::isnan(values[40 * 121 + 60]));
    int between = 0;
    for (const float value : values)
        between += value > 0 && value < 1;
    EXPECT_GT(between, 0);
}

TEST(SunShadow, ATimeIsTheSunOfThatTime) {
    const std::string dem = bundled_dem();
    const Result run =
        relevo({"sun", "shadow", dem, "--time", "2026-01-10T22:00Z", "-o", out("t.tif")});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_TRUE(run.out.starts_with("time                2026-01-10T22:00:00+00:00")) << run.out;
    const Dataset raster = opened(out("t.tif"));
    ASSERT_TRUE(raster);
    EXPECT_STREQ(raster->GetMetadataItem("TIME_UTC"), "2026-01-10T22:00:00.000Z");
    // At least a tenth of the mountains is in the shade of a low sun, and not all.
    double lit = 0;
    const std::vector<float> values = values_of(*raster);
    for (const float value : values)
        lit += value == 1;
    EXPECT_GT(lit / static_cast<double>(values.size()), 0.2);
    EXPECT_LT(lit / static_cast<double>(values.size()), 0.95);
}

std::string table(const std::string& name, const std::string& text) {
    std::ofstream(out(name)) << text;
    return out(name);
}

TEST(SunShadow, ATableOfTimesHasABandForEach) {
    const std::string dem = bundled_dem();
    const std::string times = table("times.csv",
                                    "name;time\n# two mornings and an event\n"
                                    "first;2026-01-10T13:30Z\n;2026-01-10T09:00\n"
                                    "\"last; of all\";2026-01-10 sunset-45min\n");
    for (const bool soft : {false, true}) {
        const auto run_with = [&](std::vector<std::string> more, const std::string& name) {
            std::vector<std::string> arguments{"sun",         "shadow", dem,
                                               "--overwrite", "-o",     out(name)};
            if (soft) arguments.push_back("--soft");
            arguments.insert(arguments.end(), more.begin(), more.end());
            const Result run = relevo(arguments);
            EXPECT_EQ(run.status, 0) << run.err;
            return run;
        };
        const Result run = run_with({"--times", times}, "many.tif");
        EXPECT_NE(run.out.find("\n   2  2026-01-10T09:00:00-05:00"), std::string::npos) << run.out;
        EXPECT_NE(run.err.find("America/New_York"), std::string::npos) << run.err;
        EXPECT_EQ(run.err.find("America/New_York"), run.err.rfind("America/New_York"))
            << "said once: " << run.err;
        const Dataset many = opened(out("many.tif"));
        ASSERT_TRUE(many);
        ASSERT_EQ(many->GetRasterCount(), 3);
        EXPECT_STREQ(many->GetRasterBand(1)->GetDescription(), "2026-01-10T13:30:00+00:00 first");
        EXPECT_STREQ(many->GetRasterBand(2)->GetDescription(), "2026-01-10T09:00:00-05:00");
        EXPECT_STREQ(many->GetRasterBand(2)->GetMetadataItem("TIME_UTC"),
                     "2026-01-10T14:00:00.000Z");
        EXPECT_EQ(many->GetMetadataItem("TIME_UTC"), nullptr);
        EXPECT_EQ(many->GetRasterBand(3)->GetRasterDataType(), soft ? GDT_Float32 : GDT_Byte);
        const std::array<std::string, 3> alone{"2026-01-10T13:30Z", "2026-01-10T09:00",
                                               "2026-01-10 sunset-45min"};
        for (int band = 1; band <= 3; ++band) {
            run_with({"--time", alone[static_cast<std::size_t>(band) - 1]}, "single.tif");
            EXPECT_EQ(values_of(*many, band), values_of(*opened(out("single.tif")))) << band;
        }
        EXPECT_NE(values_of(*many, 1), values_of(*many, 2));
    }
}

TEST(SunShadow, TablesThatAreNoneAreRefused) {
    const std::string dem = bundled_dem();
    const auto expect_refused = [&](const std::string& times, const std::string& message) {
        const Result run = relevo({"sun", "shadow", dem, "--times", times, "-o", out("x.tif")});
        EXPECT_EQ(run.status, 3) << run.err;
        EXPECT_NE(run.err.find(message), std::string::npos) << run.err;
        EXPECT_FALSE(std::filesystem::exists(out("x.tif")));
    };
    expect_refused(table("none.csv", "lat,lon\n1,2\n"),
                   "none.csv: no column time, expected a first line that names it");
    expect_refused(table("empty.csv", "time\n"),
                   "empty.csv: no times, expected a first line \"time\" and a line for each below "
                   "it");
    expect_refused(table("gap.csv", "time,name\n2026-01-10T13:30Z,a\n,b\n"),
                   "gap.csv: line 3: no time in it");
    expect_refused(table("odd.csv", "time\n2026-01-10T13:30Z\nnoonish\n"), "odd.csv: line 3: ");
    expect_refused(out("nowhere.csv"), "nowhere.csv: cannot be read");
    std::string text = "time\n";
    for (int k = 0; k <= 10'000; ++k)
        text += "2026-01-10T13:30Z\n";
    expect_refused(table("long.csv", text), "long.csv: more than 10000 times; split the file");
    const std::string times = table("one.csv", "time\n2026-01-10T13:30Z\n");
    expect_failure({"sun", "shadow", dem, "--times", times, "--sun", "90,10", "-o", out("x.tif")},
                   2, "--times and --sun exclude each other; use one");
    expect_failure(
        {"sun", "shadow", dem, "--times", times, "--time", "2026-01-10T13:30Z", "-o", out("x.tif")},
        2, "--times: excludes --time and --date; remove them");
    expect_failure({"sun", "shadow", dem, "--times", times, "--overwrite", "-o", times}, 2,
                   fmt::format("-o: {}: no format that this command writes, expected a name that "
                               "ends in tif, tiff",
                               times));
}

TEST(SunShadow, OneThreadAndManyGiveTheSameBytes) {
    cpu_set_t all, one;
    ASSERT_EQ(sched_getaffinity(0, sizeof all, &all), 0);
    if (CPU_COUNT(&all) < 2) GTEST_SKIP() << "not run: needs two processors";
    const std::vector<std::string> verb{
        "sun", "shadow", bundled_dem(), "--time", "2026-01-10T22:00Z", "--soft", "-o"};
    const auto run_to = [&](const std::string& name) {
        std::vector<std::string> arguments = verb;
        arguments.push_back(out(name));
        EXPECT_EQ(relevo(arguments).status, 0);
        return bytes_of(out(name));
    };
    const std::string many = run_to("many.tif");
    CPU_ZERO(&one);
    for (int k = 0; k < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++k)
        if (CPU_ISSET(k, &all)) CPU_SET(k, &one);
    ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
    const std::string single = run_to("one.tif");
    ASSERT_EQ(sched_setaffinity(0, sizeof all, &all), 0);
    EXPECT_FALSE(many.empty());
    EXPECT_EQ(many, single);
}

TEST(SunShadow, NorthIsNorthAfterAnyNumberOfTurns) {
    std::vector<std::string> results;
    for (const std::string sun : {"0,5", "360,5", "-720,5"}) {
        const std::string path = out(fmt::format("north{}.tif", results.size()));
        ASSERT_EQ(relevo({"sun", "shadow", bundled_dem(), "--sun=" + sun, "-o", path}).status, 0);
        results.push_back(bytes_of(path));
    }
    EXPECT_EQ(results[0], results[1]);
    EXPECT_EQ(results[0], results[2]);
}

TEST(SunShadow, WhatMeansNothingIsRefused) {
    const std::string dem = walled();
    const std::vector<std::string> verb{"sun", "shadow", dem, "-o", out("x.tif")};
    const auto with = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments = verb;
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    };
    expect_failure(with({}), 2,
                   "--time: missing; pass --time 2026-06-21T18:30+02:00, or --sun AZ,EL");
    expect_failure(with({"--sun", "90,10", "--time", "2026-01-10T22:00Z"}), 2,
                   "--time and --sun exclude each other; use one");
    expect_failure(with({"--sun", "90,10", "--no-refraction"}), 2,
                   "--refraction: needs --time; --sun is an apparent direction");
    for (const std::string sun : {"90", "90,100", "north,10", "90,10,5", "map:90,10"})
        expect_failure(
            with({"--sun", sun}), 2,
            fmt::format("--sun: {}: expected AZ,EL in degrees, clockwise from true north "
                        "and -90 to 90 above the horizon, or grid:AZ,EL from the north of "
                        "the DEM's map",
                        sun));
    expect_failure(
        {"sun", "shadow", dem, "--sun", "90,10", "-o", dem}, 3,
        fmt::format(
            "-o: {}: is the DEM {}, which would be overwritten; give the result another name", dem,
            dem));
    expect_failure(
        {"sun", "shadow", dem, "--sun", "90,10", "-o", out("x.png")}, 2,
        fmt::format("-o: {}: no format that this command writes, expected a name that ends "
                    "in tif, tiff",
                    out("x.png")));
    EXPECT_FALSE(std::filesystem::exists(out("x.tif")));
}

}  // namespace
}  // namespace relevo::test::test_sun_shadow
