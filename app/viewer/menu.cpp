#include <array>
#include <filesystem>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "base/text.h"
#include "viewer/state.h"
#include "viewer/translation.h"
#include "viewer/window.h"

namespace relevo::viewer {
namespace {

struct Key {
    int key;
    bool control;
    Command command;
};

constexpr std::array<Key, 37> kKeys = {{
    {GLFW_KEY_O, true, Command::Open},
    {GLFW_KEY_PAGE_DOWN, true, Command::NextFile},
    {GLFW_KEY_PAGE_UP, true, Command::PreviousFile},
    {GLFW_KEY_F5, false, Command::ReadAgain},
    {GLFW_KEY_F12, false, Command::TakePicture},
    {GLFW_KEY_P, true, Command::ExportPicture},
    {GLFW_KEY_C, true, Command::CopyCommand},
    {GLFW_KEY_S, true, Command::SaveScene},
    {GLFW_KEY_J, true, Command::SaveJob},
    {GLFW_KEY_Q, true, Command::Quit},
    {GLFW_KEY_Z, true, Command::Undo},
    {GLFW_KEY_Y, true, Command::Redo},
    {GLFW_KEY_F, true, Command::Find},
    {GLFW_KEY_F, false, Command::Film},
    {GLFW_KEY_HOME, false, Command::Whole},
    {GLFW_KEY_N, false, Command::NorthUp},
    {GLFW_KEY_L, false, Command::LookToMoon},
    {GLFW_KEY_T, false, Command::FromAbove},
    {GLFW_KEY_G, false, Command::Walk},
    {GLFW_KEY_B, false, Command::SaveView},
    {GLFW_KEY_M, false, Command::Measure},
    {GLFW_KEY_ENTER, false, Command::EndMeasuring},
    {GLFW_KEY_KP_ENTER, false, Command::EndMeasuring},
    {GLFW_KEY_BACKSPACE, false, Command::DropCorner},
    {GLFW_KEY_C, false, Command::Compare},
    {GLFW_KEY_SPACE, false, Command::Play},
    {GLFW_KEY_LEFT_BRACKET, false, Command::Earlier},
    {GLFW_KEY_RIGHT_BRACKET, false, Command::Later},
    {GLFW_KEY_TAB, false, Command::Panels},
    {GLFW_KEY_F6, false, Command::PanelKeys},
    {GLFW_KEY_F10, false, Command::MenuKeys},
    {GLFW_KEY_P, false, Command::Charts},
    {GLFW_KEY_O, false, Command::Overlay},
    {GLFW_KEY_E, true, Command::SaveOverlay},
    {GLFW_KEY_H, false, Command::Keys},
    {GLFW_KEY_F1, false, Command::Keys},
    {GLFW_KEY_ESCAPE, false, Command::Close},
}};

void item(State& state, const char* label, const char* keys, Command command, bool checked = false,
          bool enabled = true) {
    if (ImGui::MenuItem(label, keys, checked, enabled)) state.commands.push_back(command);
}

/// The file name of a DEM, and the number of its other files.
void recent_files(State& state) {
    if (!ImGui::BeginMenu(tr_label("Open recent"), !state.recent.empty())) return;
    for (std::size_t i = 0; i < state.recent.size(); ++i) {
        const std::vector<std::string>& dems = state.recent[i].files;
        if (ImGui::MenuItem(fmt::format("{}##{}", short_name(dems), i).c_str()))
            state.recent_to_open = state.recent[i];
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", printable(dems.front()).c_str());
    }
    ImGui::EndMenu();
}

void file_menu(State& state) {
    if (!ImGui::BeginMenu(tr_label("File"))) return;
    item(state, tr_label("Open..."), tr("Ctrl+O"), Command::Open);
    recent_files(state);
    item(state, tr_label("How this DEM is read..."), nullptr, Command::HowToRead);
    item(state, tr_label("Next DEM in the folder"), tr("Ctrl+Page down"), Command::NextFile);
    item(state, tr_label("Previous DEM in the folder"), tr("Ctrl+Page up"), Command::PreviousFile);
    ImGui::Separator();
    item(state, tr_label("Save picture"), "F12", Command::TakePicture);
    item(state, tr_label("Export..."), tr("Ctrl+P"), Command::ExportPicture);
    item(state, tr_label("Film..."), "F", Command::Film);
    item(state, tr_label("Export overlay as GeoTIFF"), tr("Ctrl+E"), Command::SaveOverlay, false,
         state.document.overlay.kind > OverlayKind::File);
    item(state, tr_label("Save scene"), tr("Ctrl+S"), Command::SaveScene);
    item(state, tr_label("Save the day as a job"), tr("Ctrl+J"), Command::SaveJob);
    ImGui::Separator();
    item(state, tr_label("Quit"), tr("Ctrl+Q"), Command::Quit);
    ImGui::EndMenu();
}

/// "Undo: time"
std::string with_name(const char* label, const std::string& of) {
    return of.empty() ? label : tr_format("{}: {}", label, of);
}

void edit_menu(State& state) {
    if (!ImGui::BeginMenu(tr_label("Edit"))) return;
    item(state, with_name(tr_label("Undo"), state.undo_name).c_str(), tr("Ctrl+Z"), Command::Undo,
         false, !state.undo_name.empty());
    item(state, with_name(tr_label("Redo"), state.redo_name).c_str(), tr("Ctrl+Y"), Command::Redo,
         false, !state.redo_name.empty());
    ImGui::Separator();
    item(state, tr_label("Copy command"), tr("Ctrl+C"), Command::CopyCommand);
    if (ImGui::MenuItem(tr_label("Copy coordinates"), nullptr, false, state.chosen.has_value()))
        ImGui::SetClipboardText(
            coordinates_text(*state.chosen, state.settings.coordinates).c_str());
    ImGui::EndMenu();
}

void saved_views(State& state) {
    if (state.views.empty()) return;
    ImGui::Separator();
    std::optional<std::size_t> gone;
    for (std::size_t i = 0; i < state.views.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        if (ImGui::SmallButton(tr_label("go"))) {
            state.view_to_go_to = i;
            ImGui::CloseCurrentPopup();
        }
        ImGui::SameLine();
        ImGui::SetNextItemWidth(ImGui::GetFontSize() * 12);
        ImGui::InputText("##name", &state.views[i].name, ImGuiInputTextFlags_AutoSelectAll);
        state.views_changed = state.views_changed || ImGui::IsItemDeactivatedAfterEdit();
        ImGui::SameLine();
        if (ImGui::SmallButton("x")) gone = i;
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tr("Delete this view"));
        if (i < 9) {
            ImGui::SameLine();
            ImGui::TextDisabled("%d", static_cast<int>(i) + 1);
        }
        ImGui::PopID();
    }
    if (!gone) return;
    state.views.erase(state.views.begin() + static_cast<std::ptrdiff_t>(*gone));
    state.views_changed = true;
}

void style_items(Settings& settings) {
    if (ImGui::MenuItem(tr_label("Light theme"), nullptr, settings.light_style))
        settings.light_style = !settings.light_style;
    if (ImGui::BeginMenu(tr_label("Font size"))) {
        for (const int px : {13, 16, 20, 24, 28})
            if (ImGui::MenuItem(fmt::format("{}", px).c_str(), nullptr, settings.text_px == px))
                settings.text_px = px;
        ImGui::EndMenu();
    }
    if (ImGui::BeginMenu(tr_label("Coordinates"))) {
        for (const auto& [name, kind] :
             {std::pair("UTM", Coordinates::Utm), std::pair("MGRS", Coordinates::Mgrs),
              std::pair(tr_later("Degrees"), Coordinates::Degrees)})
            if (ImGui::MenuItem(tr_label(name), nullptr, settings.coordinates == kind))
                settings.coordinates = kind;
        ImGui::EndMenu();
    }
}

void view_menu(State& state) {
    if (!ImGui::BeginMenu(tr_label("View"))) return;
    item(state, tr_label("Whole DEM"), tr("Home"), Command::Whole);
    item(state, tr_label("North up"), "N", Command::NorthUp);
    item(state, tr_label("Top view"), "T", Command::FromAbove);
    item(state, tr_label("Walk at eye height"), "G", Command::Walk);
    item(state, tr_label("Go to a place..."), tr("Ctrl+F"), Command::Find);
    item(state, tr_label("Save view"), "B", Command::SaveView);
    saved_views(state);
    ImGui::Separator();
    item(state, tr_label("Panels"), tr("Tab"), Command::Panels, state.settings.panels);
    item(state, tr_label("Keyboard in the panels"), "F6", Command::PanelKeys);
    style_items(state.settings);
    ImGui::EndMenu();
}

void sun_menu(State& state) {
    if (!ImGui::BeginMenu(tr_label("Sun"))) return;
    item(state, tr_label("Now"), nullptr, Command::Now);
    item(state, tr_label("Half an hour earlier"), "[", Command::Earlier);
    item(state, tr_label("Half an hour later"), "]", Command::Later);
    item(state, tr_label("A day earlier"), tr("Shift+["), Command::DayEarlier);
    item(state, tr_label("A day later"), tr("Shift+]"), Command::DayLater);
    item(state, state.playing ? tr_label("Pause") : tr_label("Play"), tr("Space"), Command::Play);
    ImGui::Separator();
    item(state, tr_label("Look to the moon"), "L", Command::LookToMoon);
    item(state, tr_label("Next moonrise"), nullptr, Command::NextMoonrise);
    item(state, tr_label("When the sun stands over the point"), nullptr, Command::SunOverPoint,
         false, state.chosen.has_value());
    item(state, tr_label("When the moon stands over the point"), nullptr, Command::MoonOverPoint,
         false, state.chosen.has_value());
    item(state, tr_label("Sun hours of the day"), "O", Command::Overlay,
         state.document.overlay.shows_day());
    item(state, tr_label("Horizon and year of the point"), "P", Command::Charts,
         state.settings.charts);
    ImGui::EndMenu();
}

void tools_menu(State& state) {
    if (!ImGui::BeginMenu(tr_label("Tools"))) return;
    item(state, tr_label("Measure"), "M", Command::Measure, state.measurement.follows_cursor);
    item(state, tr_label("Comparison"), "C", Command::Compare, state.compare_is_wanted);
    item(state, tr_label("Reload effects"), "F5", Command::ReadAgain);
    ImGui::EndMenu();
}

void help_menu(State& state) {
    if (!ImGui::BeginMenu(tr_label("Help"))) return;
    item(state, tr_label("First steps"), nullptr, Command::FirstSteps);
    item(state, tr_label("Keys"), "H", Command::Keys);
    item(state, tr_label("About Relevo"), nullptr, Command::About);
    ImGui::EndMenu();
}

}  // namespace

std::optional<Command> command_of(const KeyPress& press) {
    if (press.key == GLFW_KEY_Z && press.control && press.shift) return Command::Redo;
    for (const Key& key : kKeys) {
        if (key.key != press.key || key.control != press.control) continue;
        if (press.shift && key.command == Command::Earlier) return Command::DayEarlier;
        if (press.shift && key.command == Command::Later) return Command::DayLater;
        return key.command;
    }
    return std::nullopt;
}

void menu_bar(State& state) {
    if (!ImGui::BeginMainMenuBar()) return;
    if (std::exchange(state.opens_menu, false)) ImGui::OpenPopup(tr_label("File"));
    file_menu(state);
    edit_menu(state);
    view_menu(state);
    sun_menu(state);
    tools_menu(state);
    help_menu(state);
    ImGui::EndMainMenuBar();
}

}  // namespace relevo::viewer
