#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

/// The system's fonts, for panels.
namespace relevo::viewer {

/// A font, and letters that it is used for.
struct FontFile {
    std::string path;
    int face = 0;  ///< of a file of several
    std::vector<char32_t> letters;
};

/// The font of panels: Liberation Sans, DejaVu Sans, else what fontconfig has for sans-serif; empty
/// where there is none.
std::string usual_font_file();

/// Whether the usual font is loaded with a letter: Latin, Greek, Cyrillic, and some signs.
bool is_usual(char32_t letter);
/// The letters of a UTF-8 text that it is not loaded with.
std::set<char32_t> unusual_letters(std::string_view utf8);

/// Fonts that have these letters, as fontconfig prefers them in the user's language, as few as do.
/// What no font has is left out.
std::vector<FontFile> fonts_with(const std::set<char32_t>& letters);

/// Loads the font in its default size and then in each of style::Size.
/// @param text_px  height of the usual size, in pixels of the display
/// @param letters  additional characters
void load_fonts(float text_px, const std::set<char32_t>& letters);

}  // namespace relevo::viewer
