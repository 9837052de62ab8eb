#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace relevo::dem {

/// A unit of height.
struct Unit {
    std::string name =
        "m";  ///< as `--unit` writes it: m, ft, us-ft, cm, mm, dm, km; else the file's word
    double metres = 1;  ///< in one unit

    friend bool operator==(const Unit&, const Unit&) = default;
};

/// The unit that a file or a person means by a word: "m", "metre", "Meters", "ft", "feet", "us-ft",
/// "US survey foot", "gpm" and so on, capitals or not, also with the surface that heights are
/// above: "metres above EGM96". Nothing where the word is none of a length.
std::optional<Unit> known_unit(std::string_view word);

/// Whether a file's word for a unit says that there is none: "", "unknown", "unspecified", "none".
bool means_no_unit(std::string_view word);

/// The unit of `metres` metres, named as `--unit` does where it is one of those.
Unit unit_of(double metres, std::string_view otherwise_named);

/// Reads `--unit`.
/// @param who  what the error begins with, for example "--unit"
/// @throws Error (Usage) `who: furlong: a unit of height, expected m, ft, us-ft, cm, mm, dm or km`
Unit parse_unit(std::string_view text, std::string_view who);

}  // namespace relevo::dem
