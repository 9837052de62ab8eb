#include "shader/driver_log.h"

#include <algorithm>
#include <charconv>
#include <optional>

#include "base/text.h"

namespace relevo::shader {
namespace {

/// A log line and the place up to which it is read.
class Cursor {
  public:
    explicit Cursor(std::string_view text) : text_(text) {}

    bool take(std::string_view word) {
        if (text_.substr(0, word.size()) != word) return false;
        text_.remove_prefix(word.size());
        return true;
    }

    std::optional<int> number() {
        int value = 0;
        const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
        if (error != std::errc{} || value < 0) return std::nullopt;
        text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
        return value;
    }

    void blanks() {
        while (!text_.empty() && (text_[0] == ' ' || text_[0] == '\t'))
            text_.remove_prefix(1);
    }

    std::string_view rest() const { return text_; }

  private:
    std::string_view text_;
};

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

std::optional<Parsed> parse_mesa_or_nvidia(std::string_view text) {
    Cursor cursor(text);
    if (!cursor.number()) return std::nullopt;
    if (cursor.take(":")) {  // 0:12(5): error: message
        const std::optional<int> line = cursor.number();
        if (!line || !cursor.take("(") || !cursor.number() || !cursor.take("):"))
            return std::nullopt;
        return severity_and_message(*line, cursor.rest());
    }
    if (!cursor.take("(")) return std::nullopt;  // 0(12) : error C1008: message
    const std::optional<int> line = cursor.number();
    if (!line || !cursor.take(")")) return std::nullopt;
    cursor.blanks();
    if (!cursor.take(":")) return std::nullopt;
    return severity_and_message(*line, cursor.rest());
}

std::optional<Parsed> parse_severity_first(std::string_view text) {
    Cursor cursor(text);
    const bool error = cursor.take("ERROR:");
    if (!error && !cursor.take("WARNING:")) return std::nullopt;
    cursor.blanks();
    if (!cursor.number() || !cursor.take(":")) return std::nullopt;
    const std::optional<int> line = cursor.number();
    if (!line || !cursor.take(":")) return std::nullopt;
    return Parsed{*line, error ? "error" : "warning", std::string(trimmed(cursor.rest()))};
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
        std::optional<Parsed> parsed = parse_mesa_or_nvidia(text);
        if (!parsed) parsed = parse_severity_first(text);
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
