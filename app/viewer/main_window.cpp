#include "viewer/main_window.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include <imgui.h>

#include "viewer/layers.h"
#include "viewer/measurement_panel.h"
#include "viewer/overlay.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

/// The longest wait at the end for work in progress. Reading a large DEM may take longer.
constexpr auto kLeave = std::chrono::milliseconds(600);
/// A pause of this length ends a step of undo.
constexpr double kStep_s = 0.5;

void play(State& state, double passed_s) {
    if (!state.playing) return;
    state.set_utc(state.document.utc + passed_s * state.hours_a_second * 3600);
    state.sun_moves = true;
}

}  // namespace

MainWindow::MainWindow(const scene::Scene& scene, const std::string& device)
    : device_name_(device), device_(device, presentation_of_environment()), zone_(scene.time.zone) {
    state_.document.scene = scene;
    state_.time_is_pinned = !scene.time.at.empty();
    Window::check_display();
    // The scene opens while the window is created.
    opening_ = std::make_unique<Opening>(scene, device_, messages_, discard_);
    try {
        window_ = std::make_unique<Window>("Relevo");
    } catch (...) {
        device_.give_up();
        throw;
    }
    device_.set_window(window_->context());
    hand_ = std::make_unique<Hand>(*window_, state_);
    comparison_ = std::make_unique<Comparison>(device_, *window_, messages_, discard_);
    point_ = std::make_unique<PointQuery>(state_);
    overlay_ = std::make_unique<OverlayController>(state_, messages_, discard_);
    const Parts parts{*window_, state_,  *hand_,    history_, messages_,
                      pacing_,  *point_, *overlay_, *opening_};
    moves_ = std::make_unique<CameraMoves>(parts);
    saver_ = std::make_unique<SceneSaver>(parts, device_name_);
    film_ = make_film();
    opener_ = std::make_unique<FileOpener>(
        parts, *moves_, *film_, [this] { return first_wanted(); }, scene.dem.cached);
    state_.effects = EffectsModel::of(scene.effects);
    state_.settings = written_ = memory_.settings();
    state_.recent = memory_.recent();
    style_ = std::make_unique<WindowStyle>(*window_, state_.settings);
    opening_->thread().want(first_wanted());
}

scene::Scene MainWindow::scene() const {
    return is_open() ? saver_->whole_scene() : state_.document.scene;
}

Clock::duration MainWindow::shown_for() const {
    return first_picture_at_ ? Clock::now() - *first_picture_at_ : Clock::duration::zero();
}

void MainWindow::run() {
    while (!ends()) {
        const bool is_animated = state_.playing || hand_->is_moving() || film_->is_playing();
        const double wait_s = pacing_.wait_s(is_animated, is_drawing() || shows_card());
        const auto waits_from = Clock::now();
        window_->wait(wait_s);
        // Panels process input in one frame and show its result in the next.
        const bool was_woken = wait_s >= kIdle_s && seconds_since(waits_from) < wait_s;
        if (window_->take_input() || was_woken) pacing_.need_frames(3);
        const double passed_s = pacing_.begin_pass();
        state_.layout = layout();
        poll_threads();
        process_keys();
        if (is_open()) {
            process_mouse(std::min(passed_s, 0.1));
            if (!film_->shows_frame()) moves_->fit_home();
            process_film(passed_s);
            play(state_, std::min(passed_s, 0.5));
            want_view();  // early: the scene's thread draws while this one draws the panels
        }
        opener_->open_requested_files();
        if (opening_->is_refused() && !opener_->is_asking()) opening_->throw_refusal();
        check_files();
        if (is_open() && pacing_.still_s() > kStep_s && !hand_->is_busy() && !state_.playing &&
            !film_->shows_frame())
            history_.end_step(state_.document);
        const bool is_idle = wait_s >= kIdle_s && !pacing_.needs_frames();
        if (is_idle || repeats_frame()) continue;
        draw_window();
        state_.take_effects(/*is_step=*/true);
        hand_over();
        if (style_->update(state_)) pacing_.need_frames(3);
    }
    leave();
}

bool MainWindow::shows_card() const {
    return !picture_ && !opening_->is_refused() && !opening_->thread().rests();
}

bool MainWindow::is_drawing() const {
    return is_open() && pacing_.is_overdue() && !opening_->thread().rests();
}

void MainWindow::leave() {
    window_->hide();
    remember_settings();
    if (saver_->is_exporting()) log::info("view: the ordered picture is drawn before the end");
    saver_->finish();
    film_.reset();  // ends a film without a file
    discard_.take(std::move(comparison_));
    discard_.take(std::move(opening_));
    discard_.take(std::move(point_));
    discard_.take(std::move(outside_));
    discard_.take(std::move(overlay_));
    discard_.take(std::move(moves_));  // it may look for a time
    // No file is being written by now, and the system frees everything else.
    if (!discard_.ends_within(kLeave)) std::_Exit(EXIT_SUCCESS);
}

bool MainWindow::repeats_frame() const {
    const bool moves_scene = is_open() &&
                             (hand_->is_busy() || state_.playing || film_->is_playing()) &&
                             !ImGui::GetIO().WantCaptureMouse;
    return moves_scene && pacing_.repeats_frame(window_->buttons());
}

void MainWindow::draw_window() {
    pacing_.begin_frame(window_->buttons());
    window_->draw([&] { draw_panels(); });
    has_new_input_ = true;
}

double MainWindow::unit() const {
    return window_->scale() * state_.settings.text_px / kUsualText_px;
}

Layout MainWindow::layout() const {
    const bool has_charts = state_.settings.charts && state_.chosen;
    return lay_out(size(), static_cast<float>(unit()), state_.settings,
                   film_->is_open() ? Lower::Film
                   : has_charts     ? Lower::Charts
                                    : Lower::Bar);
}

scene::Insets MainWindow::panel_insets() const {
    return layout().insets(size());
}

glm::vec2 MainWindow::free_middle() const {
    const Area picture = layout().picture;
    return picture.at + 0.5f * picture.size;
}

void MainWindow::draw_panels() {
    // Menus close if no window has the focus.
    if (std::exchange(closes_menus_, false)) ImGui::SetWindowFocus(nullptr);
    state_.layout = layout();
    if (!picture_) draw_no_picture();
    if (shows_card()) opening_card(state_, opening_->scene(), seconds_since(began_at_));
    if (!is_open()) {
        if (state_.settings.panels) menu_bar(state_);
        opener_->draw(size());
        return;
    }
    if (picture_) draw_over_image();
    film_->draw_edges(size());
    // A film's frame is no change of the user's.
    state_.undo_name = history_.undo_name(film_->shows_frame() ? nullptr : &state_.document);
    state_.redo_name = history_.redo_name();
    if (state_.settings.panels) {
        menu_bar(state_);
        draw_film();
        if (!film_->shows_frame()) side_panel(state_, size(), unit());
        // The film panel takes the place of charts and time bar.
        if (!film_->is_open()) {
            charts_.draw(state_, unit());
            time_bar(state_);
        }
    }
    if (const auto to = std::exchange(gives_keys_, std::nullopt))
        window_->give_keys_to(*to == Command::MenuKeys ? nullptr
                              : film_->is_open()       ? tr_label("Film")
                                                       : "Relevo");
    if (film_->draw_question(size())) quits_ = true;
    point_menu(state_, std::exchange(opens_point_menu_, false));
    opener_->draw(size());
    find_sheet_.draw(size(), state_, opening_->opened()->dem->field.grid);
    if (!film_->shows_frame()) saver_->draw_sheet();
    status_line(state_, work_in_progress());
    // The export sheet shows the message itself.
    if (!saver_->sheet().is_open()) message_box(state_, unit());
    if (sheet_) help_sheet(*sheet_, window_->context().info().renderer);
}

std::string MainWindow::work_in_progress() const {
    if (opening_->is_opening())
        return tr_format("opening {} ...   Esc cancels", short_name(opening_->next_scene().dems));
    if (const std::string film = film_->progress(); !film.empty()) return film;
    if (const std::string picture = saver_->progress(); !picture.empty()) return picture;
    if (moves_->looks_for_time()) return tr("looking for the time ...");
    return is_drawing() ? tr("drawing ...") : "";
}

void MainWindow::draw_over_image() {
    const std::shared_ptr<const Picture>& before = comparison_->image();
    const float line = before ? window_->line() : 0;
    const Area& free = state_.layout.picture;
    legend_.update(overlay_->coloured(*picture_).legends, free, unit());
    std::vector<chart::Rect> taken = legend_.places();
    taken.push_back(north_place(free));
    if (before) marks_before_.draw(before, window_->size_px(), 0, line, size(), taken);
    marks_.draw(picture_, window_->size_px(), line, 1, size(), taken);
    if (!film_->shows_frame()) draw_sun_path(state_, *picture_, size());
    draw_measurement(state_.measurement, *picture_, size());
    draw_scale_and_north(*picture_, state_.land, hand_->ground_at(free_middle()), size(), free);
    legend_.draw();
    if (comparison_->thread()) draw_sides(window_->line() * size().x, free.at.y);
}

void MainWindow::hand_over() {
    pacing_.end_frame();
    if (is_open()) hand_over_scene();
    sun_moved_ = state_.sun_moves;
    state_.step = state_.sun_moves = false;
}

void MainWindow::hand_over_scene() {
    const Opened& opened = *opening_->opened();
    const scene::Scene& scene = state_.document.scene;
    state_.is_outside =
        scene.backdrop != scene::Backdrop::Horizon &&
        render::is_outside(opened.ground, state_.document.pose.eye_m, scene.exaggeration);
    show_true_heights();
    if (state_.step && !film_->shows_frame()) {
        history_.add(state_.document);
        pacing_.need_frames(2);
    }
    if (film_->update(opened, pacing_.is_at_rest())) pacing_.need_frames(2);
    if (!film_->shows_frame()) point_->update(opened, unit());
    if (film_->shows_frame())
        overlay_->show_frame();
    else if (overlay_->update(opened))
        pacing_.need_frames(2);
    find_files_outside(opened);
    want_view();
    if (state_.compare_is_wanted && !comparison_->thread()) {
        window_->set_line(free_middle().x / size().x);
        comparison_->start(saver_->whole_scene(), opened, wanted_now());
    }
    if (!state_.compare_is_wanted && comparison_->thread()) stop_comparison();
    saver_->poll(saver_->awaits_image() && is_image_complete() ? picture_ : nullptr);
}

void MainWindow::find_files_outside(const Opened& opened) {
    LayerFiles files{opened.dem, files_of_layers(*state_.effects, state_.document)};
    if (files != layer_files_) outside_->want(layer_files_ = std::move(files));
    const std::shared_ptr<const FilesOutside> found = outside_->answer();
    state_.files_outside = found ? found->files : std::set<std::string>{};
}

void MainWindow::check_files() {
    if (seconds_since(checked_at_) < kIdle_s) return;
    checked_at_ = Clock::now();
    remember_settings();
    if (messages_.expire()) pacing_.need_frames(2);
    if (!is_open() || opening_->is_opening()) return;
    if (opening_->effects_changed()) reload_effects();
    if (opening_->dem_changed()) reload_dem();
}

void MainWindow::remember_settings() {
    if (state_.settings == written_) return;
    written_ = state_.settings;
    try_or_log([&] { memory_.write(written_); });
}

}  // namespace relevo::viewer
