#include "names/fold.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include <utf8proc.h>

namespace relevo::names {
namespace {

/// Letters of Latin scripts without a decomposition, after case folding.
struct Spelling {
    utf8proc_int32_t code;
    std::string_view text;
};
constexpr std::array kSpellings{Spelling{0xe6, "ae"}, Spelling{0xf0, "d"},  Spelling{0xf8, "o"},
                                Spelling{0xfe, "th"}, Spelling{0x111, "d"}, Spelling{0x127, "h"},
                                Spelling{0x131, "i"}, Spelling{0x142, "l"}, Spelling{0x153, "oe"},
                                Spelling{0x259, "a"}};

/// ' ` and the letters and quotation marks that are typed as apostrophes.
constexpr std::array<utf8proc_int32_t, 7> kApostrophes{0x27,  0x60,   0xb4,  0x2bb,
                                                       0x2bc, 0x2018, 0x2019};

bool is_letter_or_digit(utf8proc_int32_t code) {
    const utf8proc_category_t category = utf8proc_category(code);
    return (category >= UTF8PROC_CATEGORY_LU && category <= UTF8PROC_CATEGORY_LO) ||
           (category >= UTF8PROC_CATEGORY_ND && category <= UTF8PROC_CATEGORY_NO);
}

std::vector<utf8proc_int32_t> decomposed(std::string_view text) {
    constexpr auto kOptions =
        static_cast<utf8proc_option_t>(UTF8PROC_STABLE | UTF8PROC_COMPAT | UTF8PROC_DECOMPOSE |
                                       UTF8PROC_CASEFOLD | UTF8PROC_STRIPMARK | UTF8PROC_IGNORE);
    const auto* const bytes = reinterpret_cast<const utf8proc_uint8_t*>(text.data());
    const auto length = static_cast<utf8proc_ssize_t>(text.size());
    std::vector<utf8proc_int32_t> codes(text.size() + 1);
    for (;;) {
        const auto room = static_cast<utf8proc_ssize_t>(codes.size());
        const utf8proc_ssize_t count =
            utf8proc_decompose(bytes, length, codes.data(), room, kOptions);
        codes.resize(static_cast<std::size_t>(std::max<utf8proc_ssize_t>(count, 0)));
        if (count <= room) return codes;  // negative: not UTF-8
    }
}

void append(utf8proc_int32_t code, std::string& to) {
    for (const Spelling& spelling : kSpellings)
        if (spelling.code == code) {
            to += spelling.text;
            return;
        }
    std::array<utf8proc_uint8_t, 4> bytes{};
    const utf8proc_ssize_t count = utf8proc_encode_char(code, bytes.data());
    to.append(reinterpret_cast<const char*>(bytes.data()), static_cast<std::size_t>(count));
}

}  // namespace

std::string fold(std::string_view text) {
    std::string key;
    bool is_parted = false;
    for (const utf8proc_int32_t code : decomposed(text)) {
        if (std::ranges::find(kApostrophes, code) != kApostrophes.end()) continue;
        if (!is_letter_or_digit(code)) {
            is_parted = !key.empty();
            continue;
        }
        if (is_parted) key += ' ';
        is_parted = false;
        append(code, key);
    }
    return key;
}

std::string with_spelled_umlauts(std::string_view text) {
    constexpr std::array<std::array<std::string_view, 2>, 6> kUmlauts{
        {{"ä", "ae"}, {"ö", "oe"}, {"ü", "ue"}, {"Ä", "Ae"}, {"Ö", "Oe"}, {"Ü", "Ue"}}};
    std::string result(text);
    for (const auto& [letter, spelled] : kUmlauts)
        for (std::size_t at = 0; (at = result.find(letter, at)) != result.npos;)
            result.replace(at, letter.size(), spelled);
    return result;
}

}  // namespace relevo::names
