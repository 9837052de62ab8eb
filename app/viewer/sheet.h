#pragma once

#include <algorithm>
#include <initializer_list>

#include <imgui.h>

namespace relevo::viewer {

/// Whether Esc closes the sheet that is being drawn: it has the focus, also if one of its text
/// fields has it.
inline bool closes_sheet() {
    return ImGui::IsWindowFocused(ImGuiFocusedFlags_RootAndChildWindows) &&
           ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
}

/// Room that labels take on the right of their fields [px].
inline float widest(std::initializer_list<const char*> labels) {
    float width = 0;
    for (const char* label : labels)
        width = std::max(width, ImGui::CalcTextSize(label).x);
    return width + ImGui::GetFontSize() / 2;
}

}  // namespace relevo::viewer
