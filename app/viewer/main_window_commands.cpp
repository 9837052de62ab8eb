#include <cmath>
#include <utility>

#include "base/text.h"
#include "viewer/main_window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include "viewer/export.h"

namespace relevo::viewer {
namespace {

/// What comes after so long is another step of undo.
constexpr double kStep_s = 0.5;

}  // namespace

void MainWindow::take_hand(double passed_s) {
    hand_->act(passed_s, before_ != nullptr, std::exchange(input_is_new_, false));
    if (hand_->has_moved()) moved();
    const std::optional<glm::dvec3> clicked = hand_->take_click();
    Measurement& line = state_.measurement;
    if (clicked && !std::exchange(line.follows_cursor, false)) choose_point(*clicked);
    if (line.follows_cursor && state_.cursor) line.follow(state_.cursor->point_m, state_.land);
}

void MainWindow::choose_point(const glm::dvec3& point_m) {
    geo::Geodetic place = state_.land.frame->to_geodetic(point_m);
    place.height_m = state_.land.height_m(place);
    if (std::isnan(place.height_m)) return;
    state_.measurement.start(point_m);
    state_.chosen = place;
    asked_point_.reset();
}

void MainWindow::keys() {
    for (const KeyPress& press : window_->take_keys()) {
        busy_frames_ = 3;
        if (const auto command = command_of(press))
            state_.commands.push_back(*command);
        else if (!press.control && press.key >= GLFW_KEY_1 && press.key <= GLFW_KEY_9)
            state_.view_to_go_to = static_cast<std::size_t>(press.key - GLFW_KEY_1);
    }
    for (const Command command : std::exchange(state_.commands, {}))
        if (!of_program(command) && is_open()) of_scene(command);
    if (state_.view_to_go_to && is_open()) go_to_view(*state_.view_to_go_to);
    state_.view_to_go_to.reset();
    const std::string place = std::exchange(state_.place_to_go_to, {});
    if (!place.empty() && is_open()) say_or_fail([&] { go_to_place(place); });
    if (std::exchange(state_.views_changed, false)) remember_views();
}

bool MainWindow::of_program(Command command) {
    switch (command) {
        case Command::Open:
            ask_for_dem();
            return true;
        case Command::NextFile:
            open_neighbour(1);
            return true;
        case Command::PreviousFile:
            open_neighbour(-1);
            return true;
        case Command::Quit:
            window_->close();
            return true;
        case Command::Panels:
            state_.settings.panels = !state_.settings.panels;
            return true;
        case Command::Charts:
            state_.settings.charts = !state_.settings.charts;
            return true;
        case Command::Keys:
            sheet_ = !sheet_;
            return true;
        case Command::CloseKeys:
            if (!is_open() && !has_failed_ && !has_gone_back_ && last_good_) {
                give_up_opening();
                return true;
            }
            sheet_ = state_.measurement.follows_cursor = false;
            open_panel_.close();
            closes_menus_ = true;
            state_.message.clear();
            return true;
        default:
            return false;
    }
}

void MainWindow::of_scene(Command command) {
    switch (command) {
        case Command::ReadAgain:
            return read_again();
        case Command::TakePicture:
            return take_picture();
        case Command::CopyCommand:
            return copy_command();
        case Command::SaveScene:
            return say_or_fail([&] { done(save_scene(whole()) + overlay_note()); });
        case Command::SaveJob:
            return say_or_fail([&] {
                done(save_job(whole(), state_.day, state_.document.zone) + overlay_note());
            });
        case Command::SaveView:
            return keep_view();
        case Command::Measure:
            return measure();
        case Command::Compare:
            state_.compare_is_wanted = !state_.compare_is_wanted;
            return;
        case Command::Overlay: {
            OverlayKind& kind = state_.document.overlay.kind;
            kind = kind == OverlayKind::Day ? OverlayKind::None : OverlayKind::Day;
            state_.step = true;
            return;
        }
        case Command::SaveOverlay:
            return save_overlay();
        case Command::GiveUpSaving:
            return give_up_saving();
        case Command::Play:
            state_.playing = !state_.playing;
            return;
        case Command::Undo:
            history_.end_step(state_.document);
            history_.can_undo() ? go_to(history_.undo()) : tell("nothing to undo");
            return;
        case Command::Redo:
            history_.can_redo() ? go_to(history_.redo()) : tell("nothing to redo");
            return;
        default:
            move(command);
    }
}

void MainWindow::move(Command command) {
    constexpr double kHour_s = 3600, kDay_s = 86400;
    history_.end_step(state_.document);
    const auto by = [&](double seconds) { state_.set_utc(state_.document.utc + seconds); };
    if (command == Command::Earlier)
        by(-kHour_s / 2);
    else if (command == Command::Later)
        by(kHour_s / 2);
    else if (command == Command::DayEarlier)
        by(-kDay_s);
    else if (command == Command::DayLater)
        by(kDay_s);
    else if (!hand_->move(command, [this] { return whole_views(); }))
        return;
    if (command == Command::Walk)
        tell(hand_->is_walking()
                 ? "walking at eye height: W A S D, faster with Shift; G flies again"
                 : "flying: W A S D, Q down and E up, faster with Shift");
    moved();
    state_.step = true;
}

void MainWindow::measure() {
    Measurement& line = state_.measurement;
    if (!state_.cursor && !line.follows_cursor) return;
    line.follows_cursor = !line.follows_cursor;
    if (line.follows_cursor && line.ends_m.empty()) line.start(state_.cursor->point_m);
}

void MainWindow::go_to(const Document& document) {
    hand_->rest();
    state_.restore(document);
    moved();
}

void MainWindow::keep_view() {
    const SavedView view =
        saved_view(state_.document, state_.land, fmt::format("View {}", state_.views.size() + 1));
    state_.views.push_back(view);
    tell(state_.views.size() < 10
             ? fmt::format("saved as {}; key {} goes to it", view.name, state_.views.size())
             : fmt::format("saved as {}, in the menu View", view.name));
    remember_views();
}

void MainWindow::go_to_view(std::size_t i) {
    if (i >= state_.views.size()) {
        tell(fmt::format("this DEM has no saved view {}; B saves one", i + 1));
        return;
    }
    const SavedView& view = state_.views[i];
    history_.end_step(state_.document);
    hand_->rest();
    state_.document.pose = pose_of(view, state_.land);
    state_.set_utc(view.utc);
    moved();
    state_.step = true;
}

void MainWindow::go_to_place(const std::string& text) {
    std::string bare = text;  // maps write a space after the comma
    std::erase(bare, ' ');
    geo::Geodetic place = geo::parse_place(bare, "view").place;
    place.height_m = state_.land.height_m(place);
    if (std::isnan(place.height_m)) return tell("the DEM has no ground at " + printable(text));
    history_.end_step(state_.document);
    hand_->rest();
    geo::Geodetic drawn = place;
    drawn.height_m = state_.land.ground_under(state_.land.frame->to_local(place));
    const glm::dvec3 point_m = state_.land.frame->to_local(drawn);
    // Near enough for single posts to be seen.
    constexpr double kPosts = 150;
    Pose& pose = state_.document.pose;
    pose = look_at(pose, state_.land, point_m,
                   std::min(distance(pose.eye_m, point_m), kPosts * state_.spacing_m));
    choose_point(point_m);
    moved();
    state_.step = true;
}

void MainWindow::step_at_rest() {
    if (is_open() && seconds_since(moved_at_) > kStep_s && !hand_->is_busy() && !state_.playing)
        history_.end_step(state_.document);
}

}  // namespace relevo::viewer
