// The film panel: its preview is the film's frames, and leaves the scene as it was.
#include <chrono>
#include <fstream>
#include <thread>

#include <gmock/gmock.h>

#include "base/units.h"
#include "scene/job.h"
#include "session/scene_times.h"
#include "window/viewer_fixture.h"

namespace relevo::test_film_window {
namespace {

class FilmWindow : public Viewer {
  protected:
    void open_film(const std::vector<std::string>& more = {}) {
        std::vector<std::string> arguments{dem_, "--time", "2026-06-21T18:30:00Z", "--only",
                                           "shadows"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        open(arguments);
        act({"mousemove", "900", "300", "key", "f"});
        ASSERT_TRUE(settles());
    }
    void click(int x, int y) {
        act({"mousemove", std::to_string(x), std::to_string(y)});
        settles(3);
        act({"click", "1"});
    }
    /// Types a frame's number, from 1, into the time line.
    void go_to_frame(int number) {
        act({"mousemove", "900", std::to_string(kTimeLine)});
        act({"keydown", "ctrl", "click", "1", "keyup", "ctrl"});
        settles(3);
        act({"key", "ctrl+a"});
        act({"type", std::to_string(number)});
        settles(3);
        act({"key", "Return"});
        act({"mousemove", "900", "300"});
        settles();
    }
    static sun::Instant time_of(const nlohmann::json& scene) {
        return sun::parse_time(scene["time"]["at"].get<std::string>(),
                               sun::Zone::named("America/New_York"))
            .utc;
    }
    /// Waits for a file in the working folder.
    bool appears(const std::string& name) {
        return wait([&] { return std::filesystem::exists(folder_ / name); });
    }
    /// The frames of the job that the panel saves.
    scene::Shots frames_of_saved_job() {
        const std::string name = fmt::format("relevo-{}.json", ++saved_);
        click(kSaveJob, kButtons);
        EXPECT_TRUE(appears(name)) << program_->output();
        session::SceneTimes times;
        return scene::shots_of(
            scene::read_job(folder_ / name),
            [&](const scene::Scene& scene) { return times.of(scene); }, 1000,
            [&](const scene::Scene& scene) { return times.motion_ground(scene); });
    }

    /// The window shows a frame: its values, and its picture in the window's size.
    void expect_frame(const scene::Shot& frame) {
        const nlohmann::json seen = this->scene();
        EXPECT_EQ(time_of(seen), frame.utc);
        const geo::Geodetic& eye = frame.scene.view.eye->place;
        EXPECT_NEAR(seen["camera"]["eye"][0].get<double>(), degrees(eye.lat_rad), 1e-9);
        EXPECT_NEAR(seen["camera"]["eye"][1].get<double>(), degrees(eye.lon_rad), 1e-9);
        EXPECT_NEAR(seen["camera"]["eye"][2].get<double>(), eye.height_m, 1e-3);
        scene::Scene scene = frame.scene;
        scene.width_px = 1280;
        scene.height_px = 800;
        std::ofstream(folder_ / "frame.json") << scene::scene_text(scene, folder_);
        const auto taken = folder_ / "relevo-1.png", captured = folder_ / "captured.png";
        act({"key", "F12"});
        ASSERT_TRUE(appears(taken)) << program_->output();
        test::WindowedProgram capture(display_, test::build_dir() / "bin/relevo",
                                      {"-q", "capture", "--scene",
                                       (folder_ / "frame.json").string(), "-o", captured.string()});
        ASSERT_EQ(capture.status(), 0) << capture.output();
        EXPECT_LE(test::difference(image::read(taken), image::read(captured), 1), 2e-4);
    }

    // Places of the panel in a window of 1280 x 800.
    static constexpr int kButtons = 676, kTimeLine = 706, kPlay = 414, kBack = 494;
    static constexpr int kSaveFilm = 423, kSaveJob = 520, kLength = 755, kLengthRow = 598;
};

TEST_F(FilmWindow, APreviewedFrameIsThatOfTheFilm) {
    open_film();
    const scene::Shots film = frames_of_saved_job();
    ASSERT_EQ(film.shots.size(), 300u);
    go_to_frame(251);
    expect_frame(film.shots[250]);
}

TEST_F(FilmWindow, SoIsOneWhoseCameraMoves) {
    open_film();
    click(510, 572);  // the films
    settles(3);
    click(510, 659);  // a day in 15 s, half-way around
    settles();
    const scene::Shots film = frames_of_saved_job();
    ASSERT_EQ(film.shots.size(), 450u);
    ASSERT_TRUE(film.shots[200].scene.view.look_at);
    go_to_frame(201);
    expect_frame(film.shots[200]);
}

TEST_F(FilmWindow, ItsEndLeavesSceneAndUndoAsTheyWere) {
    open_film();
    const nlohmann::json before = scene();
    const image::Image8 picture = display_.screen();
    go_to_frame(20);
    go_to_frame(100);
    EXPECT_NE(scene()["time"], before["time"]);
    act({"key", "Escape"});
    ASSERT_TRUE(settles());
    EXPECT_EQ(scene(), before);
    act({"key", "ctrl+z"});
    ASSERT_TRUE(settles());
    EXPECT_EQ(scene(), before) << "there is nothing to undo";
    act({"key", "f"});
    EXPECT_TRUE(wait([&] { return test::difference(display_.screen(), picture, 8) < 0.023; }));
}

TEST_F(FilmWindow, AnotherCommandActsOnTheSceneBefore) {
    open_film();
    const nlohmann::json before = scene();
    go_to_frame(20);
    act({"key", "bracketright"});  // half an hour later
    ASSERT_TRUE(settles());
    EXPECT_THAT(scene()["time"]["at"].get<std::string>(),
                testing::StartsWith("2026-06-21T15:00:00"));
    act({"key", "ctrl+z"});
    ASSERT_TRUE(settles());
    EXPECT_EQ(scene(), before);
}

TEST_F(FilmWindow, PlaysAtItsOwnPaceToTheEnd) {
    open_film();
    const scene::Shots film = frames_of_saved_job();
    const auto began = std::chrono::steady_clock::now();
    act({"key", "space"});
    std::this_thread::sleep_for(std::chrono::seconds(3));
    const nlohmann::json middle = scene();
    const double passed_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    const double day_s = film.shots.back().utc - film.shots.front().utc;
    const double shown_s = time_of(middle) - film.shots.front().utc;
    EXPECT_GT(shown_s, 2.0 / 10 * day_s);
    EXPECT_LE(shown_s, passed_s / 10 * day_s);
    std::this_thread::sleep_for(std::chrono::seconds(9));
    const nlohmann::json end = scene();
    EXPECT_EQ(time_of(end), film.shots.back().utc);
}

TEST_F(FilmWindow, AFilmIsDrawnInTheBackground) {
    open_film();
    click(kLength, kLengthRow);
    act({"key", "ctrl+a"});
    act({"type", "0.2"});
    settles(3);
    act({"key", "Return"});
    ASSERT_TRUE(settles());
    click(kSaveFilm, kButtons);
    ASSERT_TRUE(appears("jacksboro_film.mp4")) << program_->output();
    EXPECT_TRUE(wait([&] {
        return program_->output().find(", 6 frames, 0.2 s") != std::string::npos;
    })) << program_->output();
}

TEST_F(FilmWindow, NoEncoderIsAMessageAndNothingIsLost) {
    environment_ = {std::string("LD_PRELOAD=") + RELEVO_TEST_SHIM, "RELEVO_SHIM=encoders"};
    open_film();
    const nlohmann::json before = scene();
    click(kSaveFilm, kButtons);
    EXPECT_TRUE(wait([&] {
        return program_->output().find("has none of the encoders libx264, libopenh264") !=
               std::string::npos;
    })) << program_->output();
    EXPECT_EQ(scene(), before);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "jacksboro_film.mp4"));
}

TEST_F(FilmWindow, ClosingItAsksAboutAFilmInWork) {
    open_film();
    click(kSaveFilm, kButtons);
    act({"mousemove", "900", "300"});
    std::this_thread::sleep_for(std::chrono::seconds(3));
    act({"key", "ctrl+q"});
    std::this_thread::sleep_for(std::chrono::seconds(2));
    EXPECT_TRUE(program_->is_running());
    act({"key", "ctrl+q"});
    EXPECT_EQ(program_->status(), 0) << program_->output();
    EXPECT_FALSE(std::filesystem::exists(folder_ / "jacksboro_film.mp4"));
    for (const auto& file : std::filesystem::directory_iterator(folder_))
        EXPECT_NE(file.path().extension(), ".mp4") << file.path();
}

}  // namespace
}  // namespace relevo::test_film_window
