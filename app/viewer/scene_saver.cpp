#include "viewer/scene_saver.h"

#include <utility>

#include "viewer/export.h"
#include "viewer/translation.h"

namespace relevo::viewer {

scene::Scene SceneSaver::whole_scene() const {
    const State& state = parts_.state;
    scene::Scene scene = viewer::whole_scene(state.document, state.land, parts_.window.size_px());
    parts_.overlay.add_to(scene);
    return scene;
}

scene::Scene SceneSaver::scene_for(Document document, bool is_centred, double aspect) const {
    const State& state = parts_.state;
    const glm::vec2 window = parts_.window.size();
    if (is_centred)
        document.pose = centred(document.pose, state.land, state.layout.insets(window),
                                static_cast<double>(window.x) / window.y, aspect);
    scene::Scene scene = viewer::whole_scene(document, state.land, parts_.window.size_px());
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

void SceneSaver::draw_sheet() {
    const Document& document = parts_.state.document;
    if (sheet_.is_open())
        sheet_.draw(parts_.window.size(), scene_for(document, sheet_.is_centred(), sheet_.aspect()),
                    document.utc, document.zone, is_exporting());
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
    std::optional<PictureOrder> order = sheet_.take();
    if (!order || export_) return;
    if (parts_.opening.is_preview())
        return parts_.messages.show(tr("the picture can be exported when all posts are read"));
    if (const std::string note = parts_.overlay.missing_note(); !note.empty())
        parts_.messages.note(tr_format("the picture is {}", note));
    export_ = std::make_unique<PictureExport>(std::move(*order), device_,
                                              parts_.opening.opened()->dem, &Window::wake);
}

}  // namespace relevo::viewer
