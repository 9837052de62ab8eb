#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "shader/source.h"

namespace relevo::shader {

/// A GLSL file and the token at which parsing is, with what every kind of declaration needs.
class SourceCursor {
  public:
    /// @throws Error (BadInput), as below
    SourceCursor(SourceKind kind, std::string_view owner, std::string_view file,
                 std::string_view text);

    Source source;
    std::size_t at = 0;  ///< the next token

    bool is_snippet() const { return source.kind == SourceKind::Snippet; }
    bool at_end() const { return at >= source.tokens.size(); }
    const Token& token(std::size_t i) const { return source.tokens[i]; }
    std::string_view str(std::size_t i) const { return source.str(token(i)); }
    bool is(std::size_t i, std::string_view text) const {
        return i < source.tokens.size() && str(i) == text;
    }
    bool is_word(std::size_t i) const {
        return i < source.tokens.size() && token(i).kind == TokenKind::Word;
    }
    /// A token for messages.
    std::string written(std::size_t i) const;
    int end_line(std::size_t i) const;
    /// The text between two tokens, without them.
    std::string_view between(std::size_t begin, std::size_t end) const;
    /// The token after the bracket that closes the one at `i`.
    std::size_t after_brackets(std::size_t i) const;

    [[noreturn]] void fail(int line, std::string_view message) const;
    /// A global of a plugin begins with its id.
    void check_name(std::size_t i, std::string_view name) const;
    void check_unconditional(int line, std::string_view what) const;
    void expect_semicolon(int line);

    void read_includes();
    /// Extends an item by its comments: those directly above it, and one on its last line.
    /// @param previous_line  the last line of the item before
    void attach_comments(Item& item, int previous_line, int last_line) const;
    /// The `//@` comment after a token on its line, without the mark.
    std::optional<std::string_view> annotation_after(std::size_t last);
    /// Every `//@` comment has been used.
    void check_annotations() const;

    std::vector<int> conditional_lines;  ///< of the #ifs that are open

  private:
    std::vector<Comment> comments_;
    std::vector<bool> used_;  // comments that are annotations
};

}  // namespace relevo::shader
