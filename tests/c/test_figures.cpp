// Figures of the library are the program's.
#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "c/library.h"
#include "cli/program.h"
#include "support/support.h"

namespace relevo::test {
namespace {

/// The bands of a raster as the program writes it, one after the other; holes are NaN.
std::vector<float> written(std::vector<std::string> arguments) {
    const std::string path = (scratch_dir() / "program.tif").string();
    arguments.insert(arguments.end(), {bundled_dem(), "-o", path, "--overwrite", "-q"});
    const Result made = relevo(arguments);
    EXPECT_EQ(made.status, 0) << made.err;
    GDALAllRegister();
    const std::unique_ptr<GDALDataset> file(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER));
    const auto posts = static_cast<std::size_t>(file->GetRasterXSize()) *
                       static_cast<std::size_t>(file->GetRasterYSize());
    std::vector<float> values(posts * static_cast<std::size_t>(file->GetRasterCount()));
    EXPECT_EQ(file->RasterIO(GF_Read, 0, 0, file->GetRasterXSize(), file->GetRasterYSize(),
                             values.data(), file->GetRasterXSize(), file->GetRasterYSize(),
                             GDT_Float32, file->GetRasterCount(), nullptr, 0, 0, 0, nullptr),
              CE_None);
    return values;
}

/// Whether all values are those of the other, to the bit; NaN equals NaN.
bool equal(const std::vector<float>& a, const std::vector<float>& b) {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (!(a[i] == b[i] || (std::isnan(a[i]) && std::isnan(b[i])))) return false;
    return true;
}

class Figures : public testing::Test {
  protected:
    DemHandle dem_ = open_bundled();
    std::vector<float> values_ = std::vector<float>(posts_of(dem_.get()));
};

TEST_F(Figures, ShadowsAreThoseOfTheProgram) {
    expect_ok(relevo_shadow(dem_.get(), R"({"time": "2026-12-21T14:00Z"})", values_.data(),
                            values_.size(), nullptr, nullptr));
    EXPECT_TRUE(equal(values_, written({"sun", "shadow", "--time", "2026-12-21T14:00Z"})));
    expect_ok(relevo_shadow(dem_.get(),
                            R"({"time": "2026-12-21T14:00Z", "soft": true, "refraction": "none",
                                "terrestrial_refraction": 0.2})",
                            values_.data(), values_.size(), nullptr, nullptr));
    EXPECT_TRUE(equal(values_, written({"sun", "shadow", "--time", "2026-12-21T14:00Z", "--soft",
                                        "--no-refraction", "-k", "0.2"})));
}

TEST_F(Figures, HoursAndIrradiationAreThoseOfTheProgram) {
    values_.resize(3 * values_.size());
    const char* about = nullptr;
    expect_ok(relevo_sun_hours(dem_.get(),
                               R"({"from": "2026-12-20", "to": "2026-12-21", "zone": "-05:00",
                                   "bands": ["hours", "first", "global"], "linke": 2, "step": 120})",
                               values_.data(), values_.size(), nullptr, &about));
    EXPECT_TRUE(equal(values_, written({"sun", "hours", "--from", "2026-12-20", "--to",
                                        "2026-12-21", "--tz", "-05:00", "--bands",
                                        "hours,first,global", "--linke", "2", "--step", "2min"})));
    const auto json = nlohmann::json::parse(about);
    EXPECT_EQ(json["holes"], 0);
    EXPECT_TRUE(std::string(json["definition"]).find("irradiation") != std::string::npos);
    EXPECT_TRUE(json.contains("beyond"));
    expect_ok(relevo_shadow(dem_.get(), R"({"time": "2026-06-21T17:00Z", "highest": 300})",
                            values_.data(), values_.size() / 3, nullptr, &about));
    EXPECT_FALSE(nlohmann::json::parse(about).contains("beyond"));
    EXPECT_EQ(relevo_sky_view(dem_.get(), R"({"highest": 9000})", values_.data(),
                              values_.size() / 3, nullptr, nullptr),
              RELEVO_RESULT_BAD_INPUT);
    ASSERT_EQ(json["bands"].size(), 3U);
    EXPECT_EQ(json["bands"][2]["name"], "global irradiation");
    EXPECT_EQ(json["bands"][2]["unit"], "kWh/m2");
}

TEST_F(Figures, AYearTakesDirectionsAsInTheProgram) {
    expect_ok(relevo_sun_hours(dem_.get(), R"({"year": 2026})", values_.data(), values_.size(),
                               nullptr, nullptr));
    EXPECT_TRUE(equal(values_, written({"sun", "hours", "--year", "2026"})));
}

TEST_F(Figures, SkyViewsAreThoseOfTheProgram) {
    expect_ok(relevo_sky_view(dem_.get(), R"({"directions": 16, "level": true})", values_.data(),
                              values_.size(), nullptr, nullptr));
    EXPECT_TRUE(equal(values_, written({"sun", "sky-view", "--directions", "16", "--level"})));
}

TEST_F(Figures, ADemFromMemoryGivesTheSame) {
    std::vector<float> heights(values_.size());
    expect_ok(relevo_dem_read(dem_.get(), heights.data(), heights.size()));
    const relevo_grid grid = grid_of(dem_.get());
    const char* crs = nullptr;
    expect_ok(relevo_dem_crs(dem_.get(), &crs));
    auto raster = sized<relevo_raster>();
    raster.heights_m = heights.data();
    raster.count = heights.size();
    raster.columns = grid.columns;
    raster.rows = grid.rows;
    std::memcpy(raster.transform, grid.transform, sizeof grid.transform);
    raster.crs = crs;
    relevo_dem* made = nullptr;
    expect_ok(relevo_dem_from_heights(&raster, &made));
    const DemHandle copy(made);

    const char* const options = R"({"date": "2026-06-21"})";
    std::vector<float> of_copy(values_.size());
    expect_ok(
        relevo_sun_hours(dem_.get(), options, values_.data(), values_.size(), nullptr, nullptr));
    expect_ok(
        relevo_sun_hours(copy.get(), options, of_copy.data(), of_copy.size(), nullptr, nullptr));
    EXPECT_TRUE(equal(values_, of_copy));
    const std::string scene =
        R"({"time": {"at": "2026-06-21T14:00Z"}, "picture": {"size": [96, 64]}})";
    EXPECT_EQ(draw(open_session(dem_.get(), scene).get()).rgba,
              draw(open_session(copy.get(), scene).get()).rgba);
}

TEST(Heights, AreReadAsTheOptionsSay) {
    std::vector<float> heights(12, 1000.0F);
    heights[5] = -5;
    auto raster = sized<relevo_raster>();
    raster.heights_m = heights.data();
    raster.count = 12;
    raster.columns = 4;
    raster.rows = 3;
    raster.crs = "EPSG:32632";
    const double transform[6] = {600000, 30, 0, 5200000, 0, -30};
    std::copy_n(transform, 6, raster.transform);
    raster.options = R"({"unit": "ft", "nodata": -5})";
    relevo_dem* made = nullptr;
    expect_ok(relevo_dem_from_heights(&raster, &made));
    const DemHandle dem(made);
    std::vector<float> read(12);
    expect_ok(relevo_dem_read(dem.get(), read.data(), 12));
    EXPECT_FLOAT_EQ(read[0], 304.8F);
    EXPECT_TRUE(std::isnan(read[5]));
    const char* wkt = nullptr;
    expect_ok(relevo_dem_wkt(dem.get(), &wkt));
    EXPECT_EQ(std::string(wkt).rfind("PROJCRS[\"WGS 84 / UTM zone 32N\"", 0), 0U) << wkt;
    raster.options = R"({"crs": "EPSG:4326"})";
    expect_error(relevo_dem_from_heights(&raster, &made), RELEVO_RESULT_BAD_CALL,
                 "relevo_dem_from_heights: heights.options: crs: expected none");
    raster.size = offsetof(relevo_raster, options);  // of an earlier version
    expect_ok(relevo_dem_from_heights(&raster, &made));
    relevo_dem_close(made);
}

TEST(Heights, ObeyTheRulesOfFiles) {
    std::vector<float> heights(100, 1000.0F);
    heights[5] = -9999;
    auto raster = sized<relevo_raster>();
    raster.heights_m = heights.data();
    raster.count = 100;
    raster.columns = raster.rows = 10;
    const double transform[6] = {600000, 30, 0, 5200000, 0, -30};
    std::copy_n(transform, 6, raster.transform);
    const auto read = [&](const char* crs, const char* options) {
        raster.crs = crs;
        raster.options = options;
        relevo_dem* made = nullptr;
        expect_ok(relevo_dem_from_heights(&raster, &made));
        const DemHandle dem(made);
        std::vector<float> result(100);
        expect_ok(relevo_dem_read(dem.get(), result.data(), result.size()));
        return result;
    };
    EXPECT_TRUE(std::isnan(read("EPSG:32632", nullptr)[5]));
    EXPECT_EQ(read("EPSG:32632", R"({"nodata": "none"})")[5], -9999);
    EXPECT_EQ(read("EPSG:32632", R"({"voids_known": true})")[5], -9999);
    EXPECT_FLOAT_EQ(read("EPSG:32632", R"({"scale": 0.5, "offset": 7})")[0], 507);
    // NAVD88 height in US survey feet.
    EXPECT_FLOAT_EQ(read("EPSG:32632+6360", nullptr)[0], 1000 * 1200.0F / 3937);
    EXPECT_EQ(read("EPSG:32632+6360", R"({"unit": "m"})")[0], 1000);
    relevo_dem* made = nullptr;
    raster.options = R"({"scale": 0})";
    expect_error(relevo_dem_from_heights(&raster, &made), RELEVO_RESULT_BAD_INPUT,
                 "heights: options:1: scale: expected another than 0");
}

TEST_F(Figures, ThePositionIsThatOfTheProgram) {
    auto place = sized<relevo_place>();
    place.lat_deg = 46.95;
    place.lon_deg = 7.44;
    place.height_m = 540;
    const double times_s[] = {1782036000, 1782050400};  // 2026-06-21T10:00Z and 14:00Z
    double azimuth_deg[2], elevation_deg[2], apparent_deg[2];
    expect_ok(
        relevo_sun_position(&place, times_s, 2, nullptr, azimuth_deg, elevation_deg, apparent_deg));
    for (int i = 0; i < 2; ++i) {
        const Result run = relevo({"sun", "position", "--at", "46.95,7.44,540", "--json", "--time",
                                   i == 0 ? "2026-06-21T10:00Z" : "2026-06-21T14:00Z"});
        ASSERT_EQ(run.status, 0) << run.err;
        const auto json = nlohmann::json::parse(run.out);
        EXPECT_NEAR(azimuth_deg[i], json["azimuth_deg"], 1e-6);
        EXPECT_NEAR(elevation_deg[i], json["elevation_deg"], 1e-6);
        EXPECT_NEAR(apparent_deg[i], json["apparent_elevation_deg"], 1e-6);
    }
}

TEST(Position, DependsOnTheCallAlone) {
    // What one call has computed of the air is no other place's or model's.
    const double time_s = 1781982000;  // 2026-06-20T19:00Z, the sun near the horizon
    const auto apparent = [&](double lat_deg, double height_m, const char* model) {
        auto place = sized<relevo_place>();
        place.lat_deg = lat_deg;
        place.lon_deg = 7.44;
        place.height_m = height_m;
        double elevation_deg = 0, apparent_deg = 0;
        expect_ok(
            relevo_sun_position(&place, &time_s, 1, model, nullptr, &elevation_deg, &apparent_deg));
        return apparent_deg - elevation_deg;
    };
    const double first = apparent(46.95, 0, nullptr);
    EXPECT_LT(apparent(46.95, 3000, nullptr), 0.8 * first);
    EXPECT_NE(apparent(46.95, 0, "saemundsson"), first);
    EXPECT_EQ(apparent(46.95, 0, "none"), 0);
    EXPECT_NE(apparent(40, 0, "standard"), first);
    EXPECT_EQ(apparent(46.95, 0, "standard"), first);
}

TEST_F(Figures, EventsAreThoseOfTheProgram) {
    auto place = sized<relevo_place>();
    place.lat_deg = 46.95;
    place.lon_deg = 7.44;
    relevo_event events[20] = {};
    events[0].size = sizeof(relevo_event);
    std::size_t count = 0;
    expect_ok(relevo_sun_events(&place, "2026-06-21", "Europe/Zurich", events, 20, &count));
    const Result run = relevo({"sun", "day", "--at", "46.95,7.44,0", "--date", "2026-06-21", "--tz",
                               "Europe/Zurich", "--json"});
    ASSERT_EQ(run.status, 0) << run.err;
    const auto json = nlohmann::json::parse(run.out)["days"][0]["events"];
    ASSERT_EQ(count, json.size());
    for (std::size_t i = 0; i < count; ++i) {
        EXPECT_EQ(events[i].kind, json[i]["kind"]);
        EXPECT_NEAR(events[i].azimuth_deg, json[i]["azimuth_deg"], 1e-6);
    }
    // Only the number is asked for.
    std::size_t again = 0;
    expect_ok(relevo_sun_events(&place, "2026-06-21", nullptr, nullptr, 0, &again));
    EXPECT_EQ(again, count);
}

TEST_F(Figures, TheHorizonIsThatOfTheProgram) {
    const relevo_grid grid = grid_of(dem_.get());
    auto place = sized<relevo_place>();
    place.lat_deg = grid.centre_lat_deg;
    place.lon_deg = grid.centre_lon_deg;
    std::vector<double> azimuth_deg, elevation_deg(360), distance_m(360);
    for (int i = 0; i < 360; ++i)
        azimuth_deg.push_back(i);
    expect_ok(relevo_horizon(dem_.get(), &place, R"({"eye_height": 2})", azimuth_deg.data(), 360,
                             elevation_deg.data(), distance_m.data()));
    const Result run = relevo({"sun", "horizon", bundled_dem(), "--at",
                               fmt::format("{},{}", place.lat_deg, place.lon_deg), "--eye-height",
                               "2", "--step", "1", "--json"});
    ASSERT_EQ(run.status, 0) << run.err;
    const auto json = nlohmann::json::parse(run.out)["horizon"];
    ASSERT_EQ(json.size(), 360U);
    for (std::size_t i = 0; i < 360; ++i) {
        EXPECT_NEAR(elevation_deg[i], json[i]["horizon_deg"], 1e-6);
        if (json[i]["distance_m"].is_null())
            EXPECT_TRUE(std::isnan(distance_m[i]));
        else
            EXPECT_NEAR(distance_m[i], json[i]["distance_m"], 1e-3);
    }
    double height_m = 0;
    expect_ok(relevo_dem_height(dem_.get(), place.lat_deg, place.lon_deg, &height_m));
    EXPECT_GT(height_m, 100);
    const std::array lat_deg{place.lat_deg, 0.0}, lon_deg{place.lon_deg, 0.0};
    std::array heights_m{0.0, 0.0};
    expect_ok(relevo_dem_heights(dem_.get(), lat_deg.data(), lon_deg.data(), 2, heights_m.data()));
    EXPECT_EQ(heights_m[0], height_m);
    EXPECT_TRUE(std::isnan(heights_m[1]));
    EXPECT_EQ(relevo_dem_heights(dem_.get(), nullptr, lon_deg.data(), 2, heights_m.data()),
              RELEVO_RESULT_BAD_CALL);
    expect_ok(relevo_dem_height(dem_.get(), 0, 0, &height_m));
    EXPECT_TRUE(std::isnan(height_m));
}

TEST_F(Figures, AnswersAreThoseOfTheProgram) {
    const relevo_grid grid = grid_of(dem_.get());
    const std::string at =
        fmt::format(R"("lat": {}, "lon": {})", grid.centre_lat_deg, grid.centre_lon_deg);
    for (const std::string figure : {"day", "eclipses"}) {
        const char* answer = nullptr;
        const std::string options =
            fmt::format(R"({{{}, "from": "2024-04-08", "to": "2024-04-09", "limb": "upper"}})", at);
        expect_ok(relevo_answer(dem_.get(), ("sun " + figure).c_str(), options.c_str(), &answer));
        const Result run =
            relevo({"sun", figure, bundled_dem(), "--at",
                    fmt::format("{},{}", grid.centre_lat_deg, grid.centre_lon_deg), "--from",
                    "2024-04-08", "--to", "2024-04-09", "--limb", "upper", "--json"});
        ASSERT_EQ(run.status, 0) << run.err;
        EXPECT_EQ(nlohmann::json::parse(answer), nlohmann::json::parse(run.out)) << figure;
    }
    const char* answer = nullptr;
    const std::string one = "{" + at + R"(, "date": "2026-06-21"})";
    expect_ok(relevo_answer(nullptr, "moon day", one.c_str(), &answer));
    EXPECT_EQ(nlohmann::json::parse(answer)["days"].size(), 1U);
    expect_error(relevo_answer(nullptr, "sun dial", nullptr, &answer), RELEVO_RESULT_BAD_INPUT,
                 "figure: expected one of sun position, sun day, sun eclipses, sun carpet, sun "
                 "when, sun along, moon position, moon day, moon when, halo but got sun dial");
    EXPECT_EQ(answer, nullptr);
    expect_error(relevo_answer(nullptr, "sun carpet",
                               R"({"lat": 47, "lon": 8, "year": 2026, "zone": "UTC"})", &answer),
                 RELEVO_RESULT_BAD_CALL, "relevo_answer: dem: null");
    expect_error(
        relevo_answer(dem_.get(), "moon day", R"({"lat": 47, "lon": 8, "dates": ""})", &answer),
        RELEVO_RESULT_BAD_INPUT,
        "relevo_answer: options:1: dates: no such key; did you mean \"date\"?");
}

TEST_F(Figures, EstimatesAndTilesCanBeCancelled) {
    const char* answer = nullptr;
    expect_ok(
        relevo_tiles(dem_.get(), "sky_view", R"({"directions": 8})", nullptr, nullptr, &answer));
    EXPECT_EQ(nlohmann::json::parse(answer)["posts"], static_cast<double>(posts_of(dem_.get())));
    const auto folder = std::filesystem::path(testing::TempDir()) / "relevo_c_tiles";
    std::filesystem::remove_all(folder);
    const std::string files = fmt::format(R"({{"folder": "{}", "tiles": 200}})", folder.string());
    auto progress = sized<relevo_progress>();
    progress.done = [](void*, double) { return 1; };
    expect_error(relevo_tiles(dem_.get(), "sky_view", R"({"directions": 8})", files.c_str(),
                              &progress, nullptr),
                 RELEVO_RESULT_CANCELLED, "relevo_tiles: cancelled");
    expect_error(relevo_tiles(dem_.get(), "dial", nullptr, nullptr, nullptr, &answer),
                 RELEVO_RESULT_BAD_INPUT,
                 "figure: expected one of shadow, sun_hours, sky_view, horizons but got dial");
}

}  // namespace
}  // namespace relevo::test
