#include "shader/source_cursor.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/text.h"

namespace relevo::shader {
namespace {

constexpr std::string_view kIncludeForm = "//@ include lib/NAME.glsl";

}  // namespace

SourceCursor::SourceCursor(SourceKind of, std::string_view by, std::string_view name,
                           std::string_view raw) {
    kind = of;
    owner = by;
    file = name;
    text = unix_lines(raw);
    Tokens read = tokenize(text, file);
    tokens = std::move(read.code);
    comments_ = std::move(read.comments);
    used_.resize(comments_.size());
}

std::string SourceCursor::written(std::size_t i) const {
    return i < tokens.size() ? std::string(str(i)) : "the end of the file";
}

int SourceCursor::end_line(std::size_t i) const {
    return tokens[i].line + static_cast<int>(std::ranges::count(str(i), '\n'));
}

std::string_view SourceCursor::between(std::size_t begin, std::size_t end) const {
    const std::size_t offset = tokens[begin].offset + tokens[begin].length;
    return std::string_view(text).substr(offset, tokens[end].offset - offset);
}

void SourceCursor::fail(int line, std::string_view message) const {
    source_error(file, line, message);
}

void SourceCursor::check_name(std::size_t i, std::string_view name) const {
    if (!is_snippet()) return;
    if (name == "main")
        fail(tokens[i].line, fmt::format("main is core's; a plugin hooks into it with "
                                         "functions named {}_on_<hook>",
                                         owner));
    const std::string prefix = owner + '_';
    if (name.substr(0, prefix.size()) != prefix || name.size() == prefix.size())
        fail(tokens[i].line, fmt::format("{}: a plugin's globals begin with its id, expected "
                                         "{}{} but got {}",
                                         name, prefix, name, name));
}

void SourceCursor::check_unconditional(int line, std::string_view what) const {
    if (!conditional_lines.empty())
        fail(line, fmt::format("{} is under the #if of line {}; a plugin's declarations must not "
                               "depend on other effects; move the #if into a function",
                               what, conditional_lines.back()));
}

void SourceCursor::expect_semicolon(int line) {
    if (!is(at, ";")) fail(line, fmt::format("expected ; but got {}", written(at)));
    ++at;
}

// ---- comments

void SourceCursor::read_includes() {
    for (std::size_t i = 0; i < comments_.size(); ++i) {
        const std::string_view what = trimmed(annotation(i).value_or(""));
        if (what.substr(0, 7) != "include") continue;
        const std::string name(trimmed(what.substr(7)));
        const bool good = name.size() > 9 && name.starts_with("lib/") && name.ends_with(".glsl") &&
                          name.find("..") == std::string::npos &&
                          name.find_first_of(" \t\\") == std::string::npos;
        if (!good)
            fail(comments_[i].line,
                 fmt::format("expected {} but got {}", kIncludeForm, text_of(text, comments_[i])));
        includes.push_back({name, comments_[i].line});
        used_[i] = true;
    }
}

void SourceCursor::attach_comments(Item& item, int previous_line, int last_line) const {
    for (std::size_t i = comments_.size(); i-- > 0;) {
        const Comment& comment = comments_[i];
        if (comment.offset >= item.begin) continue;
        if (comment.last_line < item.line - 1 || comment.line <= previous_line || used_[i]) break;
        item.begin = comment.offset;
        item.line = comment.line;
    }
    const std::size_t next =
        item.last < tokens.size() ? tokens[item.last].offset : std::string::npos;
    for (const Comment& comment : comments_) {
        if (comment.offset < item.end || comment.offset > next) continue;
        if (comment.line != last_line) break;
        item.end = comment.offset + comment.length;
        last_line = comment.last_line;
    }
}

std::optional<std::string_view> SourceCursor::annotation(std::size_t comment) const {
    const std::string_view whole = text_of(text, comments_[comment]);
    return whole.starts_with("//@") ? std::optional(whole.substr(3)) : std::nullopt;
}

std::optional<std::string_view> SourceCursor::annotation_after(std::size_t last) {
    for (std::size_t i = 0; i < comments_.size(); ++i) {
        if (comments_[i].line != tokens[last].line || comments_[i].offset < tokens[last].offset ||
            !annotation(i))
            continue;
        used_[i] = true;
        return annotation(i);
    }
    return std::nullopt;
}

void SourceCursor::check_annotations() const {
    for (std::size_t i = 0; i < comments_.size(); ++i)
        if (annotation(i) && !used_[i])
            fail(comments_[i].line,
                 fmt::format("{} is misplaced; expected it after a uniform, or {}",
                             text_of(text, comments_[i]), kIncludeForm));
}

}  // namespace relevo::shader
