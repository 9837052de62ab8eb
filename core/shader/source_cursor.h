#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "shader/source.h"

namespace relevo::shader {

/// A GLSL file and the token at which parsing is, with what every kind of declaration needs.
class SourceCursor : public Source {
  public:
    /// @throws Error (BadInput), as below
    SourceCursor(SourceKind of, std::string_view by, std::string_view name, std::string_view raw);

    std::size_t at = 0;  ///< the next token

    bool at_end() const { return at >= tokens.size(); }
    /// A token for messages.
    std::string written(std::size_t i) const;
    int end_line(std::size_t i) const;
    /// The text between two tokens, without them.
    std::string_view between(std::size_t begin, std::size_t end) const;

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
    /// The text of a comment after `//@`; none of another comment.
    std::optional<std::string_view> annotation(std::size_t comment) const;

    std::vector<Comment> comments_;
    std::vector<bool> used_;  // comments that are annotations
};

}  // namespace relevo::shader
