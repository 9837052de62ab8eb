#include "shader/driver_hints.h"

#include <algorithm>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "base/contains.h"
#include "base/error.h"
#include "base/text.h"
#include "shader/tokenizer.h"

namespace relevo::shader {
namespace {

// GLSL 4.50, 8: the functions that plugins may use.
constexpr const char* kFunctions =
    "radians degrees sin cos tan asin acos atan sinh cosh tanh pow exp log exp2 log2 "
    "sqrt inversesqrt abs sign floor trunc round ceil fract mod modf min max clamp mix "
    "step smoothstep isnan isinf length distance dot cross normalize faceforward reflect "
    "refract transpose determinant inverse lessThan greaterThan equal notEqual any all "
    "not textureSize texture textureLod textureGrad texelFetch textureOffset "
    "outerProduct matrixCompMult roundEven floatBitsToInt intBitsToFloat";

bool has(std::string_view text, std::string_view word) {
    return text.find(word) != std::string_view::npos;
}

/// The identifier between quotes, which drivers write as `x', 'x' and "x".
std::string quoted_name(std::string_view message) {
    const std::size_t open = message.find_first_of("`'\"");
    if (open == std::string_view::npos) return {};
    std::size_t end = open + 1;
    while (end < message.size() && is_word_byte(message[end]))
        ++end;
    return std::string(message.substr(open + 1, end - open - 1));
}

std::vector<std::string> words_of(const std::string& text) {
    std::vector<std::string> words;
    for (std::size_t i = 0; i < text.size();) {
        std::size_t end = i;
        while (end < text.size() && is_word_byte(text[end]))
            ++end;
        if (end > i) words.push_back(text.substr(i, end - i));
        i = end + 1;
    }
    return words;
}

/// Names that the author may have meant, without those of core's internals.
std::optional<std::string> meant(const std::string& name, const CompiledText& compiled) {
    std::set<std::string> candidates;
    for (std::string& function : words_of(kFunctions))
        candidates.insert(std::move(function));
    candidates.insert(compiled.names.begin(), compiled.names.end());
    try {
        for (const Token& token : tokenize(compiled.text, "text").code)
            if (token.kind == TokenKind::Word) candidates.emplace(text_of(compiled.text, token));
    } catch (const Error&) {
        // The other candidates are worth a suggestion.
    }
    candidates.erase(name);
    return nearest(name, {candidates.begin(), candidates.end()});
}

std::string line_of(const std::string& text, int line) {
    const std::vector<std::string> lines = split(text, '\n');
    const auto at = static_cast<std::size_t>(line - 1);
    return line > 0 && at < lines.size() ? lines[at] : "";
}

/// The parameter that a line uses where GLSL needs a constant.
std::string constant_hint(const std::string& line, const CompiledText& compiled) {
    for (const std::string& word : words_of(line))
        if (contains(compiled.values, word))
            return fmt::format("add static after its //@ to make {} a constant", word);
    return {};
}

}  // namespace

std::string hint_for(const Diagnostic& diagnostic, const CompiledText& compiled) {
    const std::string& message = diagnostic.message;
    const bool unknown = has(message, "undeclared") || has(message, "undefined") ||
                         has(message, "no function with name") || has(message, "access field") ||
                         has(message, "no such field");
    if (unknown) {
        const std::string name = quoted_name(message);
        const auto near = name.empty() ? std::nullopt : meant(name, compiled);
        return near ? fmt::format("did you mean {}?", *near) : "";
    }
    if (has(message, "constant expression") || has(message, "array size"))
        return constant_hint(line_of(compiled.text, diagnostic.text_line), compiled);
    if (has(message, "operator %")) return "write mod(a, b) for numbers of type float";
    if (has(message, "initializer of type float cannot be assigned to variable of type vec"))
        return fmt::format("write {}(x) for a vector of equal components",
                           message.substr(message.rfind("vec"), 4));
    if (has(message, "syntax error") && (has(message, "';'") || has(message, "SEMICOLON")))
        return has(message, "unexpected NEW_IDENTIFIER")
                   ? "is a ; missing before it, or a type misspelt?"
                   : "is a ; missing before it?";
    return {};
}

std::string brief_text(const DriverLog& log, const CompiledText& compiled) {
    std::set<std::string> places, messages;
    std::string result;
    for (const Diagnostic& diagnostic : log.diagnostics) {
        if (diagnostic.severity != "error" || diagnostic.text_line == 0) continue;
        const std::string place =
            fmt::format("{}:{}:{}", diagnostic.origin.file, diagnostic.origin.line,
                        diagnostic.origin.file.empty() ? diagnostic.text_line : 0);
        if (!places.insert(place).second || !messages.insert(diagnostic.message).second) continue;
        const std::string hint = hint_for(diagnostic, compiled);
        std::string text = diagnostic.text();
        // The candidates are lines of their own, which are not shown.
        if (const std::string_view end = "; candidates are:"; text.ends_with(end))
            text.resize(text.size() - end.size());
        result += (result.empty() ? "" : "\n") + text + (hint.empty() ? "" : "; ") + hint;
    }
    return result.empty() ? log.text() : result;
}

}  // namespace relevo::shader
