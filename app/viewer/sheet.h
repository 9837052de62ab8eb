#pragma once

#include <imgui.h>

namespace relevo::viewer {

/// Whether Esc closes the sheet that is being drawn: it has the focus, also if one of its text
/// fields has it. An open list takes Esc first.
inline bool closes_sheet() {
    return !ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopup) &&
           ImGui::IsWindowFocused(ImGuiFocusedFlags_RootAndChildWindows) &&
           ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
}

}  // namespace relevo::viewer
