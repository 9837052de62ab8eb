#include "shader/tokenizer.h"

#include <array>

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

    /// Reads `text[begin, end)`. Inside a directive a `#` is an operator, not a directive.
    Tokens run(std::size_t begin, std::size_t end, int line, bool in_directive) {
        at_ = begin;
        end_ = end;
        line_ = line;
        bool first_on_line = true;
        while (at_ < end_) {
            const char c = text_[at_];
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
        return std::move(tokens_);
    }

  private:
    bool starts(std::string_view what) const {
        return text_.substr(at_, std::min(what.size(), end_ - at_)) == what;
    }

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
            while (at_ < end_ && text_[at_] != '\n')
                advance(continues() ? 2 : 1);
        } else {
            advance(2);
            while (at_ < end_ && !starts("*/")) {
                if (text_[at_] == '*' && at_ + 1 < end_ && text_[at_ + 1] == '\\')
                    fail(
                        "* and \\ next to each other in a comment may end it; put a space between "
                        "them");
                advance(1);
            }
            if (at_ == end_) source_error(file_, result.line, "/* is never closed");
            advance(2);
        }
        result.length = at_ - result.offset;
        result.last_line = line_;
        tokens_.comments.push_back(result);
    }

    void directive() {
        Token token{TokenKind::Directive, at_, 0, line_};
        while (at_ < end_ && text_[at_] != '\n') {
            if (continues()) {
                check_continuation();
                advance(2);
            } else if (starts("//")) {
                break;
            } else if (starts("/*")) {
                comment();
                tokens_.comments.pop_back();  // a part of the directive
                token.length = at_ - token.offset;
            } else {
                const bool blank = text_[at_] == ' ' || text_[at_] == '\t';
                advance(1);
                if (!blank) token.length = at_ - token.offset;
            }
        }
        const std::size_t end = token.offset + token.length;
        token.words =
            std::move(Scanner(text_, file_).run(token.offset + 1, end, token.line, true).code);
        tokens_.code.push_back(std::move(token));
    }

    void code(char c, bool in_directive) {
        Token token{TokenKind::Mark, at_, 0, line_};
        std::size_t length = 0;
        const bool number = is_digit(c) || (c == '.' && at_ + 1 < end_ && is_digit(text_[at_ + 1]));
        if (number) {
            token.kind = TokenKind::Number;
            const bool hexadecimal = starts("0x") || starts("0X");
            while (at_ + length < end_) {
                const char next = text_[at_ + length];
                const char last = length > 0 ? text_[at_ + length - 1] : '\0';
                const bool exponent_sign =
                    (next == '+' || next == '-') && !hexadecimal && (last == 'e' || last == 'E');
                if (!is_word_byte(next) && next != '.' && !exponent_sign) break;
                ++length;
            }
        } else if (is_word_byte(c)) {
            token.kind = TokenKind::Word;
            while (at_ + length < end_ && is_word_byte(text_[at_ + length]))
                ++length;
        } else {
            for (const std::string_view mark : kLongMarks) {
                if (starts(mark)) {
                    length = mark.size();
                    break;
                }
            }
            if (length == 0 && (kMarks.find(c) != std::string_view::npos ||
                                (in_directive && (c == '#' || c == '"'))))
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
    std::size_t end_ = 0;
    int line_ = 1;
    Tokens tokens_;
};

}  // namespace

Tokens tokenize(std::string_view text, std::string_view file) {
    return Scanner(text, file).run(0, text.size(), 1, false);
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
