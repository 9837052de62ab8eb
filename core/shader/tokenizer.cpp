#include "shader/tokenizer.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"

namespace relevo::shader {
namespace {

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

// Longest first: GLSL reads the longest that matches.
constexpr std::array<std::string_view, 21> kLongMarks = {
    "<<=", ">>=", "<<", ">>", "<=", ">=", "==", "!=", "&&", "||", "^^",
    "++",  "--",  "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^="};
constexpr std::string_view kMarks = "(){}[];,.=+-*/%<>!~&|^?:";

class Scanner {
  public:
    Scanner(std::string_view text, std::string_view file) : text_(text), file_(file) {}

    Tokens run() {
        read(/*in_directive=*/false);
        return std::move(tokens_);
    }

  private:
    /// Reads to the end, or the end of a directive, in which a `#` is an operator.
    void read(bool in_directive) {
        bool first_on_line = true;
        while (at_ < text_.size()) {
            const char c = text_[at_];
            if (in_directive && (c == '\n' || starts("//"))) return;
            if (c == '\n') {
                advance(1);
                first_on_line = true;
            } else if (c == ' ' || c == '\t' || c == '\v' || c == '\f') {
                advance(1);
            } else if (continues()) {
                check_continuation();
                advance(2);
            } else if (starts("//") || starts("/*")) {
                comment();
            } else if (c == '#' && !in_directive) {
                if (!first_on_line) fail("# must be first on its line");
                directive();
            } else {
                code(c, in_directive);
                first_on_line = false;
            }
        }
    }

    bool starts(std::string_view what) const { return text_.substr(at_).starts_with(what); }

    // A backslash before the line end joins two lines, also in comments (GLSL 4.50, 3.2).
    bool continues() const { return starts("\\\n"); }

    // The driver would join a split word or mark; the tokens here would differ.
    void check_continuation() const {
        const auto is_blank = [](char c) {
            return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\n';
        };
        if (at_ > 0 && !is_blank(text_[at_ - 1]) && at_ + 2 < text_.size() &&
            !is_blank(text_[at_ + 2]))
            fail("\\ joins this line and the next without a space between them; add one");
    }

    void advance(std::size_t count) {
        for (; count > 0; --count, ++at_)
            line_ += text_[at_] == '\n';
    }

    [[noreturn]] void fail(std::string_view message) const { source_error(file_, line_, message); }

    void comment() {
        Comment result{at_, 0, line_, line_};
        if (starts("//")) {
            while (at_ < text_.size() && text_[at_] != '\n')
                advance(continues() ? 2 : 1);
        } else {
            advance(2);
            while (at_ < text_.size() && !starts("*/")) {
                if (text_[at_] == '*' && at_ + 1 < text_.size() && text_[at_ + 1] == '\\')
                    fail(
                        "* and \\ next to each other in a comment may end it; put a space between "
                        "them");
                advance(1);
            }
            if (at_ == text_.size()) source_error(file_, result.line, "/* is never closed");
            advance(2);
        }
        result.length = at_ - result.offset;
        result.last_line = line_;
        tokens_.comments.push_back(result);
    }

    void directive() {
        Token token{TokenKind::Directive, at_, 1, line_};
        std::vector<Token> before = std::exchange(tokens_.code, {});
        const std::size_t comments = tokens_.comments.size();
        advance(1);
        read(/*in_directive=*/true);
        tokens_.comments.resize(comments);  // those in it are a part of it
        token.words = std::exchange(tokens_.code, std::move(before));
        if (!token.words.empty())
            token.length = token.words.back().offset + token.words.back().length - token.offset;
        tokens_.code.push_back(std::move(token));
    }

    void code(char c, bool in_directive) {
        Token token{TokenKind::Mark, at_, 0, line_};
        std::size_t length = 0;
        const bool number =
            is_digit(c) || (c == '.' && at_ + 1 < text_.size() && is_digit(text_[at_ + 1]));
        if (number) {
            token.kind = TokenKind::Number;
            const bool hexadecimal = starts("0x") || starts("0X");
            while (at_ + length < text_.size()) {
                const char next = text_[at_ + length];
                const char last = length > 0 ? text_[at_ + length - 1] : '\0';
                const bool exponent_sign =
                    (next == '+' || next == '-') && !hexadecimal && (last == 'e' || last == 'E');
                if (!is_word_byte(next) && next != '.' && !exponent_sign) break;
                ++length;
            }
        } else if (is_word_byte(c)) {
            token.kind = TokenKind::Word;
            while (at_ + length < text_.size() && is_word_byte(text_[at_ + length]))
                ++length;
        } else {
            const auto mark =
                std::ranges::find_if(kLongMarks, [&](auto known) { return starts(known); });
            if (mark != kLongMarks.end())
                length = mark->size();
            else if (kMarks.find(c) != kMarks.npos || (in_directive && (c == '#' || c == '"')))
                length = 1;
            if (length == 0) {
                const auto byte = static_cast<unsigned char>(c);
                if (byte > 32 && byte < 127)
                    fail(fmt::format("the character {} has no place in GLSL", c));
                fail(fmt::format("the byte 0x{:02X} may stand in comments only", byte));
            }
        }
        advance(length);
        token.length = length;
        tokens_.code.push_back(token);
    }

    std::string_view text_;
    std::string_view file_;
    std::size_t at_ = 0;
    int line_ = 1;
    Tokens tokens_;
};

}  // namespace

Tokens tokenize(std::string_view text, std::string_view file) {
    return Scanner(text, file).run();
}

std::string unix_lines(std::string_view text) {
    if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);
    std::string result;
    result.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '\r') {
            result += text[i];
        } else {
            result += '\n';
            if (i + 1 < text.size() && text[i + 1] == '\n') ++i;
        }
    }
    return result;
}

void source_error(std::string_view file, int line, std::string_view message) {
    bad_input(fmt::format("shader: {}:{}: {}", file, line, message));
}

}  // namespace relevo::shader
