#pragma once

#include <imgui.h>

/// Colours and text sizes of the window; no other file of it has any.
namespace relevo::viewer::style {

constexpr ImU32 colour(unsigned rgb, unsigned opacity = 255) {
    return IM_COL32(rgb >> 16 & 255, rgb >> 8 & 255, rgb & 255, opacity);
}

/// A length that is `usual` pixels with texts of the usual size on a display of usual density.
inline float px(float usual) {
    return usual * ImGui::GetFontSize() / 16;
}

// ---- texts

/// Sizes besides the usual one: notes, and the name of the program.
enum class Size { Small, Title };
inline constexpr float kSmall = 0.8125f, kTitle = 1.75f;

/// Texts have another size as long as it lives.
class Sized {
  public:
    explicit Sized(Size size);
    ~Sized() { ImGui::PopFont(); }
    Sized(const Sized&) = delete;
    Sized& operator=(const Sized&) = delete;
};

// ---- over the picture

inline constexpr ImU32 kInk = colour(0xffffff, 235), kShade = colour(0x000000, 150);
/// What the user has placed, and now.
inline constexpr ImU32 kMark = colour(0xff503c), kFaintMark = colour(0xff503c, 80);
inline constexpr ImU32 kDivider = colour(0xffffff, 200);
inline constexpr ImU32 kSun = colour(0xffe282), kHiddenSun = colour(0xffe282, 90),
                       kSunRim = colour(0x785014, 200);
inline constexpr ImU32 kWay = colour(0xffd678, 220), kHiddenWay = colour(0xffd678, 70);
inline constexpr ImU32 kSolstice = colour(0xffffff, 90), kHiddenSolstice = colour(0xffffff, 25);
/// Before the first picture.
inline constexpr ImU32 kDusk = colour(0x16223a), kDawn = colour(0x766060);

// ---- over charts, which are white

inline constexpr ImU32 kChartNow = colour(0xc82814), kChartSun = colour(0xffd65a);

// ---- the day's strip

inline constexpr ImU32 kDay = colour(0xf6dc94), kGolden = colour(0xeca054),
                       kCivil = colour(0x7068a8), kNautical = colour(0x424a88),
                       kAstronomical = colour(0x242e60), kNight = colour(0x0e1226);
inline constexpr ImU32 kHiddenByGround = colour(0x46424a), kMoon = colour(0xc8d6ff),
                       kTick = colour(0x808080, 220);

// ---- in panels, by the theme that is set

ImVec4 lit();     ///< a place in the sun
ImVec4 shaded();  ///< in shade
ImVec4 error();

/// Colours of panels: grey, with one accent, the sun's.
void set_colours(ImGuiStyle& of, bool light);

}  // namespace relevo::viewer::style
