#include "viewer/style.h"

#include <span>
#include <utility>

namespace relevo::viewer::style {
namespace {

using Row = std::pair<ImGuiCol, unsigned>;

// Text has a contrast of at least 4.5 : 1 on all that it stands on (tests/window/test_style.cpp).
constexpr Row kDark[] = {{ImGuiCol_Text, 0xe8eaed},
                         {ImGuiCol_TextDisabled, 0xa3aab4},
                         {ImGuiCol_WindowBg, 0x15171b},
                         {ImGuiCol_PopupBg, 0x1b1e23},
                         {ImGuiCol_Border, 0x30353d},
                         {ImGuiCol_MenuBarBg, 0x222427},
                         {ImGuiCol_TitleBg, 0x222427},
                         {ImGuiCol_TitleBgActive, 0x2a2f37},
                         {ImGuiCol_FrameBg, 0x262a31},
                         {ImGuiCol_FrameBgHovered, 0x30363f},
                         {ImGuiCol_FrameBgActive, 0x39414c},
                         {ImGuiCol_ScrollbarBg, 0x15171b},
                         {ImGuiCol_ScrollbarGrab, 0x3a414b},
                         {ImGuiCol_ScrollbarGrabHovered, 0x4a525e},
                         {ImGuiCol_ScrollbarGrabActive, 0x5a6370},
                         {ImGuiCol_CheckMark, 0xf2b84b},
                         {ImGuiCol_SliderGrab, 0x86631f},
                         {ImGuiCol_SliderGrabActive, 0x86631f},
                         {ImGuiCol_Button, 0x2d323a},
                         {ImGuiCol_ButtonHovered, 0x3a424e},
                         {ImGuiCol_ButtonActive, 0x4a5361},
                         {ImGuiCol_Header, 0x22262c},
                         {ImGuiCol_HeaderHovered, 0x2e343c},
                         {ImGuiCol_HeaderActive, 0x38404a},
                         {ImGuiCol_Separator, 0x30353d},
                         {ImGuiCol_SeparatorHovered, 0xb98a35},
                         {ImGuiCol_SeparatorActive, 0xf2b84b},
                         {ImGuiCol_ResizeGrip, 0x22262c},
                         {ImGuiCol_ResizeGripHovered, 0xb98a35},
                         {ImGuiCol_ResizeGripActive, 0xf2b84b},
                         {ImGuiCol_Tab, 0x22262c},
                         {ImGuiCol_TabHovered, 0x3a424e},
                         {ImGuiCol_TabActive, 0x39414c},
                         {ImGuiCol_TabUnfocused, 0x22262c},
                         {ImGuiCol_TabUnfocusedActive, 0x39414c},
                         {ImGuiCol_PlotHistogram, 0xf2b84b},
                         {ImGuiCol_TextSelectedBg, 0x5c4a24},
                         {ImGuiCol_NavHighlight, 0xf2b84b}};

constexpr Row kLight[] = {{ImGuiCol_Text, 0x1b1e23},
                          {ImGuiCol_TextDisabled, 0x525a65},
                          {ImGuiCol_WindowBg, 0xf4f5f7},
                          {ImGuiCol_PopupBg, 0xffffff},
                          {ImGuiCol_Border, 0xa9b1bc},
                          {ImGuiCol_MenuBarBg, 0xe2e5ea},
                          {ImGuiCol_TitleBg, 0xe2e5ea},
                          {ImGuiCol_TitleBgActive, 0xd5dbe3},
                          {ImGuiCol_FrameBg, 0xe6e9ee},
                          {ImGuiCol_FrameBgHovered, 0xdadfe6},
                          {ImGuiCol_FrameBgActive, 0xccd3dc},
                          {ImGuiCol_ScrollbarBg, 0xf4f5f7},
                          {ImGuiCol_ScrollbarGrab, 0xb5bcc7},
                          {ImGuiCol_ScrollbarGrabHovered, 0x98a1ae},
                          {ImGuiCol_ScrollbarGrabActive, 0x7d8794},
                          {ImGuiCol_CheckMark, 0x8a5200},
                          {ImGuiCol_SliderGrab, 0xb87a1e},
                          {ImGuiCol_SliderGrabActive, 0xc4852a},
                          {ImGuiCol_Button, 0xd9dee5},
                          {ImGuiCol_ButtonHovered, 0xccd3dc},
                          {ImGuiCol_ButtonActive, 0xbcc5d0},
                          {ImGuiCol_Header, 0xe0e4e9},
                          {ImGuiCol_HeaderHovered, 0xd3d9e1},
                          {ImGuiCol_HeaderActive, 0xc6ced8},
                          {ImGuiCol_Separator, 0xc3c8d0},
                          {ImGuiCol_SeparatorHovered, 0xb87a1e},
                          {ImGuiCol_SeparatorActive, 0x8a5200},
                          {ImGuiCol_ResizeGrip, 0xe0e4e9},
                          {ImGuiCol_ResizeGripHovered, 0xb87a1e},
                          {ImGuiCol_ResizeGripActive, 0x8a5200},
                          {ImGuiCol_Tab, 0xe0e4e9},
                          {ImGuiCol_TabHovered, 0xccd3dc},
                          {ImGuiCol_TabActive, 0xccd3dc},
                          {ImGuiCol_TabUnfocused, 0xe0e4e9},
                          {ImGuiCol_TabUnfocusedActive, 0xccd3dc},
                          {ImGuiCol_PlotHistogram, 0xb87a1e},
                          {ImGuiCol_TextSelectedBg, 0xf0d9ae},
                          {ImGuiCol_NavHighlight, 0x8a5200}};

ImVec4 by_theme(unsigned dark, unsigned light) {
    const bool is_light = ImGui::GetStyle().Colors[ImGuiCol_WindowBg].x > 0.5f;
    return ImGui::ColorConvertU32ToFloat4(colour(is_light ? light : dark));
}

}  // namespace

Sized::Sized(Size size) {
    const ImVector<ImFont*>& fonts = ImGui::GetIO().Fonts->Fonts;  // as load_fonts() orders them
    const int index = 1 + static_cast<int>(size);
    ImGui::PushFont(index < fonts.Size ? fonts[index] : nullptr);
}

ImVec4 lit() {
    return by_theme(0xffd966, 0x855200);
}

ImVec4 shaded() {
    return by_theme(0x99b2ff, 0x334db3);
}

ImVec4 error() {
    return by_theme(0xff8066, 0xb3261e);
}

void set_colours(ImGuiStyle& of, bool light) {
    light ? ImGui::StyleColorsLight(&of) : ImGui::StyleColorsDark(&of);
    for (const auto& [what, rgb] : light ? std::span<const Row>(kLight) : std::span(kDark))
        of.Colors[what] = ImGui::ColorConvertU32ToFloat4(colour(rgb));
    of.FrameBorderSize = light ? 1 : 0;
}

}  // namespace relevo::viewer::style
