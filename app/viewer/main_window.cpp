#include "viewer/main_window.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include <imgui.h>

#include "viewer/overlay.h"

namespace relevo::viewer {
namespace {

/// At the end work in progress is waited for so long; reading a large DEM may take longer.
constexpr auto kLeave = std::chrono::milliseconds(600);
/// While the hand moves the camera and no new picture has come, the window is drawn so often; each
/// time takes from the scene what it could be drawn with.
constexpr double kSame_s = 0.08;

}  // namespace

MainWindow::MainWindow(const scene::Scene& scene, std::string device)
    : device_(std::move(device)), zone_(scene.moment.zone) {
    state_.document.scene = scene;
    if (scene.overlay) state_.document.overlay = {OverlayKind::File, scene.overlay->opacity};
    Window::check_display();
    // The scene opens beside the window.
    scene_ = std::make_unique<SceneThread>(scene, device_, &Window::wake);
    window_ = std::make_unique<Window>("Relevo");
    hand_ = std::make_unique<Hand>(*window_, state_);
    point_work_ = std::make_unique<PointWork>(&Window::wake);
    overlay_work_ = std::make_unique<OverlayWork>(&Window::wake);
    state_.effects = EffectsModel::of(scene.effects);
    state_.settings = written_ = memory_.settings();
    state_.recent = memory_.recent();
    window_->set_style(state_.settings.light_style, state_.settings.text_px);
    want_size();
}

void MainWindow::run() {
    while (!window_->should_close()) {
        const double most_s = waiting_s();
        const auto waits_from = Clock::now();
        window_->wait(most_s);
        // Panels take in a frame what has come before it, and show it in the next.
        const bool input = most_s >= kWatch_s && seconds_since(waits_from) < most_s;
        if (window_->take_input() || input) busy_frames_ = std::max(busy_frames_, 3);
        const double passed_s = seconds_since(frame_at_);
        frame_at_ = Clock::now();
        read_thread();
        keys();
        if (is_open()) {
            take_hand(std::min(passed_s, 0.1));
            pass_time(std::min(passed_s, 0.5));
            want_view();  // before the panels are drawn, which takes its time too
        }
        open_files();
        watch_files();
        step_at_rest();
        if (most_s >= kWatch_s && busy_frames_ == 0) continue;
        if (shows_the_same()) continue;
        draw_window();
        state_.take_effects(/*is_step=*/true);
        hand_over();
        restyle();
    }
    leave();
}

bool MainWindow::is_drawing() const {
    return is_open() && rested_ && !scene_->rests() && seconds_since(moved_at_) > 2 * kRest_s;
}

void MainWindow::leave() {
    window_->hide();
    remember_settings();
    discard_.take(std::move(before_));
    discard_.take(std::move(scene_));
    discard_.take(std::move(point_work_));
    discard_.take(std::move(overlay_work_));
    discard_.take(std::move(overlay_save_));
    // Nothing is being written by then, and the rest is the system's to take back.
    if (!discard_.ends_within(kLeave)) std::_Exit(EXIT_SUCCESS);
}

bool MainWindow::shows_the_same() const {
    const bool is_of_the_scene =
        is_open() && (hand_->is_busy() || state_.playing) && !ImGui::GetIO().WantCaptureMouse;
    return is_of_the_scene && !has_new_picture_ && window_->buttons() == drawn_buttons_ &&
           seconds_since(drawn_at_) < kSame_s;
}

void MainWindow::draw_window() {
    drawn_at_ = Clock::now();
    drawn_buttons_ = window_->buttons();
    has_new_picture_ = false;
    window_->draw([&] { panels(); });
    input_is_new_ = true;
}

double MainWindow::waiting_s() const {
    if (busy_frames_ > 0 || state_.playing || hand_->is_moving()) return 0.008;
    if (!rested_) return 0.05;
    return is_drawing() ? 0.25 : kWatch_s;
}

void MainWindow::read_point_work() {
    const std::shared_ptr<const PointLight> answer = point_work_->answer();
    state_.point_in_work = !point_work_->is_done();
    if (answer == state_.point) return;
    // Drawings of the day before stay until there are others.
    state_.point = answer;
    busy_frames_ = std::max(busy_frames_, 2);
}

void MainWindow::moved() {
    // The scene has the processors for its first picture of the new view.
    if (rested_) drawn_at_ = Clock::now();
    moved_at_ = Clock::now();
    rested_ = false;
}

void MainWindow::follow_the_day() {
    if (!state_.chosen || stands_in()) return;
    const bool same = asked_point_ && asked_point_->date == state_.day.date &&
                      asked_point_->chart_px == state_.chart_px &&
                      asked_point_->px_a_unit == unit();
    if (same) return;
    PointWanted wanted;
    wanted.dem = opened_->dem;
    wanted.dems = opened_->scene.dems;
    wanted.options = opened_->scene.dem;
    wanted.refraction = opened_->scene.refraction;
    wanted.place = *state_.chosen;
    wanted.date = state_.day.date;
    wanted.zone = state_.document.zone;
    wanted.chart_px = state_.chart_px;
    wanted.px_a_unit = unit();
    asked_point_ = wanted;
    point_work_->want(std::move(wanted));
}

void MainWindow::pass_time(double passed_s) {
    if (!state_.playing) return;
    state_.set_utc(state_.document.utc + passed_s * state_.hours_a_second * 3600);
    state_.sun_moves = true;
}

double MainWindow::unit() const {
    return window_->scale() * state_.settings.text_px / kUsualText_px;
}

void MainWindow::panels() {
    // No focus on any of them: menus close.
    if (std::exchange(closes_menus_, false)) ImGui::SetWindowFocus(nullptr);
    if (!is_open()) {
        if (state_.settings.panels) menu_bar(state_);
        waiting_text(state_, has_failed_, last_good_.has_value());
        return;
    }
    if (picture_) {
        draw_sun_path(state_, *picture_, size());
        draw_measurement(state_.measurement, *picture_, size());
        const float top = state_.settings.panels ? ImGui::GetFrameHeight() : 0;
        draw_scale_and_north(*picture_, state_.land, hand_->ground_at(0.5f * size()), size(), top);
        legend_.draw(legends(), size(), top, unit());
        if (before_) draw_sides(window_->line() * size().x, top);
    }
    if (state_.settings.panels) {
        menu_bar(state_);
        side_panel(state_, size(), unit());
        charts_.draw(state_, size(), unit());
    }
    open_panel_.draw(size());
    status_line(state_, is_drawing());
    message_box(state_, size(), unit());
    if (sheet_) key_sheet();
}

void MainWindow::want_view() {
    if (state_.sun_moves) moved();
    rested_ = seconds_since(moved_at_) > kRest_s;
    const Wanted wanted = wanted_now();
    if (!(wanted_ && same(*wanted_, wanted))) {
        scene_->want(wanted);
        if (before_) before_->want(wanted);
    }
    wanted_ = wanted;
}

void MainWindow::hand_over() {
    if (busy_frames_ > 0) --busy_frames_;
    if (is_open()) hand_over_scene();
    sun_moved_ = state_.sun_moves;
    state_.step = state_.sun_moves = false;
    state_.new_effects.reset();
    state_.new_values.clear();
}

void MainWindow::hand_over_scene() {
    want_view();
    if (state_.new_effects) scene_->want_effects(*state_.new_effects);
    for (const auto& [address, value] : state_.new_values)
        scene_->want_value(address, value);
    if (state_.step) {
        history_.add(state_.document);
        busy_frames_ = 2;
    }
    follow_the_day();
    follow_overlay();
    if (state_.compare_is_wanted && !before_) compare();
    if (!state_.compare_is_wanted && before_) stop_comparing();
    if (takes_when_sharp_ && is_answered()) take_picture();
}

Wanted MainWindow::wanted_now() const {
    const glm::ivec2 size = window_->size_px();
    Wanted wanted;
    wanted.view = view_of(state_.document.pose, state_.land);
    wanted.keep_above_m = hand_->is_walking() ? kWalk_m : kClearance_m;
    wanted.utc = state_.document.utc;
    wanted.width_px = size.x;
    wanted.height_px = size.y;
    wanted.moving = !rested_;
    wanted.sun_moving = !rested_ && (state_.sun_moves || sun_moved_);
    return wanted;
}

bool MainWindow::same(const Wanted& a, const Wanted& b) {
    return a.keep_above_m == b.keep_above_m && a.utc == b.utc && a.width_px == b.width_px &&
           a.height_px == b.height_px && a.moving == b.moving && a.sun_moving == b.sun_moving &&
           a.view->heading_deg == b.view->heading_deg && a.view->pitch_deg == b.view->pitch_deg &&
           a.view->fov_y_rad == b.view->fov_y_rad &&
           a.view->eye->place.lat_rad == b.view->eye->place.lat_rad &&
           a.view->eye->place.lon_rad == b.view->eye->place.lon_rad &&
           a.view->eye->place.height_m == b.view->eye->place.height_m;
}

}  // namespace relevo::viewer
