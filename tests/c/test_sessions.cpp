// Pictures of the library are the program's.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/units.h"
#include "c/library.h"
#include "cli/program.h"
#include "geo/local_frame.h"
#include "image/image.h"
#include "support/support.h"

namespace relevo::test {
namespace {

constexpr const char* kScene =
    R"({"time": {"at": "2026-06-21T20:00Z"}, "picture": {"size": [128, 96]}})";

/// The picture of the program, as RGBA.
std::vector<std::uint8_t> captured(std::vector<std::string> arguments) {
    const std::string path = (scratch_dir() / "program.png").string();
    arguments.insert(arguments.begin(),
                     {"capture", bundled_dem(), "-o", path, "--overwrite", "-q"});
    const Result made = relevo(arguments);
    EXPECT_EQ(made.status, 0) << made.err;
    const image::Image8 image = image::read(path);
    const auto channels = static_cast<std::size_t>(image.channels);
    std::vector<std::uint8_t> rgba;
    for (std::size_t i = 0; i < image.values.size(); i += channels)
        for (std::size_t k = 0; k < 4; ++k)
            rgba.push_back(k < channels ? image.values[i + k] : 255);
    return rgba;
}

std::string scene_of(relevo_session* session) {
    const char* scene = nullptr;
    expect_ok(relevo_scene(session, &scene));
    return scene ? scene : "";
}

class Sessions : public testing::Test {
  protected:
    DemHandle dem_ = open_bundled();
    SessionHandle session_ = open_session(dem_.get(), kScene);
};

TEST_F(Sessions, PicturesAreThoseOfTheProgram) {
    EXPECT_EQ(draw(session_.get()).rgba,
              captured({"--time", "2026-06-21T20:00Z", "--size", "128x96"}));
    expect_ok(relevo_set(session_.get(), R"({"time": {"at": "2026-06-21T12:30Z"},
        "camera": {"orbit": {"azimuth": 300, "elevation": 20}}, "exaggeration": 2,
        "effects": {"disable": ["haze"]}, "picture": {"transparent": true, "samples": 4}})"));
    EXPECT_EQ(
        draw(session_.get()).rgba,
        captured({"--time", "2026-06-21T12:30Z", "--size", "128x96", "--view", "az=300,el=20",
                  "--exaggerate", "2", "--disable", "haze", "--transparent", "--samples", "4"}));
    expect_ok(relevo_resize(session_.get(), 80, 60));
    const Colours small = draw(session_.get());
    EXPECT_EQ(small.columns, 80);
    EXPECT_EQ(small.rows, 60);
}

TEST_F(Sessions, MapsAndMarginsHaveTheirOwnSize) {
    expect_ok(relevo_set(session_.get(), R"({"picture": {"ortho": true}})"));
    EXPECT_EQ(draw(session_.get()).rgba,
              captured({"--time", "2026-06-21T20:00Z", "--size", "128x96", "--ortho"}));
    expect_ok(relevo_set(session_.get(), R"({"picture": {"ortho": false, "size": [480, 320]},
        "stamps": {"show": ["title", "scale"], "margin": true}})"));
    const Colours framed = draw(session_.get());
    EXPECT_EQ(framed.rgba, captured({"--time", "2026-06-21T20:00Z", "--size", "480x320", "--stamp",
                                     "title,scale", "--margin"}));
}

TEST_F(Sessions, TheSceneSaysWhatWasChosen) {
    const auto scene = nlohmann::json::parse(scene_of(session_.get()));
    EXPECT_EQ(scene["time"]["at"], "2026-06-21T20:00:00Z");
    EXPECT_TRUE(scene["camera"]["orbit"].contains("azimuth"));
    // It opens the same again.
    auto options = sized<relevo_open_options>();
    options.device = "software";
    relevo_session* again = nullptr;
    expect_ok(relevo_open(scene_of(session_.get()).c_str(), &options, &again));
    EXPECT_EQ(draw(SessionHandle(again).get()).rgba, draw(session_.get()).rgba);
}

TEST_F(Sessions, AnErrorLeavesTheSceneAsItWas) {
    const std::vector<std::uint8_t> before = draw(session_.get()).rgba;
    const std::string scene = scene_of(session_.get());
    for (const char* change :
         {"{", "[]", R"({"exaggerate": 2})", R"({"effects": {"enable": ["nothing"]}})",
          R"({"effects": {"set": {"haze.density": "thick"}}})", R"({"time": {"at": "noonish"}})",
          R"({"picture": {"size": [0, 10]}})", R"({"dem": {"files": ["other.tif"]}})",
          R"({"camera": {"eye": [95, 0, 100], "heading": 0}})",
          R"({"picture": {"size": [65536, 65536]}})"}) {
        EXPECT_EQ(relevo_set(session_.get(), change), RELEVO_RESULT_BAD_INPUT) << change;
        EXPECT_NE(std::string(relevo_error()), "") << change;
        EXPECT_EQ(scene_of(session_.get()), scene) << change;
    }
    const std::string in_feet =
        fmt::format(R"({{"dem": {{"files": ["{}"], "unit": "ft"}}}})", bundled_dem());
    expect_error(relevo_set(session_.get(), in_feet.c_str()), RELEVO_RESULT_BAD_INPUT,
                 "scene: dem: a session keeps its DEM; open another session");
    EXPECT_EQ(relevo_resize(session_.get(), 0, 4), RELEVO_RESULT_BAD_INPUT);
    EXPECT_EQ(draw(session_.get()).rgba, before);
}

TEST_F(Sessions, PositionsLieOnTheGround) {
    const std::size_t pixels = 640 * 480;
    std::vector<float> depth_m(pixels), position_m(3 * pixels), normal(3 * pixels);
    auto picture = sized<relevo_picture>();
    picture.depth_m = depth_m.data();
    picture.depth_count = pixels;
    picture.position_m = position_m.data();
    picture.position_count = 3 * pixels;
    picture.normal = normal.data();
    picture.normal_count = 3 * pixels;
    expect_ok(
        relevo_set(session_.get(), R"({"picture": {"size": [640, 480], "pixel_error": 0.1}})"));
    expect_ok(relevo_draw_picture(session_.get(), &picture));
    const geo::LocalFrame frame(
        geo::geodetic_deg(picture.origin_lat_deg, picture.origin_lon_deg, picture.origin_height_m));
    int on_ground = 0, compared = 0;
    double worst_m = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
        if (!std::isfinite(depth_m[i])) {
            EXPECT_TRUE(std::isnan(position_m[3 * i]));
            continue;
        }
        ++on_ground;
        const float* n = &normal[3 * i];
        const float length = std::hypot(n[0], n[1], n[2]);
        if (length == 0) continue;  // a wall
        EXPECT_NEAR(length, 1, 0.01);
        const geo::Geodetic at =
            frame.to_geodetic({position_m[3 * i], position_m[3 * i + 1], position_m[3 * i + 2]});
        double height_m = 0;
        expect_ok(
            relevo_dem_height(dem_.get(), degrees(at.lat_rad), degrees(at.lon_rad), &height_m));
        if (std::isnan(height_m)) continue;
        worst_m = std::max(worst_m, std::abs(at.height_m - height_m));
        ++compared;
    }
    EXPECT_GT(on_ground, 1000);
    EXPECT_GT(compared, 500);
    std::printf("[ accuracy ] positions of %d pixels: worst %.2f m (limit 12)\n", compared,
                worst_m);
    EXPECT_LT(worst_m, 12);  // a tenth of a pixel of the farthest ground, triangles for bilinear
    // Nothing is written where a count is wrong, or where there is no data.
    std::vector<std::uint8_t> rgba(4 * pixels, 7);
    picture.rgba = rgba.data();
    picture.rgba_count = rgba.size();
    picture.normal_count -= 1;
    EXPECT_EQ(relevo_draw_picture(session_.get(), &picture), RELEVO_RESULT_BAD_CALL);
    EXPECT_TRUE(std::ranges::all_of(rgba, [](auto value) { return value == 7; }));
    expect_ok(relevo_set(session_.get(), R"({"camera": {"stereo": "anaglyph"}})"));
    picture.normal_count += 1;
    EXPECT_EQ(relevo_draw_picture(session_.get(), &picture), RELEVO_RESULT_BAD_INPUT);
    EXPECT_TRUE(std::ranges::all_of(rgba, [](auto value) { return value == 7; }));
}

TEST_F(Sessions, TakeOverlaysAndTheirOwnScene) {
    const std::string hours = (scratch_dir("overlay") / "hours.tif").string();
    ASSERT_EQ(relevo({"-q", "sun", "hours", bundled_dem(), "--date", "2026-06-21", "-o", hours,
                      "--overwrite"})
                  .status,
              0);
    const std::vector<std::uint8_t> plain = draw(session_.get()).rgba;
    expect_ok(relevo_set(session_.get(),
                         fmt::format(R"({{"overlay": {{"file": "{}"}}}})", hours).c_str()));
    EXPECT_EQ(draw(session_.get()).rgba,
              captured({"--time", "2026-06-21T20:00Z", "--size", "128x96", "--overlay", hours}));
    const std::string scene = scene_of(session_.get());
    expect_ok(relevo_set(session_.get(), scene.c_str()));
    EXPECT_EQ(draw(open_session(dem_.get(), scene).get()).rgba, draw(session_.get()).rgba);
    EXPECT_NE(draw(session_.get()).rgba, plain);
}

TEST_F(Sessions, AHostMayExitWithANativeEffectInUse) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(
        {
            relevo_set(session_.get(), R"({"effects": {"enable": ["contours"]}})");
            draw(session_.get());
            std::exit(0);
        },
        testing::ExitedWithCode(0), "");
}

TEST_F(Sessions, OpenWithoutADevice) {
    auto options = sized<relevo_open_options>();
    options.device = "no such GPU";
    options.dem = dem_.get();
    relevo_session* session = nullptr;
    EXPECT_EQ(relevo_open(nullptr, &options, &session), RELEVO_RESULT_NO_DEVICE);
    EXPECT_EQ(session, nullptr);
    EXPECT_EQ(relevo_open("{}", nullptr, &session), RELEVO_RESULT_BAD_INPUT);
    EXPECT_EQ(std::string(relevo_error()),
              "scene: dem.files: missing, expected the files of a DEM");
}

TEST_F(Sessions, OutliveTheirDemAndAreUsedByAnyThread) {
    dem_.reset();
    const std::vector<std::uint8_t> here = draw(session_.get()).rgba;
    std::thread([&] { EXPECT_EQ(draw(session_.get()).rgba, here); }).join();
}

TEST_F(Sessions, EightDrawOnEightThreads) {
    constexpr int kThreads = 8;
    const auto scene = [](int i) {
        return fmt::format(R"({{"time": {{"at": "2026-06-21T{:02}:00Z"}},
                               "picture": {{"size": [96, 64]}}}})",
                           12 + i);
    };
    std::vector<std::vector<std::uint8_t>> together(kThreads);
    std::vector<std::thread> threads;
    for (int i = 0; i < kThreads; ++i)
        threads.emplace_back([&, i] {
            const SessionHandle session = open_session(dem_.get(), scene(i));
            for (int k = 0; k < 3; ++k)
                together[static_cast<std::size_t>(i)] = draw(session.get()).rgba;
        });
    for (std::thread& thread : threads)
        thread.join();
    for (int i = 0; i < kThreads; ++i) {
        expect_ok(relevo_set(session_.get(), scene(i).c_str()));
        EXPECT_EQ(draw(session_.get()).rgba, together[static_cast<std::size_t>(i)]) << i;
    }
}

double resident_mib() {
    std::ifstream file("/proc/self/statm");
    long total = 0, resident = 0;
    file >> total >> resident;
    return static_cast<double>(resident) * 4096 / (1 << 20);
}

TEST_F(Sessions, TwoHundredPicturesKeepMemoryLevel) {
    expect_ok(relevo_resize(session_.get(), 64, 48));
    const auto draw_some = [&](int first, int last) {
        for (int i = first; i < last; ++i) {
            expect_ok(relevo_set(
                session_.get(), fmt::format(R"({{"time": {{"at": "2026-06-{:02}T{:02}:{:02}Z"}}}})",
                                            1 + i % 28, 11 + i % 10, i % 60)
                                    .c_str()));
            draw(session_.get());
        }
    };
    draw_some(0, 50);
    // A leak grows in each fifty, an allocator's reserve in one.
    double least_mib = 1e9;
    for (int first = 50; first < 200; first += 50) {
        const double before_mib = resident_mib();
        draw_some(first, first + 50);
        least_mib = std::min(least_mib, resident_mib() - before_mib);
    }
    std::printf("[ memory   ] 50 pictures: %.2f MiB more (limit 0.5)\n", least_mib);
    EXPECT_LT(least_mib, 0.5);
}

}  // namespace
}  // namespace relevo::test
