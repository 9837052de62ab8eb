#include "shader/source.h"

#include <algorithm>
#include <array>
#include <set>

#include <fmt/format.h>

#include "base/contains.h"
#include "base/text.h"
#include "shader/annotation.h"
#include "shader/source_checks.h"

namespace relevo::shader {
namespace {

constexpr std::string_view kIncludeForm = "//@ include lib/NAME.glsl";

constexpr std::array<std::string_view, 21> kQualifiers = {
    "const",    "uniform",   "in",      "out",    "inout",     "flat",       "smooth",
    "centroid", "sample",    "patch",   "layout", "buffer",    "shared",     "precise",
    "highp",    "invariant", "mediump", "lowp",   "attribute", "subroutine", "noperspective"};
constexpr std::array<std::string_view, 8> kNotForPlugins = {
    "layout", "buffer", "shared", "subroutine", "patch", "sample", "centroid", "invariant"};
constexpr std::array<std::string_view, 8> kDirectives = {"define", "undef", "if",   "ifdef",
                                                         "ifndef", "elif",  "else", "endif"};
constexpr std::array<std::string_view, 14> kVaryingTypes = {
    "float", "vec2", "vec3",  "vec4",  "int",   "ivec2", "ivec3",
    "ivec4", "uint", "uvec2", "uvec3", "uvec4", "mat3",  "mat4"};

bool is_sampler(std::string_view type) {
    if (!type.empty() && (type[0] == 'i' || type[0] == 'u')) type.remove_prefix(1);
    return type.substr(0, 7) == "sampler";
}

bool is_whole(std::string_view type) {
    return type == "int" || type == "uint" || type.substr(0, 4) == "ivec" ||
           type.substr(0, 4) == "uvec";
}

class Parser {
  public:
    Parser(SourceKind kind, std::string_view owner, std::string_view file, std::string_view text) {
        source_.kind = kind;
        source_.owner = owner;
        source_.file = file;
        source_.text = unix_lines(text);
        Tokens tokens = tokenize(source_.text, source_.file);
        source_.tokens = std::move(tokens.code);
        comments_ = std::move(tokens.comments);
        used_.resize(comments_.size());
    }

    Source run() {
        check_words(source_);
        check_brackets(source_);
        read_includes();
        while (at_ < source_.tokens.size())
            item();
        check_annotations();
        return std::move(source_);
    }

  private:
    // ---- helpers

    bool is_snippet() const { return source_.kind == SourceKind::Snippet; }
    const Token& token(std::size_t i) const { return source_.tokens[i]; }
    std::string_view str(std::size_t i) const { return source_.str(token(i)); }
    bool is(std::size_t i, std::string_view text) const {
        return i < source_.tokens.size() && str(i) == text;
    }
    bool is_word(std::size_t i) const {
        return i < source_.tokens.size() && token(i).kind == TokenKind::Word;
    }
    std::string written(std::size_t i) const {
        return i < source_.tokens.size() ? std::string(str(i)) : "the end of the file";
    }
    [[noreturn]] void fail(int line, std::string_view message) const {
        source_error(source_.file, line, message);
    }

    int end_line(std::size_t i) const {
        const std::string_view text = str(i);
        return token(i).line + static_cast<int>(std::ranges::count(text, '\n'));
    }

    /// The token behind the bracket that closes the one at `i`.
    std::size_t behind_brackets(std::size_t i) const {
        int depth = 0;
        do {
            depth += is(i, "(") || is(i, "[") || is(i, "{");
            depth -= is(i, ")") || is(i, "]") || is(i, "}");
            ++i;
        } while (depth > 0);
        return i;
    }

    void read_includes() {
        for (std::size_t i = 0; i < comments_.size(); ++i) {
            const std::string_view text = text_of(source_.text, comments_[i]);
            if (text.substr(0, 3) != "//@") continue;
            const std::string_view what = trimmed(text.substr(3));
            if (what.substr(0, 7) != "include") continue;
            const std::string name(trimmed(what.substr(7)));
            const bool good = name.size() > 9 && name.substr(0, 4) == "lib/" &&
                              name.substr(name.size() - 5) == ".glsl" &&
                              name.find("..") == std::string::npos &&
                              name.find_first_of(" \t\\") == std::string::npos;
            if (!good)
                fail(comments_[i].line, fmt::format("expected {} but got {}", kIncludeForm, text));
            source_.includes.push_back({name, comments_[i].line});
            used_[i] = true;
        }
    }

    void check_annotations() const {
        for (std::size_t i = 0; i < comments_.size(); ++i) {
            const std::string_view text = text_of(source_.text, comments_[i]);
            if (text.substr(0, 3) == "//@" && !used_[i])
                fail(comments_[i].line, fmt::format("{} has nothing to say here; it stands behind "
                                                    "a uniform, or is {}",
                                                    text, kIncludeForm));
        }
    }

    // ---- top-level pieces

    /// `needs` says whose name it is: "a plugin's globals begin with its id".
    void check_name(std::size_t i, std::string_view name) const {
        if (!is_snippet()) return;
        if (name == "main")
            fail(token(i).line, fmt::format("main is core's; a plugin hooks into it with "
                                            "functions named {}_on_<hook>",
                                            source_.owner));
        const std::string prefix = source_.owner + '_';
        if (name.substr(0, prefix.size()) != prefix || name.size() == prefix.size())
            fail(token(i).line, fmt::format("{}: a plugin's globals begin with its id, expected "
                                            "{}{} but got {}",
                                            name, prefix, name, name));
    }

    /// Only conditions may stand inside a piece, whose directives nobody else looks at.
    void check_directives_inside(std::size_t first, Item::Kind kind,
                                 const std::vector<std::string>& names) const {
        for (std::size_t i = first; i < at_; ++i) {
            if (token(i).kind != TokenKind::Directive) continue;
            const std::vector<Token> words = directive_tokens(source_.text, token(i), source_.file);
            const std::string_view what = words.empty() ? "if" : source_.str(words[0]);
            if (what == "define" || what == "undef" || !contains(kDirectives, what))
                fail(token(i).line,
                     fmt::format("#{} inside {}; move it out of the {}", what,
                                 names.empty() ? "a declaration" : names.front(),
                                 kind == Item::Kind::Function ? "function" : "declaration"));
        }
    }

    void add(Item::Kind kind, std::size_t first, std::vector<std::string> names, int name_line) {
        if (token(first).kind != TokenKind::Directive) check_directives_inside(first, kind, names);
        Item item;
        item.kind = kind;
        item.names = std::move(names);
        item.first = first;
        item.last = at_;
        item.name_line = name_line;
        item.begin = token(first).offset;
        item.line = token(first).line;
        item.end = token(at_ - 1).offset + token(at_ - 1).length;
        attach_comments(item, first == 0 ? 0 : end_line(first - 1), end_line(at_ - 1));
        source_.items.push_back(std::move(item));
    }

    // A comment belongs to the piece right under it, or before it on its last line.
    void attach_comments(Item& item, int previous_line, int last_line) const {
        for (std::size_t i = comments_.size(); i-- > 0;) {
            const Comment& comment = comments_[i];
            if (comment.offset >= item.begin) continue;
            if (comment.last_line < item.line - 1 || comment.line <= previous_line || used_[i])
                break;
            item.begin = comment.offset;
            item.line = comment.line;
        }
        const std::size_t next =
            item.last < source_.tokens.size() ? token(item.last).offset : std::string::npos;
        for (const Comment& comment : comments_) {
            if (comment.offset < item.end || comment.offset > next) continue;
            if (comment.line != last_line) break;
            item.end = comment.offset + comment.length;
            last_line = comment.last_line;
        }
    }

    void item() {
        if (token(at_).kind == TokenKind::Directive)
            directive();
        else if (is(at_, ";"))
            ++at_;
        else
            declaration();
    }

    void directive() {
        const std::size_t first = at_++;
        const int line = token(first).line;
        const std::vector<Token> words = directive_tokens(source_.text, token(first), source_.file);
        if (words.empty()) return;
        const std::string_view name = source_.str(words[0]);
        if (name == "version" || name == "extension")
            fail(line, fmt::format("#{} is core's: every program is plain GLSL 4.50 core", name));
        if (name == "line") fail(line, "#line would lose the file's own line numbers; remove it");
        if (!contains(kDirectives, name))
            fail(line, fmt::format("#{} is not for here; there are #define, #undef and #if", name));
        if (name == "define" || name == "undef") {
            if (words.size() < 2 || words[1].kind != TokenKind::Word)
                fail(line, fmt::format("#{} without a name", name));
            const std::string macro(source_.str(words[1]));
            check_name(first, macro);
            if (macro.find("__") != std::string::npos)
                fail(line, fmt::format("{}: GLSL keeps names with __ to itself", macro));
            add(name == "define" ? Item::Kind::Macro : Item::Kind::Undef, first, {macro}, line);
            return;
        }
        if (name.substr(0, 2) == "if") conditional_lines_.push_back(line);
        if (name == "endif") conditional_lines_.pop_back();
        add(Item::Kind::Conditional, first, {}, line);
    }

    void check_unconditional(int line, std::string_view what) const {
        if (!conditional_lines_.empty())
            fail(line, fmt::format("{} stands under the #if of line {}; what a plugin has must not "
                                   "depend on what else is on, so move the #if into a function",
                                   what, conditional_lines_.back()));
    }

    void declaration() {
        const std::size_t first = at_;
        const int line = token(first).line;
        std::set<std::string, std::less<>> qualifiers;
        while (is_word(at_) && contains(kQualifiers, str(at_))) {
            qualifiers.emplace(str(at_));
            ++at_;
            if (is(at_ - 1, "layout") && is(at_, "(")) at_ = behind_brackets(at_);
        }
        const auto has = [&](std::string_view q) { return qualifiers.count(q) > 0; };

        if (is_snippet()) {
            for (const std::string& qualifier : qualifiers)
                if (contains(kNotForPlugins, qualifier))
                    fail(line, fmt::format("{} is core's; a plugin declares parameters, samplers, "
                                           "varyings, constants, structs and functions",
                                           qualifier));
            if (has("in"))
                fail(line, "a varying is declared once, for both sides, with out instead of in");
        } else if (has("layout") || has("invariant") || has("buffer") || has("shared")) {
            skip_declaration();
            add(Item::Kind::Interface, first, {}, line);
            return;
        }
        if (is(at_, "precision")) fail(line, "precision does nothing in desktop GLSL; remove it");
        if (is(at_, "struct")) {
            structure(first);
            return;
        }
        if (!is_word(at_))
            fail(token(std::min(at_, source_.tokens.size() - 1)).line,
                 fmt::format("expected a declaration but got {}", written(at_)));
        const std::size_t type = at_++;
        if (is(at_, "{"))
            fail(line, fmt::format("{} is a block, which is core's; a plugin declares parameters "
                                   "one by one",
                                   str(type)));
        while (is(at_, "["))
            at_ = behind_brackets(at_);
        if (!is_word(at_))
            fail(line,
                 fmt::format("expected a declaration but got {} {}", str(type), written(at_)));
        const std::size_t name = at_++;
        if (is(at_, "("))
            function(first, name);
        else if (has("uniform"))
            uniform(first, type, name);
        else if (has("out") || has("in"))
            varying(first, type, name, qualifiers);
        else
            variables(first, name);
    }

    void skip_declaration() {
        while (at_ < source_.tokens.size() && !is(at_, ";"))
            at_ = is(at_, "{") || is(at_, "(") ? behind_brackets(at_) : at_ + 1;
        expect_semicolon(token(at_ - 1).line);
    }

    void expect_semicolon(int line) {
        if (!is(at_, ";")) fail(line, fmt::format("expected ; but got {}", written(at_)));
        ++at_;
    }

    void structure(std::size_t first) {
        const int line = token(first).line;
        ++at_;
        if (!is_word(at_) || !is(at_ + 1, "{"))
            fail(line, "expected a struct with a name and its members");
        const std::size_t name = at_;
        check_name(name, str(name));
        std::vector<std::string> names = {std::string(str(name))};
        at_ = behind_brackets(at_ + 1);
        if (is_word(at_) && token(at_).line > end_line(at_ - 1))
            fail(token(at_ - 1).line, fmt::format("expected ; behind the struct {}", names[0]));
        if (is_word(at_)) {
            const std::size_t variable = at_++;
            declarators(variable, names);
        }
        expect_semicolon(line);
        add(Item::Kind::Declaration, first, std::move(names), token(name).line);
    }

    /// Reads from behind the first name up to the semicolon.
    void declarators(std::size_t name, std::vector<std::string>& names) {
        while (true) {
            check_name(name, str(name));
            names.emplace_back(str(name));
            while (at_ < source_.tokens.size() && !is(at_, ",") && !is(at_, ";")) {
                if (token(at_).kind == TokenKind::Directive)
                    fail(token(at_).line,
                         fmt::format("expected ; behind {} but got a directive", names.back()));
                // No expression has a word right behind another operand, nor a body behind a ).
                const bool operand = is_word(at_ - 1) || token(at_ - 1).kind == TokenKind::Number ||
                                     is(at_ - 1, ")") || is(at_ - 1, "}");
                if (operand && (is_word(at_) || is(at_, "{")))
                    fail(token(at_ - 1).line,
                         fmt::format("expected ; behind {} but got {}", names.back(), str(at_)));
                at_ = is(at_, "(") || is(at_, "[") || is(at_, "{") ? behind_brackets(at_) : at_ + 1;
            }
            if (!is(at_, ",")) return;
            name = at_ + 1;
            if (!is_word(name)) fail(token(at_).line, "expected a name behind the comma");
            at_ = name + 1;
        }
    }

    void variables(std::size_t first, std::size_t name) {
        std::vector<std::string> names;
        declarators(name, names);
        expect_semicolon(token(name).line);
        if (is_snippet()) ramp(first, name, names.size());
        add(Item::Kind::Declaration, first, std::move(names), token(name).line);
    }

    /// An annotated constant; others are let through.
    void ramp(std::size_t first, std::size_t name, std::size_t names) {
        const std::optional<std::string_view> annotation = annotation_behind(at_ - 1);
        if (!annotation) return;
        const int line = token(name).line;
        std::size_t equals = name + 1;
        while (equals < at_ && !is(equals, "="))
            ++equals;
        if (str(first) != "const" || str(first + 1) != "vec3" || names != 1 || equals == at_)
            fail(line, fmt::format("{}: an annotation behind a variable is for a ramp of colours, "
                                   "const vec3 {}[N] = vec3[](...);",
                                   str(name), str(name)));
        const std::size_t begin = token(equals).offset + 1;
        source_.ramps.push_back(
            parse_ramp(source_.owner, str(name),
                       std::string_view(source_.text).substr(begin, token(at_ - 1).offset - begin),
                       *annotation, source_.file, line));
    }

    void function(std::size_t first, std::size_t name) {
        const std::string text(str(name));
        const int line = token(name).line;
        check_name(name, text);
        at_ = behind_brackets(at_);
        if (is(at_, ";")) {
            ++at_;
            add(Item::Kind::Prototype, first, {text}, line);
            return;
        }
        if (!is(at_, "{"))
            fail(line, fmt::format("expected {{ or ; behind the head of {} but got {}", text,
                                   written(at_)));
        at_ = behind_brackets(at_);
        add(Item::Kind::Function, first, {text}, line);
        if (is_snippet() && text.substr(source_.owner.size(), 4) == "_on_")
            check_unconditional(line, text);
    }

    // ---- lifted declarations

    /// The `//@` behind the token, without its mark; null if there is none.
    std::optional<std::string_view> annotation_behind(std::size_t last) {
        for (std::size_t i = 0; i < comments_.size(); ++i) {
            const std::string_view text = text_of(source_.text, comments_[i]);
            if (comments_[i].line != token(last).line || comments_[i].offset < token(last).offset ||
                text.substr(0, 3) != "//@")
                continue;
            used_[i] = true;
            return text.substr(3);
        }
        return std::nullopt;
    }

    /// Moves to behind the `;`, checking that nothing else is on the line.
    void end_lifted(std::size_t first, std::size_t name) {
        const int line = token(first).line;
        while (at_ < source_.tokens.size() && token(at_).line == line && !is(at_, ";"))
            ++at_;
        if (!is(at_, ";") || token(at_).line != line)
            fail(line, fmt::format("{}: expected ; before the end of the line", str(name)));
        ++at_;
        const bool alone = (first == 0 || end_line(first - 1) < line) &&
                           (at_ == source_.tokens.size() || token(at_).line > line);
        if (!alone)
            fail(line, fmt::format("{}: uniforms and varyings stand alone, one a line", str(name)));
        check_unconditional(line, str(name));
    }

    void uniform(std::size_t first, std::size_t type, std::size_t name) {
        const std::string_view type_name = str(type);
        const int line = token(name).line;
        check_name(name, str(name));
        const std::size_t behind_name = at_;
        end_lifted(first, name);
        const bool sampler = is_sampler(type_name);
        if (is(behind_name, ",") || is(type + 1, "[") || is(behind_name, "["))
            fail(line, fmt::format("{}: expected one {} without brackets and commas", str(name),
                                   type_name));
        if (sampler) {
            if (!is(behind_name, ";"))
                fail(line,
                     fmt::format("{}: expected ; but got {}", str(name), written(behind_name)));
            add_sampler(type_name, name);
            return;
        }
        if (!is_snippet())
            fail(line, fmt::format("{}: core's uniforms are samplers and blocks", str(name)));
        if (!param_type(type_name))
            fail(line, fmt::format("{}: expected a parameter of type float, int, bool, vec2, vec3 "
                                   "or vec4, or a sampler, but got {}",
                                   str(name), type_name));
        if (!is(behind_name, "="))
            fail(line, fmt::format("{}: a parameter has a default; expected = behind it but got {}",
                                   str(name), written(behind_name)));
        const std::size_t begin = token(behind_name).offset + 1;
        const std::string_view initial =
            std::string_view(source_.text).substr(begin, token(at_ - 1).offset - begin);
        const std::string_view annotation = annotation_behind(at_ - 1).value_or("");
        source_.params.push_back(
            parse_param(type_name, str(name), initial, annotation, source_.file, line));
    }

    void add_sampler(std::string_view type, std::size_t name) {
        const int line = token(name).line;
        Sampler sampler{std::string(str(name)), std::string(type), "", source_.file, line};
        sampler.resource = is_snippet() ? address_of(sampler.name) : sampler.name;
        if (const auto annotation = annotation_behind(at_ - 1)) {
            for (const AnnotationWord& word : parse_annotation(*annotation, source_.file, line)) {
                if (word.name != "from" || word.arguments.size() != 1 ||
                    word.arguments[0].find('.') == std::string::npos)
                    fail(line, fmt::format("{}: a sampler has no annotation but from(name.word), "
                                           "for a texture that another plugin makes",
                                           sampler.name));
                sampler.resource = word.arguments[0];
            }
        }
        source_.samplers.push_back(std::move(sampler));
    }

    void varying(std::size_t first, std::size_t type, std::size_t name,
                 const std::set<std::string, std::less<>>& qualifiers) {
        const int line = token(name).line;
        Varying varying{std::string(str(name)),     std::string(str(type)), "",
                        qualifiers.count("in") > 0, source_.file,           line};
        check_name(name, varying.name);
        for (const std::string_view word : {"flat", "smooth", "noperspective"})
            if (qualifiers.count(word) > 0) varying.interpolation = word;
        if (!is(at_, ";"))
            fail(line, fmt::format("{}: expected ; behind the varying but got {}", varying.name,
                                   written(at_)));
        end_lifted(first, name);
        if (is(type + 1, "[") || !contains(kVaryingTypes, varying.type))
            fail(line, fmt::format("{}: expected a varying of type float, int or uint, a vector of "
                                   "them, mat3 or mat4, but got {}{}",
                                   varying.name, varying.type, is(type + 1, "[") ? "[]" : ""));
        if (is_whole(varying.type) && varying.interpolation != "flat")
            fail(line, fmt::format("{}: whole numbers are not interpolated; expected flat out {} "
                                   "but got out {}",
                                   varying.name, varying.type, varying.type));
        if (!is_snippet() && varying.is_input != (source_.kind == SourceKind::FragmentMain))
            fail(line, fmt::format("{}: inputs of a vertex main and outputs of a fragment main "
                                   "have a layout(location = N)",
                                   varying.name));
        source_.varyings.push_back(std::move(varying));
    }

    Source source_;
    std::vector<Comment> comments_;
    std::vector<bool> used_;  // comments that are annotations
    std::vector<int> conditional_lines_;
    std::size_t at_ = 0;
};

}  // namespace

Signature Source::signature(const Item& item) const {
    std::size_t i = item.first;
    while (str(tokens[i]) != "(")
        ++i;
    int depth = 0;
    std::size_t close = i;
    do {
        depth += (str(tokens[close]) == "(") - (str(tokens[close]) == ")");
        ++close;
    } while (depth > 0);
    const std::size_t begin = tokens[item.first].offset;
    const std::size_t end = tokens[close - 1].offset + 1;
    return parse_signature(std::string_view(text).substr(begin, end - begin));
}

Source parse_source(SourceKind kind, std::string_view owner, std::string_view file,
                    std::string_view text) {
    return Parser(kind, owner, file, text).run();
}

}  // namespace relevo::shader
