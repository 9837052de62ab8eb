#include "viewer/overlay_controller.h"

#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "viewer/translation.h"
#include "viewer/window.h"

namespace relevo::viewer {
OverlayController::OverlayController(State& state, Messages& messages, Discard& discard)
    : state_(state), messages_(messages), discard_(discard), work_(&Window::wake) {}

void OverlayController::clear() {
    shows_frame_ = is_hidden_ = false;
    work_.forget();
    requested_.reset();
    lays_overlay_ = false;
    state_.overlay.reset();
    exports_when_complete_ = false;
}

bool OverlayController::waits_for_posts() const {
    const OverlayChoice& choice = state_.document.overlay;
    return state_.is_preview && choice.visible && choice.kind > OverlayKind::File;
}

bool OverlayController::is_wanted() const {
    const OverlayChoice& choice = state_.document.overlay;
    if (choice.kind == OverlayKind::None || !choice.visible) return false;
    if (choice.kind == OverlayKind::File) return state_.document.scene.overlay.has_value();
    return !waits_for_posts();
}

OverlayWanted OverlayController::wanted(const Opened& opened) const {
    const Document& document = state_.document;
    OverlayWanted wanted;
    wanted.dem = opened.dem;
    wanted.dems = opened.scene.dems;
    wanted.options = opened.scene.dem;
    const OverlayChoice& choice = document.overlay;
    wanted.opacity = choice.opacity;
    wanted.lit = choice.lit;
    if (choice.kind == OverlayKind::File) {
        wanted.file = document.scene.overlay;
        copy_choice_to(*wanted.file);
    } else {
        wanted.figure = figure_of(choice, document.utc, document.zone, document.scene.refraction);
    }
    return wanted;
}

bool OverlayController::request(const Opened& opened) {
    if (!is_wanted()) {
        if (!requested_) return false;
        requested_.reset();
        work_.forget();
        return true;
    }
    OverlayWanted now = wanted(opened);
    if (requested_ && same_figures(*requested_, now) && requested_->opacity == now.opacity &&
        requested_->lit == now.lit)
        return false;
    requested_ = now;
    work_.want(std::move(now));
    return true;
}

void OverlayController::show_frame() {
    shows_frame_ = true;
    is_hidden_ = state_.document.overlay.kind == OverlayKind::None;
}

bool OverlayController::update(const Opened& opened) {
    shows_frame_ = is_hidden_ = false;
    bool has_changed = request(opened);
    const std::shared_ptr<const OverlayShown> answer = work_.answer();
    // Keeps the last overlay until there is an answer to another request.
    if (requested_ ? answer && answer != state_.overlay : state_.overlay != nullptr) {
        state_.overlay = requested_ ? answer : nullptr;
        lays_overlay_ = true;
        has_changed = true;
    }
    state_.overlay_progress.reset();
    if (requested_ && !work_.is_done()) state_.overlay_progress = work_.progress();
    state_.saved_overlay.clear();
    if (const ExportedOverlay* const file = exported()) state_.saved_overlay = file->shown_name;
    return has_changed;
}

std::optional<session::LaidOverlay> OverlayController::laid() const {
    if (!lays_overlay_) return std::nullopt;
    if (!is_displayed()) return session::LaidOverlay{};
    const session::Overlay& overlay = state_.overlay->overlay;
    return session::LaidOverlay{overlay.raster, overlay.time && !state_.document.overlay.shadows};
}

bool OverlayController::is_complete() const {
    if (shows_frame_) return true;
    if (waits_for_posts() || is_wanted() != requested_.has_value()) return false;
    return !requested_ || (work_.is_done() && state_.overlay == work_.answer());
}

bool OverlayController::is_displayed() const {
    return !is_hidden_ && state_.overlay && state_.overlay->error.empty();
}

const OverlayController::ExportedOverlay* OverlayController::exported() const {
    if (!requested_ || requested_->file) return nullptr;
    std::error_code ignored;
    for (const ExportedOverlay& one : exported_)
        if (same_figures(one.of, *requested_) && std::filesystem::exists(one.file, ignored))
            return &one;
    return nullptr;
}

void OverlayController::start_export(const std::string& path, bool overwrite) {
    path_ = path;
    overwrites_ = overwrite;
    exports_when_complete_ = waits_for_posts();
    if (exports_when_complete_) return;
    if (!requested_ || requested_->file)
        return messages_.show(tr("there is no sun overlay to export; O shows the day's sun hours"));
    if (export_) return messages_.show(tr("an export is running already"));
    const bool is_in_memory = requested_->dem->field.reduction == 1;
    exports_when_complete_ = is_in_memory && !(is_complete() && is_displayed());
    if (exports_when_complete_) return;
    export_ =
        std::make_unique<OverlaySave>(*requested_, is_in_memory ? state_.overlay->raster : nullptr,
                                      &Window::wake, path, overwrite);
}

void OverlayController::cancel_export() {
    exports_when_complete_ = false;
    if (export_) messages_.note(tr("export cancelled; no file was written"));
    discard_.take(std::move(export_));
}

bool OverlayController::poll_export() {
    if (exports_when_complete_ && !shows_frame_ && is_complete()) {
        exports_when_complete_ = false;
        if (is_displayed()) start_export(std::exchange(path_, {}), overwrites_);
    }
    state_.saving_progress.reset();
    if (exports_when_complete_) state_.saving_progress = 0;
    if (!export_) return false;
    if (!export_->is_done()) {
        state_.saving_progress = export_->progress();
        return false;
    }
    messages_.try_to([&] {
        const std::string name = export_->result();
        const std::string file = absolute_names({name}).front();
        const OverlayWanted& of = export_->wanted();
        exported_.push_back({of, file, name});
        messages_.report(
            tr_format("{}: {}, as written by relevo {}; scenes and commands include it", file,
                      title_of(of.figure), overlay_figure(of.figure.kind).command));
    });
    export_.reset();
    return true;
}

void OverlayController::add_to(scene::Scene& scene) const {
    const OverlayChoice& choice = state_.document.overlay;
    if (choice.kind != OverlayKind::File || !choice.visible) scene.overlay.reset();
    if (const ExportedOverlay* const file = exported()) {
        scene.overlay = scene::Overlay{.file = file->file};
        scene.overlay->title = title_of(file->of.figure);
    }
    if (scene.overlay) copy_choice_to(*scene.overlay);
}

void OverlayController::copy_choice_to(scene::Overlay& overlay) const {
    const OverlayChoice& choice = state_.document.overlay;
    overlay.opacity = choice.opacity;
    overlay.lit = choice.lit;
    overlay.shadows = choice.shadows;
}

std::string OverlayController::missing_note() const {
    const bool is_missing = waits_for_posts() || (requested_ && !requested_->file && !exported());
    return is_missing ? tr("without the overlay: Ctrl+E exports it to a file first") : "";
}

Coloured OverlayController::coloured(const Picture& image) const {
    Coloured all{image.legends, std::nullopt};
    if (!is_displayed()) return all;
    const session::Overlay& overlay = state_.overlay->overlay;
    if (const auto legend = session::dated_legend(overlay, /*zone=*/"", state_.centre))
        all.legends.insert(all.legends.begin(), *legend);
    all.overlay_time = overlay.time;
    return all;
}

}  // namespace relevo::viewer
