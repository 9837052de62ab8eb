#include "viewer/scene_saver.h"

#include <functional>
#include <optional>
#include <utility>

#include "scene/map_view.h"
#include "viewer/export.h"
#include "viewer/translation.h"

namespace relevo::viewer {

scene::Scene SceneSaver::whole_scene() const {
    const State& state = parts_.state;
    scene::Scene scene = viewer::whole_scene(state.document, state.land, parts_.window.size_px());
    parts_.overlay.add_to(scene);
    return scene;
}

Pose SceneSaver::pose_for(const Document& document, bool is_centred, double aspect) const {
    const State& state = parts_.state;
    const glm::vec2 window = parts_.window.size();
    if (!is_centred) return document.pose;
    return centred(document.pose, state.land, state.layout.insets(window),
                   static_cast<double>(window.x) / window.y, aspect);
}

scene::Scene SceneSaver::scene_for(Document document, bool is_centred, double aspect) const {
    document.pose = pose_for(document, is_centred, aspect);
    scene::Scene scene = viewer::whole_scene(document, parts_.state.land, parts_.window.size_px());
    parts_.overlay.add_to(scene);
    return scene;
}

std::string SceneSaver::with_overlay_note(const std::string& text) const {
    const std::string note = parts_.overlay.missing_note();
    return note.empty() ? text : text + ", " + note;
}

void SceneSaver::copy_command() {
    parts_.window.copy(capture_command(whole_scene(), free_picture_name()));
    parts_.messages.note(with_overlay_note(tr("the command for this picture is on the clipboard")));
}

void SceneSaver::save_scene() {
    parts_.messages.try_to(
        [&] { parts_.messages.report(with_overlay_note(viewer::save_scene(whole_scene()))); });
}

void SceneSaver::save_job() {
    const State& state = parts_.state;
    parts_.messages.try_to([&] {
        parts_.messages.report(
            with_overlay_note(viewer::save_job(whole_scene(), state.day, state.document.zone)));
    });
}

std::string SceneSaver::progress() const {
    if (!export_) return {};
    if (!export_->can_cancel()) return tr("writing the file ...");
    const double percent = 100 * export_->share();
    return export_->is_picture()
               ? tr_format("drawing the picture, {:.0f} %; Ctrl+P: cancel", percent)
               : tr_format("making the mesh, {:.0f} %; Ctrl+P: cancel", percent);
}

void SceneSaver::draw_sheet() {
    // Arrows and Space move through the sheet as long as it has the keyboard.
    if (sheet_.has_focus() && !parts_.window.panels_have_keys())
        parts_.window.give_keys_to(nullptr);
    if (had_sheet_ && !sheet_.is_open()) parts_.window.take_keys_back();
    had_sheet_ = sheet_.is_open();
    if (!had_sheet_) return;
    State& state = parts_.state;
    ExportChoice& choice = state.settings.exporting;
    const Document& document = state.document;
    const glm::vec2 window = parts_.window.size();
    const double shown = static_cast<double>(window.x) / window.y, aspect = choice.aspect();
    const scene::Scene scene = scene_for(document, choice.is_centred, aspect);
    const scene::Camera from = camera_of(document.pose, state.land),
                        to = camera_of(pose_for(document, choice.is_centred, aspect), state.land);
    scene::Scene map = scene;
    map.ortho = choice.of().is_ortho;
    map.sheet = choice.sheet();
    std::function<void()> cancel;
    if (export_ && export_->can_cancel()) cancel = [&] { export_->cancel(); };
    if (!export_ && state.saving_progress) cancel = [&] { parts_.overlay.cancel_export(); };
    parts_.messages.try_to(
        [&] { scene::fit_map(map, parts_.opening.opened()->dem->source->grid()); });
    sheet_.draw(window, choice,
                {.scene = scene,
                 .utc = document.utc,
                 .zone = document.zone,
                 .done = export_ ? export_->share() : state.saving_progress,
                 .cancel = cancel,
                 .is_busy = is_exporting() || state.saving_progress,
                 .has_figures = document.overlay.kind > OverlayKind::File,
                 .message = state.message,
                 .map_aspect = static_cast<double>(map.width_px) / map.height_px,
                 .texture = parts_.window.texture(),
                 .shown_at = [&](glm::dvec2 at) -> std::optional<glm::vec2> {
                     const auto seen = in_picture(from, from.eye_m + ray(to, at, aspect), shown);
                     return seen ? std::optional(glm::vec2(0.5 * (*seen + 1.0))) : std::nullopt;
                 }});
}

void SceneSaver::poll(const std::shared_ptr<const Picture>& image) {
    if (takes_picture_ && image) {
        takes_picture_ = false;
        save_image(*image);
    }
    start_export();
    if (!export_ || !export_->is_done()) return;
    parts_.messages.try_to([&] { parts_.messages.report(export_->result()); });
    export_.reset();
    parts_.pacing.need_frames(2);
}

void SceneSaver::save_image(const Picture& image) {
    parts_.pacing.need_frames(2);  // for the message
    parts_.messages.try_to([&] {
        std::string note = parts_.overlay.missing_note();
        if (!note.empty()) note = tr_format("; its scene is {}", note);
        parts_.messages.report(save_picture(image, whole_scene(), *parts_.opening.opened(),
                                            parts_.overlay.coloured(image)) +
                               note);
    });
}

void SceneSaver::start_export() {
    std::optional<ExportOrder> order = sheet_.take();
    if (!order || export_) return;
    if (order->kind == kFigures) return parts_.overlay.start_export(order->path, order->overwrite);
    const bool is_picture = order->is_picture();
    if (is_picture && parts_.opening.is_preview())
        return parts_.messages.show(tr("the picture can be exported when all posts are read"));
    parts_.state.message.clear();
    if (const std::string note = parts_.overlay.missing_note(); is_picture && !note.empty())
        parts_.messages.note(tr_format("the picture is {}", note));
    export_ = std::make_unique<FileExport>(std::move(*order), device_, parts_.opening.opened()->dem,
                                           &Window::wake);
}

}  // namespace relevo::viewer
