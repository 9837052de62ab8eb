#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <utility>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "cli/program.h"
#include "support/support.h"

namespace relevo::test::test_sun_plane {
namespace {

using nlohmann::json;

std::string file(const std::string& name, const std::string& text) {
    const std::filesystem::path path = scratch_dir(name) / name;
    std::ofstream(path, std::ios::binary) << text;
    return path.string();
}

/// Three hours around noon, by UTC, at a place near Innsbruck.
std::string table() {
    return file("table.csv",
                "begin,end,ghi,dni,dhi\n"
                "2026-06-21T10:00Z,2026-06-21T11:00Z,800,700,150\n"
                "2026-06-21T11:00Z,2026-06-21T12:00Z,850,750,140\n"
                "2026-06-21T12:00Z,2026-06-21T13:00Z,820,720,145\n");
}

std::vector<std::string> plane(const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"sun", "plane", "--at", "47.27,11.4,574"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

/// Lines of a CSV but its remarks, each as fields.
std::vector<std::vector<std::string>> rows_of(const std::string& csv) {
    std::vector<std::vector<std::string>> rows;
    for (const std::string& line : split(csv, '\n'))
        if (!line.empty() && line[0] != '#') rows.push_back(split(line, ','));
    return rows;
}

TEST(SunPlane, HoursAndSumsHaveTheirColumns) {
    const Result hours = relevo(plane(
        {"--tilt", "30", "--azimuth", "180", "--irradiance", table(), "--csv", "--no-refraction"}));
    ASSERT_EQ(hours.status, 0) << hours.err;
    const auto rows = rows_of(hours.out);
    ASSERT_EQ(rows.size(), 4U);
    EXPECT_EQ(fmt::format("{}", fmt::join(rows[0], ",")),
              "time,up_s,lit_s,azimuth_deg,elevation_deg,ghi_w_m2,dni_w_m2,dhi_w_m2,beam_w_m2,"
              "diffuse_w_m2,reflected_w_m2,global_w_m2,open_global_w_m2");
    EXPECT_EQ(rows[1][0], "2026-06-21T10:00:00+00:00");
    EXPECT_EQ(rows[1][1], "3600");
    EXPECT_EQ(rows[1][9], "139.95191");   // 150 (1 + cos 30) / 2
    EXPECT_EQ(rows[1][10], "10.717968");  // 800 x 0.2 (1 - cos 30) / 2
    EXPECT_EQ(rows[1][11], rows[1][12]);
    EXPECT_NE(hours.out.find("# irradiance: "), std::string::npos);
    EXPECT_NE(hours.out.find("# solar constant: 1367 W/m2"), std::string::npos);
    double sum = 0;
    for (std::size_t i = 1; i < rows.size(); ++i)
        sum += *parse_number(rows[i][11]) / 1000;
    for (const auto& [by, names, label] :
         {std::tuple{"day", "date", "2026-06-21"}, std::tuple{"month", "month", "2026-06"},
          std::tuple{"year", "year", "2026"}}) {
        const auto sums = rows_of(relevo(plane({"--tilt", "30", "--azimuth", "180", "--irradiance",
                                                table(), "--by", by, "--csv", "--no-refraction"}))
                                      .out);
        ASSERT_EQ(sums.size(), 2U) << by;
        EXPECT_EQ(fmt::format("{}", fmt::join(sums[0], ",")),
                  std::string(names) +
                      ",lit_h,beam_kwh_m2,diffuse_kwh_m2,reflected_kwh_m2,global_kwh_m2,"
                      "open_global_kwh_m2");
        EXPECT_EQ(sums[1][0], label);
        EXPECT_NEAR(*parse_number(sums[1][5]), sum, 1e-6);
    }
    const auto hour_of_month =
        rows_of(relevo(plane({"--irradiance", table(), "--by", "hour-of-month", "--csv"})).out);
    ASSERT_EQ(hour_of_month.size(), 4U);
    EXPECT_EQ(hour_of_month[0][1], "hour");
    EXPECT_EQ(hour_of_month[2][0] + " " + hour_of_month[2][1], "6 11");
}

TEST(SunPlane, JsonSaysTheSameAsCsv) {
    const std::string out = (scratch_dir("out") / "plane.json").string();
    ASSERT_EQ(relevo(plane({"--irradiance", table(), "-o", out, "--sky", "perez"})).status, 0);
    const json all = json::parse(read_text(out, "test"));
    ASSERT_EQ(all["rows"].size(), 3U);
    EXPECT_EQ(all["rows"][2]["ghi_w_m2"], 820);
    EXPECT_EQ(all["tilt_deg"], 0);
    EXPECT_TRUE(all["sky_definition"].get<std::string>().starts_with("sky: Perez"));
}

TEST(SunPlane, AHorizonOfAFileHidesTheSun) {
    const std::string wall = file("wall.csv", "azimuth,elevation\n0,80\n180,80\n");
    const auto rows =
        rows_of(relevo(plane({"--irradiance", table(), "--horizon", wall, "--csv"})).out);
    ASSERT_EQ(rows.size(), 4U);
    EXPECT_EQ(rows[2][2], "0");
    EXPECT_EQ(rows[2][8], "0");
    EXPECT_NEAR(*parse_number(rows[2][9]), 140 * 0.0301537, 1e-4);  // cos2 80
    EXPECT_GT(*parse_number(rows[2][12]), 800);
}

TEST(SunPlane, PackedFilesAreRead) {
    const std::string path = table(), packed = path + ".gz";
    VSIFCloseL(VSIFOpenL(packed.c_str(), "wb"));
    VSILFILE* out = VSIFOpenL(("/vsigzip/" + packed).c_str(), "wb");
    ASSERT_NE(out, nullptr);
    const std::string text = read_text(path, "test");
    VSIFWriteL(text.data(), 1, text.size(), out);
    VSIFCloseL(out);
    const Result plain = relevo(plane({"--irradiance", path, "--by", "day", "--csv"})),
                 zipped = relevo(plane({"--irradiance", packed, "--by", "day", "--csv"}));
    EXPECT_EQ(zipped.status, 0) << zipped.err;
    EXPECT_EQ(rows_of(zipped.out), rows_of(plain.out));
    std::filesystem::resize_file(packed, std::filesystem::file_size(packed) - 12);
    const Result cut = relevo(plane({"--irradiance", packed, "--by", "day", "--csv"}));
    EXPECT_EQ(cut.status, 3);
    EXPECT_EQ(cut.err, "relevo: error: --irradiance: " + packed +
                           ": damaged, or several gzip files in one; unpack it\n");
}

TEST(SunPlane, LitHoursAreThoseOfSunDay) {
    for (const char* limb : {"center", "upper", "lower"}) {
        const std::vector<std::string> place{bundled_dem(), "--at",       "36.30,-84.24",
                                             "--date",      "2026-02-10", "--limb",
                                             limb,          "--json",     "-q"};
        std::vector<std::string> day{"sun", "day"}, plane{"sun", "plane", "--by", "day"};
        day.insert(day.end(), place.begin(), place.end());
        plane.insert(plane.end(), place.begin(), place.end());
        EXPECT_NEAR(json::parse(relevo(plane).out)["rows"][0]["lit_h"].get<double>(),
                    json::parse(relevo(day).out)["days"][0]["direct_sun_h"].get<double>(), 1e-3);
    }
}

TEST(SunPlane, TheGroundsOwnPlaneIsTheDems) {
    const Result run = relevo({"sun", "plane", bundled_dem(), "--at", "36.30,-84.24", "--tilt",
                               "ground", "--date", "2026-06-21", "--by", "day", "--json", "-q"});
    ASSERT_EQ(run.status, 0) << run.err;
    const json all = json::parse(run.out);
    EXPECT_GT(all["tilt_deg"], 0);
    EXPECT_LT(all["tilt_deg"], 60);
    EXPECT_GT(all["rows"][0]["open_global_kwh_m2"], all["rows"][0]["global_kwh_m2"]);
    // In coordinates of a CRS the place is the same.
    const Result by_crs =
        relevo({"sun", "plane", "--at", "677635,5237620", "--at-crs", "EPSG:25832", "--date",
                "2026-06-21", "--by", "day", "--json", "-q"});
    ASSERT_EQ(by_crs.status, 0) << by_crs.err;
    EXPECT_NEAR(json::parse(by_crs.out)["place"]["lat_deg"], 47.267, 0.01);
}

/// What a raster of `sun hours` has at a post, of each band.
std::vector<double> values_at(const std::string& path, int column, int row) {
    GDALAllRegister();
    GDALDataset* const raster = GDALDataset::Open(path.c_str());
    std::vector<double> values;
    for (int band = 1; band <= raster->GetRasterCount(); ++band) {
        double value = 0;
        EXPECT_EQ(raster->GetRasterBand(band)->RasterIO(GF_Read, column, row, 1, 1, &value, 1, 1,
                                                        GDT_Float64, 0, 0),
                  CE_None);
        values.push_back(value);
    }
    GDALClose(raster);
    return values;
}

TEST(SunPlane, RastersOfAPlaneAreThoseOfItsPoints) {
    const std::string out = (scratch_dir("planes") / "planes.tif").string();
    const int column = 100, row = 80;
    std::array<double, 6> to{};
    {
        GDALAllRegister();
        GDALDataset* const dem = GDALDataset::Open(bundled_dem().c_str());
        dem->GetGeoTransform(to.data());
        GDALClose(dem);
    }
    const std::string at =
        fmt::format("{:.8f},{:.8f}", to[3] + (row + 0.5) * to[5], to[0] + (column + 0.5) * to[1]);
    double worst = 0;
    for (const auto& [tilt, azimuth] :
         {std::pair{"0", "0"}, {"35", "150"}, {"60", "20"}, {"90", "180"}})
        for (const std::vector<std::string>& time :
             {std::vector<std::string>{"--date", "2026-03-20"}, {"--year", "2026"}}) {
            std::vector<std::string> raster{
                "sun", "hours", bundled_dem(), "--bands", "beam,diffuse,reflected",
                "-o",  out,     "--overwrite"};
            std::vector<std::string> point{
                "sun",    "plane",  bundled_dem(), "--at", at,
                "--limb", "center", "--json",      "--by", time[0] == "--year" ? "year" : "day"};
            for (std::vector<std::string>* arguments : {&raster, &point}) {
                arguments->insert(arguments->end(), time.begin(), time.end());
                arguments->insert(arguments->end(), {"--tilt", tilt, "--azimuth", azimuth, "-q"});
            }
            ASSERT_EQ(relevo(raster).status, 0);
            const std::vector<double> found = values_at(out, column, row);
            const json expected = json::parse(relevo(point).out)["rows"][0];
            const double global = expected["global_kwh_m2"];
            int band = 0;
            for (const char* key : {"beam_kwh_m2", "diffuse_kwh_m2", "reflected_kwh_m2"})
                worst = std::max(worst, std::abs(found[static_cast<std::size_t>(band++)] -
                                                 expected[key].get<double>()) /
                                            global);
        }
    fmt::print("[ accuracy ] planes of rasters and of points: worst {:.2f} % of global\n",
               100 * worst);
    EXPECT_LT(worst, 0.003);
}

TEST(SunPlane, RastersRefuseAPositionThatIsNone) {
    const auto fails = [](const std::vector<std::string>& more, const std::string& why) {
        std::vector<std::string> arguments{"sun",
                                           "hours",
                                           bundled_dem(),
                                           "--date",
                                           "2026-06-21",
                                           "-o",
                                           (scratch_dir("planes") / "none.tif").string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Result run = relevo(arguments);
        EXPECT_EQ(run.status, 2);
        EXPECT_NE(run.err.find(why), run.err.npos) << run.err;
    };
    fails({"--bands", "beam", "--tilt", "30"}, "--azimuth: missing");
    fails({"--bands", "beam", "--azimuth", "30"}, "a tilt of ground has the azimuth of the DEM");
    fails({"--bands", "beam", "--tilt", "91", "--azimuth", "0"}, "expected 0 to 90");
    fails({"--tilt", "30", "--azimuth", "0"}, "--tilt: needs --bands");
}

TEST(SunPlane, PointsHaveTheirOwnPlanes) {
    const std::string points = file(
        "points.csv", "name,lat,lon,tilt,azimuth\nRoof,47.27,11.4,30,90\nGarden,47.27,11.4,,\n");
    const Result run = relevo({"sun", "plane", "--points", points, "--irradiance", table(), "--by",
                               "day", "--tilt", "90", "--azimuth", "180"});
    ASSERT_EQ(run.status, 0) << run.err;
    const auto rows = rows_of(run.out);
    ASSERT_EQ(rows.size(), 3U);
    const auto alone = [&](const char* tilt, const char* azimuth) {
        return rows_of(relevo({"sun", "plane", "--at", "47.27,11.4", "--irradiance", table(),
                               "--by", "day", "--tilt", tilt, "--azimuth", azimuth, "--csv"})
                           .out)[1];
    };
    const auto roof = alone("30", "90"), garden = alone("90", "180");
    EXPECT_EQ(rows[1][5], roof[2]);  // the beam, after name, place, date and hours
    EXPECT_EQ(rows[2][5], garden[2]);
    EXPECT_NE(roof[2], garden[2]);
    const Result bad =
        relevo({"sun", "plane", "--irradiance", table(), "--points",
                file("bad.csv", "name,lat,lon,tilt,azimuth\nRoof,47.27,11.4,30,-90\n")});
    EXPECT_EQ(bad.status, 3);
    EXPECT_NE(bad.err.find("line 2: azimuth: expected 0 to 360"), std::string::npos) << bad.err;
}

TEST(SunPlane, WhatIsWrongIsSaidInOneLine) {
    const std::string out = (scratch_dir("out") / "never.csv").string();
    const auto fails = [&](const std::vector<std::string>& more, int status,
                           const std::string& message) {
        std::vector<std::string> arguments = plane(more);
        arguments.insert(arguments.end(), {"-o", out});
        const Result run = relevo(arguments);
        EXPECT_EQ(run.status, status) << run.err;
        EXPECT_NE(run.err.find(message), std::string::npos) << run.err;
        EXPECT_FALSE(std::filesystem::exists(out));
    };
    fails({"--date", "2026-06-21", "--azimuth", "-90"}, 2, "PVGIS counts from south: add 180");
    fails({"--date", "2026-06-21", "--tilt", "30"}, 2, "--azimuth: missing");
    fails({"--date", "2026-06-21", "--tilt", "95"}, 2, "expected 0 to 90 degrees, or ground");
    fails({"--date", "2026-06-21", "--tilt", "ground"}, 2, "--tilt: ground needs a DEM");
    fails({}, 2, "--date: missing");
    fails({"--date", "2026-06-21", "--interval", "end"}, 2, "--interval: needs --irradiance");
    fails({"--date", "2026-06-21", "--linke", "3,4"}, 2, "--linke: 2 values");
    fails({"--irradiance", table(), "--linke", "3"}, 2, "--linke: for a clear sky");
    fails({"--irradiance", table(), "--date", "2026-06-22"}, 3, "no rows from 2026-06-22");
    fails({"--irradiance", table() + ".none"}, 3, "cannot be read");
    fails({"--irradiance", table(), "--horizon", table()}, 3, "--horizon: ");
    fails({"--irradiance", file("far.csv",
                                "begin,end,ghi,dni,dhi\n2026-06-21T00:00Z,"
                                "2026-06-21T01:00Z,800,700,150\n")},
          3, "line 2: direct irradiance, but the sun is down; times do not fit 47.27000 N");
}

}  // namespace
}  // namespace relevo::test::test_sun_plane
