#include "base/percent.h"

#include <fmt/format.h>

#include "base/text.h"

namespace relevo {
namespace {

/// Of a hexadecimal digit; -1 for other letters.
int value_of_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

/// @param plain  what stays, with letters and digits of ASCII
std::string encoded_but_for(std::string_view plain, std::string_view text) {
    std::string result;
    for (const char c : text) {
        const bool is_plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') ||
                              (c >= 'A' && c <= 'Z') || plain.find(c) != plain.npos;
        result +=
            is_plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
    return result;
}

}  // namespace

std::string percent_encoded(std::string_view path) {
    return encoded_but_for("-._~/", path);
}

std::string percent_encoded_url(std::string_view url) {
    return encoded_but_for("-._~/:?@!$&'()*+,;=%", url);
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

std::optional<std::string_view> path_of_file_uri(std::string_view uri) {
    constexpr std::string_view kScheme = "file:", kHost = "//localhost";
    if (!equal_ignoring_case(uri.substr(0, kScheme.size()), kScheme)) return std::nullopt;
    uri.remove_prefix(kScheme.size());
    if (equal_ignoring_case(uri.substr(0, kHost.size()), kHost))
        uri.remove_prefix(kHost.size());
    else if (uri.starts_with("///"))
        uri.remove_prefix(2);
    return uri.starts_with('/') && !uri.starts_with("//") ? std::optional(uri) : std::nullopt;
}

}  // namespace relevo
