#include "viewer/fonts.h"

#include <cmath>
#include <filesystem>
#include <list>
#include <memory>

#include <fontconfig/fontconfig.h>
#include <imgui.h>
#include <imgui_internal.h>

#include "viewer/style.h"

namespace relevo::viewer {
namespace {

template <typename T, auto Destroy>
struct Destroyer {
    void operator()(T* thing) const { Destroy(thing); }
};
using Pattern = std::unique_ptr<FcPattern, Destroyer<FcPattern, FcPatternDestroy>>;
using Letters = std::unique_ptr<FcCharSet, Destroyer<FcCharSet, FcCharSetDestroy>>;
using Fonts = std::unique_ptr<FcFontSet, Destroyer<FcFontSet, FcFontSetDestroy>>;

/// Scalable fonts without serifs, the best first, that have some of the letters.
Fonts sorted_fonts(const std::set<char32_t>& letters) {
    const Pattern wanted(FcNameParse(reinterpret_cast<const FcChar8*>("sans-serif")));
    const Letters charset(FcCharSetCreate());
    for (const char32_t letter : letters)
        FcCharSetAddChar(charset.get(), letter);
    FcPatternAddCharSet(wanted.get(), FC_CHARSET, charset.get());
    FcPatternAddBool(wanted.get(), FC_SCALABLE, FcTrue);
    FcConfigSubstitute(nullptr, wanted.get(), FcMatchPattern);
    FcDefaultSubstitute(wanted.get());
    FcResult result = FcResultMatch;
    return Fonts(FcFontSort(nullptr, wanted.get(), FcFalse, nullptr, &result));
}

/// Whether ImGui can read it.
bool is_outline(const FcPattern* font) {
    FcChar8* format = nullptr;
    if (FcPatternGetString(font, FC_FONTFORMAT, 0, &format) != FcResultMatch) return false;
    const std::string name(reinterpret_cast<const char*>(format));
    return name == "TrueType" || name == "CFF";
}

}  // namespace

std::string usual_font_file() {
    for (const char* file : {"/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf",
                             "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"}) {
        std::error_code ignored;
        if (std::filesystem::exists(file, ignored)) return file;
    }
    const std::vector<FontFile> fonts = fonts_with({U'a'});
    return fonts.empty() ? "" : fonts.front().path;
}

bool is_usual(char32_t letter) {
    return letter < 0x250 || (letter >= 0x370 && letter < 0x530) ||
           (letter >= 0x2010 && letter <= 0x2044) || (letter >= 0x2190 && letter <= 0x2193);
}

std::set<char32_t> unusual_letters(std::string_view utf8) {
    std::set<char32_t> letters;
    const char* at = utf8.data();
    const char* const end = at + utf8.size();
    while (at < end) {
        unsigned int letter = 0;
        const int bytes = ImTextCharFromUtf8(&letter, at, end);
        if (bytes <= 0 || letter == 0) break;
        at += bytes;
        if (!is_usual(letter) && letter != IM_UNICODE_CODEPOINT_INVALID && letter <= 0xffff)
            letters.insert(letter);
    }
    return letters;
}

std::vector<FontFile> fonts_with(const std::set<char32_t>& letters) {
    std::vector<FontFile> fonts;
    if (letters.empty() || !FcInit()) return fonts;
    const Fonts sorted = sorted_fonts(letters);
    std::set<char32_t> left = letters;
    for (int i = 0; sorted && i < sorted->nfont && !left.empty(); ++i) {
        const FcPattern* const font = sorted->fonts[i];
        FcCharSet* has = nullptr;
        FcChar8* path = nullptr;
        FontFile file;
        if (!is_outline(font) || FcPatternGetCharSet(font, FC_CHARSET, 0, &has) != FcResultMatch ||
            FcPatternGetString(font, FC_FILE, 0, &path) != FcResultMatch)
            continue;
        FcPatternGetInteger(font, FC_INDEX, 0, &file.face);
        file.face &= 0xffff;  // above it are named styles
        file.path = reinterpret_cast<const char*>(path);
        for (const char32_t letter : left)
            if (FcCharSetHasChar(has, letter)) file.letters.push_back(letter);
        for (const char32_t letter : file.letters)
            left.erase(letter);
        if (!file.letters.empty()) fonts.push_back(std::move(file));
    }
    return fonts;
}

void load_fonts(float text_px, const std::set<char32_t>& letters) {
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    // Latin with accents, Greek, Cyrillic, dashes, degrees: is_usual(). A title is a name of ASCII.
    static const ImWchar usual[] = {0x20, 0x24f, 0x370, 0x52f, 0x2010, 0x2044, 0x2190, 0x2193, 0};
    static const ImWchar ascii[] = {0x20, 0x7e, 0};
    const std::string file = usual_font_file();
    if (file.empty()) return;
    // Must exist until the atlas is built.
    static std::list<std::vector<ImWchar>> ranges;
    ranges.clear();
    const std::vector<FontFile> others = fonts_with(letters);
    for (const float size_px : {text_px, style::kSmall * text_px}) {
        atlas.AddFontFromFileTTF(file.c_str(), std::round(size_px), nullptr, usual);
        for (const FontFile& font : others) {
            std::vector<ImWchar>& range = ranges.emplace_back();
            for (const char32_t letter : font.letters)
                range.insert(range.end(), 2, static_cast<ImWchar>(letter));
            range.push_back(0);
            ImFontConfig config;
            config.MergeMode = true;
            config.FontNo = font.face;
            atlas.AddFontFromFileTTF(font.path.c_str(), std::round(size_px), &config, range.data());
        }
    }
    atlas.AddFontFromFileTTF(file.c_str(), std::round(style::kTitle * text_px), nullptr, ascii);
}

}  // namespace relevo::viewer
