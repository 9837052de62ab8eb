#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

#include "base/text.h"
#include "viewer/measurement_panel.h"
#include "viewer/overlay.h"
#include "viewer/state.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

constexpr float kPanel_px = 360, kBeside_px = 10;

void export_panel(State& state) {
    const auto button = [&](const char* name, Command command) {
        if (ImGui::Button(name)) state.commands.push_back(command);
    };
    button(tr_label("Picture (F12)"), Command::TakePicture);
    ImGui::SameLine();
    button(tr_label("Export..."), Command::ExportPicture);
    button(tr_label("Copy command"), Command::CopyCommand);
    ImGui::SameLine();
    button(tr_label("Save scene"), Command::SaveScene);
}

/// Keeps a constant height for the panel's text, so that panels below do not move.
void roomy_point_panel(State& state) {
    const float top = ImGui::GetCursorPosY();
    ImGui::PushTextWrapPos();
    point_panel(state);
    ImGui::PopTextWrapPos();
    const float used = ImGui::GetCursorPosY() - top;
    state.point_room_px = state.chosen ? std::max(state.point_room_px, used) : 0;
    ImGui::SetCursorPosY(top + std::max(state.point_room_px, used));
}

/// Moves a panel back into the window far enough for the user to drag it.
void keep_in_reach(glm::vec2 size_px) {
    const ImVec2 at = ImGui::GetWindowPos(), extent = ImGui::GetWindowSize();
    const float reach = 5 * ImGui::GetFrameHeight();
    const ImVec2 kept{
        std::clamp(at.x, reach - extent.x, std::max(0.0f, size_px.x - reach)),
        std::clamp(at.y, ImGui::GetFrameHeight(),
                   std::max(ImGui::GetFrameHeight(), size_px.y - 2 * ImGui::GetFrameHeight()))};
    if (kept.x != at.x || kept.y != at.y) ImGui::SetWindowPos(kept);
}

}  // namespace

void side_panel(State& state, glm::vec2 size_px, double px_a_unit) {
    const auto width = static_cast<float>(kPanel_px * px_a_unit);
    const float top = 10 + ImGui::GetFrameHeight();
    ImGui::SetNextWindowPos({kBeside_px, top}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSizeConstraints({width, 60}, {width, size_px.y - top - 50 - state.bar_px});
    ImGui::Begin("Relevo", nullptr,
                 ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_AlwaysAutoResize);
    constexpr ImGuiTreeNodeFlags kOpen = ImGuiTreeNodeFlags_DefaultOpen;
    keep_in_reach(size_px);
    const float left = ImGui::GetWindowPos().x;
    state.side_panel_px = {left, ImGui::IsWindowCollapsed() ? left : left + width};
    state.measurement.marked.reset();
    if (state.measurement.profile && ImGui::CollapsingHeader(tr_label("Measured line"), kOpen))
        measurement_panel(state);
    if (ImGui::CollapsingHeader(tr_label("Sun"), kOpen)) sun_panel(state);
    if (ImGui::CollapsingHeader(tr_label("View"))) view_panel(state, double{size_px.x} / size_px.y);
    if (ImGui::CollapsingHeader(tr_label("Layers"), kOpen)) layers_panel(state);
    if (ImGui::CollapsingHeader(tr_label("Point"), kOpen)) roomy_point_panel(state);
    if (ImGui::CollapsingHeader(tr_label("Effects"), kOpen)) effects_panel(state);
    if (ImGui::CollapsingHeader(tr_label("Export"), kOpen)) export_panel(state);
    ImGui::End();
}

scene::Insets side_panel_insets(const State& state, glm::vec2 size_px, double px_a_unit) {
    const auto width = static_cast<float>(kPanel_px * px_a_unit);
    const glm::vec2 sides = state.side_panel_px.value_or(glm::vec2(kBeside_px, kBeside_px + width));
    if (sides.x == sides.y) return {};
    scene::Insets insets;
    if (sides.x + sides.y < size_px.x)
        insets.left = std::max(0.0f, (sides.y + kBeside_px) / size_px.x);
    else
        insets.right = std::max(0.0f, 1 - (sides.x - kBeside_px) / size_px.x);
    return std::max(insets.left, insets.right) > 0.5 ? scene::Insets() : insets;
}

void status_line(const State& state, const std::string& work) {
    std::string text;
    if (state.cursor) {
        const Cursor& at = *state.cursor;
        text = coordinates_text(at.place, state.settings.coordinates) + "   " +
               (std::isnan(at.place.height_m) ? tr("no height")
                                              : fmt::format("{:.1f} m", at.place.height_m));
        if (const std::string slope = slope_text(at.slope_deg, at.aspect_deg); !slope.empty())
            text += "   " + slope;
        if (state.overlay)
            if (const std::string words = overlay_words(*state.overlay, at.place); !words.empty())
                text += "   " + words;
    } else {
        text = tr("H: keys");
    }
    if (state.is_preview)
        text +=
            std::string("   ") + tr("reading all posts; terrain and shadows are coarse until then");
    if (!work.empty()) text += "   " + work;
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    const ImVec2 extent = ImGui::CalcTextSize(text.c_str());
    const ImVec2 at{12, ImGui::GetIO().DisplaySize.y - state.bar_px - extent.y - 10};
    list.AddRectFilled({at.x - 6, at.y - 4}, {at.x + extent.x + 6, at.y + extent.y + 4},
                       IM_COL32(0, 0, 0, 150), 4);
    list.AddText(at, IM_COL32(255, 255, 255, 235), text.c_str());
}

void waiting_text(const scene::Scene& scene) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({size.x / 2, 20 + ImGui::GetFrameHeight()}, ImGuiCond_Always,
                            {0.5f, 0});
    ImGui::SetNextWindowSizeConstraints({0, 0}, {size.x - 20, size.y});
    ImGui::Begin("##opening", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize);
    ImGui::TextUnformatted(tr_format("opening {} ...", printable(scene.dems.front())).c_str());
    ImGui::End();
}

void message_box(State& state, glm::vec2 size_px, double px_a_unit) {
    if (state.message.empty()) return;
    const float width = std::max(size_px.x - 2 * static_cast<float>((kPanel_px + 30) * px_a_unit),
                                 std::min(size_px.x - 20, 420.0f));
    ImGui::SetNextWindowPos({size_px.x / 2, ImGui::GetFrameHeight() + 10}, ImGuiCond_Always,
                            {0.5f, 0});
    ImGui::SetNextWindowSizeConstraints({0, 0}, {width, size_px.y / 2});
    ImGui::Begin("##message", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                     ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoMove);
    if (ImGui::SmallButton("x")) state.message.clear();
    ImGui::SameLine();
    ImGui::PushTextWrapPos(width - 20);
    ImGui::TextUnformatted(state.message.c_str());
    ImGui::PopTextWrapPos();
    ImGui::End();
}

}  // namespace relevo::viewer
