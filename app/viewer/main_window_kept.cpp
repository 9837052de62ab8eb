#include <algorithm>
#include <utility>

#include "viewer/export.h"
#include "viewer/main_window.h"

namespace relevo::viewer {
namespace {

/// What was done is told of for so long.
constexpr double kTold_s = 8;

}  // namespace

void MainWindow::remember_views() {
    if (opened_)
        say_or_fail(
            [&] { memory_.write_views(absolute_names(opened_->scene.dems), state_.views); });
}

void MainWindow::restyle() {
    const Settings& now = state_.settings;
    const bool has_new_letters = wants_new_letters();
    if (!has_new_letters && now.light_style == styled_.light_style &&
        now.text_px == styled_.text_px)
        return;
    styled_ = now;
    window_->set_style(now.light_style, now.text_px);
    busy_frames_ = 3;
}

bool MainWindow::wants_new_letters() {
    bool any = window_->want_letters(state_.message);
    const auto want = [&](const std::string& text) { any = window_->want_letters(text) || any; };
    for (const std::string& dem : state_.document.scene.dems)
        want(dem);
    if (state_.document.scene.overlay) want(state_.document.scene.overlay->file);
    for (const RecentDem& dem : state_.recent)
        want(dem.files.front());
    for (const SavedView& view : state_.views)
        want(view.name);
    if (!state_.effects || lettered_ == state_.effects.get()) return any;
    lettered_ = state_.effects.get();
    for (const effect::Effect& effect : state_.effects->registry.effects()) {
        want(effect.manifest.name + effect.manifest.description);
        for (const shader::Param& param : effect.params()) {
            want(param.label + param.description + param.unit);
            for (const std::string& word : param.words)
                want(word);
        }
    }
    return any;
}

void MainWindow::remember_settings() {
    if (state_.settings == written_) return;
    written_ = state_.settings;
    remember([&] { memory_.write(written_); });
}

scene::Scene MainWindow::whole() const {
    scene::Scene scene = whole_scene(state_.document, state_.land, window_->size_px());
    put_overlay(scene);
    return scene;
}

void MainWindow::copy_command() {
    window_->copy(capture_command(whole(), free_picture_name()));
    tell("the command for this picture is on the clipboard" + overlay_note());
}

bool MainWindow::is_answered() const {
    return picture_ && picture_->sharp && picture_->answers == scene_->wants() && wanted_ &&
           same(*wanted_, wanted_now()) && overlay_rests();
}

std::vector<chart::Legend> MainWindow::legends() const {
    std::vector<chart::Legend> all = picture_->legends;
    if (state_.overlay && state_.overlay->error.empty())
        all.insert(all.begin(), session::dated_legend(state_.overlay->overlay, whole().moment.zone,
                                                      opened_->ground.frame.origin()));
    return all;
}

void MainWindow::take_picture() {
    takes_when_sharp_ = !is_answered();
    if (takes_when_sharp_) return;
    busy_frames_ = std::max(busy_frames_, 2);  // what is told of it is to be seen
    say_or_fail([&] {
        std::string note = overlay_note();
        if (!note.empty()) note = "; its scene is" + note.substr(1);
        const bool laid = state_.overlay && state_.overlay->error.empty();
        done(save_picture(*picture_, whole(), *opened_,
                          {legends(), laid ? state_.overlay->overlay.time : std::nullopt}) +
             note);
    });
}

void MainWindow::tell(std::string what) {
    state_.message = told_ = std::move(what);
    told_at_ = Clock::now();
}

void MainWindow::done(std::string what) {
    log::info(what);
    tell(std::move(what));
}

void MainWindow::end_message() {
    if (told_.empty() || seconds_since(told_at_) < kTold_s) return;
    if (state_.message == told_) {
        state_.message.clear();
        busy_frames_ = 2;
    }
    told_.clear();
}

}  // namespace relevo::viewer
