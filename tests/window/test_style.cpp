// Colours of the window: legible, and all in one place.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include <gmock/gmock.h>

#include "base/text.h"
#include "support/support.h"
#include "viewer/fonts.h"
#include "viewer/style.h"

namespace relevo::viewer {
namespace {

/// WCAG 2.1: relative luminance of an sRGB colour.
double luminance(const ImVec4& colour) {
    const auto linear = [](double of) {
        return of <= 0.04045 ? of / 12.92 : std::pow((of + 0.055) / 1.055, 2.4);
    };
    return 0.2126 * linear(colour.x) + 0.7152 * linear(colour.y) + 0.0722 * linear(colour.z);
}

double contrast(const ImVec4& a, const ImVec4& b) {
    const auto [low, high] = std::minmax(luminance(a), luminance(b));
    return (high + 0.05) / (low + 0.05);
}

/// An ink of some opacity over a ground without any.
ImVec4 over(ImU32 ink, const ImVec4& ground) {
    const ImVec4 of = ImGui::ColorConvertU32ToFloat4(ink);
    const auto mixed = [&](float a, float b) { return of.w * a + (1 - of.w) * b; };
    return {mixed(of.x, ground.x), mixed(of.y, ground.y), mixed(of.z, ground.z), 1};
}

class Theme : public testing::TestWithParam<bool> {
  protected:
    Theme() {
        ImGui::CreateContext();
        style::set_colours(ImGui::GetStyle(), GetParam());
    }
    ~Theme() override { ImGui::DestroyContext(); }
};

TEST_P(Theme, TextIsLegible) {
    const ImVec4* const colours = ImGui::GetStyle().Colors;
    for (const ImGuiCol ground :
         {ImGuiCol_WindowBg,       ImGuiCol_PopupBg,         ImGuiCol_MenuBarBg,
          ImGuiCol_TitleBg,        ImGuiCol_TitleBgActive,   ImGuiCol_FrameBg,
          ImGuiCol_FrameBgHovered, ImGuiCol_FrameBgActive,   ImGuiCol_Button,
          ImGuiCol_ButtonHovered,  ImGuiCol_ButtonActive,    ImGuiCol_Header,
          ImGuiCol_HeaderHovered,  ImGuiCol_HeaderActive,    ImGuiCol_Tab,
          ImGuiCol_TabHovered,     ImGuiCol_TabActive,       ImGuiCol_TextSelectedBg,
          ImGuiCol_SliderGrab,     ImGuiCol_SliderGrabActive})
        EXPECT_GE(contrast(colours[ImGuiCol_Text], colours[ground]), 4.5) << ground;
    for (const ImGuiCol ground : {ImGuiCol_WindowBg, ImGuiCol_PopupBg, ImGuiCol_FrameBg})
        EXPECT_GE(contrast(colours[ImGuiCol_TextDisabled], colours[ground]), 4.5) << ground;
    for (const ImVec4& ink : {style::lit(), style::shaded(), style::error()})
        EXPECT_GE(contrast(ink, colours[ImGuiCol_WindowBg]), 4.5);
    // Marks without letters need less.
    EXPECT_GE(contrast(colours[ImGuiCol_CheckMark], colours[ImGuiCol_FrameBg]), 3);
}

INSTANTIATE_TEST_SUITE_P(Window, Theme, testing::Bool());

TEST(Style, TextOverThePictureIsLegibleWhateverThePictureIs) {
    for (const float grey : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f}) {
        const ImVec4 shade = over(style::kShade, {grey, grey, grey, 1});
        EXPECT_GE(contrast(over(style::kInk, shade), shade), 4.5) << grey;
    }
}

TEST(Style, HasThreeSizesOfText) {
    ImGui::CreateContext();
    load_fonts(20, {});
    const ImVector<ImFontConfig>& fonts = ImGui::GetIO().Fonts->ConfigData;
    ASSERT_EQ(fonts.Size, 3);
    EXPECT_EQ(fonts[0].SizePixels, 20);
    EXPECT_EQ(fonts[1].SizePixels, 16);
    EXPECT_EQ(fonts[2].SizePixels, 35);
    ImGui::DestroyContext();
    // Scaled letters are blurred.
    for (const auto& entry : std::filesystem::directory_iterator(test::source_dir() / "app/viewer"))
        EXPECT_THAT(read_text(entry.path(), "test"),
                    testing::Not(testing::HasSubstr("SetWindowFontScale")))
            << entry.path();
}

TEST(Style, HasAllColoursOfTheWindow) {
    for (const auto& entry :
         std::filesystem::directory_iterator(test::source_dir() / "app/viewer")) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with("style.")) continue;
        EXPECT_THAT(read_text(entry.path(), "test"),
                    testing::Not(testing::AnyOf(testing::HasSubstr("IM_COL32("),
                                                testing::HasSubstr("ImVec4("))))
            << name;
    }
}

}  // namespace
}  // namespace relevo::viewer
