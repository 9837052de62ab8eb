#include "viewer/open_dialog.h"

#include <algorithm>
#include <chrono>
#include <system_error>
#include <utility>

#include <imgui.h>
#include <imgui_stdlib.h>

#include "base/text.h"
#include "viewer/file_dialog.h"
#include "viewer/settings.h"

namespace relevo::viewer {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> folders_in(const fs::path& folder) {
    std::vector<std::string> names;
    std::error_code ignored;
    for (fs::directory_iterator it(folder, ignored), end; it != end; it.increment(ignored)) {
        if (ignored) break;
        const std::string name = it->path().filename().string();
        if (!name.starts_with('.') && it->is_directory(ignored)) names.push_back(name);
    }
    std::ranges::sort(names);
    return names;
}

}  // namespace

void OpenDialog::open(const std::string& dem) {
    if (!desktop_) desktop_ = ask_for_files();
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
    folders_ = folders_in(folder_);
    dems_ = dems_in(folder_);
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
    for (const std::string& name : dems_)
        if (ImGui::Selectable(printable(name).c_str())) return choose(folder_ / name);
    if (dems_.empty()) ImGui::TextDisabled("no DEM in this folder");
}

void OpenDialog::draw(glm::vec2 size_px) {
    if (!is_open_) return;
    const float line = ImGui::GetFrameHeight();
    ImGui::SetNextWindowPos({size_px.x / 2, size_px.y / 2}, ImGuiCond_Appearing, {0.5f, 0.5f});
    ImGui::SetNextWindowSize(
        {std::min(size_px.x - 20, 26 * line), std::min(size_px.y - 20, 20 * line)},
        ImGuiCond_Appearing);
    if (ImGui::Begin("Open a DEM", &is_open_, ImGuiWindowFlags_NoCollapse)) {
        if (std::exchange(takes_focus_, false)) ImGui::SetKeyboardFocusHere();
        ImGui::SetNextItemWidth(-4 * line);
        ImGui::PushID(visits_);
        const bool is_done =
            ImGui::InputText("##name", &name_, ImGuiInputTextFlags_EnterReturnsTrue);
        ImGui::PopID();
        ImGui::SameLine();
        if (ImGui::Button("Open", {-1, 0}) || is_done) enter();
        if (ImGui::BeginChild("files", {0, 0}, /*border=*/true)) list();
        ImGui::EndChild();
    }
    ImGui::End();
}

}  // namespace relevo::viewer
