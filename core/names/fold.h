#pragma once

#include <string>
#include <string_view>

namespace relevo::names {

/// The search key of a name: Unicode's compatibility decomposition and case folding, without
/// accents and apostrophes, other punctuation as one blank, letters that do not decompose as the
/// Latin ones they are written with: "São Tomé" and "SAO TOME" are "sao tome", "Łódź" is "lodz".
/// Letters of other scripts stay. Empty if `text` is not UTF-8.
/// Source: utf8proc; Unicode Standard Annex 15.
std::string fold(std::string_view text);

/// The text with ä, ö and ü as ae, oe and ue, as people write without these keys.
std::string with_spelled_umlauts(std::string_view text);

}  // namespace relevo::names
