#include "viewer/film_controller.h"

#include <utility>

#include <fmt/format.h>
#include <imgui.h>

#include "base/text.h"
#include "viewer/export.h"
#include "viewer/translation.h"
#include "viewer/window.h"

namespace relevo::viewer {

FilmController::FilmController(State& state, Messages& messages, std::string device,
                               FilmSource source)
    : state_(state),
      messages_(messages),
      device_(std::move(device)),
      source_(std::move(source)),
      preview_(state),
      work_(&Window::wake) {}

void FilmController::play_or_pause() {
    if (clock_.is_playing())
        clock_.pause();
    else
        clock_.play();
    action_ = FilmAction::ShowFrame;
}

void FilmController::end_preview() {
    clock_.pause();
    preview_.end();
    shown_frame_ = -1;
    if (action_ == FilmAction::ShowFrame) action_.reset();
}

void FilmController::forget() {
    clock_.pause();
    preview_.forget();
    work_.forget();
    requested_.reset();
    plan_.reset();
    shown_frame_ = -1;
    error_.clear();
}

bool FilmController::advance(double passed_s) {
    if (!preview_.is_on()) return false;
    if (!panel_.is_open() || !plan_ || plan_->frames.shots.empty()) {
        end_preview();
        return true;
    }
    clock_.advance(passed_s);
    const int frame = clock_.frame();
    if (frame == shown_frame_) return false;
    const scene::Shot& shot = plan_->frames.shots[static_cast<std::size_t>(frame)];
    preview_.show(shot, source_.pose_of(shot.scene.view));
    shown_frame_ = frame;
    return true;
}

void FilmController::draw(glm::vec2 window_px, float left_px, float right_px) {
    const FilmStatus status{.plan = plan_.get(),
                            .is_planned = is_planned(),
                            .shows_frame = preview_.is_on(),
                            .drawing = film_.get(),
                            .error = error_,
                            .missing = missing_};
    if (const auto action = panel_.draw(state_, clock_, status, window_px, left_px, right_px))
        action_ = action;
}

void FilmController::draw_edges(glm::vec2 window_px) const {
    if (!preview_.is_on() || !plan_) return;
    const glm::dvec2 film(plan_->of.wish.file.size_px);
    draw_film_edges(film.x / film.y, window_px);
}

bool FilmController::is_planned() const {
    return is_requested_ && work_.is_done() && plan_ && plan_ == work_.answer();
}

std::string FilmController::progress() const {
    if (!film_) return {};
    return tr_format("drawing {}, {} of {} frames", printable(film_->file()), film_->drawn(),
                     film_->frames());
}

FilmWish FilmController::wish() const {
    const Document& document = state_.document;
    const glm::dvec2 size(state_.settings.film.size_px);
    const auto scene_of = [&](const Document& of) {
        return source_.scene(of, panel_.is_centred(), size.x / size.y);
    };
    FilmWish wish{.scene = scene_of(document),
                  .utc = document.utc,
                  .zone = document.zone,
                  .views = {},
                  .choice = panel_.choice(),
                  .file = state_.settings.film,
                  .folder = state_.settings.exporting.folder};
    if (wish.choice.camera != FilmChoice::Camera::Views) return wish;
    Document seen = document;
    for (const SavedView& view : state_.views) {
        seen.pose = viewer::pose_of(view, state_.land);
        wish.views.push_back(scene_of(seen).view);
    }
    return wish;
}

bool FilmController::request(const Opened& opened, bool is_at_rest) {
    if (opened.dem->is_preview) {
        requested_.reset();
        work_.forget();
        plan_.reset();
    }
    is_requested_ = !opened.dem->is_preview && (preview_.is_on() || is_at_rest);
    if (!is_requested_) return false;
    if (!preview_.is_on()) {
        const std::string missing = source_.missing_overlay();
        missing_ = missing.empty() ? "" : tr_format("the film is {}", missing);
        FilmWish now = wish();
        plans_again_ = plans_again_ || !requested_ || !(*requested_ == now);
        if (plans_again_) requested_ = std::move(now);
    }
    if (!std::exchange(plans_again_, false)) return false;
    work_.want({*requested_, opened.dem});
    return true;
}

bool FilmController::take_plan() {
    const std::shared_ptr<const FilmPlan> answer = work_.answer();
    if (!answer || answer == plan_) return false;
    plan_ = answer;
    if (!plan_->frames.shots.empty())
        clock_.set_film(static_cast<int>(plan_->frames.shots.size()), plan_->film.film.fps);
    if (preview_.is_on()) shown_frame_ = -1;
    return true;
}

bool FilmController::update(const Opened& opened, bool is_at_rest) {
    if (!panel_.is_open()) {
        action_.reset();
        return false;
    }
    bool has_changed = request(opened, is_at_rest);
    has_changed = take_plan() || has_changed;
    const bool needs_plan =
        action_ && *action_ != FilmAction::Cancel && *action_ != FilmAction::EndPreview;
    if (!action_ || (needs_plan && !is_planned())) return has_changed;
    act(*std::exchange(action_, std::nullopt));
    return true;
}

void FilmController::act(FilmAction action) {
    switch (action) {
        case FilmAction::ShowFrame:
            if (plan_->frames.shots.empty()) clock_.pause();
            if (preview_.is_on() || plan_->frames.shots.empty()) return;
            preview_.begin();
            shown_frame_ = -1;
            return;
        case FilmAction::EndPreview:
            return end_preview();
        case FilmAction::SaveFilm:
            return save_film();
        case FilmAction::SaveJob:
            return messages_.try_to(
                [&] { messages_.report(save_film_job(plan_->scene, plan_->film)); });
        case FilmAction::CopyCommand:
            ImGui::SetClipboardText(film_command(plan_->scene, plan_->film).c_str());
            return messages_.note(tr("the command for this film is on the clipboard"));
        case FilmAction::ShowTrack:
            track_to_show_ = panel_.choice().track;
            return;
        case FilmAction::Cancel:
            if (film_) film_->cancel();
            return;
    }
}

void FilmController::save_film() {
    if (film_) return;
    error_.clear();
    film_ = std::make_unique<FilmExport>(plan_, device_, &Window::wake);
}

bool FilmController::poll() {
    if (!film_) return false;
    if (!film_->is_done()) return std::exchange(shown_drawn_, film_->drawn()) != film_->drawn();
    try {
        messages_.report(film_->result());
    } catch (const Error& error) {
        error_ = error.what();
        log::warning(error_);
    }
    film_.reset();
    asks_to_quit_ = false;
    plans_again_ = true;  // its name is taken now
    return true;
}

bool FilmController::draw_question(glm::vec2 window_px) {
    if (!asks_to_quit_ || !film_) return false;
    ImGui::SetNextWindowPos({window_px.x / 2, window_px.y / 3}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::Begin(tr_label("Quit"), nullptr,
                 ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_AlwaysAutoResize |
                     ImGuiWindowFlags_NoSavedSettings);
    ImGui::TextUnformatted(progress().c_str());
    const bool quits = ImGui::Button(tr_label("Quit without the film"));
    ImGui::SameLine();
    if (ImGui::Button(tr_label("Continue drawing"))) asks_to_quit_ = false;
    ImGui::End();
    return quits;
}

}  // namespace relevo::viewer
