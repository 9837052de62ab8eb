#include "shader/source_checks.h"

#include <array>

#include <fmt/format.h>

#include "base/contains.h"

namespace relevo::shader {
namespace {

constexpr std::array<std::string_view, 10> kOwnedByCore = {
    "gl_Position",   "gl_PointSize", "gl_ClipDistance",  "gl_CullDistance", "gl_FragDepth",
    "gl_SampleMask", "gl_Layer",     "gl_ViewportIndex", "gl_FragColor",    "gl_FragData"};
struct Open {
    char bracket;
    int line;
};

struct Branch {
    std::size_t depth;  ///< brackets that were open before the #if
    int line;
};

class Brackets {
  public:
    explicit Brackets(const Source& source) : source_(source) {}

    void check() {
        for (const Token& token : source_.tokens) {
            if (token.kind == TokenKind::Directive) {
                directive(token);
                continue;
            }
            bracket(open_, source_.str(token), token.line);
            if (!branches_.empty() && open_.size() < branches_.back().depth)
                fail(token.line, fmt::format("{} closes a bracket that was opened before the #if "
                                             "of line {}",
                                             source_.str(token), branches_.back().line));
        }
        // A forgotten brace leaves its function open: that is the line to report.
        if (!open_.empty())
            fail(open_.front().line, fmt::format("{} is never closed", open_.front().bracket));
        if (!branches_.empty()) fail(branches_.back().line, "#if without an #endif");
    }

  private:
    [[noreturn]] void fail(int line, std::string_view message) const {
        source_error(source_.file, line, message);
    }

    void bracket(std::vector<Open>& open, std::string_view text, int line) const {
        if (text == "(" || text == "[" || text == "{") {
            open.push_back({text[0], line});
        } else if (text == ")" || text == "]" || text == "}") {
            const char expected = text == ")" ? '(' : text == "]" ? '[' : '{';
            if (open.empty()) fail(line, fmt::format("{} closes nothing", text));
            if (open.back().bracket != expected)
                fail(line, fmt::format("{} cannot close the {} of line {}", text,
                                       open.back().bracket, open.back().line));
            open.pop_back();
        }
    }

    void directive(const Token& token) {
        const std::vector<Token> words = directive_tokens(source_.text, token, source_.file);
        if (words.empty()) return;
        const std::string_view name = source_.str(words[0]);
        if (name == "define") {
            std::vector<Open> inside;
            for (const Token& word : words)
                bracket(inside, source_.str(word), word.line);
            if (!inside.empty())
                fail(inside.back().line,
                     fmt::format("{} is never closed in this #define", inside.back().bracket));
        } else if (name.substr(0, 2) == "if") {
            branches_.push_back({open_.size(), token.line});
        } else if (name == "elif" || name == "else" || name == "endif") {
            if (branches_.empty()) fail(token.line, fmt::format("#{} without an #if", name));
            if (open_.size() != branches_.back().depth)
                fail(open_.back().line, fmt::format("{} is not closed before the #{} of line {}",
                                                    open_.back().bracket, name, token.line));
            if (name == "endif") branches_.pop_back();
        }
    }

    const Source& source_;
    std::vector<Open> open_;
    std::vector<Branch> branches_;
};

void check_word(const Source& source, const Token& token) {
    const std::string_view word = source.str(token);
    const auto fail = [&](const std::string& message) {
        source_error(source.file, token.line, message);
    };
    if (word.find("__") != std::string_view::npos)
        fail(fmt::format("{}: names with __ are reserved for GLSL", word));
    if (contains(kOwnedByCore, word))
        fail(fmt::format("{} is core's; a plugin moves the ground in {}_on_displace", word,
                         source.owner));
    if (word == "discard")
        fail(
            "discard: every pixel must be written, or it shows an earlier frame; leave the "
            "arguments unchanged instead");
    if (word.substr(0, 5) == "hook_")
        fail(fmt::format("{}: only core's main programs call hooks", word));
}

}  // namespace

void check_words(const Source& source) {
    if (source.kind != SourceKind::Snippet) return;
    for (const Token& token : source.tokens) {
        if (token.kind == TokenKind::Word) check_word(source, token);
        if (token.kind != TokenKind::Directive) continue;
        // Names that a macro pastes together are not checked.
        for (const Token& word : directive_tokens(source.text, token, source.file)) {
            if (word.kind == TokenKind::Word) check_word(source, word);
            if (source.str(word) == "#" || source.str(word) == "\"")
                source_error(
                    source.file, word.line,
                    fmt::format("{} is not allowed in a directive of GLSL 4.50", source.str(word)));
        }
    }
}

void check_brackets(const Source& source) {
    Brackets(source).check();
}

}  // namespace relevo::shader
