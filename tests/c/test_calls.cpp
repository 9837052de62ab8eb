// What is wrong with a call is a code and a sentence, never a crash.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "c/library.h"
#include "cli/program.h"
#include "support/support.h"

namespace relevo::test {
namespace {

TEST(Version, IsThatOfTheHeader) {
    EXPECT_EQ(relevo_version(), std::to_string(RELEVO_VERSION_MAJOR) + "." +
                                    std::to_string(RELEVO_VERSION_MINOR) + "." +
                                    std::to_string(RELEVO_VERSION_PATCH));
}

/// Each function with nothing at all.
TEST(BadCalls, NullIsAnError) {
    const std::vector<relevo_result> results = {
        relevo_dem_open(nullptr, 1, nullptr, nullptr),
        relevo_dem_from_heights(nullptr, nullptr),
        relevo_dem_grid(nullptr, nullptr),
        relevo_dem_crs(nullptr, nullptr),
        relevo_dem_wkt(nullptr, nullptr),
        relevo_dem_read(nullptr, nullptr, 0),
        relevo_dem_height(nullptr, 0, 0, nullptr),
        relevo_dem_heights(nullptr, nullptr, nullptr, 0, nullptr),
        relevo_sun_position(nullptr, nullptr, 1, nullptr, nullptr, nullptr, nullptr),
        relevo_sun_events(nullptr, nullptr, nullptr, nullptr, 1, nullptr),
        relevo_horizon(nullptr, nullptr, nullptr, nullptr, 1, nullptr, nullptr),
        relevo_answer(nullptr, nullptr, nullptr, nullptr),
        relevo_dem_around(nullptr, nullptr),
        relevo_shadow(nullptr, nullptr, nullptr, 0, nullptr, nullptr),
        relevo_sun_hours(nullptr, R"({"date": "2026-06-21"})", nullptr, 0, nullptr, nullptr),
        relevo_sky_view(nullptr, nullptr, nullptr, 0, nullptr, nullptr),
        relevo_horizons(nullptr, nullptr, nullptr, 0, nullptr, nullptr),
        relevo_tiles(nullptr, "shadow", nullptr, nullptr, nullptr, nullptr),
        relevo_open(nullptr, nullptr, nullptr),
        relevo_set(nullptr, nullptr),
        relevo_resize(nullptr, 1, 1),
        relevo_scene(nullptr, nullptr),
        relevo_picture_size(nullptr, nullptr, nullptr),
        relevo_draw_picture(nullptr, nullptr),
    };
    for (std::size_t i = 0; i < results.size(); ++i)
        EXPECT_EQ(results[i], RELEVO_RESULT_BAD_CALL) << i;
    expect_error(relevo_draw_picture(nullptr, nullptr), RELEVO_RESULT_BAD_CALL,
                 "relevo_draw_picture: picture: null");
    relevo_dem_close(nullptr);
    relevo_close(nullptr);
}

TEST(BadCalls, ClosedHandlesAreFoundOut) {
    relevo_dem* const dem = open_bundled().release();
    relevo_dem_close(dem);
    relevo_dem_close(dem);
    auto grid = sized<relevo_grid>();
    expect_error(relevo_dem_grid(dem, &grid), RELEVO_RESULT_BAD_CALL,
                 "relevo_dem_grid: dem: a closed handle");
    const DemHandle other = open_bundled();
    EXPECT_NE(other.get(), dem);  // numbers are not used again
    EXPECT_EQ(relevo_dem_grid(dem, &grid), RELEVO_RESULT_BAD_CALL);
    // A handle of another kind, and an address of anything.
    EXPECT_EQ(relevo_set(reinterpret_cast<relevo_session*>(other.get()), "{}"),
              RELEVO_RESULT_BAD_CALL);
    EXPECT_EQ(relevo_dem_grid(reinterpret_cast<relevo_dem*>(&grid), &grid), RELEVO_RESULT_BAD_CALL);
}

TEST(BadCalls, SizesAreChecked) {
    const DemHandle dem = open_bundled();
    std::vector<float> values(posts_of(dem.get()), -1.0F);
    EXPECT_EQ(relevo_dem_read(dem.get(), values.data(), values.size() - 1), RELEVO_RESULT_BAD_CALL);
    EXPECT_EQ(relevo_shadow(dem.get(), R"({"time": "2026-06-21T12:00Z"})", values.data(),
                            values.size() + 1, nullptr, nullptr),
              RELEVO_RESULT_BAD_CALL);
    EXPECT_TRUE(std::ranges::all_of(values, [](float v) { return v == -1; }));
    relevo_grid grid{};
    expect_error(
        relevo_dem_grid(dem.get(), &grid), RELEVO_RESULT_BAD_CALL,
        "relevo_dem_grid: grid.size: expected " + std::to_string(sizeof grid) + " but got 0");
    grid.size = offsetof(relevo_grid, column_spacing_m);
    EXPECT_EQ(relevo_dem_grid(dem.get(), &grid), RELEVO_RESULT_BAD_CALL);
    // A struct of a later version: only the members that are known are filled.
    struct {
        relevo_grid grid;
        double later;
    } larger{{}, -7};
    larger.grid.size = sizeof larger;
    expect_ok(relevo_dem_grid(dem.get(), &larger.grid));
    EXPECT_GT(larger.grid.columns, 1);
    EXPECT_EQ(larger.grid.size, sizeof larger);
    EXPECT_EQ(larger.later, -7);
}

TEST(Dems, AreFoundAfterTheWorkingFolderHasChanged) {
    const std::filesystem::path before = std::filesystem::current_path();
    const std::filesystem::path path = bundled_dem();
    std::filesystem::current_path(path.parent_path());
    const std::string name = path.filename().string();
    const char* const file = name.c_str();
    relevo_dem* opened = nullptr;
    expect_ok(relevo_dem_open(&file, 1, nullptr, &opened));
    const DemHandle dem(opened);
    std::filesystem::current_path("/");
    const relevo_grid grid = grid_of(opened);
    auto place = sized<relevo_place>();
    place.lat_deg = grid.centre_lat_deg;
    place.lon_deg = grid.centre_lon_deg;
    const double azimuth_deg = 90;
    double elevation_deg = -90;
    expect_ok(relevo_horizon(opened, &place, nullptr, &azimuth_deg, 1, &elevation_deg, nullptr));
    EXPECT_GT(elevation_deg, -10);
    std::filesystem::current_path(before);
}

TEST(BadInput, SaysWhatTheProgramSays) {
    const char* const missing = "/nowhere/alps.tif";
    relevo_dem* dem = reinterpret_cast<relevo_dem*>(7);
    expect_error(relevo_dem_open(&missing, 1, nullptr, &dem), RELEVO_RESULT_BAD_INPUT,
                 "/nowhere/alps.tif: no such file; there is no folder /nowhere");
    EXPECT_EQ(dem, nullptr);
    const std::string path = bundled_dem();
    const char* const file = path.c_str();
    expect_error(relevo_dem_open(&file, 1, R"({"untit": "m"})", &dem), RELEVO_RESULT_BAD_INPUT,
                 "scene: (text):1: dem.untit: no such key; did you mean \"unit\"?");
    EXPECT_EQ(relevo_dem_open(&file, 1, "{", &dem), RELEVO_RESULT_BAD_INPUT);
    // A damaged file is damaged, and not on the net.
    const std::string damaged = (scratch_dir() / "damaged.tif").string();
    std::filesystem::copy_file(path, damaged);
    std::filesystem::resize_file(damaged, 200);
    const char* const damaged_name = damaged.c_str();
    EXPECT_EQ(relevo_dem_open(&damaged_name, 1, nullptr, &dem), RELEVO_RESULT_BAD_INPUT);
    EXPECT_NE(std::string(relevo_error()).find("damaged"), std::string::npos) << relevo_error();
    EXPECT_EQ(std::string(relevo_error()).find("net"), std::string::npos) << relevo_error();
    auto place = sized<relevo_place>();
    place.lat_deg = 91;
    double time_s = 0, azimuth_deg = 0;
    EXPECT_EQ(relevo_sun_position(&place, &time_s, 1, nullptr, &azimuth_deg, nullptr, nullptr),
              RELEVO_RESULT_BAD_INPUT);
    place.lat_deg = 45;
    for (const double bad_s : {1e30, std::nan(""), -std::numeric_limits<double>::infinity(), 5e9})
        EXPECT_EQ(relevo_sun_position(&place, &bad_s, 1, nullptr, &azimuth_deg, nullptr, nullptr),
                  RELEVO_RESULT_BAD_INPUT);
    expect_error(relevo_sun_position(&place, &time_s, 1, "mist", &azimuth_deg, nullptr, nullptr),
                 RELEVO_RESULT_BAD_INPUT,
                 "refraction: expected one of standard, saemundsson, none but got \"mist\"");
}

TEST(BadInput, OptionsOfRastersAreChecked) {
    const DemHandle dem = open_bundled();
    std::vector<float> values(posts_of(dem.get()));
    const auto hours = [&](const char* options) {
        return relevo_sun_hours(dem.get(), options, values.data(), values.size(), nullptr, nullptr);
    };
    for (const char* options :
         {"{}", R"({"date": "2026-02-30"})", R"({"date": "2026-06-21", "year": 2026})",
          R"({"from": "2026-06-21"})", R"({"from": "2026-06-22", "to": "2026-06-21"})",
          R"({"date": "2026-06-21", "bands": ["houses"]})",
          R"({"date": "2026-06-21", "bands": ["hours", "hours"]})",
          R"({"date": "2026-06-21", "linke": 3})", R"({"date": "2026-06-21", "step": 0})",
          R"({"date": "2026-06-21", "zone": "Mars/Olympus"})", R"({"date": 20260621})"}) {
        EXPECT_EQ(hours(options), RELEVO_RESULT_BAD_INPUT) << options;
        EXPECT_NE(std::string(relevo_error()), "") << options;
    }
    EXPECT_EQ(relevo_shadow(dem.get(), nullptr, values.data(), values.size(), nullptr, nullptr),
              RELEVO_RESULT_BAD_INPUT);
    EXPECT_EQ(relevo_sky_view(dem.get(), R"({"directions": 3})", values.data(), values.size(),
                              nullptr, nullptr),
              RELEVO_RESULT_BAD_INPUT);
}

TEST(BadInput, HeightsOfLies) {
    std::vector<float> heights(12, 100.0F);
    auto raster = sized<relevo_raster>();
    raster.heights_m = heights.data();
    raster.count = 12;
    raster.columns = 4;
    raster.rows = 3;
    raster.crs = "EPSG:32632";
    relevo_dem* dem = nullptr;
    expect_error(relevo_dem_from_heights(&raster, &dem), RELEVO_RESULT_BAD_INPUT,
                 "heights: transform: expected finite numbers and cells with an area");
    raster.transform[1] = raster.transform[5] = 1;
    expect_error(relevo_dem_from_heights(&raster, &dem), RELEVO_RESULT_BAD_INPUT,
                 "heights: transform: the identity, which GDAL has where it knows no place; "
                 "expected coordinates of the CRS");
    const double transform[6] = {600000, 30, 0, 5200000, 0, -30};
    std::copy_n(transform, 6, raster.transform);
    raster.columns = 5;
    EXPECT_EQ(relevo_dem_from_heights(&raster, &dem), RELEVO_RESULT_BAD_CALL);
    raster.columns = -4;
    EXPECT_EQ(relevo_dem_from_heights(&raster, &dem), RELEVO_RESULT_BAD_CALL);
    raster.columns = 4;
    raster.crs = "EPSG:nothing";
    EXPECT_EQ(relevo_dem_from_heights(&raster, &dem), RELEVO_RESULT_BAD_INPUT);
    raster.crs = "EPSG:32632";
    expect_ok(relevo_dem_from_heights(&raster, &dem));
    const DemHandle made(dem);
    std::vector<float> read(12);
    expect_ok(relevo_dem_read(dem, read.data(), read.size()));
    EXPECT_EQ(read, heights);
    // Heights that no ground has are told of where figures are asked for.
    heights[5] = 100000;
    expect_ok(relevo_dem_from_heights(&raster, &dem));
    const DemHandle tall(dem);
    EXPECT_EQ(relevo_sky_view(dem, nullptr, read.data(), read.size(), nullptr, nullptr),
              RELEVO_RESULT_BAD_INPUT);
    EXPECT_NE(std::string(relevo_error()), "");
}

struct Told {
    std::vector<double> shares;
    int calls_until_cancelled = 1 << 30;
    bool throws = false;
};

relevo_progress progress_of(Told& told) {
    auto progress = sized<relevo_progress>();
    progress.user = &told;
    progress.done = [](void* user, double share) -> std::int32_t {
        auto& to = *static_cast<Told*>(user);
        if (to.throws) throw std::runtime_error("of the caller");
        to.shares.push_back(share);
        return --to.calls_until_cancelled <= 0;
    };
    return progress;
}

TEST(Progress, RisesToOneAndCancels) {
    const DemHandle dem = open_bundled();
    std::vector<float> values(posts_of(dem.get()));
    Told told;
    const relevo_progress progress = progress_of(told);
    const auto hours = [&] {
        return relevo_sun_hours(dem.get(), R"({"date": "2026-06-21"})", values.data(),
                                values.size(), &progress, nullptr);
    };
    expect_ok(hours());
    ASSERT_GT(told.shares.size(), 3U);
    EXPECT_TRUE(std::ranges::is_sorted(told.shares));
    EXPECT_NEAR(told.shares.back(), 1, 1e-6);
    told.calls_until_cancelled = 2;
    expect_error(hours(), RELEVO_RESULT_CANCELLED, "relevo_sun_hours: cancelled");
    told.throws = true;
    expect_error(hours(), RELEVO_RESULT_FAILED,
                 "relevo_sun_hours: progress: the callback threw an exception");
    told = {};
    expect_ok(hours());
}

TEST(Progress, IsPolledToo) {
    const DemHandle dem = open_bundled();
    std::vector<float> values(posts_of(dem.get()));
    std::int32_t cancel = 0;
    double share = 0;
    auto progress = sized<relevo_progress>();
    progress.cancel = &cancel;
    progress.share = &share;
    const auto sky_view = [&] {
        return relevo_sky_view(dem.get(), R"({"directions": 8})", values.data(), values.size(),
                               &progress, nullptr);
    };
    expect_ok(sky_view());
    EXPECT_NEAR(share, 1, 1e-6);
    cancel = 1;
    expect_error(sky_view(), RELEVO_RESULT_CANCELLED, "relevo_sky_view: cancelled");
    EXPECT_LT(share, 0.5);
    progress.size = 24;  // of callers of 0.1, which have neither
    progress.cancel = reinterpret_cast<std::int32_t*>(1);
    expect_ok(sky_view());
}

TEST(Messages, GoWhereTheCallerWantsThem) {
    std::vector<std::string> texts;
    expect_ok(relevo_set_message(
        [](void* user, std::int32_t level, const char* text) {
            if (level != RELEVO_MESSAGE_WARNING) return;
            static_cast<std::vector<std::string>*>(user)->emplace_back(text);
            throw std::runtime_error("of the caller");
        },
        &texts));
    const DemHandle dem = open_bundled();
    std::vector<float> values(posts_of(dem.get()));
    testing::internal::CaptureStderr();
    expect_ok(relevo_sky_view(dem.get(), nullptr, values.data(), values.size(), nullptr, nullptr));
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    ASSERT_EQ(texts.size(), 1U);
    EXPECT_TRUE(texts.front().find("outside this DEM") != std::string::npos) << texts.front();

    expect_ok(relevo_set_message(nullptr, nullptr));
    testing::internal::CaptureStderr();
    expect_ok(relevo_sky_view(dem.get(), nullptr, values.data(), values.size(), nullptr, nullptr));
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "relevo: warning: " + texts.front() + "\n");
}

TEST(Errors, BelongToTheirThread) {
    relevo_dem_grid(nullptr, nullptr);
    std::thread([] { EXPECT_EQ(std::string(relevo_error()), ""); }).join();
    EXPECT_EQ(std::string(relevo_error()), "relevo_dem_grid: grid: null");
}

}  // namespace
}  // namespace relevo::test
