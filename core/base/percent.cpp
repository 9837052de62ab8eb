#include "base/percent.h"

#include <fmt/format.h>

namespace relevo {
namespace {

/// Of a hexadecimal digit; -1 for other letters.
int value_of_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

}  // namespace

std::string percent_encoded(std::string_view path) {
    constexpr std::string_view kPlain = "-._~/";
    std::string result;
    for (const char c : path) {
        const bool is_plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') ||
                              (c >= 'A' && c <= 'Z') || kPlain.find(c) != kPlain.npos;
        result +=
            is_plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
    return result;
}

std::string percent_decoded(std::string_view text) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const int high = i + 2 < text.size() ? value_of_digit(text[i + 1]) : -1;
        const int low = i + 2 < text.size() ? value_of_digit(text[i + 2]) : -1;
        const bool is_code = text[i] == '%' && high >= 0 && low >= 0;
        result += is_code ? static_cast<char>(16 * high + low) : text[i];
        if (is_code) i += 2;
    }
    return result;
}

}  // namespace relevo
