#include "viewer/film_fields.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "base/text.h"
#include "shader/params.h"
#include "viewer/file_kind.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

using Time = FilmChoice::Time;
using Camera = FilmChoice::Camera;

constexpr const char* kSeconds = "seconds";
constexpr float kColumn_em = 7.5f;  // of labels that begin a row

/// Draws widgets as without effect where they have none.
class DisabledIf {
  public:
    explicit DisabledIf(bool is_disabled) { ImGui::BeginDisabled(is_disabled); }
    ~DisabledIf() { ImGui::EndDisabled(); }
    DisabledIf(const DisabledIf&) = delete;
    DisabledIf& operator=(const DisabledIf&) = delete;
};

void tooltip(const char* text) {
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) ImGui::SetTooltip("%s", text);
}

/// A number without step buttons, kept in its range.
void number(const char* id, double& value, double least, double most, const char* format) {
    if (ImGui::InputDouble(id, &value, 0, 0, format, ImGuiInputTextFlags_AutoSelectAll))
        value = std::clamp(value, least, most);
}

template <typename Choice, std::size_t count>
void combo(const char* id, Choice& choice,
           const std::array<std::pair<Choice, const char*>, count>& words) {
    const auto now = std::ranges::find(words, choice, &std::pair<Choice, const char*>::first);
    if (!ImGui::BeginCombo(id, tr(now->second))) return;
    for (const auto& [value, word] : words)
        if (ImGui::Selectable(tr_label(word), value == choice)) choice = value;
    ImGui::EndCombo();
}

/// The file of lines that an effect shows now; empty: none does.
std::string shown_lines(const State& state) {
    const std::string address = file_text_for(FileKind::Lines, state.effects->registry);
    if (address.empty() || !state.effects->selection.has(address.substr(0, address.find('.'))))
        return {};
    return state.effects->values.text(address);
}

void preset(FilmChoice& choice) {
    const std::vector<FilmPreset>& presets = film_presets();
    const auto now = std::ranges::find(presets, choice, &FilmPreset::choice);
    if (!ImGui::BeginCombo("##preset",
                           now == presets.end() ? tr("as chosen below") : tr(now->name)))
        return;
    for (const FilmPreset& one : presets) {
        if (!ImGui::Selectable(tr_label(one.name), now != presets.end() && one.name == now->name))
            continue;
        const std::string track = choice.track;
        choice = one.choice;
        if (choice.camera == Camera::Track) choice.track = track;
    }
    ImGui::EndCombo();
}

void track_fields(FilmChoice& choice, WidgetRows& rows) {
    rows.next(tr("Track"), 14);
    std::string track = choice.track;  // not read before all of it is typed
    if (ImGui::InputTextWithHint(
            "##track", tr("GPX, CSV, GeoJSON; then Enter"), &track,
            ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll))
        choice.track = track.empty() ? "" : std::filesystem::absolute(track).string();
    if (!choice.track.empty()) tooltip(printable(choice.track).c_str());
    rows.next(tr("Above ground"), 5);
    number("##above", choice.height_m, 0.1, 1e6, "%.0f m");
    rows.next(tr("Look ahead"), 5);
    number("##ahead", choice.look_ahead_m, 0, 1e6,
           choice.look_ahead_m > 0 ? "%.0f m" : slider_format(tr("automatic"), "").c_str());
    tooltip(tr("How far ahead the camera looks; bends narrower than it are cut. 0: automatic"));
    const DisabledIf disabled(!choice.can_have_speed());
    rows.next(tr("Speed"), 5);
    number("##speed", choice.speed_m_s, 0, 1e6,
           choice.speed_m_s > 0 ? "%.0f m/s" : slider_format(tr("by length"), "").c_str());
    tooltip(
        tr("Highest speed of the flight; 0: by the length of the film. If something else moves, "
           "the length counts."));
}

/// The scalar parameters of effects that are on, which need no other program.
void parameter_combo(FilmChoice& choice, const State& state) {
    if (!ImGui::BeginCombo("##value", choice.value.empty() ? tr("none") : choice.value.c_str()))
        return;
    if (ImGui::Selectable(tr_label("none"), choice.value.empty())) choice.value.clear();
    if (ImGui::Selectable(tr_label("seconds, of effects that move"), choice.value == kSeconds)) {
        choice.value = kSeconds;
        choice.from = 0;
        choice.to = choice.duration_s;
    }
    for (const effect::Effect& effect : state.effects->registry.effects()) {
        if (!state.effects->selection.has(effect.id())) continue;
        for (const shader::Param& param : effect.params()) {
            const bool is_number = param.type == shader::ParamType::Float ||
                                   (param.type == shader::ParamType::Int && param.words.empty());
            if (!is_number || param.is_static || param.is_host) continue;
            if (!ImGui::Selectable(param.address.c_str(), choice.value == param.address)) continue;
            choice.value = param.address;
            choice.from = state.effects->values.value(param.address)[0];
            choice.to = param.range ? param.range->max : choice.from + 1;
        }
    }
    ImGui::EndCombo();
}

}  // namespace

bool WidgetRows::next(float width_px) {
    const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
    const float end = ImGui::GetItemRectMax().x + ImGui::GetStyle().ItemSpacing.x + width_px;
    const bool begins_row = std::exchange(is_first_, false) || end > right;
    if (!begins_row) ImGui::SameLine();
    return begins_row;
}

void WidgetRows::next(const char* label, float width_em) {
    const float inner = ImGui::GetStyle().ItemInnerSpacing.x;
    const float width = width_em * ImGui::GetFontSize();
    const float label_px = ImGui::CalcTextSize(label).x;
    const bool begins_row = next(label_px + inner + width);
    // The first widgets of rows are below each other.
    const float column = begins_row ? kColumn_em * ImGui::GetFontSize() : 0;
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(label);
    ImGui::SameLine(0, std::max(inner, column - label_px));
    ImGui::SetNextItemWidth(width);
}

void film_choice_fields(FilmChoice& choice, const State& state) {
    WidgetRows rows;
    rows.next(tr("Film"), 13);
    preset(choice);
    rows.next(tr("Time"), 9);
    combo<Time, 3>("##time", choice.time,
                   {{{Time::Still, tr_later("stands still")},
                     {Time::Day, tr_later("this day")},
                     {Time::Year, tr_later("this year")}}});
    tooltip(
        tr("From half an hour before sunrise to half an hour after sunset; or the whole year at "
           "this hour of mean solar time"));
    rows.next(tr("Camera"), 11);
    const Camera before = choice.camera;
    combo<Camera, 5>("##camera", choice.camera,
                     {{{Camera::Still, tr_later("stands still")},
                       {Camera::AroundMiddle, tr_later("around the middle")},
                       {Camera::AroundDem, tr_later("around the DEM")},
                       {Camera::Views, tr_later("through the views")},
                       {Camera::Track, tr_later("along a track")}}});
    tooltip(
        tr("Around the ground in the middle of the view, or around all of the DEM; through the "
           "saved views (B) in their order; above the line of a file"));
    if (choice.camera != before) choice.ease = choice.is_flight();
    if (choice.is_orbit()) {
        rows.next(tr("Turns"), 4);
        number("##turns", choice.turns, -1000, 1000, "%g");
        tooltip(tr("Clockwise from above; negative: the other way"));
    }
    if (choice.camera == Camera::Track) {
        if (choice.camera != before && choice.track.empty()) choice.track = shown_lines(state);
        track_fields(choice, rows);
    }
    {
        const DisabledIf disabled(!choice.is_orbit() && !choice.is_flight());
        rows.next(tr("Ease"), ImGui::GetFrameHeight() / ImGui::GetFontSize());
        ImGui::Checkbox("##ease", &choice.ease);
        tooltip(tr("The camera begins and ends at rest"));
    }
    rows.next(tr("Parameter"), 11);
    parameter_combo(choice, state);
    if (!choice.value.empty()) {
        rows.next(tr("from"), 5);
        number("##from", choice.from, -1e9, 1e9, "%g");
        rows.next(tr("to"), 5);
        number("##to", choice.to, -1e9, 1e9, "%g");
    }
    {
        const DisabledIf disabled(choice.can_have_speed() && choice.speed_m_s > 0);
        rows.next(tr("Length"), 4);
        number("##length", choice.duration_s, 0.1, kLongestFilm_s, "%g s");
    }
    rows.next(tr("Frames a second"), 4);
    number("##fps", choice.fps, 1, film::kMaxFps, "%g");
}

void film_file_fields(FilmFile& file, bool& is_centred, glm::vec2 window_px) {
    WidgetRows rows;
    rows.next(tr("Size"), 7);
    if (ImGui::BeginCombo("##size",
                          fmt::format("{} x {}", file.size_px.x, file.size_px.y).c_str())) {
        const glm::ivec2 window = 2 * (glm::ivec2(window_px) / 2);
        for (const glm::ivec2 size :
             {glm::ivec2(1280, 720), glm::ivec2(1920, 1080), glm::ivec2(3840, 2160),
              glm::ivec2(1080, 1080), glm::ivec2(1080, 1920), glm::ivec2(640, 360), window})
            if (ImGui::Selectable(
                    (size == window ? tr_format("{} x {}, as the window", size.x, size.y)
                                    : fmt::format("{} x {}", size.x, size.y))
                        .c_str(),
                    size == file.size_px))
                file.size_px = size;
        ImGui::EndCombo();
    }
    rows.next(tr("Pixels"), 8);
    if (ImGui::InputInt2("##pixels", &file.size_px.x))
        file.size_px =
            glm::clamp(file.size_px, glm::ivec2(kLeastFilm_px), glm::ivec2(kMostFilm_px));
    rows.next(tr("Format"), 5);
    if (ImGui::BeginCombo("##format", file.ending.c_str())) {
        for (const std::string_view ending : kFilmEndings)
            if (ImGui::Selectable(ending.data(), file.ending == ending)) file.ending = ending;
        ImGui::EndCombo();
    }
    {
        const DisabledIf disabled(!file.has_quality());
        rows.next(tr("Quality"), 5);
        ImGui::SliderInt("##quality", &file.quality, 0, 100);
    }
    rows.next(tr("Samples"), 4);
    if (ImGui::BeginCombo("##samples", fmt::format("{}", file.samples).c_str())) {
        for (const int samples : {1, 4, 8, 16})
            if (ImGui::Selectable(fmt::format("{}", samples).c_str(), samples == file.samples))
                file.samples = samples;
        ImGui::EndCombo();
    }
    tooltip(tr("Samples a pixel: smoother edges, as many times the work"));
    rows.next(tr("Name"), 9);
    ImGui::InputText("##name", &file.name, ImGuiInputTextFlags_AutoSelectAll);
    tooltip(tr("{dem}, and {time:...} with the conversions of strftime"));
    rows.next(tr("Date"), ImGui::GetFrameHeight() / ImGui::GetFontSize());
    ImGui::Checkbox("##date", &file.has_date);
    tooltip(tr("Stamps date and time on every frame"));
    rows.next(tr("Centred"), ImGui::GetFrameHeight() / ImGui::GetFontSize());
    ImGui::Checkbox("##centred", &is_centred);
    tooltip(tr("Centres the film on what the side panel leaves free of the window"));
}

}  // namespace relevo::viewer
