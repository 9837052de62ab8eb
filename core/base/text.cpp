#include "base/text.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "base/error.h"
#include "base/input_file.h"
#include "base/utf8.h"

namespace relevo {
namespace {

constexpr std::size_t kBlockBytes = 4096;

}  // namespace

std::string read_text(const std::filesystem::path& path, std::string_view who) {
    const InputFile file(AllowedName(path.string()), who);
    // One more than there should be: the read after the last finds the end.
    std::string text(std::min<std::uint64_t>(file.size(), kMaxTextBytes) + 1, '\0');
    std::size_t length = 0;
    while (length <= kMaxTextBytes) {
        if (length == text.size()) text.resize(text.size() + kBlockBytes);
        const ssize_t count = read(file.descriptor(), text.data() + length, text.size() - length);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0)
            bad_input(fmt::format("{}: {}: cannot be read, {}", who, path.string(),
                                  std::strerror(errno)));
        if (count == 0) break;
        length += static_cast<std::size_t>(count);
    }
    if (length > kMaxTextBytes)
        bad_input(fmt::format("{}: {}: expected a text of at most {} MiB but got a longer one", who,
                              path.string(), kMaxTextBytes >> 20));
    text.resize(length);
    return text;
}

std::vector<std::string> split(std::string_view text, char separator) {
    std::vector<std::string> pieces;
    if (text.empty()) return pieces;
    for (;;) {
        const std::size_t at = text.find(separator);
        pieces.emplace_back(text.substr(0, at));
        if (at == std::string_view::npos) return pieces;
        text.remove_prefix(at + 1);
    }
}

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kBlank = " \t\r\n";
    const std::size_t first = text.find_first_not_of(kBlank);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::string lower(std::string_view text) {
    std::string result(text);
    for (char& c : result)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return result;
}

bool equal_ignoring_case(std::string_view a, std::string_view b) {
    return lower(a) == lower(b);
}

namespace {

/// Length of the character at the start of a text; 0 if it is not UTF-8, a control character (C0,
/// DEL, C1) or a noncharacter, which XML and Cairo refuse.
std::size_t printable_length(std::string_view text) {
    const auto [length, code] = first_character(text);
    const bool is_control = code < 0x20 || (code >= 0x7f && code < 0xa0);
    const bool is_noncharacter = (code & 0xfffe) == 0xfffe || (code >= 0xfdd0 && code <= 0xfdef);
    return is_control || is_noncharacter ? 0 : length;
}

std::string printable(std::string_view text, std::string_view kept) {
    std::string result;
    result.reserve(text.size());
    while (!text.empty()) {
        const std::size_t length = std::max<std::size_t>(
            printable_length(text), kept.find(text[0]) != std::string_view::npos);
        if (length > 0)
            result += text.substr(0, length);
        else if (text[0] == '\n')
            result += "\\n";
        else if (text[0] == '\t')
            result += "\\t";
        else if (text[0] == '\r')
            result += "\\r";
        else
            result += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[0]));
        text.remove_prefix(std::max<std::size_t>(1, length));
    }
    return result;
}

/// Letters to insert, remove, replace or swap with the next one (optimal string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before_last, last, row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        before_last = std::exchange(last, row);
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before_last[j - 2] + 1);
        }
    }
    return row.back();
}

}  // namespace

std::string printable(std::string_view text) {
    return printable(text, "");
}

std::string printable_lines(std::string_view text) {
    return printable(text, "\n\t");
}

std::optional<double> parse_number(std::string_view text) {
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
        return std::nullopt;
    return value;
}

std::optional<std::string> nearest(std::string_view word,
                                   const std::vector<std::string>& candidates) {
    std::optional<std::string> best;
    std::size_t best_distance = std::max<std::size_t>(1, word.size() / 3) + 1;
    for (const std::string& candidate : candidates) {
        const std::size_t longer = std::max(word.size(), candidate.size());
        // Also keeps long texts of others from being compared letter by letter.
        if (longer - std::min(word.size(), candidate.size()) >= best_distance) continue;
        const std::size_t distance = edit_distance(word, candidate);
        if (distance < best_distance) {
            best_distance = distance;
            best = candidate;
        }
    }
    return best;
}

}  // namespace relevo
