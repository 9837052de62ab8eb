#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "base/units.h"
#include "dem/surface.h"
#include "scene/options.h"
#include "viewer/sheet.h"
#include "viewer/state.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

/// The long side of a camera's sensor [mm].
struct Sensor {
    const char* name;
    double side_mm;
};
constexpr std::array<Sensor, 6> kSensors = {{{tr_later("full frame, 36 mm"), 36},
                                             {tr_later("APS-C, 23.5 mm"), 23.5},
                                             {tr_later("APS-C of Canon, 22.3 mm"), 22.3},
                                             {tr_later("four thirds, 17.3 mm"), 17.3},
                                             {tr_later("1 inch, 13.2 mm"), 13.2},
                                             {tr_later("telephone, 9.8 mm"), 9.8}}};

/// Ends a step of undo with the widget before it.
void end_step(State& state) {
    state.step = state.step || ImGui::IsItemDeactivatedAfterEdit();
}

/// The focal length on the chosen sensor, which with the aspect of the window is the field of view.
void lens(State& state, double aspect) {
    const double side_mm = kSensors[static_cast<std::size_t>(state.sensor)].side_mm;
    double& fov_y_rad = state.document.pose.fov_y_rad;
    const double height_mm = aspect >= 1 ? side_mm / aspect : side_mm;
    auto focal_mm = static_cast<float>(height_mm / 2 / std::tan(fov_y_rad / 2));
    const std::string text =
        slider_format(tr_format("{} mm, {:.0f}° high", kSliderValue, degrees(fov_y_rad)),
                      focal_mm < 10 ? "%.1f" : "%.0f");
    if (ImGui::SliderFloat(tr_label("Lens"), &focal_mm, 4, 600, text.c_str(),
                           ImGuiSliderFlags_Logarithmic))
        fov_y_rad = 2 * std::atan(height_mm / 2 / std::max(1.0, double{focal_mm}));
    end_step(state);
    if (ImGui::BeginCombo(tr_label("Sensor"),
                          tr(kSensors[static_cast<std::size_t>(state.sensor)].name))) {
        for (std::size_t i = 0; i < kSensors.size(); ++i)
            if (ImGui::Selectable(tr_label(kSensors[i].name), static_cast<int>(i) == state.sensor))
                state.sensor = static_cast<int>(i);
        ImGui::EndCombo();
    }
}

void exposure(State& state) {
    const scene::Option& option = scene::option("--exposure");
    auto stops = static_cast<float>(state.document.scene.exposure_ev);
    if (ImGui::SliderFloat(tr_label("Exposure"), &stops, -5, 5, "%+.1f EV"))
        state.document.scene.exposure_ev =
            std::clamp(std::round(10.0 * stops) / 10, option.min, option.max);
    end_step(state);
}

void backdrop(State& state) {
    scene::Backdrop& chosen = state.document.scene.backdrop;
    const bool sky = chosen == scene::Backdrop::Horizon;
    if (!ImGui::BeginCombo(tr_label("Backdrop"), sky ? tr("sky and horizon") : tr("studio")))
        return;
    const auto choice = [&](const char* name, scene::Backdrop of, bool is_chosen) {
        if (!ImGui::Selectable(name, is_chosen) || is_chosen) return;
        chosen = of;
        state.step = true;
    };
    choice(tr_label("sky and horizon"), scene::Backdrop::Horizon, sky);
    choice(tr_label("studio"), scene::Backdrop::Studio, !sky);
    ImGui::EndCombo();
}

/// Taken when the slider is let go: the ground is drawn anew.
void exaggeration(State& state) {
    double& taken = state.document.scene.exaggeration;
    float& times = state.dragged_exaggeration;
    if (!state.drags_exaggeration) times = static_cast<float>(taken);
    ImGui::SliderFloat(tr_label("Heights"), &times, 0.5f, 10, "x %.2f",
                       ImGuiSliderFlags_Logarithmic);
    state.drags_exaggeration = ImGui::IsItemActive();
    if (!ImGui::IsItemDeactivatedAfterEdit()) return;
    const scene::Option& option = scene::option("--exaggerate");
    taken = std::clamp(std::round(100.0 * times) / 100, option.min, option.max);
    state.chooses_exaggeration = false;
    state.step = true;
}

/// Where heights are dense enough to show houses.
void surface(State& state) {
    bool& shown = state.document.scene.land_cover.surface;
    if (state.spacing_m > dem::kSurfacePosts_m && !shown) return;
    state.step = ImGui::Checkbox(tr_label("Houses and trees in the heights"), &shown) || state.step;
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("%s", tr("The heights are those of a surface model: draws its roofs, "
                                   "walls, streets and trees as such"));
}

/// Of displayed times. "auto" is that of the place.
void zone(State& state) {
    ImGui::InputTextWithHint(
        tr_label("Zone"), state.document.zone.name().c_str(), &state.zone_text,
        ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("%s", tr("Europe/Zurich, +05:30, solar, or auto: that of the place"));
    if (!ImGui::IsItemDeactivatedAfterEdit()) return;
    state.zone_to_show = state.zone_text;
    state.zone_text.clear();
}

}  // namespace

void view_panel(State& state, double aspect) {
    ImGui::PushItemWidth(-widest(
        {tr("Lens"), tr("Sensor"), tr("Exposure"), tr("Heights"), tr("Zone"), tr("Backdrop")}));
    lens(state, aspect);
    exposure(state);
    exaggeration(state);
    zone(state);
    backdrop(state);
    surface(state);
    ImGui::PopItemWidth();
}

}  // namespace relevo::viewer
