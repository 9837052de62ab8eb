#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace relevo::shader {

enum class TokenKind {
    Word,       ///< identifier or keyword
    Number,     ///< 1, 0.5f, 0x1Fu
    Mark,       ///< operator or bracket, the longest that matches: "<<="
    Directive,  ///< a whole preprocessor line with its continuations, without a comment after it
};

/// A range of the text.
struct Token {
    TokenKind kind;
    std::size_t offset;  ///< of its first byte
    std::size_t length;
    int line;    ///< from 1
    int column;  ///< from 1, in bytes
};

struct Comment {
    std::size_t offset;
    std::size_t length;
    int line;  ///< of its first byte
    int last_line;
    int column;
};

struct Tokens {
    std::vector<Token> code;
    std::vector<Comment> comments;
};

/// Splits GLSL 4.50 into tokens and comments.
/// @param text  with "\n" line ends (see unix_lines)
/// @param file  only for messages
/// @throws Error (BadInput) for an unclosed comment, a byte that GLSL allows in comments only, or
///         a `#` that is not first on its line
Tokens tokenize(std::string_view text, std::string_view file);

/// The tokens of a directive after its `#`. Offsets are into the same text.
std::vector<Token> directive_tokens(std::string_view text, const Token& directive,
                                    std::string_view file);

/// The text without a byte-order mark, with "\n" line ends.
std::string unix_lines(std::string_view text);

inline std::string_view text_of(std::string_view text, const Token& token) {
    return text.substr(token.offset, token.length);
}

inline std::string_view text_of(std::string_view text, const Comment& comment) {
    return text.substr(comment.offset, comment.length);
}

/// Throws `Error(BadInput, "shader: file:line: message")`.
[[noreturn]] void source_error(std::string_view file, int line, std::string_view message);

}  // namespace relevo::shader
