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
    int line;                    ///< from 1
    std::size_t partner = 0;     ///< of a bracket in a Source: the index of the other of the pair
    std::vector<Token> words{};  ///< of a directive: the tokens after its `#`, without comments
};

struct Comment {
    std::size_t offset;
    std::size_t length;
    int line;  ///< of its first byte
    int last_line;
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

/// Whether an identifier may have a byte.
constexpr bool is_word_byte(char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

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
