// The checks of SourceCursor's header.
#include <array>

#include <fmt/format.h>

#include "base/contains.h"
#include "shader/source_cursor.h"

namespace relevo::shader {
namespace {

constexpr std::array<std::string_view, 10> kOwnedByCore = {
    "gl_Position",   "gl_PointSize", "gl_ClipDistance",  "gl_CullDistance", "gl_FragDepth",
    "gl_SampleMask", "gl_Layer",     "gl_ViewportIndex", "gl_FragColor",    "gl_FragData"};
constexpr std::array<std::string_view, 3> kTestsOfMacros = {"ifdef", "ifndef", "defined"};

/// A word that a plugin must not use. The message has {0}, the word, and {1}, the plugin's id.
struct WordRule {
    /// @param before  the token before the word, without brackets
    bool (*is_broken)(std::string_view word, std::string_view before);
    std::string_view message;
};
// Names that a macro pastes together are not checked: pasting is refused.
constexpr std::array kWordRules = {
    WordRule{[](auto word, auto) { return word.find("__") != word.npos; },
             "{0}: names with __ are reserved for GLSL"},
    WordRule{[](auto word, auto) { return contains(kOwnedByCore, word); },
             "{0} is core's; a plugin moves the ground in {1}_on_displace"},
    WordRule{[](auto word, auto) { return word == "discard"; },
             "discard: every pixel must be written, or it shows an earlier frame; leave the "
             "arguments unchanged instead"},
    WordRule{[](auto word, auto) { return word.starts_with("hook_"); },
             "{0}: only core's main programs call hooks"},
    WordRule{[](auto word, auto) { return word == "#" || word == "\""; },
             "{0} is not allowed in a directive of GLSL 4.50"},
    // A misspelt one is an error, not a missing capability.
    WordRule{[](auto word, auto before) {
                 return word.starts_with(kHasPrefix) && contains(kTestsOfMacros, before);
             },
             "{0} is always defined, as 0 or as 1; write #if {0}"}};

class Brackets {
  public:
    explicit Brackets(Source& source) : source_(source) {}

    void pair() {
        for (std::size_t i = 0; i < source_.tokens.size(); ++i) {
            Token& token = source_.tokens[i];
            if (token.kind == TokenKind::Directive) directive(token);
            bracket(source_.tokens, i, open_);
            if (!branches_.empty() && open_.size() < branches_.back().depth)
                fail(token.line, fmt::format("{} closes a bracket that was opened before the #if "
                                             "of line {}",
                                             source_.str(token), branches_.back().line));
        }
        // A forgotten brace leaves its function open: that is the line to report.
        if (!open_.empty())
            fail(source_.tokens[open_.front()].line,
                 fmt::format("{} is never closed", source_.str(open_.front())));
        if (!branches_.empty()) fail(branches_.back().line, "#if without an #endif");
    }

  private:
    struct Branch {
        std::size_t depth;  ///< brackets that were open before the #if
        int line;
    };

    [[noreturn]] void fail(int line, std::string_view message) const {
        source_error(source_.file, line, message);
    }

    void bracket(std::vector<Token>& tokens, std::size_t i, std::vector<std::size_t>& open) const {
        constexpr std::string_view kOpening = "([{", kClosing = ")]}";
        const std::string_view text = source_.str(tokens[i]);
        if (text.size() != 1) return;
        if (kOpening.find(text) != text.npos) open.push_back(i);
        const std::size_t kind = kClosing.find(text);
        if (kind == text.npos) return;
        if (open.empty()) fail(tokens[i].line, fmt::format("{} closes nothing", text));
        Token& partner = tokens[open.back()];
        if (source_.str(partner)[0] != kOpening[kind])
            fail(tokens[i].line, fmt::format("{} cannot close the {} of line {}", text,
                                             source_.str(partner), partner.line));
        partner.partner = i;
        tokens[i].partner = open.back();
        open.pop_back();
    }

    void directive(Token& token) {
        if (token.words.empty()) return;
        const std::string_view name = source_.str(token.words[0]);
        if (name == "define") {
            std::vector<std::size_t> inside;
            for (std::size_t i = 0; i < token.words.size(); ++i)
                bracket(token.words, i, inside);
            if (!inside.empty()) {
                const Token& last = token.words[inside.back()];
                fail(last.line,
                     fmt::format("{} is never closed in this #define", source_.str(last)));
            }
        } else if (name.starts_with("if")) {
            branches_.push_back({open_.size(), token.line});
        } else if (name == "elif" || name == "else" || name == "endif") {
            if (branches_.empty()) fail(token.line, fmt::format("#{} without an #if", name));
            if (open_.size() != branches_.back().depth) {
                const Token& last = source_.tokens[open_.back()];
                fail(last.line, fmt::format("{} is not closed before the #{} of line {}",
                                            source_.str(last), name, token.line));
            }
            if (name == "endif") branches_.pop_back();
        }
    }

    Source& source_;
    std::vector<std::size_t> open_;
    std::vector<Branch> branches_;
};

}  // namespace

void check_words(const Source& source) {
    if (!source.is_snippet()) return;
    std::string_view before;
    source.each([&](const Token& token) {
        const std::string_view word = source.str(token);
        for (const WordRule& rule : kWordRules)
            if (rule.is_broken(word, before))
                source_error(source.file, token.line,
                             fmt::format(fmt::runtime(rule.message), word, source.owner));
        if (word != "(") before = word;
    });
}

void pair_brackets(Source& source) {
    Brackets(source).pair();
}

}  // namespace relevo::shader
