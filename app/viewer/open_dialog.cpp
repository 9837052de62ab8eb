#include "viewer/open_dialog.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <system_error>
#include <utility>

#include <imgui.h>
#include <imgui_stdlib.h>

#include "base/contains.h"
#include "base/text.h"
#include "viewer/document.h"
#include "viewer/file_kind.h"
#include "viewer/settings.h"
#include "viewer/sheet.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

namespace fs = std::filesystem;

/// What is in a folder, by name. @param is_listed  of an entry
template <typename IsListed>
std::vector<std::string> names_in(const fs::path& folder, const IsListed& is_listed) {
    std::vector<std::string> names;
    std::error_code ignored;
    for (fs::directory_iterator it(folder, ignored), end; it != end; it.increment(ignored)) {
        if (ignored) break;
        const std::string name = it->path().filename().string();
        if (!name.starts_with('.') && is_listed(*it)) names.push_back(name);
    }
    std::ranges::sort(names);
    return names;
}

bool is_installed(const std::string& program) {
    const char* const path = std::getenv("PATH");
    std::error_code ignored;
    return std::ranges::any_of(split(path ? path : "", ':'), [&](const std::string& folder) {
        return fs::is_regular_file(fs::path(folder) / program, ignored);
    });
}

std::vector<std::string> lines_of(const std::string& command) {
    std::vector<std::string> lines;
    std::FILE* const pipe = popen(command.c_str(), "r");
    if (!pipe) return lines;
    std::string text;
    std::array<char, 4096> piece{};
    while (const std::size_t count = std::fread(piece.data(), 1, piece.size(), pipe))
        text.append(piece.data(), count);
    pclose(pipe);
    for (const std::string& line : split(text, '\n'))
        if (!line.empty()) lines.push_back(line);
    return lines;
}

/// Opens the dialog of the desktop; its files, if any, come from another thread.
/// @returns none: neither zenity nor kdialog is installed
std::optional<std::future<std::vector<std::string>>> ask_desktop() {
    std::string command;
    if (is_installed("zenity"))
        command = fmt::format(
            "zenity --file-selection --multiple --separator='\n' --title={} 2>/dev/null",
            quoted(tr("Open a file")));
    else if (is_installed("kdialog"))
        command = "kdialog --getopenfilename . --multiple --separate-output 2>/dev/null";
    if (command.empty()) return std::nullopt;
    return std::async(std::launch::async, [command] { return lines_of(command); });
}

}  // namespace

void OpenDialog::open(const std::string& dem) {
    if (!desktop_) desktop_ = ask_desktop();
    if (!desktop_) open_panel(dem);
}

std::vector<std::string> OpenDialog::take() {
    std::vector<std::string> files = std::exchange(chosen_, {});
    if (!desktop_ || desktop_->wait_for(std::chrono::seconds(0)) != std::future_status::ready)
        return files;
    std::vector<std::string> from_desktop = desktop_->get();
    desktop_.reset();
    return files.empty() ? from_desktop : files;
}

void OpenDialog::open_panel(const std::string& dem) {
    std::error_code ignored;
    const fs::path file = dem.empty() ? fs::path() : fs::path(absolute_names({dem}).front());
    const bool is_file = fs::is_regular_file(file, ignored);
    go_to(is_file ? file.parent_path() : fs::current_path(ignored));
    is_open_ = true;
}

void OpenDialog::go_to(const fs::path& folder) {
    folder_ = folder.lexically_normal();
    if (!folder_.has_filename() && folder_.has_relative_path()) folder_ = folder_.parent_path();
    std::error_code ignored;
    folders_ = names_in(folder_, [&](const auto& entry) { return entry.is_directory(ignored); });
    files_ = dems_in(folder_);
    const std::vector<std::string> layers = names_in(folder_, [&](const auto& entry) {
        return entry.is_regular_file(ignored) && is_name_of_layer(entry.path().string()) &&
               !contains(files_, entry.path().filename().string());
    });
    files_.insert(files_.end(), layers.begin(), layers.end());
    name_ = folder_.string();
    if (!name_.ends_with('/')) name_ += '/';
    takes_focus_ = true;
    ++visits_;
}

void OpenDialog::choose(const fs::path& file) {
    chosen_ = {file.string()};
    is_open_ = false;
}

void OpenDialog::enter() {
    if (name_.empty()) return;
    std::error_code ignored;
    const fs::path named = folder_ / name_;  // the name may be absolute
    fs::is_directory(named, ignored) ? go_to(named) : choose(named);
}

void OpenDialog::list() {
    if (ImGui::Selectable("..")) return go_to(folder_.parent_path());
    for (const std::string& name : folders_)
        if (ImGui::Selectable((printable(name) + "/").c_str())) return go_to(folder_ / name);
    for (const std::string& name : files_)
        if (ImGui::Selectable(printable(name).c_str())) return choose(folder_ / name);
    if (files_.empty()) ImGui::TextDisabled("%s", tr("nothing in this folder that can be opened"));
}

void OpenDialog::draw(glm::vec2 size_px) {
    if (!is_open_) return;
    const float line = ImGui::GetFrameHeight();
    ImGui::SetNextWindowPos({size_px.x / 2, size_px.y / 2}, ImGuiCond_Appearing, {0.5f, 0.5f});
    ImGui::SetNextWindowSize(
        {std::min(size_px.x - 20, 26 * line), std::min(size_px.y - 20, 20 * line)},
        ImGuiCond_Appearing);
    if (ImGui::Begin(tr_label("Open a file"), &is_open_, ImGuiWindowFlags_NoCollapse)) {
        if (std::exchange(takes_focus_, false)) ImGui::SetKeyboardFocusHere();
        ImGui::SetNextItemWidth(-4 * line);
        ImGui::PushID(visits_);
        const bool is_done = ImGui::InputText(
            "##name", &name_,
            ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
        ImGui::PopID();
        ImGui::SameLine();
        if (ImGui::Button(tr_label("Open"), {-1, 0}) || is_done) enter();
        if (ImGui::BeginChild("files", {0, 0}, /*border=*/true)) list();
        ImGui::EndChild();
        if (closes_sheet()) close();
    }
    ImGui::End();
}

}  // namespace relevo::viewer
