#include "viewer/film_panel.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>

#include "base/text.h"
#include "viewer/film_fields.h"
#include "viewer/style.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

/// Room for the status line and the scale below the panel, in text heights.
constexpr float kStatus_em = 3.4f;

/// "21 Jun 2026, 12:43:10 CEST": the time of a frame.
std::string time_of(const Document& document) {
    const sun::LocalTime local = document.zone.local(document.utc);
    const sun::CivilTime& wall = local.wall;
    return fmt::format("{} {}, {:02}:{:02}:{:02} {}", day_label(wall.date), wall.date.year,
                       wall.hour, wall.minute, wall.second, local.abbreviation);
}

/// "camera at 1530 m facing 214°".
std::string camera_of(const State& state) {
    const Pose& pose = state.document.pose;
    const double eye_m = state.land.frame->to_geodetic(pose.eye_m).height_m;
    return tr_format("camera at {:.0f} m facing {:.0f}°", eye_m / state.land.exaggeration,
                     std::fmod(pose.heading_deg + 360, 360.0));
}

/// The first of some texts, each shorter than the one before, that has room on a line.
std::string fitting(const std::vector<std::string>& texts) {
    const float room = ImGui::GetContentRegionAvail().x;
    for (const std::string& text : texts)
        if (ImGui::CalcTextSize(text.c_str()).x <= room) return text;
    return texts.back();
}

void message(const std::string& text, bool is_error) {
    if (text.empty()) return;
    ImGui::PushTextWrapPos();
    if (is_error)
        ImGui::TextColored(style::error(), "%s", text.c_str());
    else
        ImGui::TextDisabled("%s", text.c_str());
    ImGui::PopTextWrapPos();
}

bool has_frames(const FilmStatus& status) {
    return status.plan && !status.plan->frames.shots.empty();
}

}  // namespace

void FilmPanel::time_line(FilmClock& clock, const FilmStatus& status) {
    const float em = ImGui::GetFontSize();
    ImGui::BeginDisabled(!has_frames(status));
    if (ImGui::Button(clock.is_playing() ? tr_label("Pause") : tr_label("Play"), {4.5f * em, 0})) {
        if (clock.is_playing())
            clock.pause();
        else
            clock.play();
        action_ = FilmAction::ShowFrame;
    }
    ImGui::EndDisabled();
    ImGui::SameLine();
    ImGui::BeginDisabled(!status.shows_frame);
    if (ImGui::Button(tr_label("Back"), {4.5f * em, 0})) action_ = FilmAction::EndPreview;
    ImGui::EndDisabled();
    ImGui::SameLine();
    ImGui::BeginDisabled(!has_frames(status));
    int frame = clock.frame() + 1;
    const std::string format =
        slider_format(tr_format("frame {} of {}", kSliderValue, clock.frames()), "%d");
    ImGui::SetNextItemWidth(-1);
    if (ImGui::SliderInt("##frame", &frame, 1, clock.frames(), format.c_str(),
                         ImGuiSliderFlags_AlwaysClamp)) {
        clock.pause();
        clock.go_to(frame - 1);
        action_ = FilmAction::ShowFrame;
    }
    ImGui::EndDisabled();
}

void FilmPanel::buttons(const FilmStatus& status) {
    const float em = ImGui::GetFontSize();
    WidgetRows rows;
    const auto button = [&](const char* name, bool enabled, FilmAction action, const char* tip) {
        const float width = ImGui::CalcTextSize(name, nullptr, true).x + 2 * em;
        rows.next(width);
        ImGui::BeginDisabled(!enabled);
        if (ImGui::Button(name, {width, 0})) action_ = action;
        ImGui::EndDisabled();
        if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) ImGui::SetTooltip("%s", tip);
    };
    const bool is_ready = has_frames(status) && status.is_planned;
    button(tr_label("Save film"), is_ready && !status.drawing, FilmAction::SaveFilm,
           tr("Draws the film in the background, into the folder of the export sheet"));
    button(tr_label("Save job"), is_ready, FilmAction::SaveJob,
           tr("The film as a file for relevo run"));
    const bool has_command = choice_.camera != FilmChoice::Camera::Views;
    button(tr_label("Copy command"), is_ready && has_command, FilmAction::CopyCommand,
           has_command ? tr("The relevo film command that makes this film")
                       : tr("relevo film knows no saved views; save the job, for relevo run"));
    if (choice_.camera == FilmChoice::Camera::Track)
        button(tr_label("Show track"), !choice_.track.empty(), FilmAction::ShowTrack,
               tr("Shows the line on the ground by an effect"));
    if (!status.drawing) return;
    const FilmExport& film = *status.drawing;
    const float cancel = ImGui::CalcTextSize(tr("Cancel")).x + 2 * em;
    rows.next(std::min(16 * em, ImGui::GetWindowContentRegionMax().x - 2 * em - cancel) + cancel);
    ImGui::ProgressBar(
        static_cast<float>(film.drawn()) / static_cast<float>(film.frames()),
        {std::max(8 * em, std::min(16 * em, ImGui::GetContentRegionAvail().x - cancel - em)), 0},
        tr_format("{} of {} frames", film.drawn(), film.frames()).c_str());
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", printable(film.file()).c_str());
    ImGui::SameLine();
    ImGui::BeginDisabled(film.is_cancelled());
    if (ImGui::Button(tr_label("Cancel"), {cancel, 0})) action_ = FilmAction::Cancel;
    ImGui::EndDisabled();
}

void FilmPanel::stamp(const State& state, const FilmClock& clock, const FilmStatus& status) const {
    if (status.shows_frame) {
        const std::string time =
            fmt::format("{}   {:.2f} s", time_of(state.document), clock.time_s());
        const bool moves = status.plan && (status.plan->film.orbit || status.plan->film.flight);
        ImGui::TextUnformatted(
            fitting({moves ? time + "   " + camera_of(state) : time, time}).c_str());
    } else if (has_frames(status)) {
        const std::string length =
            tr_format("{} frames, {:.3g} s", clock.frames(), clock.length_s());
        const std::string drag = length + "   " + tr("Space plays, dragging shows a frame");
        ImGui::TextDisabled(
            "%s",
            fitting({drag + tr(", Ctrl and a click takes its number"), drag, length}).c_str());
    } else {
        ImGui::TextDisabled("%s", state.is_preview
                                      ? tr("when all posts are read a film can be made")
                                  : status.is_planned ? tr("no frames")
                                                      : tr("planning ..."));
    }
}

std::optional<FilmAction> FilmPanel::draw(State& state, FilmClock& clock, const FilmStatus& status,
                                          glm::vec2 window_px, float left_px, float right_px) {
    if (!is_open_) return std::nullopt;
    const float below = kStatus_em * ImGui::GetFontSize();
    ImGui::SetNextWindowPos({left_px, window_px.y - below}, ImGuiCond_Always, {0, 1});
    const float width = right_px - left_px, menu = 2 * ImGui::GetFrameHeight();
    ImGui::SetNextWindowSizeConstraints({width, 0}, {width, window_px.y - below - menu});
    ImGui::SetNextWindowSize({width, 0}, ImGuiCond_Always);
    const bool shows = ImGui::Begin(
        tr_label("Film"), &is_open_,
        ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
            ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoSavedSettings);
    if (shows) {
        if (!status.shows_frame) {
            film_choice_fields(choice_, state);
            film_file_fields(state.settings.film, is_centred_, window_px);
        }
        buttons(status);
        message(status.error, true);
        if (status.plan) {
            message(status.plan->error, true);
            message(status.plan->note, false);
        }
        if (has_frames(status)) message(status.missing, false);
        ImGui::Separator();
        time_line(clock, status);
        stamp(state, clock, status);
    }
    ImGui::End();
    return std::exchange(action_, std::nullopt);
}

void draw_film_edges(double aspect, glm::vec2 size_px) {
    const float width = size_px.y * static_cast<float>(aspect);
    const float beside = (size_px.x - width) / 2;
    if (beside < 1) return;
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.AddRectFilled({0, 0}, {beside, size_px.y}, style::kShade);
    list.AddRectFilled({size_px.x - beside, 0}, {size_px.x, size_px.y}, style::kShade);
}

}  // namespace relevo::viewer
