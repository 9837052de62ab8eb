#include "dem/unit.h"

#include <array>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

#include "base/contains.h"
#include "base/error.h"
#include "base/text.h"
#include "base/units.h"

namespace relevo::dem {
namespace {

struct Known {
    std::string_view name;
    double metres;
    std::array<std::string_view, 14> words;  // letters only, in small ones
};

/// What may follow a unit: "metres above EGM96", "m (NAVD88)", "m a.s.l.".
constexpr std::array<std::string_view, 5> kSurfaces = {" above ", " over ", " relative to ", " (",
                                                       " a.s.l."};

// What GDAL's drivers, PROJ and people write.
const std::array kUnits = {
    Known{"m",
          1,
          {"m", "metre", "metres", "meter", "meters", "mtr", "metros", "mètre", "mètres", "masl",
           "gpm", "geopotentialmetre", "geopotentialmeter"}},
    Known{"ft",
          kFoot_m,
          {"ft", "foot", "feet", "internationalfoot", "internationalfeet", "footinternational",
           "ftint", "ift"}},
    Known{"us-ft",
          kUsSurveyFoot_m,
          {"usft", "ftus", "ussurveyfoot", "ussurveyfeet", "footus", "feetus", "surveyfoot",
           "surveyfeet", "footussurvey", "feetussurvey", "sft", "ftussurvey"}},
    Known{"cm", 0.01, {"cm", "centimetre", "centimetres", "centimeter", "centimeters"}},
    Known{"km", 1000, {"km", "kilometre", "kilometres", "kilometer", "kilometers"}},
    Known{"dm", 0.1, {"dm", "decimetre", "decimetres", "decimeter", "decimeters"}},
    Known{"mm", 0.001, {"mm", "millimetre", "millimetres", "millimeter", "millimeters"}},
};

std::string letters_of(std::string_view word) {
    std::string letters;
    for (const unsigned char c : word)
        if (std::isalpha(c) || c >= 0x80) letters += static_cast<char>(std::tolower(c));
    return letters;
}

std::optional<Unit> unit_named(std::string_view word) {
    // Powers, quotients and multiples are other units: "m2", "m/s", "0.001 m".
    if (word.find_first_of("0123456789/^*") != word.npos) return std::nullopt;
    const std::string letters = letters_of(word);
    for (const Known& known : kUnits)
        if (!letters.empty() && contains(known.words, letters))
            return Unit{std::string(known.name), known.metres};
    return std::nullopt;
}

}  // namespace

bool means_no_unit(std::string_view word) {
    constexpr std::array kNone = {"", "unknown", "unspecified", "undefined", "none", "na"};
    // Digits alone are no letters either, but they are a word for something.
    return trimmed(word).empty() ||
           (!letters_of(word).empty() && contains(kNone, letters_of(word)));
}

std::optional<Unit> known_unit(std::string_view word) {
    const std::string small = lower(word);
    if (const std::optional<Unit> unit = unit_named(small)) return unit;
    for (const std::string_view surface : kSurfaces)
        if (const std::size_t end = small.find(surface); end != small.npos)
            if (const std::optional<Unit> unit = unit_named(small.substr(0, end))) return unit;
    return std::nullopt;
}

Unit unit_of(double metres, std::string_view otherwise_named) {
    for (const Known& known : kUnits)
        // The two feet differ by 2e-6; files print them to 1e-9 or better.
        if (std::abs(known.metres / metres - 1) < 1e-8)
            return {std::string(known.name), known.metres};
    return {std::string(otherwise_named), metres};
}

Unit parse_unit(std::string_view text, std::string_view who) {
    if (const std::optional<Unit> unit = known_unit(text)) return *unit;
    bad_usage(fmt::format("{}: {}: a unit of height, expected m, ft, us-ft, cm, mm, dm or km", who,
                          trimmed(text).empty() ? "\"\"" : text));
}

}  // namespace relevo::dem
