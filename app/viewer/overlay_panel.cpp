#include "viewer/overlay_panel.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>

#include <fmt/format.h>
#include <imgui.h>

#include "base/text.h"
#include "chart/legend.h"
#include "scene/options.h"
#include "viewer/image_texture.h"

namespace relevo::viewer {
namespace {

constexpr std::array<const char*, 7> kNames = {"none",
                                               "from the scene",
                                               "sun hours of the day",
                                               "sun hours of the week",
                                               "sun hours of the year",
                                               "direct sun at this time",
                                               "sky view"};

/// Name of an overlay kind; that of the scene is its file's name.
std::string name_of(const State& state, OverlayKind kind) {
    const std::optional<scene::Overlay>& of_scene = state.document.scene.overlay;
    if (kind == OverlayKind::File && of_scene)
        return printable(std::filesystem::path(of_scene->file).filename().string());
    return kNames[static_cast<std::size_t>(kind)];
}

void choice(State& state) {
    OverlayChoice& chosen = state.document.overlay;
    ImGui::SetNextItemWidth(-1);
    if (!ImGui::BeginCombo("##overlay", name_of(state, chosen.kind).c_str())) return;
    for (std::size_t i = 0; i < kNames.size(); ++i) {
        const auto kind = static_cast<OverlayKind>(i);
        if (kind == OverlayKind::File && !state.document.scene.overlay) continue;
        if (!ImGui::Selectable(name_of(state, kind).c_str(), kind == chosen.kind)) continue;
        chosen.kind = kind;
        state.step = true;
    }
    ImGui::EndCombo();
}

void opacity(State& state) {
    auto percent = static_cast<int>(std::lround(100 * state.document.overlay.opacity));
    ImGui::SetNextItemWidth(-1);
    const auto most = static_cast<int>(100 * scene::option("--overlay-opacity").max);
    if (ImGui::SliderInt("##opacity", &percent, 10, most, "opacity %d %%"))
        state.document.overlay.opacity = percent / 100.0;
    state.step = state.step || ImGui::IsItemDeactivatedAfterEdit();
}

/// Of the scene's overlay alone: figures of the sun have a legend, whose colours light would
/// change.
void light(State& state) {
    bool lit = state.document.scene.overlay->lit;
    if (!ImGui::Checkbox("lit by the sun", &lit)) return;
    state.document.scene.overlay->lit = lit;
    state.step = true;
}

/// Resolution of the overlay, and progress.
void work(const State& state) {
    const ImVec2 size{-1, ImGui::GetTextLineHeight()};
    if (state.is_preview)
        ImGui::TextDisabled("waiting until all posts are read ...");
    else if (state.overlay_progress)
        ImGui::ProgressBar(static_cast<float>(*state.overlay_progress), size, "refining ...");
    else if (state.overlay && state.overlay->raster && !state.overlay->is_whole())
        ImGui::TextWrapped(
            "Every %.1f-th post in each direction, limited by --memory. The exported GeoTIFF has "
            "all posts.",
            state.overlay->every);
}

void save(State& state) {
    if (state.saving_progress) {
        ImGui::ProgressBar(static_cast<float>(*state.saving_progress),
                           {-90, ImGui::GetTextLineHeight()}, "writing ...");
        ImGui::SameLine();
        if (ImGui::SmallButton("Cancel")) state.commands.push_back(Command::GiveUpSaving);
        return;
    }
    if (ImGui::Button("Export as GeoTIFF (Ctrl+E)")) state.commands.push_back(Command::SaveOverlay);
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip(
            "The same file as relevo sun writes. Scenes and commands include it then.");
    if (!state.saved_overlay.empty()) ImGui::TextDisabled("in %s", state.saved_overlay.c_str());
}

}  // namespace

void overlay_panel(State& state) {
    choice(state);
    const OverlayKind kind = state.document.overlay.kind;
    if (kind == OverlayKind::None) return;
    if (state.overlay && !state.overlay->error.empty()) {
        ImGui::TextWrapped("%s", state.overlay->error.c_str());
        return;
    }
    opacity(state);
    if (kind == OverlayKind::File) return light(state);
    work(state);
    save(state);
}

std::string overlay_words(const OverlayShown& overlay, const geo::Geodetic& place) {
    const double value = overlay.value_at(place);
    if (std::isnan(value)) return overlay.raster ? "no overlay value here" : "";
    switch (overlay.of.raster.figure) {
        case session::SunFigure::Shadow:
            return value > 0 ? "in the sun" : "in shade";
        case session::SunFigure::SkyView:
            return fmt::format("sky view {:.3f}", value);
        default:
            return fmt::format("sun hours {:.2f}", value);
    }
}

void LegendPicture::update(const std::vector<chart::Legend>& legends, glm::vec2 size_px,
                           float top_px, double px_a_unit) {
    if (of_ != legends || px_a_unit_ != px_a_unit) {
        of_ = legends;
        px_a_unit_ = px_a_unit;
        textures_.clear();
        for (const chart::Legend& legend : legends)
            textures_.push_back(texture_of(chart::to_image(chart::legend(legend), px_a_unit)));
    }
    constexpr double kMargin_px = 12, kNorth_px = 92;
    places_.clear();
    double y = static_cast<double>(top_px) + kNorth_px;
    for (const gl::Texture& texture : textures_) {
        const double width = texture.extent().width, height = texture.extent().height;
        places_.push_back({static_cast<double>(size_px.x) - kMargin_px - width, y, width, height});
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
