#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>

#include "base/text.h"
#include "viewer/measurement_panel.h"
#include "viewer/overlay.h"
#include "viewer/state.h"
#include "viewer/style.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

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

}  // namespace

void side_panel(State& state, glm::vec2 size_px, double px_a_unit) {
    const Area& side = state.layout.side;
    ImGui::SetNextWindowPos({side.at.x, side.at.y});
    ImGui::SetNextWindowSize({side.size.x, side.size.y});
    ImGui::SetNextWindowSizeConstraints({1, side.size.y}, {size_px.x, side.size.y});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
    ImGui::Begin("Relevo", nullptr,
                 ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoTitleBar |
                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoBringToFrontOnFocus);
    ImGui::PopStyleVar();
    if (const float width = ImGui::GetWindowWidth(); width != side.size.x)
        state.settings.panel_width = static_cast<int>(std::lround(width / px_a_unit));
    constexpr ImGuiTreeNodeFlags kOpen = ImGuiTreeNodeFlags_DefaultOpen;
    // A double click edits a slider's number, as Ctrl and a click do. A text field has double
    // clicks of its own, and ImGui ends the program where one of the two says otherwise than the
    // other.
    ImGuiIO& io = ImGui::GetIO();
    const bool was_down = io.KeyCtrl;
    const ImGuiKeyModFlags were_down = io.KeyMods;
    if (ImGui::IsMouseDoubleClicked(0) && !io.WantTextInput) {
        io.KeyCtrl = true;
        io.KeyMods |= ImGuiKeyModFlags_Ctrl;
    }
    state.measurement.marked.reset();
    if (state.measurement.profile && ImGui::CollapsingHeader(tr_label("Measured line"), kOpen))
        measurement_panel(state);
    if (ImGui::CollapsingHeader(tr_label("Sun"), kOpen)) sun_panel(state);
    if (ImGui::CollapsingHeader(tr_label("Camera")))
        view_panel(state, double{size_px.x} / size_px.y);
    if (ImGui::CollapsingHeader(tr_label("Layers"), kOpen)) layers_panel(state);
    if (ImGui::CollapsingHeader(tr_label("Point"), kOpen)) roomy_point_panel(state);
    if (ImGui::CollapsingHeader(tr_label("Effects"), kOpen)) effects_panel(state);
    if (ImGui::CollapsingHeader(tr_label("Export"), kOpen)) export_panel(state);
    io.KeyCtrl = was_down;
    io.KeyMods = were_down;
    ImGui::End();
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
    const Area& picture = state.layout.picture;
    const float room = std::max(1.0f, picture.size.x - style::px(24));
    const float high = ImGui::CalcTextSize(text.c_str(), nullptr, false, room).y;
    label_over({picture.at.x + style::px(12), picture.end().y - high - style::px(10)}, text.c_str(),
               room);
}

void draw_no_picture() {
    ImGui::GetBackgroundDrawList()->AddRectFilledMultiColor(
        {0, 0}, ImGui::GetIO().DisplaySize, style::kDusk, style::kDusk, style::kDawn, style::kDawn);
}

void opening_card(const State& state, const scene::Scene& scene, double since_s) {
    const Area& free = state.layout.picture;
    const float em = ImGui::GetFontSize(), width = std::min(26 * em, free.size.x - 2 * em);
    ImGui::SetNextWindowPos({free.at.x + free.size.x / 2, free.at.y + free.size.y / 2},
                            ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSizeConstraints({width, 0}, {width, free.size.y});
    ImGui::Begin("##opening", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize);
    {
        const style::Sized title(style::Size::Title);
        ImGui::TextUnformatted("Relevo");
    }
    ImGui::PushTextWrapPos();
    ImGui::TextUnformatted(tr_format("opening {} ...", printable(scene.dems.front())).c_str());
    ImGui::PopTextWrapPos();
    // How much is left to do is not known.
    constexpr double kTurn_s = 2.5;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float room = ImGui::GetContentRegionAvail().x, piece = 0.25f * room, high = 0.4f * em;
    const auto turn = static_cast<float>(std::fmod(since_s, kTurn_s) / kTurn_s);
    const float left = (room - piece) * (turn < 0.5f ? 2 * turn : 2 - 2 * turn);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(at, {at.x + room, at.y + high}, ImGui::GetColorU32(ImGuiCol_FrameBg), 3);
    list.AddRectFilled({at.x + left, at.y}, {at.x + left + piece, at.y + high},
                       ImGui::GetColorU32(ImGuiCol_PlotHistogram), 3);
    ImGui::Dummy({room, high});
    ImGui::End();
}

void message_box(State& state, double px_a_unit) {
    if (state.message.empty()) return;
    const Area& picture = state.layout.picture;
    constexpr double kBeside = 80;  // for legend and north arrow
    const float width = picture.size.x - static_cast<float>(2 * kBeside * px_a_unit);
    ImGui::SetNextWindowPos({picture.at.x + picture.size.x / 2, picture.at.y + style::px(10)},
                            ImGuiCond_Always, {0.5f, 0});
    ImGui::SetNextWindowSizeConstraints({0, 0}, {width, picture.size.y / 2});
    ImGui::Begin("##message", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                     ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoMove);
    if (ImGui::SmallButton("x")) state.message.clear();
    ImGui::SameLine();
    ImGui::PushTextWrapPos(width - style::px(20));
    ImGui::TextUnformatted(state.message.c_str());
    ImGui::PopTextWrapPos();
    ImGui::End();
}

}  // namespace relevo::viewer
