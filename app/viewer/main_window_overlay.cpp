#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "viewer/export.h"
#include "viewer/main_window.h"

namespace relevo::viewer {
namespace {

/// The verb that writes such a raster.
std::string verb_of(session::SunFigure figure) {
    switch (figure) {
        case session::SunFigure::Shadow:
            return "sun shadow";
        case session::SunFigure::SkyView:
            return "sun sky-view";
        default:
            return "sun hours";
    }
}

}  // namespace

std::optional<OverlayWanted> MainWindow::overlay_wanted() const {
    const Document& document = state_.document;
    const OverlayKind kind = document.overlay.kind;
    if (kind == OverlayKind::None || overlay_waits()) return std::nullopt;
    OverlayWanted wanted;
    wanted.dem = opened_->dem;
    wanted.dems = opened_->scene.dems;
    wanted.options = opened_->scene.dem;
    wanted.opacity = document.overlay.opacity;
    if (kind == OverlayKind::File) {
        if (!document.scene.overlay) return std::nullopt;
        wanted.file = document.scene.overlay;
        wanted.file->opacity = wanted.opacity;
    } else {
        wanted.raster = raster_of(kind, document.utc, document.zone, document.scene.refraction);
        wanted.title = title_of(kind, wanted.raster);
    }
    return wanted;
}

bool MainWindow::overlay_waits() const {
    const OverlayKind kind = state_.document.overlay.kind;
    return stands_in() && kind != OverlayKind::None && kind != OverlayKind::File;
}

void MainWindow::follow_overlay() {
    std::optional<OverlayWanted> wanted = overlay_wanted();
    const bool same = wanted ? asked_overlay_ && same_figures(*asked_overlay_, *wanted) &&
                                   asked_overlay_->opacity == wanted->opacity
                             : !asked_overlay_;
    if (!same) {
        asked_overlay_ = wanted;
        wanted ? overlay_work_->want(std::move(*wanted)) : overlay_work_->forget();
        busy_frames_ = std::max(busy_frames_, 2);
    }
    lay_overlay();
}

void MainWindow::lay_overlay() {
    const std::shared_ptr<const OverlayShown> answer = overlay_work_->answer();
    const bool has_news =
        asked_overlay_ ? answer && answer != state_.overlay : state_.overlay != nullptr;
    if (has_news) {
        state_.overlay = asked_overlay_ ? answer : nullptr;
        scene_->want_drape(state_.overlay ? state_.overlay->overlay.drape : nullptr);
        busy_frames_ = std::max(busy_frames_, 2);
    }
    state_.overlay_progress.reset();
    if (asked_overlay_ && !overlay_work_->is_done())
        state_.overlay_progress = overlay_work_->progress();
    state_.saved_overlay.clear();
    if (const SavedOverlay* const saved = saved_overlay()) state_.saved_overlay = saved->shown_name;
}

bool MainWindow::overlay_rests() const {
    if (overlay_waits() || overlay_wanted().has_value() != asked_overlay_.has_value()) return false;
    return !asked_overlay_ ||
           (overlay_work_->is_done() && state_.overlay == overlay_work_->answer());
}

const MainWindow::SavedOverlay* MainWindow::saved_overlay() const {
    if (!asked_overlay_ || asked_overlay_->file) return nullptr;
    std::error_code ignored;
    for (const SavedOverlay& saved : saved_overlays_)
        if (same_figures(saved.of, *asked_overlay_) && std::filesystem::exists(saved.file, ignored))
            return &saved;
    return nullptr;
}

void MainWindow::save_overlay() {
    saves_when_whole_ = overlay_waits();
    if (saves_when_whole_) return;
    if (!asked_overlay_ || asked_overlay_->file) {
        state_.message = "there is no sun overlay to export; O shows the day's sun hours";
        return;
    }
    if (overlay_save_) {
        state_.message = "an export is running already";
        return;
    }
    const bool is_there = overlay_rests() && state_.overlay->error.empty();
    const bool fits = opened_->dem->field.reduction == 1;
    if (fits && !is_there) {
        saves_when_whole_ = true;
        return;
    }
    overlay_save_ = std::make_unique<OverlaySave>(
        *asked_overlay_, fits ? state_.overlay->raster : nullptr, &Window::wake);
}

void MainWindow::watch_saving() {
    if (saves_when_whole_ && overlay_rests()) {
        if (state_.overlay && state_.overlay->error.empty())
            save_overlay();
        else
            saves_when_whole_ = false;
    }
    state_.saving_progress.reset();
    if (saves_when_whole_) state_.saving_progress = 0;
    if (!overlay_save_) return;
    state_.saving_progress = overlay_save_->progress();
    if (!overlay_save_->is_done()) return;
    say_or_fail([&] {
        const std::string name = overlay_save_->result();
        const OverlayWanted& of = overlay_save_->wanted();
        saved_overlays_.push_back({of, absolute_names({name}).front(), name});
        done(fmt::format("{}: {}, as written by relevo {}; scenes and commands include it",
                         absolute_names({name}).front(), of.title, verb_of(of.raster.figure)));
    });
    overlay_save_.reset();
    state_.saving_progress.reset();
    busy_frames_ = 3;
}

void MainWindow::give_up_saving() {
    saves_when_whole_ = false;
    if (overlay_save_) tell("export cancelled; no file was written");
    discard_.take(std::move(overlay_save_));
}

void MainWindow::put_overlay(scene::Scene& scene) const {
    const OverlayChoice& choice = state_.document.overlay;
    if (choice.kind == OverlayKind::File) {
        if (scene.overlay) scene.overlay->opacity = choice.opacity;
        return;
    }
    scene.overlay.reset();
    if (const SavedOverlay* const saved = saved_overlay()) {
        scene.overlay = scene::Overlay{.file = saved->file};
        scene.overlay->opacity = choice.opacity;
        scene.overlay->title = saved->of.title;
    }
}

std::string MainWindow::overlay_note() const {
    const bool is_missing =
        overlay_waits() || (asked_overlay_ && !asked_overlay_->file && !saved_overlay());
    return is_missing ? ", without the overlay: Ctrl+E exports it to a file first" : "";
}

}  // namespace relevo::viewer
