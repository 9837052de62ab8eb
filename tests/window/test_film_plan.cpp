// The film of the window without a window: what is asked for, its frames, its job and its command.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <imgui.h>

#include "base/text.h"
#include "base/units.h"
#include "support/support.h"
#include "viewer/document.h"
#include "viewer/export.h"
#include "viewer/film_clock.h"
#include "viewer/film_export.h"
#include "viewer/film_fields.h"
#include "viewer/film_plan.h"
#include "viewer/film_preview.h"

namespace relevo::viewer::test_film_plan {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Time = FilmChoice::Time;
using Camera = FilmChoice::Camera;

TEST(FilmClock, PassesOverFramesAsTimePasses) {
    FilmClock clock;
    clock.set_film(300, 30);
    clock.advance(1);
    EXPECT_EQ(clock.frame(), 0) << "it does not play yet";
    clock.play();
    clock.advance(1);
    EXPECT_EQ(clock.frame(), 30);
    clock.advance(0.02);
    EXPECT_EQ(clock.frame(), 30) << "the next frame is due after 1/30 s";
    clock.advance(0.02);
    EXPECT_EQ(clock.frame(), 31);
    clock.advance(100);
    EXPECT_EQ(clock.frame(), 299);
    EXPECT_FALSE(clock.is_playing());
    clock.play();
    EXPECT_EQ(clock.frame(), 0) << "from the beginning";
}

TEST(FilmClock, StaysAtItsShareOfAnotherFilm) {
    FilmClock clock;
    clock.set_film(301, 30);
    clock.go_to(150);
    clock.set_film(101, 25);
    EXPECT_EQ(clock.frame(), 50);
    EXPECT_DOUBLE_EQ(clock.time_s(), 2);
    clock.go_to(1000);
    EXPECT_EQ(clock.frame(), 100);
}

class Film : public testing::Test {
  protected:
    Film() {
        wanted_.dem = session::load_dem(
            std::make_shared<const dem::Source>(dem::Source::open(scene_.dems, scene_.dem)),
            scene_);
        wanted_.wish.scene = scene_;
        wanted_.wish.zone = sun::Zone::named("America/New_York");
        wanted_.wish.utc = sun::parse_time(scene_.time.at, wanted_.wish.zone).utc;
        times_.use(scene_, wanted_.dem);
        fs::current_path(folder_);
    }
    FilmChoice& choice() { return wanted_.wish.choice; }
    FilmPlan plan() {
        FilmPlan result = plan_film(wanted_, times_);
        EXPECT_EQ(result.error, "");
        return result;
    }
    std::string error() { return plan_film(wanted_, times_).error; }
    void add_views() {
        for (const double heading_deg : {0.0, 60.0, 120.0}) {
            scene::View view = scene_.view;
            view.eye->place.lat_rad += radians(heading_deg / 2000);
            view.heading_deg = heading_deg;
            wanted_.wish.views.push_back(view);
        }
    }
    std::string line(const std::string& text) const {
        const fs::path file = folder_ / "line.csv";
        std::ofstream(file) << "lat,lon\n" << text;
        return file.string();
    }
    /// The frames of a job's file, as `relevo run` draws them up.
    static scene::Shots frames_of(const fs::path& job) {
        session::SceneTimes times;
        return scene::shots_of(
            scene::read_job(job), [&](const scene::Scene& scene) { return times.of(scene); }, 1000,
            [&](const scene::Scene& scene) { return times.motion_ground(scene); });
    }

    const fs::path folder_ = test::scratch_dir("film");
    const scene::Scene scene_ = [] {
        scene::Scene scene;
        scene.dems = {(test::source_dir() / "data/dem/jacksboro.tif").string()};
        scene.time.at = "2026-06-21T14:30:00-04:00";
        scene.view.eye = scene::Standpoint{geo::geodetic_deg(36.33, -84.28, 1500), false};
        scene.view.heading_deg = 70;
        scene.view.pitch_deg = -12;
        scene.view.fov_y_rad = radians(40.0);
        scene.effects.switches.only = std::vector<std::string>{"shadows"};
        return scene;
    }();
    FilmWanted wanted_;
    session::SceneTimes times_;
};

TEST_F(Film, FirstIsADayInTenSecondsAtThirtyFrames) {
    choice() = film_presets().front().choice;
    const FilmPlan film = plan();
    ASSERT_EQ(film.frames.shots.size(), 300u);
    EXPECT_EQ(film.film.film.fps, 30);
    const auto at = [&](const char* event) {
        scene::Scene scene = scene_;
        scene.time = {event, "2026-06-21", "America/New_York"};
        return times_.of(scene).utc;
    };
    EXPECT_EQ(film.frames.shots.front().utc - at("sunrise-30min"), 0);
    EXPECT_NEAR(film.frames.shots.back().utc - at("sunset+30min"), 0, 1e-3);
    EXPECT_EQ(film.film.output, "jacksboro_film.mp4");
    std::ofstream("jacksboro_film.mp4") << "taken";
    EXPECT_EQ(plan().film.output, "jacksboro_film-2.mp4");
}

TEST_F(Film, EveryPresetHasTheFramesOfItsSavedJob) {
    add_views();
    wanted_.wish.file.size_px = {64, 48};
    for (const FilmPreset& preset : film_presets()) {
        SCOPED_TRACE(preset.name);
        choice() = preset.choice;
        choice().fps = 2;
        if (choice().camera == Camera::Track)
            choice().track = line("36.30,-84.28\n36.33,-84.24\n36.36,-84.20\n");
        const FilmPlan film = plan();
        ASSERT_EQ(film.frames.shots.size(), static_cast<std::size_t>(2 * choice().duration_s));
        EXPECT_EQ(times_.loaded(film.frames.shots.back().scene), wanted_.dem) << "was read again";
        const std::string message = save_film_job(film.scene, film.film);
        const fs::path job = message.substr(0, message.find(':'));
        const scene::Shots saved = frames_of(job);
        ASSERT_EQ(saved.shots.size(), film.frames.shots.size());
        for (std::size_t i = 0; i < saved.shots.size(); ++i) {
            EXPECT_EQ(saved.shots[i].utc, film.frames.shots[i].utc) << i;
            EXPECT_EQ(scene::scene_line(saved.shots[i].scene),
                      scene::scene_line(film.frames.shots[i].scene))
                << i;
        }
        const scene::Shot &first = saved.shots.front(), &last = saved.shots.back();
        EXPECT_EQ(first.utc == last.utc, choice().time == Time::Still);
        const bool same_view =
            first.scene.view.eye->place.lat_rad == last.scene.view.eye->place.lat_rad;
        EXPECT_EQ(same_view, choice().camera == Camera::Still);
    }
}

TEST_F(Film, AYearHasTheHourOfTheSunsClock) {
    choice() = film_presets()[1].choice;
    const FilmPlan film = plan();
    EXPECT_EQ(film.frames.shots.size(), 360u);
    const sun::Zone solar = sun::Zone::mean_solar(radians(-84.28));
    const sun::CivilTime now = solar.local(wanted_.wish.utc).wall;
    for (const scene::Shot& shot : film.frames.shots) {
        const sun::CivilTime wall = solar.local(shot.utc).wall;
        EXPECT_NEAR(wall.hour * 60 + wall.minute, now.hour * 60 + now.minute, 2);
    }
}

TEST_F(Film, AParameterGoesFromOneValueToAnother) {
    choice() = {.time = Time::Still, .value = "seconds", .from = 1, .to = 4, .duration_s = 0.5};
    const FilmPlan seconds = plan();
    ASSERT_EQ(seconds.frames.shots.size(), 15u);
    EXPECT_EQ(seconds.frames.shots.front().scene.seconds, 1);
    EXPECT_EQ(seconds.frames.shots.back().scene.seconds, 4);
    choice().value = "haze.density";
    choice().from = 0.5;
    choice().to = 0;
    const FilmPlan haze = plan();
    EXPECT_EQ(haze.frames.shots.front().scene.effects.settings.back().text, "0.5");
    EXPECT_EQ(haze.frames.shots.back().scene.effects.settings.back().text, "0");
}

TEST_F(Film, SpeedGivesTheLengthOfAFlightAlone) {
    choice() = {.time = Time::Still, .camera = Camera::Track, .ease = false};
    choice().track = line("36.30,-84.28\n36.33,-84.24\n36.36,-84.20\n");
    choice().speed_m_s = 1000;
    const std::size_t fast = plan().frames.shots.size();
    choice().speed_m_s = 500;
    EXPECT_NEAR(static_cast<double>(plan().frames.shots.size()), 2.0 * static_cast<double>(fast),
                2);
    choice().time = Time::Day;
    EXPECT_EQ(plan().frames.shots.size(), 300u) << "as long as the day";
}

TEST_F(Film, MistakesAreToldBeforeAnythingIsDrawn) {
    choice().time = Time::Still;
    EXPECT_THAT(error(), HasSubstr("nothing moves"));
    choice().camera = Camera::Views;
    EXPECT_THAT(error(), HasSubstr("two saved views or more, this DEM has none"));
    wanted_.wish.views = {scene_.view};
    EXPECT_THAT(error(), HasSubstr("this DEM has one"));
    wanted_.wish.views = {scene_.view, scene_.view};
    EXPECT_THAT(error(), HasSubstr("flight: expected"));
    choice().camera = Camera::Track;
    EXPECT_THAT(error(), HasSubstr("needs its file"));
    choice().track = line("36.30,-84.28\n");
    EXPECT_THAT(error(), HasSubstr("line.csv: a line of 1 point"));
    choice().track = "/missing.gpx";
    EXPECT_THAT(error(), HasSubstr("/missing.gpx"));
    choice() = {};
    choice().duration_s = 3600;
    choice().fps = 240;
    EXPECT_THAT(error(), HasSubstr("at most 20000 frames but got 864000"));
    choice() = {};
    wanted_.wish.file.size_px = {641, 360};
    EXPECT_THAT(error(), HasSubstr("even width and height"));
    wanted_.wish.file = {};
    wanted_.wish.file.name = "{depth}";
    EXPECT_THAT(error(), HasSubstr("depth"));
    EXPECT_TRUE(fs::is_empty(folder_) || !fs::exists(folder_ / "jacksboro_film.mp4"));
}

TEST_F(Film, WhereTheSunDoesNotSetTheDayIsWhole) {
    wanted_.wish.zone = sun::Zone::named("Asia/Tokyo");  // whose day ends before its sunset
    const FilmPlan film = plan();
    EXPECT_THAT(film.note, HasSubstr("shows the whole day"));
    EXPECT_EQ(film.film.day->from, "00:00");
}

TEST_F(Film, ItsCommandMakesTheSameJob) {
    wanted_.wish.file.size_px = {64, 48};
    for (std::size_t i = 0; i < film_presets().size(); ++i) {
        choice() = film_presets()[i].choice;
        if (choice().camera == Camera::Views) continue;  // it has no command
        SCOPED_TRACE(film_presets()[i].name);
        choice().fps = 4;
        choice().duration_s = 2;
        choice().ease = choice().camera != Camera::Still && !choice().ease;
        if (choice().camera == Camera::Still) {
            choice().value = "seconds";
        }
        if (choice().camera == Camera::Track)
            choice().track = line("36.30,-84.28\n36.33,-84.24\n36.36,-84.20\n");
        const FilmPlan film = plan();
        const std::string command = film_command(film.scene, film.film);
        ASSERT_TRUE(command.starts_with("relevo ")) << command;
        const std::string shell = fmt::format(
            "{} -q {} --save-job again.json --overwrite --dry-run --device software > said.txt "
            "2>&1",
            (test::build_dir() / "bin/relevo").string(), command.substr(7));
        ASSERT_EQ(std::system(shell.c_str()), 0) << command << "\n"
                                                 << read_text("said.txt", "test");
        const scene::Shots again = frames_of(folder_ / "again.json");
        ASSERT_EQ(again.shots.size(), film.frames.shots.size()) << command;
        for (std::size_t k = 0; k < again.shots.size(); ++k) {
            const scene::Shot &a = again.shots[k], &b = film.frames.shots[k];
            EXPECT_NEAR(a.utc - b.utc, 0, 1e-3) << k;
            EXPECT_EQ(a.scene.seconds, b.scene.seconds) << k;
            const geo::Geodetic &p = a.scene.view.eye->place, &q = b.scene.view.eye->place;
            EXPECT_NEAR(degrees(p.lat_rad - q.lat_rad), 0, 1e-6) << k;
            EXPECT_NEAR(degrees(p.lon_rad - q.lon_rad), 0, 1e-6) << k;
            EXPECT_NEAR(p.height_m - q.height_m, 0, 0.1) << k;
        }
    }
}

TEST_F(Film, PreviewLeavesTheDocumentAsItWas) {
    choice() = {.value = "haze.density", .from = 0, .to = 0.4};
    const FilmPlan film = plan();
    State state;
    state.document.scene = scene_;
    state.document.utc = wanted_.wish.utc;
    state.document.zone = wanted_.wish.zone;
    state.document.overlay = {.kind = OverlayKind::Hours, .opacity = 0.5};
    const std::string before = scene::scene_line(state.document.scene);
    FilmPreview preview(state);
    preview.begin();
    preview.show(film.frames.shots[100], {.heading_deg = 12});
    EXPECT_EQ(state.document.utc, film.frames.shots[100].utc);
    EXPECT_EQ(state.document.pose.heading_deg, 12);
    EXPECT_EQ(state.document.overlay, OverlayChoice()) << "it is in no file, so not in the film";
    EXPECT_EQ(state.document.scene.effects, film.frames.shots[100].scene.effects);
    EXPECT_NE(scene::scene_line(state.document.scene), before);
    preview.show(film.frames.shots[101], {});
    preview.end();
    EXPECT_EQ(scene::scene_line(state.document.scene), before);
    EXPECT_EQ(state.document.utc, wanted_.wish.utc);
    EXPECT_EQ(state.document.pose.heading_deg, 0);
    EXPECT_EQ(state.document.overlay, (OverlayChoice{.kind = OverlayKind::Hours, .opacity = 0.5}));
    EXPECT_FALSE(state.step);
}

/// Waits for a film. @returns what it reports
std::string result_of(const FilmExport& film) {
    while (!film.is_done())
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return film.result();
}

TEST_F(Film, IsDrawnIntoTheWorkingFolder) {
    choice().duration_s = 0.2;
    wanted_.wish.file.size_px = {64, 48};
    const auto film = std::make_shared<const FilmPlan>(plan());
    FilmExport drawing(film, "software", [] {});
    EXPECT_EQ(result_of(drawing), "jacksboro_film.mp4: film saved in " +
                                      fs::current_path().string() + ", 6 frames, 0.2 s");
    EXPECT_EQ(drawing.drawn(), 6u);
    EXPECT_TRUE(fs::exists("jacksboro_film.mp4"));
    FilmExport again(film, "software", [] {});
    EXPECT_THROW(result_of(again), Error) << "the file is there by now, and stays";
}

TEST_F(Film, CancelledLeavesNothing) {
    choice().duration_s = 60;
    wanted_.wish.file.size_px = {64, 48};
    FilmExport drawing(std::make_shared<const FilmPlan>(plan()), "software", [] {});
    while (drawing.drawn() < 3)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    drawing.cancel();
    EXPECT_EQ(result_of(drawing), "jacksboro_film.mp4: cancelled, there is no film");
    EXPECT_LT(drawing.drawn(), 1800u);
    EXPECT_TRUE(fs::is_empty(folder_));
}

TEST(WidgetRows, FieldsThatBeginARowAreBelowEachOther) {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {800, 600};
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsAlpha8(&pixels, &width, &height);
    ImGui::NewFrame();
    ImGui::SetNextWindowSize({330, 400});
    ImGui::Begin("rows");
    std::vector<float> first;
    WidgetRows rows;
    float y = -1;
    for (const char* label : {"Film", "Time", "Length", "Above ground", "Camera", "Look ahead"}) {
        rows.next(label, 8);
        const ImVec2 at = ImGui::GetCursorPos();
        if (at.y > y) first.push_back(at.x);
        y = at.y;
        ImGui::Button(label, {ImGui::CalcItemWidth(), 0});
    }
    ImGui::End();
    ImGui::EndFrame();
    ImGui::DestroyContext();
    EXPECT_GE(first.size(), 3U);
    EXPECT_EQ(std::ranges::count(first, first.front()), static_cast<int>(first.size()));
}

}  // namespace
}  // namespace relevo::viewer::test_film_plan
