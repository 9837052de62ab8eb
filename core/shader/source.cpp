#include "shader/source.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "base/contains.h"
#include "shader/lifted.h"
#include "shader/source_checks.h"
#include "shader/source_cursor.h"

namespace relevo::shader {
namespace {

constexpr std::array<std::string_view, 21> kQualifiers = {
    "const",    "uniform",   "in",      "out",    "inout",     "flat",       "smooth",
    "centroid", "sample",    "patch",   "layout", "buffer",    "shared",     "precise",
    "highp",    "invariant", "mediump", "lowp",   "attribute", "subroutine", "noperspective"};
constexpr std::array<std::string_view, 7> kNotForPlugins = {
    "layout", "buffer", "subroutine", "patch", "sample", "centroid", "invariant"};
constexpr std::array<std::string_view, 8> kDirectives = {"define", "undef", "if",   "ifdef",
                                                         "ifndef", "elif",  "else", "endif"};

class Parser : SourceCursor {
  public:
    using SourceCursor::SourceCursor;

    Source run() {
        check_words(source);
        check_brackets(source);
        read_includes();
        while (!at_end())
            item();
        check_annotations();
        return std::move(source);
    }

  private:
    // ---- items

    /// Directives inside an item are not evaluated: only conditionals are allowed there.
    void check_directives_inside(std::size_t first, Item::Kind kind,
                                 const std::vector<std::string>& names) const {
        for (std::size_t i = first; i < at; ++i) {
            if (token(i).kind != TokenKind::Directive) continue;
            const std::vector<Token> words = directive_tokens(source.text, token(i), source.file);
            const std::string_view what = words.empty() ? "if" : source.str(words[0]);
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
        item.last = at;
        item.name_line = name_line;
        item.begin = token(first).offset;
        item.line = token(first).line;
        item.end = token(at - 1).offset + token(at - 1).length;
        attach_comments(item, first == 0 ? 0 : end_line(first - 1), end_line(at - 1));
        source.items.push_back(std::move(item));
    }

    void item() {
        if (token(at).kind == TokenKind::Directive)
            directive();
        else if (is(at, ";"))
            ++at;
        else
            declaration();
    }

    void directive() {
        const std::size_t first = at++;
        const int line = token(first).line;
        const std::vector<Token> words = directive_tokens(source.text, token(first), source.file);
        if (words.empty()) return;
        const std::string_view name = source.str(words[0]);
        if (name == "version" || name == "extension")
            fail(line, fmt::format("#{} is core's: every program is plain GLSL 4.50 core", name));
        if (name == "line") fail(line, "#line would lose the file's own line numbers; remove it");
        if (!contains(kDirectives, name))
            fail(line, fmt::format("#{} is not supported; use #define, #undef or #if", name));
        if (name == "define" || name == "undef") {
            if (words.size() < 2 || words[1].kind != TokenKind::Word)
                fail(line, fmt::format("#{} without a name", name));
            const std::string macro(source.str(words[1]));
            check_name(first, macro);
            if (macro.find("__") != std::string::npos)
                fail(line, fmt::format("{}: names with __ are reserved for GLSL", macro));
            add(name == "define" ? Item::Kind::Macro : Item::Kind::Undef, first, {macro}, line);
            return;
        }
        if (name.substr(0, 2) == "if") conditional_lines.push_back(line);
        if (name == "endif") conditional_lines.pop_back();
        add(Item::Kind::Conditional, first, {}, line);
    }

    void declaration() {
        const std::size_t first = at;
        const int line = token(first).line;
        Qualifiers qualifiers;
        while (is_word(at) && contains(kQualifiers, str(at))) {
            qualifiers.emplace(str(at));
            ++at;
            if (is(at - 1, "layout") && is(at, "(")) at = after_brackets(at);
        }
        const auto has = [&](std::string_view q) { return qualifiers.count(q) > 0; };

        if (is_snippet()) {
            for (const std::string& qualifier : qualifiers)
                if (contains(kNotForPlugins, qualifier))
                    fail(line, fmt::format("{} is core's; a plugin declares parameters, samplers, "
                                           "varyings, constants, structs and functions",
                                           qualifier));
            if (has("in"))
                fail(line, "a varying is declared once, for both stages, with out instead of in");
        } else if (has("layout") || has("invariant") || has("buffer") || has("shared")) {
            skip_declaration();
            add(Item::Kind::Interface, first, {}, line);
            return;
        }
        if (is(at, "precision")) fail(line, "precision does nothing in desktop GLSL; remove it");
        if (is(at, "struct")) {
            structure(first);
            return;
        }
        if (!is_word(at))
            fail(token(std::min(at, source.tokens.size() - 1)).line,
                 fmt::format("expected a declaration but got {}", written(at)));
        const std::size_t type = at++;
        if (is(at, "{"))
            fail(line, fmt::format("{} is a block, which is core's; a plugin declares parameters "
                                   "one by one",
                                   str(type)));
        while (is(at, "["))
            at = after_brackets(at);
        if (!is_word(at))
            fail(line, fmt::format("expected a declaration but got {} {}", str(type), written(at)));
        const std::size_t name = at++;
        if (is(at, "("))
            function(first, name);
        else if (has("uniform"))
            read_uniform(*this, first, type, name);
        else if (has("out") || has("in"))
            read_varying(*this, first, type, name, qualifiers);
        else
            variables(first, name);
    }

    void skip_declaration() {
        while (!at_end() && !is(at, ";"))
            at = is(at, "{") || is(at, "(") ? after_brackets(at) : at + 1;
        expect_semicolon(token(at - 1).line);
    }

    void structure(std::size_t first) {
        const int line = token(first).line;
        ++at;
        if (!is_word(at) || !is(at + 1, "{"))
            fail(line, "expected a struct with a name and its members");
        const std::size_t name = at;
        check_name(name, str(name));
        std::vector<std::string> names = {std::string(str(name))};
        at = after_brackets(at + 1);
        if (is_word(at) && token(at).line > end_line(at - 1))
            fail(token(at - 1).line, fmt::format("expected ; after the struct {}", names[0]));
        if (is_word(at)) {
            const std::size_t variable = at++;
            declarators(variable, names);
        }
        expect_semicolon(line);
        add(Item::Kind::Declaration, first, std::move(names), token(name).line);
    }

    /// Reads from the token after the first name up to the semicolon.
    void declarators(std::size_t name, std::vector<std::string>& names) {
        while (true) {
            check_name(name, str(name));
            names.emplace_back(str(name));
            while (!at_end() && !is(at, ",") && !is(at, ";")) {
                if (token(at).kind == TokenKind::Directive)
                    fail(token(at).line,
                         fmt::format("expected ; after {} but got a directive", names.back()));
                // In an expression no word follows an operand, and no body follows a `)`.
                const bool operand = is_word(at - 1) || token(at - 1).kind == TokenKind::Number ||
                                     is(at - 1, ")") || is(at - 1, "}");
                if (operand && (is_word(at) || is(at, "{")))
                    fail(token(at - 1).line,
                         fmt::format("expected ; after {} but got {}", names.back(), str(at)));
                at = is(at, "(") || is(at, "[") || is(at, "{") ? after_brackets(at) : at + 1;
            }
            if (!is(at, ",")) return;
            name = at + 1;
            if (!is_word(name)) fail(token(at).line, "expected a name after the comma");
            at = name + 1;
        }
    }

    void variables(std::size_t first, std::size_t name) {
        std::vector<std::string> names;
        declarators(name, names);
        expect_semicolon(token(name).line);
        if (is_snippet()) read_ramp(*this, first, name, names.size());
        add(Item::Kind::Declaration, first, std::move(names), token(name).line);
    }

    void function(std::size_t first, std::size_t name) {
        const std::string text(str(name));
        const int line = token(name).line;
        check_name(name, text);
        at = after_brackets(at);
        if (is(at, ";")) {
            ++at;
            add(Item::Kind::Prototype, first, {text}, line);
            return;
        }
        if (!is(at, "{"))
            fail(line, fmt::format("expected {{ or ; after the head of {} but got {}", text,
                                   written(at)));
        at = after_brackets(at);
        add(Item::Kind::Function, first, {text}, line);
        if (is_snippet() && text.substr(source.owner.size(), 4) == "_on_")
            check_unconditional(line, text);
    }
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
