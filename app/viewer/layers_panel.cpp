#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

#include "session/overlay_time.h"
#include "shader/params.h"
#include "viewer/layer_legend.h"
#include "viewer/layers.h"
#include "viewer/state.h"
#include "viewer/style.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

constexpr const char* kLit = tr_later("lit");

/// @param has_light  a checkbox follows on the same line
void slider(State& state, double& share, bool has_light) {
    auto percent = static_cast<int>(std::lround(100 * share));
    const float light_px = ImGui::GetFrameHeight() + ImGui::CalcTextSize(tr(kLit)).x +
                           2 * ImGui::GetStyle().ItemInnerSpacing.x +
                           ImGui::GetStyle().ItemSpacing.x;
    ImGui::SetNextItemWidth(has_light ? -light_px : -1);
    if (ImGui::SliderInt("##opacity", &percent, 0, 100,
                         slider_format(tr_format("opacity {} %", kSliderValue), "%d").c_str(),
                         ImGuiSliderFlags_AlwaysClamp))
        share = percent / 100.0;
    state.step = state.step || ImGui::IsItemDeactivatedAfterEdit();
}

/// A share of the parameter's range.
void effect_opacity(State& state, const Layer& layer) {
    const shader::Param& param = state.effects->values.param(layer.opacity);
    const shader::ParamRange range = param.range.value_or(shader::ParamRange{0, 1});
    shader::ParamValue value = state.effects->values.value(layer.opacity);
    const double width = std::max(range.max - range.min, 1e-9);
    const double before = (value[0] - range.min) / width;
    double share = before;
    slider(state, share, !layer.light.empty());
    if (share == before) return;
    value[0] = range.min + share * width;
    if (shader::is_valid(param, value)) state.set_value(param, shader::format_value(param, value));
}

void light(State& state, const Layer& layer) {
    const bool is_overlay = layer.is_overlay();
    bool lit = is_overlay ? state.document.overlay.lit : is_lit(*state.effects, layer.light);
    const bool is_changed = ImGui::Checkbox(tr_label(kLit), &lit);
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("%s", tr("Lit by the sun and the sky; else in its own colours"));
    if (!is_changed) return;
    state.step = true;
    if (is_overlay)
        state.document.overlay.lit = lit;
    else
        state.set_effects(with_value(state.document.scene.effects, layer.light,
                                     light_value(*state.effects, layer.light, lit)));
}

/// Time and zone of the overlay, and whether it is drawn with shadows of another time.
void overlay_time(State& state) {
    const session::Overlay& overlay = state.overlay->overlay;
    if (!overlay.time) return;
    const std::string clock =
        session::clock_text(*overlay.time, state.document.zone.name(), state.centre);
    if (!clock.empty()) ImGui::TextDisabled("%s", clock.c_str());
    state.step |= ImGui::Checkbox(tr_label("cast shadows of the displayed time"),
                                  &state.document.overlay.shadows);
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("%s",
                          tr("The overlay shows sunlight of its own time: shadows on it are off."));
}

void legends(const State& state, const Layer& layer) {
    if (layer.is_overlay()) {
        if (state.overlay && state.overlay->overlay.legend)
            layer_legend(*state.overlay->overlay.legend);
        return;
    }
    int number = 0;
    for (const chart::Legend& legend : state.layer_legends) {
        if (legend.layer != layer.id) continue;
        ImGui::PushID(++number);
        ImGui::TextDisabled("%s", legend.title.c_str());
        layer_legend(legend);
        ImGui::PopID();
    }
}

void details(State& state, const Layer& layer) {
    if (!layer.is_overlay() && !layer.source.empty()) {
        ImGui::TextDisabled("%s", layer.source.c_str());
        if (state.files_outside.contains(state.effects->values.text(layer.file)))
            ImGui::TextColored(style::error(), "%s", tr("outside the DEM"));
    }
    const bool has_light = layer.is_overlay() || !layer.light.empty();
    if (layer.is_overlay())
        slider(state, state.document.overlay.opacity, has_light);
    else if (!layer.opacity.empty())
        effect_opacity(state, layer);
    if (has_light && (layer.is_overlay() || !layer.opacity.empty())) ImGui::SameLine();
    if (has_light) light(state, layer);
    if (layer.is_overlay() && state.overlay) overlay_time(state);
    legends(state, layer);
    if (layer.is_overlay() || !ImGui::TreeNode(tr_label("Settings"))) return;
    effect_values(state, state.effects->registry.effect(layer.id, "layers"));
    ImGui::TreePop();
}

void switch_layer(State& state, const Layer& layer) {
    state.step = true;
    if (layer.is_overlay())
        state.document.overlay.visible = !layer.is_on;
    else
        state.set_effects(switched(state.document.scene.effects, layer.id, !layer.is_on));
}

void remove(State& state, const Layer& layer) {
    state.step = true;
    scene::Effects& effects = state.document.scene.effects;
    if (layer.is_overlay()) {
        state.document.overlay = {};
        return;
    }
    const effect::Effect& effect = state.effects->registry.effect(layer.id, "layers");
    state.set_effects(without_layer(effects, layer.id, effect.manifest.enabled_by_default));
}

void move(State& state, const std::vector<Layer>& layers, std::size_t i, int by) {
    scene::Effects effects = state.document.scene.effects;
    effects.switches = moved(std::move(effects.switches), layers, i, by);
    state.set_effects(std::move(effects));
}

/// Up, down, remove: at the right edge of a row.
void buttons(State& state, const std::vector<Layer>& layers, std::size_t i, float left) {
    const auto arrow = [&](const char* id, ImGuiDir direction, int by, const char* tip) {
        ImGui::BeginDisabled(!can_move(layers, i, by));
        if (ImGui::ArrowButton(id, direction)) move(state, layers, i, by);
        ImGui::EndDisabled();
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tip);
        ImGui::SameLine(0, 2);
    };
    ImGui::SameLine(left);
    arrow("up", ImGuiDir_Up, -1, tr("Over the layer above. Lit layers lie under the others."));
    arrow("down", ImGuiDir_Down, 1, tr("Under the layer below. Names lie over all layers."));
    if (ImGui::Button("x", {ImGui::GetFrameHeight(), 0})) remove(state, layers[i]);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tr("Remove the layer"));
}

/// As much of a text as fits into a width.
std::string fitting(std::string text, float width) {
    if (ImGui::CalcTextSize(text.c_str()).x <= width) return text;
    while (!text.empty() && ImGui::CalcTextSize((text + "...").c_str()).x > width)
        text.pop_back();
    while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xC0) == 0x80)
        text.pop_back();  // no part of a letter
    return text + "...";
}

/// The name of a row: of the overlay what it shows.
std::string name_of(const State& state, const Layer& layer) {
    if (!layer.is_overlay()) return layer.name;
    if (state.overlay && state.overlay->overlay.legend) return state.overlay->overlay.legend->title;
    return layer.source.empty() ? layer.name : layer.source;
}

void row(State& state, const std::vector<Layer>& layers, std::size_t i) {
    const Layer& layer = layers[i];
    ImGui::PushID(layer.id.c_str());
    bool on = layer.is_on;
    if (ImGui::Checkbox("##on", &on)) switch_layer(state, layer);
    ImGui::SameLine();
    const float button_px = ImGui::GetFrameHeight() + 2;
    const float left = ImGui::GetContentRegionMax().x - 3 * button_px;
    const float name_px = left - ImGui::GetCursorPosX() - ImGui::GetTreeNodeToLabelSpacing();
    const std::string name = fmt::format("{}###row", fitting(name_of(state, layer), name_px));
    ImGui::AlignTextToFramePadding();
    const bool is_open = ImGui::TreeNodeEx(
        name.c_str(), (layer.is_on ? ImGuiTreeNodeFlags_DefaultOpen : ImGuiTreeNodeFlags_None) |
                          ImGuiTreeNodeFlags_AllowItemOverlap);
    buttons(state, layers, i, left);
    if (is_open) {
        details(state, layer);
        ImGui::TreePop();
    }
    ImGui::PopID();
}

void add(State& state, const std::vector<Layer>& layers) {
    if (ImGui::Button(tr_label("Add a file..."))) state.commands.push_back(Command::Open);
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip(
            "%s",
            tr("A photograph, figures of the sun, tracks or places. Files can be dropped, too."));
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-1);
    if (!ImGui::BeginCombo("##add", tr("Add an effect"))) return;
    for (const std::string& id : further_layers(*state.effects, layers)) {
        const effect::Manifest& manifest = state.effects->registry.effect(id, "layers").manifest;
        if (ImGui::Selectable(fmt::format("{}##{}", manifest.name, id).c_str()))
            state.set_effects(switched(state.document.scene.effects, id, true));
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", manifest.description.c_str());
    }
    ImGui::EndCombo();
}

}  // namespace

void layers_panel(State& state) {
    overlay_panel(state);
    const std::vector<Layer> layers = layers_of(*state.effects, state.document);
    for (std::size_t i = 0; i < layers.size(); ++i)
        row(state, layers, i);
    add(state, layers);
}

}  // namespace relevo::viewer
