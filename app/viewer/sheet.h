#pragma once

#include <imgui.h>

namespace relevo::viewer {

/// Whether Esc closes the sheet that is being drawn: it has the focus, also if one of its text
/// fields has it.
inline bool closes_sheet() {
    return ImGui::IsWindowFocused(ImGuiFocusedFlags_RootAndChildWindows) &&
           ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
}

}  // namespace relevo::viewer
