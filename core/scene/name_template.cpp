#include "scene/name_template.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <ctime>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/contains.h"
#include "base/error.h"
#include "base/text.h"

namespace relevo::scene {
namespace {

constexpr std::string_view kTimeFormat = "%Y%m%dT%H%M%S";
constexpr std::string_view kConversions = "aAbBdFHIjmMpSTuUVwWyYzZ%";

void check_time_format(std::string_view format) {
    for (std::size_t at = 0; (at = format.find('%', at)) != std::string_view::npos; at += 2)
        if (at + 1 == format.size() || kConversions.find(format[at + 1]) == std::string_view::npos)
            bad_input(fmt::format(
                "expected conversions such as %Y, %m, %d, %H, %M, %S, %j in {{time:...}} but got "
                "\"{}\"",
                format.substr(at, 2)));
}

std::string time_text(const NameParts& parts, const std::string& format) {
    const sun::LocalTime local = parts.zone.local(parts.utc);
    const sun::CivilTime& wall = local.wall;
    std::tm fields{};
    fields.tm_year = wall.date.year - 1900;
    fields.tm_mon = wall.date.month - 1;
    fields.tm_mday = wall.date.day;
    fields.tm_hour = wall.hour;
    fields.tm_min = wall.minute;
    fields.tm_sec = wall.second;
    fields.tm_yday = sun::days_between({wall.date.year, 1, 1}, wall.date);
    // 1900-01-01 was a Monday.
    fields.tm_wday = (sun::days_between({1900, 1, 1}, wall.date) + 1) % 7;
    fields.tm_gmtoff = local.utc_offset_s;
    fields.tm_zone = local.abbreviation.c_str();
    std::array<char, 256> text{};
    const std::size_t length = std::strftime(text.data(), text.size(), format.c_str(), &fields);
    return {text.data(), length};
}

/// Text as a part of a file's name on any file system.
std::string in_a_name(std::string_view text) {
    std::string result(text);
    for (char& letter : result)
        if (static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f ||
            std::string_view("/\\:*?\"<>|").find(letter) != std::string_view::npos)
            letter = '-';
    if (result.starts_with('.')) result.front() = '-';
    return result;
}

}  // namespace

NameTemplate::NameTemplate(std::string_view text, const std::vector<std::string>& known) {
    std::string plain;
    const auto end_plain = [&] {
        if (!plain.empty()) pieces_.push_back({"", plain});
        plain.clear();
    };
    for (std::size_t at = 0; at < text.size(); ++at) {
        const char letter = text[at];
        const bool twice = at + 1 < text.size() && text[at + 1] == letter;
        if ((letter == '{' || letter == '}') && twice) {
            plain += letter;
            ++at;
        } else if (letter == '{') {
            const std::size_t end = text.find('}', at);
            if (end == std::string_view::npos)
                bad_input(fmt::format("expected a }} behind \"{}\"; a brace itself is {{{{",
                                      text.substr(at)));
            end_plain();
            add_field(text.substr(at + 1, end - at - 1), known);
            at = end;
        } else if (letter == '}') {
            bad_input("expected a { before }; a brace itself is }}");
        } else {
            plain += letter;
        }
    }
    end_plain();
}

void NameTemplate::add_field(std::string_view field, const std::vector<std::string>& known) {
    const std::size_t colon = field.find(':');
    Piece piece{std::string(field.substr(0, colon)),
                colon == std::string_view::npos ? "" : std::string(field.substr(colon + 1))};
    std::vector<std::string> fields{"dem", "n", "time"};
    fields.insert(fields.end(), known.begin(), known.end());
    if (!contains(fields, piece.key)) {
        const auto near = nearest(piece.key, fields);
        bad_input(fmt::format("expected one of {{{}}} but got {{{}}}{}", fmt::join(fields, "}, {"),
                              piece.key, near ? fmt::format("; did you mean {{{}}}?", *near) : ""));
    }
    if (piece.key == "time") {
        if (piece.text.empty()) piece.text = kTimeFormat;
        check_time_format(piece.text);
    } else if (piece.key == "n") {
        const bool digits = std::ranges::all_of(piece.text, [](char letter) {
            return std::isdigit(static_cast<unsigned char>(letter));
        });
        if (!digits || piece.text.size() > 2)
            bad_input(
                fmt::format("expected a width such as {{n:04}} but got {{n:{}}}", piece.text));
    } else if (!piece.text.empty()) {
        bad_input(fmt::format("expected nothing behind the name but got {{{}}}", field));
    }
    pieces_.push_back(std::move(piece));
}

std::string NameTemplate::name(const NameParts& parts) const {
    std::string result;
    for (const Piece& piece : pieces_) {
        if (piece.key.empty())
            result += piece.text;
        else if (piece.key == "dem")
            result += in_a_name(parts.dem);
        else if (piece.key == "time")
            result += in_a_name(time_text(parts, piece.text));
        else if (piece.key == "n")
            result +=
                fmt::format("{:0{}}", parts.number, piece.text.empty() ? 0 : std::stoi(piece.text));
        else if (const auto found = parts.names.find(piece.key); found != parts.names.end())
            result += in_a_name(found->second);
    }
    return result;
}

}  // namespace relevo::scene
