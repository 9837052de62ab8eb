#pragma once

#include <cstddef>
#include <optional>
#include <set>
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

// ---- declarations that are lifted out of a file
// The cursor is after the name, and then after the semicolon.

using Qualifiers = std::set<std::string, std::less<>>;

/// A parameter or a sampler.
/// @param first  token of the declaration; its type and name are the tokens `type` and `name`
void read_uniform(SourceCursor& cursor, std::size_t first, std::size_t type, std::size_t name);
void read_varying(SourceCursor& cursor, std::size_t first, std::size_t type, std::size_t name,
                  const Qualifiers& qualifiers);
/// A ramp of colours, if the declaration of variables that ends before the cursor has an
/// annotation. It stays in the file.
/// @param names  that are declared
void read_ramp(SourceCursor& cursor, std::size_t first, std::size_t name, std::size_t names);

// ---- checks of a whole file before it is parsed

/// A plugin's file has no words that are reserved for GLSL or core.
void check_words(const Source& source);

/// Every bracket is closed in its file and in its branch of a conditional. Otherwise an error would
/// name the next plugin. Sets Token::partner.
void pair_brackets(Source& source);

}  // namespace relevo::shader
