// Cloud cover of forecasts: which bands, at which time, and what is wrong with a file.
#include <cstring>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/text.h"
#include "dem/fixture.h"
#include "session/classic_netcdf.h"
#include "session/cover_forecast.h"
#include "support/support.h"

namespace relevo::session::test_cover_forecast {
namespace {

using test::error_of;
using test::folder;
using testing::HasSubstr;
using testing::StartsWith;
using weather::CloudLevel;

constexpr std::int64_t kNoon_s = 1780315200;  // 2026-06-01 12:00 UTC
constexpr std::int64_t kHour_s = 3600;

/// A DEM in the middle of the forecasts below.
dem::Grid dem_grid() {
    return {41, 31, {500015, 30, 0, 5199985, 0, -30}, geo::Crs::parse("EPSG:32632", "test")};
}

/// A band of a GRIB2 file: cloud cover of the same value everywhere.
struct GribBand {
    int number;  ///< of category 6: 1 total, 3 low, 4 middle, 5 high
    int hour;    ///< after midnight
    double value;
};

/// A forecast of 1 June 2026 in cells of half a degree around the DEM.
std::string write_grib(const std::string& name, const std::vector<GribBand>& bands) {
    std::vector<std::string> options;
    for (std::size_t i = 0; i < bands.size(); ++i) {
        const auto add = [&](const std::string& option) {
            options.push_back(fmt::format("BAND_{}_{}", i + 1, option));
        };
        const int level = bands[i].number == 1 ? 10 : 204 + 10 * (bands[i].number - 2);
        add("DISCIPLINE=0");
        add("IDS=CENTER=7 SUBCENTER=0 MASTER_TABLE=2 LOCAL_TABLE=0 SIGNF_REF_TIME=1 "
            "REF_TIME=2026-06-01T00:00:00Z PROD_STATUS=0 TYPE=1");
        add("PDS_PDTN=0");
        add(fmt::format("PDS_TEMPLATE_ASSEMBLED_VALUES=6 {} 2 0 96 0 0 1 {} {} 0 0 255 0 0",
                        bands[i].number, bands[i].hour, level));
    }
    return test::write_raster(folder() / name,
                              {.driver = "GRIB",
                               .columns = 12,
                               .rows = 10,
                               .bands = static_cast<int>(bands.size()),
                               .geotransform = {{6, 0.5, 0, 49.5, 0, -0.5}},
                               .crs = "EPSG:4326",
                               .options = options,
                               .value = [&](int, int, int band) {
                                   return bands[static_cast<std::size_t>(band) - 1].value;
                               }});
}

double mean(const WeatherFields& fields, const std::string& name) {
    return fields.contains(name) ? double{fields.at(name)->mean} : -1;
}

TEST(CoverForecast, OfGribHasItsLevelsBetweenItsTimes) {
    const std::string file = write_grib(
        "levels.grib2", {{3, 12, 20}, {5, 12, 80}, {3, 15, 50}, {5, 15, 80}, {1, 12, 90}});
    CoverForecast forecast(file, dem_grid());
    EXPECT_EQ(forecast.levels(), (std::vector{CloudLevel::Low, CloudLevel::High}));
    const WeatherFields at_noon = forecast.at(kNoon_s);
    EXPECT_NEAR(mean(at_noon, "deck_1_cover"), 0.2, 1e-3);
    EXPECT_NEAR(mean(at_noon, "deck_2_cover"), 0.8, 1e-3);
    EXPECT_FALSE(at_noon.contains("deck_3_cover"));
    EXPECT_EQ(forecast.summary(),
              "levels.grib2: low and high cloud cover, 20 and 80 % over the DEM, of 2026-06-01 "
              "12:00 UTC");
    EXPECT_NEAR(mean(forecast.at(kNoon_s + kHour_s), "deck_1_cover"), 0.3, 1e-3);
    EXPECT_EQ(forecast.summary(),
              "levels.grib2: low and high cloud cover, 30 and 80 % over the DEM, between "
              "2026-06-01 12:00 and 15:00 UTC");
    // Half a step farther, the last time holds.
    EXPECT_NEAR(mean(forecast.at(kNoon_s + 4 * kHour_s), "deck_1_cover"), 0.5, 1e-3);
}

TEST(CoverForecast, OfTotalCoverAloneIsOneDeck) {
    CoverForecast forecast(write_grib("total.grib2", {{1, 12, 40}}), dem_grid());
    EXPECT_EQ(forecast.levels(), std::vector{CloudLevel::Total});
    EXPECT_NEAR(mean(forecast.at(kNoon_s + kHour_s), "deck_1_cover"), 0.4, 1e-3);
}

TEST(CoverForecast, OfNetcdfIsTheSameInVariablesAndShares) {
    const std::string file = (folder() / "era.nc").string();
    test::write_netcdf(file, "hours since 1900-01-01 00:00:00.0", {1108140, 1108143},
                       {{"lcc", "(0 - 1)", {0.2, 0.5}}, {"mcc", "(0 - 1)", {1, 1}}});
    CoverForecast forecast(file, dem_grid());
    EXPECT_EQ(forecast.levels(), (std::vector{CloudLevel::Low, CloudLevel::Middle}));
    EXPECT_NEAR(mean(forecast.at(kNoon_s + kHour_s), "deck_1_cover"), 0.3, 1e-6);
    const std::string single = (folder() / "clt.nc").string();
    test::write_netcdf(single, "days since 1970-01-01", {20605.5}, {{"clt", "%", {60}}});
    CoverForecast of_one(single, dem_grid());
    EXPECT_NEAR(mean(of_one.at(kNoon_s), "deck_1_cover"), 0.6, 1e-6);
}

TEST(CoverForecast, PlacesWithoutAValueHaveNone) {
    const std::string file = (folder() / "void.nc").string();
    test::write_netcdf(file, "days since 1970-01-01", {20605.5},
                       {{"clt", "1", {0.5}, [](double lon_deg) { return lon_deg < 8.5; }}});
    CoverForecast forecast(file, dem_grid());
    const auto field = forecast.at(kNoon_s).at("deck_1_cover");
    EXPECT_TRUE(std::isnan(field->around.at({-100'000, 0})));
    EXPECT_FLOAT_EQ(field->around.at({0, 0}), 0.5F);
    EXPECT_EQ(field->part_of_dem, 1);
}

TEST(CoverForecast, OverAPartOfTheDemIsSaid) {
    const std::string file = (folder() / "part.nc").string();
    test::write_netcdf(file, "days since 1970-01-01", {20605.5},
                       {{"clt", "1", {0.5}, [](double lon_deg) { return lon_deg < 9; }}});
    const dem::Grid wide(41, 31, {400000, 5000, 0, 5270000, 0, -5000},
                         geo::Crs::parse("EPSG:32632", "test"));
    CoverForecast forecast(file, wide);
    const float part = forecast.at(kNoon_s).at("deck_1_cover")->part_of_dem;
    EXPECT_NEAR(part, 0.5, 0.1);
    EXPECT_EQ(
        forecast.summary(),
        fmt::format("part.nc: total cloud cover, 50 % over {:.0f} % of the DEM, of 2026-06-01 "
                    "12:00 UTC",
                    100 * part));
}

TEST(CoverForecast, ATimeThatItDoesNotHaveIsAnError) {
    const std::string file = write_grib("times.grib2", {{1, 12, 40}, {1, 15, 40}});
    CoverForecast forecast(file, dem_grid());
    EXPECT_EQ(
        error_of([&] { forecast.at(kNoon_s - 2 * kHour_s); }),
        fmt::format(
            "exit 3: weather: {}: its times are 2026-06-01 12:00 UTC to 2026-06-01 15:00 UTC, "
            "the picture's is 2026-06-01 10:00 UTC; --time sets another",
            file));
    CoverForecast single(write_grib("single.grib2", {{1, 12, 40}}), dem_grid());
    EXPECT_THAT(error_of([&] { single.at(kNoon_s + 2 * kHour_s); }),
                HasSubstr("its times are 2026-06-01 12:00 UTC, the picture's"));
}

/// A GeoTIFF as gdal_translate makes of a GRIB, without some of its metadata.
std::string write_band(const std::string& name, double value,
                       std::vector<std::pair<std::string, std::string>> about,
                       double west_deg = 6) {
    return test::write_raster(folder() / name, {.columns = 12,
                                                .rows = 10,
                                                .geotransform = {{west_deg, 0.5, 0, 49.5, 0, -0.5}},
                                                .crs = "EPSG:4326",
                                                .about = std::move(about),
                                                .value = [=](int, int, int) { return value; }});
}

TEST(CoverForecast, WhatIsMissingIsSaid) {
    const std::string timeless =
        write_band("timeless.tif", 40, {{"GRIB_ELEMENT", "TCDC"}, {"GRIB_UNIT", "[%]"}});
    EXPECT_THAT(
        error_of([&] { CoverForecast(timeless, dem_grid()); }),
        StartsWith(fmt::format("exit 3: weather: {}: its cloud cover has no time", timeless)));
    const std::string plain = write_band("plain.tif", 40, {});
    EXPECT_THAT(
        error_of([&] { CoverForecast(plain, dem_grid()); }),
        StartsWith(fmt::format("exit 3: weather: {}: no band says that it is cloud cover", plain)));
    EXPECT_THAT(error_of([&] { CoverForecast("nowhere.grib2", dem_grid()); }),
                StartsWith("exit 3: weather: nowhere.grib2: "));
}

TEST(CoverForecast, ValuesThatAreNoCoverAreAnError) {
    const std::vector<std::pair<std::string, std::string>> about = {
        {"GRIB_ELEMENT", "LCDC"},
        {"GRIB_UNIT", "[%]"},
        {"GRIB_VALID_TIME", fmt::format("{}", kNoon_s)}};
    const std::string file = write_band("wild.tif", 400, about);
    CoverForecast forecast(file, dem_grid());
    EXPECT_EQ(
        error_of([&] { forecast.at(kNoon_s); }),
        fmt::format("exit 3: weather: {}: low cloud cover of 400 %, expected 0 to 100 %", file));
    const std::string negative = write_band("negative.tif", -3, about);
    CoverForecast below(negative, dem_grid());
    EXPECT_THAT(error_of([&] { below.at(kNoon_s); }), HasSubstr("low cloud cover of -3 %"));
    // Rounding of packed values is none of that.
    CoverForecast packed(write_band("packed.tif", 100.2, about), dem_grid());
    EXPECT_FLOAT_EQ(packed.at(kNoon_s).at("deck_1_cover")->mean, 1);
}

TEST(CoverForecast, ElsewhereIsAnError) {
    const std::string file = write_band("far.tif", 40,
                                        {{"GRIB_ELEMENT", "TCDC"},
                                         {"GRIB_UNIT", "[%]"},
                                         {"GRIB_VALID_TIME", fmt::format("{}", kNoon_s)}},
                                        40);
    CoverForecast forecast(file, dem_grid());
    EXPECT_THAT(error_of([&] { forecast.at(kNoon_s); }),
                StartsWith(fmt::format("exit 3: weather: {}: the raster does not cover", file)));
}

TEST(CoverForecast, ATemplateThatGdalCannotReadIsNamedInItsWords) {
    const std::string file = write_grib("template.grib2", {{1, 12, 40}});
    // Section 5, data representation: its template, after length, number and count of values.
    std::string bytes = read_text(file, "test");
    std::size_t at = 16;
    while (bytes[at + 4] != 5)
        at += static_cast<unsigned char>(bytes[at + 2]) * 256U +
              static_cast<unsigned char>(bytes[at + 3]);
    bytes[at + 9] = static_cast<char>(0xFD);
    std::ofstream(file, std::ios::binary) << bytes;
    const std::string error = error_of([&] {
        CoverForecast forecast(file, dem_grid());
        forecast.at(kNoon_s);
    });
    EXPECT_THAT(error, StartsWith(fmt::format("exit 3: weather: {}: ", file)));
    EXPECT_THAT(error, HasSubstr("emplate"));
}

}  // namespace
}  // namespace relevo::session::test_cover_forecast
