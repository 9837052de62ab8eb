// A DEM that takes long to read: what stands in for it, and what waits for all of its posts.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <string>

#include <glm/geometric.hpp>

#include "cli/raster.h"
#include "image/image.h"
#include "session/session.h"
#include "support/change.h"
#include "viewer/navigation.h"
#include "viewer/scene_thread.h"
#include "window/viewer_fixture.h"

namespace relevo::test_large_dem {
namespace {

/// 4104 x 4100 posts, few more than are read at once, with overviews.
void make_large_dem(const test::Display& display, const std::filesystem::path& file) {
    test::WindowedProgram make(display, test::build_dir() / "bin/make_dem",
                               {(test::source_dir() / "data/dem/jacksboro.tif").string(), "4104",
                                "4100", file.string(), "--overviews"});
    ASSERT_EQ(make.status(120), 0) << make.output();
}

image::Image8 image_of(const viewer::Picture& picture) {
    return image::from_device(picture.width_px, picture.height_px, picture.rgba);
}

TEST_F(Viewer, MeansStandInForALargeDemUntilItIsRead) {
    const auto dem = folder_ / "large.tif";
    make_large_dem(display_, dem);
    scene::Scene scene;
    scene.dems = {dem.string()};
    scene.width_px = 320;
    scene.height_px = 200;
    viewer::SceneThread thread(scene, viewer::SceneDevice("software"), [] {});
    viewer::Wanted wanted;
    wanted.width_px = scene.width_px;
    wanted.height_px = scene.height_px;
    thread.want(wanted);
    ASSERT_TRUE(wait([&] { return thread.opened() != nullptr; }));
    const auto first = thread.opened();
    EXPECT_TRUE(first->dem->is_preview);
    EXPECT_EQ(first->dem->field.reduction, 4);
    // What is told of a place is of the posts all the same.
    const geo::Geodetic place = first->dem->source->grid().place(1001.25, 2001.5);
    const double height_m = first->dem->height_m(place);

    std::shared_ptr<const viewer::Picture> picture;
    bool stood_in = false;
    ASSERT_TRUE(test::WindowedProgram::wait(
        [&] {
            const bool is_preview = thread.opened()->dem->is_preview;
            if (const auto newer = thread.newer_than(picture ? picture->number : 0))
                picture = newer;
            stood_in = stood_in || (picture && is_preview);
            return picture && picture->sharp;
        },
        120));
    EXPECT_TRUE(stood_in);  // there was a picture before
    const auto whole = thread.opened();
    EXPECT_FALSE(whole->dem->is_preview);
    EXPECT_EQ(whole->dem->field.reduction, 1);
    EXPECT_NEAR(whole->dem->height_m(place), height_m, 1e-4);
    const geo::Geodetic before = first->ground.frame.origin(), after = whole->ground.frame.origin();
    EXPECT_EQ(before.lat_rad, after.lat_rad);
    EXPECT_EQ(before.lon_rad, after.lon_rad);

    FilesInUse files;
    session::Session session(scene, {.device = "software"}, files);
    EXPECT_FALSE(session.dem()->is_preview);  // captures wait
    EXPECT_EQ(session.time(), whole->utc);
    const scene::Camera camera = whole->camera(whole->scene.view, 320.0 / 200, {});
    EXPECT_LT(distance(session.camera().eye_m, camera.eye_m), 1e-6);
    // As the window draws it, upright at its eye.
    const viewer::Land land{&session.ground().frame, 1, {}, {}};
    test::change(session, [&](scene::Scene& drawn) {
        drawn.backdrop = whole->scene.backdrop;
        drawn.view = view_of(pose_of(camera, land), land);
    });
    session.draw();
    EXPECT_LE(test::difference(image_of(*picture), session.picture(), 1), 2e-4);
}

TEST_F(Viewer, NoEyeIsUnderTheDrawnGround) {
    scene::Scene scene;
    scene.dems = {dem_};
    scene.time.at = "2026-06-21T12:00Z";
    scene.exaggeration = 5;  // slopes of 45 degrees between posts of 80 m
    constexpr int kSide_px = 33, kSites = 40;
    constexpr double kEye_m = 2;
    viewer::SceneThread thread(scene, viewer::SceneDevice("software"), [] {});
    viewer::Wanted wanted;
    wanted.width_px = wanted.height_px = kSide_px;
    wanted.keep_above_m = 0;
    std::uint64_t number = 0;
    const auto depth_ahead_m = [&](const scene::View& view) {
        wanted.scene = thread.opened()->scene;
        wanted.utc = thread.opened()->utc;
        wanted.scene->view = view;
        thread.want(wanted);
        std::shared_ptr<const viewer::Picture> picture;
        EXPECT_TRUE(wait([&] {
            thread.check();
            picture = thread.newer_than(number);
            return picture && picture->sharp && picture->answers == thread.wants();
        }));
        number = picture->number;
        return picture->depths_m.at(kSide_px * kSide_px / 2);
    };
    thread.want(wanted);
    ASSERT_TRUE(wait([&] { return thread.opened() != nullptr; }));
    const dem::Grid& grid = thread.opened()->dem->field.grid;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> share(0.02, 0.98);
    int under = 0, off = 0;
    for (int site = 0; site < kSites; ++site) {
        scene::View view;
        const double column = share(random) * (grid.columns() - 1);
        view.eye = scene::Standpoint{grid.place(column, share(random) * (grid.rows() - 1)),
                                     /*above_ground=*/true};
        view.eye->place.height_m = kEye_m;
        view.pitch_deg = 90;
        under += !std::isinf(depth_ahead_m(view));
        view.pitch_deg = -90;
        off += !(std::abs(depth_ahead_m(view) - kEye_m) < 0.03);
    }
    fmt::print("[ standing ] window: {} sites, {} under the drawn ground, {} off\n", kSites, under,
               off);
    EXPECT_EQ(under, 0);
    EXPECT_EQ(off, 0);
}

TEST_F(Viewer, APictureOfALargeDemWaitsForAllOfIt) {
    const auto dem = folder_ / "large.tif";
    make_large_dem(display_, dem);
    start({dem.string(), "--disable", "haze", "--time", "2026-06-21T20:00:00Z"});
    ASSERT_TRUE(wait([&] { return program_->title().find("large") != std::string::npos; }))
        << program_->output();
    act({"mousemove", "900", "500", "key", "F12"});
    const auto taken = folder_ / "relevo-1.png";
    ASSERT_TRUE(test::WindowedProgram::wait([&] { return std::filesystem::exists(taken); }, 120))
        << program_->output();
    const auto captured = folder_ / "captured.png";
    test::WindowedProgram capture(
        display_, test::build_dir() / "bin/relevo",
        {"-q", "capture", "--from", taken.string(), "-o", captured.string()});
    ASSERT_EQ(capture.status(120), 0) << capture.output();
    EXPECT_LE(test::difference(image::read(taken), image::read(captured), 1), 2e-4);
}

TEST_F(Viewer, AnOverlayOfALargeDemIsOfEveryPostAndWaitsForThem) {
    const auto dem = folder_ / "large.tif";
    make_large_dem(display_, dem);
    start({dem.string(), "--only", "--time", "2026-12-21T20:30:00Z"});
    ASSERT_TRUE(wait([&] { return program_->title().find("large") != std::string::npos; }))
        << program_->output();
    // "Direct sun at this time", and its raster, before all posts are there.
    ASSERT_TRUE(wait([&] {
        return count_near(display_.screen(), {316, 216, 18, 18}, {45, 50, 58}, 4) > 100;
    }));
    const glm::ivec4 arrow{316, 216, 18, 18}, choices{10, 240, 300, 140}, choice{10, 344, 200, 16};
    ASSERT_TRUE(changes_in(arrow, [&] { act({"mousemove", "326", "225"}); }));
    ASSERT_TRUE(changes_in(choices, [&] { act({"click", "1"}); }));
    ASSERT_TRUE(changes_in(choice, [&] { act({"mousemove", "100", "352"}); }));
    ASSERT_TRUE(changes_in(choices, [&] { act({"click", "1"}); }));
    act({"mousemove", "900", "500"});
    settles();
    act({"key", "ctrl+e"});
    const auto saved = folder_ / "relevo-1.tif";
    ASSERT_TRUE(test::WindowedProgram::wait([&] { return std::filesystem::exists(saved); }, 120))
        << program_->output();
    const auto commanded = folder_ / "command.tif";
    test::WindowedProgram shadow(display_, test::build_dir() / "bin/relevo",
                                 {"-q", "sun", "shadow", dem.string(), "--time",
                                  "2026-12-21T15:30:00-05:00", "-o", commanded.string()});
    ASSERT_EQ(shadow.status(120), 0) << shadow.output();
    EXPECT_TRUE(read_text(saved, "test") == read_text(commanded, "test"));
}

TEST_F(Viewer, ALargeDemWhoseRestIsDamagedIsSaidAndTheOneBeforeComesBack) {
    std::filesystem::create_directories(folder_ / "maps");
    const auto good = folder_ / "maps/a.tif", bad = folder_ / "maps/b.tif";
    std::filesystem::copy_file(dem_, good);
    make_large_dem(display_, bad);
    std::uint64_t at = 0;
    {
        const auto file = test::opened(bad.string());
        const char* const offset =
            file->GetRasterBand(1)->GetMetadataItem("BLOCK_OFFSET_5_11", "TIFF");
        ASSERT_TRUE(offset);
        at = std::stoull(offset);
    }
    std::fstream(bad, std::ios::in | std::ios::out | std::ios::binary)
        .seekp(static_cast<std::streamoff>(at))
        .write(std::string(64, '\xff').data(), 64);
    // Its means can be drawn, till the rest is read.
    {
        scene::Scene scene;
        scene.dems = {bad.string()};
        viewer::SceneThread thread(scene, viewer::SceneDevice("software"), [] {});
        thread.want({.width_px = 320, .height_px = 200});
        ASSERT_TRUE(wait([&] {
            thread.check();
            return thread.opened() != nullptr;
        }));
        EXPECT_TRUE(thread.opened()->dem->is_preview);
        std::string why;
        ASSERT_TRUE(test::WindowedProgram::wait(
            [&] {
                try {
                    thread.check();
                } catch (const Error& error) {
                    why = error.what();
                }
                return !why.empty();
            },
            120));
        EXPECT_THAT(why, testing::HasSubstr("b.tif: its heights cannot be read"));
    }
    // The window goes back to the DEM before, with a message.
    open({good.string(), "--only"});
    const image::Image8 before = display_.screen();
    act({"key", "ctrl+Next"});
    const auto message = [&](const image::Image8& screen) {
        return count_near(screen, {390, 30, 500, 70}, {232, 234, 237}, 30);
    };
    ASSERT_EQ(message(before), 0);
    // Progress of reading the other one may stand there before.
    ASSERT_TRUE(wait([&] {
        return message(display_.screen()) > 500 &&
               program_->title().find("a.tif") != std::string::npos;
    }));
    // The message and the panel's title are all that is new.
    EXPECT_TRUE(wait([&] { return test::difference(display_.screen(), before, 8) < 0.08; }));
    act({"key", "ctrl+q"});
    EXPECT_EQ(program_->status(), 0);
    // What the program was started for is its end.
    start({bad.string(), "--only"});
    EXPECT_NE(program_->status(120), 0);
    EXPECT_THAT(program_->output(), testing::HasSubstr("b.tif"));
}

}  // namespace
}  // namespace relevo::test_large_dem
