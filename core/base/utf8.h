#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace relevo {

/// A character at the start of a text.
struct Utf8Character {
    std::size_t length = 0;  ///< [bytes]; 0: there is no valid one
    std::uint32_t code = 0;  ///< its code point
};

/// Source: RFC 3629; overlong forms, surrogates and codes beyond U+10FFFF are invalid.
Utf8Character first_character(std::string_view text);

/// True if all of a text is UTF-8.
bool is_utf8(std::string_view text);

}  // namespace relevo
