#include "viewer/overlay_panel.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "base/error.h"
#include "base/text.h"
#include "chart/legend.h"
#include "viewer/image_texture.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

constexpr std::array<const char*, 4> kPeriods = {tr_later("of the day"), tr_later("of the week"),
                                                 tr_later("of the year"),
                                                 tr_later("from ... to ...")};

/// Name of an overlay kind; that of the scene is its file's name.
std::string name_of(const State& state, OverlayKind kind) {
    const std::optional<scene::Overlay>& of_scene = state.document.scene.overlay;
    if (kind == OverlayKind::File && of_scene)
        return printable(std::filesystem::path(of_scene->file).filename().string());
    return tr(overlay_figure(kind).name);
}

void choice(State& state) {
    OverlayChoice& chosen = state.document.overlay;
    ImGui::SetNextItemWidth(-1);
    if (!ImGui::BeginCombo("##overlay", name_of(state, chosen.kind).c_str())) return;
    for (int i = 0; i <= static_cast<int>(OverlayKind::SkyView); ++i) {
        const auto kind = static_cast<OverlayKind>(i);
        if (kind == OverlayKind::File && !state.document.scene.overlay) continue;
        if (!ImGui::Selectable(name_of(state, kind).c_str(), kind == chosen.kind)) continue;
        chosen.kind = kind;
        chosen.visible = true;
        state.step = true;
    }
    ImGui::EndCombo();
}

/// A date as text, which is taken when Enter is pressed.
void date_field(State& state, const char* label, sun::Date& date) {
    std::string text = fmt::format("{:04}-{:02}-{:02}", date.year, date.month, date.day);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(label);
    ImGui::SameLine();
    ImGui::PushID(label);
    ImGui::SetNextItemWidth(7.5f * ImGui::GetFontSize());
    if (ImGui::InputText("##date", &text,
                         ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll))
        try {
            const sun::Date wanted = sun::parse_date(text);
            if (wanted.year < 1900 || wanted.year > 2100)
                bad_input(tr_format("{}: expected a year from 1900 to 2100", text));
            date = wanted;
            state.step = true;
        } catch (const Error& error) {
            state.message = error.what();
        }
    ImGui::PopID();
}

void period(State& state) {
    OverlayChoice& chosen = state.document.overlay;
    ImGui::SetNextItemWidth(-1);
    const auto now = static_cast<std::size_t>(chosen.period);
    if (ImGui::BeginCombo("##period", tr(kPeriods[now]))) {
        for (std::size_t i = 0; i < kPeriods.size(); ++i) {
            if (!ImGui::Selectable(tr_label(kPeriods[i]), i == now)) continue;
            chosen.period = static_cast<OverlayPeriod>(i);
            state.step = true;
            const sun::Date shown = state.document.zone.local(state.document.utc).wall.date;
            if (chosen.first == sun::Date{}) chosen.first = chosen.last = shown;
        }
        ImGui::EndCombo();
    }
    if (chosen.period != OverlayPeriod::Range) return;
    date_field(state, tr("from"), chosen.first);
    ImGui::SameLine();
    date_field(state, tr("to"), chosen.last);
    if (sun::days_between(chosen.first, chosen.last) < 0)
        ImGui::TextDisabled("%s", tr("the last day is before the first; shown is the first"));
}

/// Resolution of the overlay, and progress.
void work(const State& state) {
    const ImVec2 size{-1, ImGui::GetTextLineHeight()};
    if (state.is_preview)
        ImGui::TextDisabled("%s", tr("waiting until all posts are read ..."));
    else if (state.overlay_progress)
        ImGui::ProgressBar(static_cast<float>(*state.overlay_progress), size, tr("refining ..."));
    else if (state.overlay && state.overlay->raster && !state.overlay->is_whole())
        ImGui::TextWrapped("%s", tr_format("Every {:.1f}-th post in each direction, limited by "
                                           "--memory. The exported GeoTIFF has all posts.",
                                           state.overlay->every)
                                     .c_str());
}

void save(State& state) {
    if (state.saving_progress) {
        ImGui::ProgressBar(static_cast<float>(*state.saving_progress),
                           {-90, ImGui::GetTextLineHeight()}, tr("writing ..."));
        ImGui::SameLine();
        if (ImGui::SmallButton(tr_label("Cancel"))) state.commands.push_back(Command::GiveUpSaving);
        return;
    }
    if (ImGui::Button(tr_label("Export as GeoTIFF (Ctrl+E)")))
        state.commands.push_back(Command::SaveOverlay);
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip(
            "%s", tr("The same file as relevo sun writes. Scenes and commands include it then."));
    if (!state.saved_overlay.empty())
        ImGui::TextDisabled("%s", tr_format("in {}", state.saved_overlay).c_str());
}

}  // namespace

void overlay_panel(State& state) {
    choice(state);
    const OverlayChoice& choice = state.document.overlay;
    if (choice.kind == OverlayKind::None) return;
    if (choice.has_period()) period(state);
    if (state.overlay && !state.overlay->error.empty()) {
        ImGui::TextWrapped("%s", state.overlay->error.c_str());
        return;
    }
    if (choice.kind == OverlayKind::File || !choice.visible) return;
    work(state);
    save(state);
}

std::string overlay_words(const OverlayShown& overlay, const geo::Geodetic& place) {
    const double value = overlay.value_at(place);
    const FigureWanted& of = overlay.of.figure;
    const bool is_first = of.kind == OverlayKind::FirstLight;
    if (is_first || of.kind == OverlayKind::LastLight) {
        if (!overlay.raster) return "";
        if (std::isnan(value)) return tr("no direct sun here");
        constexpr double kMinute_s = 60;
        const sun::CivilTime at = of.zone.local(of.time.begin + kMinute_s * value).wall;
        return is_first ? tr_format("first light {:02}:{:02}", at.hour, at.minute)
                        : tr_format("last light {:02}:{:02}", at.hour, at.minute);
    }
    if (std::isnan(value)) return overlay.raster ? tr("no overlay value here") : "";
    switch (of.kind) {
        case OverlayKind::Mask:
            return value > 0 ? tr("in the sun") : tr("in shade");
        case OverlayKind::SkyView:
            return tr_format("sky view {:.3f}", value);
        case OverlayKind::Irradiation:
            return tr_format("irradiation {:.2f} kWh/m2", value);
        default:
            return tr_format("sun hours {:.2f} h", value);
    }
}

void LegendPicture::update(const std::vector<chart::Legend>& legends, const Area& picture,
                           double px_a_unit) {
    if (of_ != legends || px_a_unit_ != px_a_unit) {
        of_ = legends;
        px_a_unit_ = px_a_unit;
        textures_.clear();
        for (const chart::Legend& legend : legends)
            textures_.push_back(texture_of(chart::to_image(chart::legend(legend), px_a_unit)));
    }
    constexpr double kMargin_px = 12, kNorth_px = 92;
    places_.clear();
    double y = double{picture.at.y} + kNorth_px;
    for (const gl::Texture& texture : textures_) {
        const double width = texture.extent().width, height = texture.extent().height;
        places_.push_back({double{picture.end().x} - kMargin_px - width, y, width, height});
        y += height + kMargin_px;
    }
}

void LegendPicture::draw() const {
    for (std::size_t i = 0; i < textures_.size(); ++i) {
        const chart::Rect& at = places_[i];
        const ImVec2 from{static_cast<float>(at.x), static_cast<float>(at.y)};
        ImGui::GetBackgroundDrawList()->AddImage(
            reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(textures_[i].name())), from,
            {from.x + static_cast<float>(at.width), from.y + static_cast<float>(at.height)});
    }
}

}  // namespace relevo::viewer
