// The film of the window, and what keeps its preview from changing the scene.
#include <algorithm>

#include "viewer/main_window.h"

namespace relevo::viewer {
namespace {

/// Whether a command leaves the displayed scene as it is.
bool only_looks(Command command) {
    switch (command) {
        case Command::TakePicture:
        case Command::CopyCommand:
        case Command::SaveScene:
        case Command::EndMeasuring:
        case Command::DropCorner:
        case Command::Film:
        case Command::Play:  // of the film
            return true;
        default:
            return false;
    }
}

}  // namespace

std::unique_ptr<FilmController> MainWindow::make_film() {
    return std::make_unique<FilmController>(
        state_, messages_, device_name_,
        FilmSource{.scene =
                       [this](const Document& document, bool is_centred, double aspect) {
                           return saver_->scene_for(document, is_centred, aspect);
                       },
                   .pose_of = [this](const scene::View& view) { return moves_->pose_in(view); },
                   .missing_overlay = [this] { return overlay_->missing_note(); }});
}

bool MainWindow::ends() {
    if (!window_->should_close() && !quits_) return false;
    if (quits_ || !film_->draws_film() || film_->asks_to_quit()) return true;
    window_->keep_open();
    film_->ask_to_quit();
    pacing_.need_frames(3);
    return false;
}

void MainWindow::process_film(double passed_s) {
    if (film_->shows_frame() && (hand_->is_busy() || hand_->has_moved())) {
        hand_->rest();
        film_->end_preview();
        pacing_.moved();
        return;
    }
    if (!film_->advance(passed_s)) return;
    state_.playing = false;
    state_.sun_moves = true;
    pacing_.moved();
    pacing_.need_frames(2);
}

void MainWindow::end_film_preview(Command before) {
    if (!film_->shows_frame() || only_looks(before)) return;
    film_->end_preview();
    pacing_.moved();
}

void MainWindow::draw_film() {
    constexpr float kBeside_px = 10;
    film_->draw(size(), state_.layout.picture.at.x + kBeside_px, size().x - kBeside_px);
}

}  // namespace relevo::viewer
