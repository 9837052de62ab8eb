#include "shader/driver_log.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

#include "base/text.h"

namespace relevo::shader {
namespace {

struct Parsed {
    int line = 0;
    std::string severity;
    std::string message;
};

/// `error: message`, `error C1008: message`, `preprocessor error: message`.
Parsed severity_and_message(int line, std::string_view text) {
    text = trimmed(text);
    const std::size_t colon = text.find(':');
    if (colon != std::string_view::npos) {
        const std::string_view head = text.substr(0, colon);
        for (const std::string_view word : {"error", "warning", "note"})
            if (head.find(word) != std::string_view::npos)
                return {line, std::string(word), std::string(trimmed(text.substr(colon + 1)))};
    }
    return {line, "error", std::string(text)};
}

/// The beginning of a driver's line: L is the line, # another number, a blank any number of blanks.
struct Form {
    std::string_view begin;
    std::string_view severity;  ///< empty: the text goes on with it
};
constexpr std::array kForms = {Form{"#:L(#):", ""},  // Mesa, "0:12(5): error: message"
                               Form{"#(L) :", ""},   // NVIDIA, "0(12) : error C1008: message"
                               Form{"ERROR: #:L:", "error"},  // Intel, AMD and glslang
                               Form{"WARNING: #:L:", "warning"}};

std::optional<Parsed> parse_as(const Form& form, std::string_view text) {
    Parsed parsed;
    for (const char c : form.begin) {
        if (c == ' ') {
            text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
        } else if (c == 'L' || c == '#') {
            int value = 0;
            const auto [end, error] =
                std::from_chars(text.data(), text.data() + text.size(), value);
            if (error != std::errc{} || value < 0) return std::nullopt;
            text.remove_prefix(static_cast<std::size_t>(end - text.data()));
            if (c == 'L') parsed.line = value;
        } else {
            if (!text.starts_with(c)) return std::nullopt;
            text.remove_prefix(1);
        }
    }
    if (form.severity.empty()) return severity_and_message(parsed.line, text);
    parsed.severity = form.severity;
    parsed.message = trimmed(text);
    return parsed;
}

std::optional<Parsed> parse_line(std::string_view text) {
    for (const Form& form : kForms)
        if (auto parsed = parse_as(form, text)) return parsed;
    return std::nullopt;
}

}  // namespace

std::string Diagnostic::text() const {
    if (text_line == 0) return message;
    const std::string place = origin.file.empty() ? "stitched text:" + std::to_string(text_line)
                                                  : origin.file + ':' + std::to_string(origin.line);
    return place + ": " + severity + ": " + message;
}

std::string DriverLog::text() const {
    std::string result;
    for (const Diagnostic& diagnostic : diagnostics)
        result += (result.empty() ? "" : "\n") + diagnostic.text();
    return result;
}

std::string DriverLog::blamed() const {
    const auto found = std::ranges::find_if(diagnostics, [](const auto& d) {
        return d.severity == "error" && !d.origin.owner.empty();
    });
    return found == diagnostics.end() ? "" : found->origin.owner;
}

DriverLog parse_driver_log(std::string_view log, const LineMap& lines) {
    DriverLog result;
    result.raw = log;
    for (const std::string& piece : split(log, '\n')) {
        const std::string_view text = trimmed(std::string_view(piece).substr(0, piece.find('\0')));
        if (text.empty()) continue;
        const std::optional<Parsed> parsed = parse_line(text);
        Diagnostic diagnostic;
        if (parsed && parsed->line > 0 && static_cast<std::size_t>(parsed->line) <= lines.size()) {
            diagnostic.severity = parsed->severity;
            diagnostic.text_line = parsed->line;
            diagnostic.origin = lines[static_cast<std::size_t>(parsed->line - 1)];
            diagnostic.message = parsed->message;
        } else {
            diagnostic.message = text;
        }
        result.diagnostics.push_back(std::move(diagnostic));
    }
    return result;
}

}  // namespace relevo::shader
