#include "shader/source.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "base/contains.h"
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
        check_words(*this);
        pair_brackets(*this);
        read_includes();
        while (!at_end())
            item();
        check_annotations();
        return std::move(static_cast<Source&>(*this));
    }

  private:
    // ---- items

    /// Directives inside an item are not evaluated: only conditionals are allowed there.
    void check_directives_inside(std::size_t first, Item::Kind of,
                                 const std::vector<std::string>& names) const {
        for (std::size_t i = first; i < at; ++i) {
            if (tokens[i].kind != TokenKind::Directive) continue;
            const std::string_view what = directive(i);
            if (what.empty()) continue;
            if (what == "define" || what == "undef" || !contains(kDirectives, what))
                fail(tokens[i].line,
                     fmt::format("#{} inside {}; move it out of the {}", what,
                                 names.empty() ? "a declaration" : names.front(),
                                 of == Item::Kind::Function ? "function" : "declaration"));
        }
    }

    void add(Item::Kind of, std::size_t first, std::vector<std::string> names, int name_line) {
        if (tokens[first].kind != TokenKind::Directive) check_directives_inside(first, of, names);
        Item item;
        item.kind = of;
        item.names = std::move(names);
        item.first = first;
        item.last = at;
        item.name_line = name_line;
        item.begin = tokens[first].offset;
        item.line = tokens[first].line;
        item.end = tokens[at - 1].offset + tokens[at - 1].length;
        attach_comments(item, first == 0 ? 0 : end_line(first - 1), end_line(at - 1));
        items.push_back(std::move(item));
    }

    void item() {
        if (tokens[at].kind == TokenKind::Directive)
            read_directive();
        else if (is(at, ";"))
            ++at;
        else
            declaration();
    }

    void read_directive() {
        const std::size_t first = at++;
        const int line = tokens[first].line;
        const std::vector<Token>& words = tokens[first].words;
        const std::string_view name = directive(first);
        if (name.empty()) return;
        if (name == "version" || name == "extension")
            fail(line, fmt::format("#{} is core's: every program is plain GLSL 4.50 core", name));
        if (name == "line") fail(line, "#line would lose the file's own line numbers; remove it");
        if (!contains(kDirectives, name))
            fail(line, fmt::format("#{} is not supported; use #define, #undef or #if", name));
        if (name == "define" || name == "undef") {
            if (words.size() < 2 || words[1].kind != TokenKind::Word)
                fail(line, fmt::format("#{} without a name", name));
            const std::string macro(str(words[1]));
            check_name(first, macro);
            add(name == "define" ? Item::Kind::Macro : Item::Kind::Undef, first, {macro}, line);
            return;
        }
        if (name.starts_with("if")) conditional_lines.push_back(line);
        if (name == "endif") conditional_lines.pop_back();
        add(Item::Kind::Conditional, first, {}, line);
    }

    void declaration() {
        const std::size_t first = at;
        const int line = tokens[first].line;
        Qualifiers qualifiers;
        while (is_word(at) && contains(kQualifiers, str(at))) {
            qualifiers.emplace(str(at));
            ++at;
            if (is(at - 1, "layout") && is(at, "(")) at = next(at);
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
            fail(tokens[std::min(at, tokens.size() - 1)].line,
                 fmt::format("expected a declaration but got {}", written(at)));
        const std::size_t type = at++;
        if (is(at, "{"))
            fail(line, fmt::format("{} is a block, which is core's; a plugin declares parameters "
                                   "one by one",
                                   str(type)));
        while (is(at, "["))
            at = next(at);
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
        at = until(at, ";");
        expect_semicolon(tokens[at - 1].line);
    }

    void structure(std::size_t first) {
        const int line = tokens[first].line;
        ++at;
        if (!is_word(at) || !is(at + 1, "{"))
            fail(line, "expected a struct with a name and its members");
        const std::size_t name = at;
        check_name(name, str(name));
        std::vector<std::string> names = {std::string(str(name))};
        at = next(at + 1);
        if (is_word(at) && tokens[at].line > end_line(at - 1))
            fail(tokens[at - 1].line, fmt::format("expected ; after the struct {}", names[0]));
        if (is_word(at)) {
            const std::size_t variable = at++;
            declarators(variable, names);
        }
        expect_semicolon(line);
        add(Item::Kind::Declaration, first, std::move(names), tokens[name].line);
    }

    /// Reads from the token after the first name up to the semicolon.
    void declarators(std::size_t name, std::vector<std::string>& names) {
        while (true) {
            check_name(name, str(name));
            names.emplace_back(str(name));
            while (!at_end() && !is(at, ",") && !is(at, ";")) {
                if (tokens[at].kind == TokenKind::Directive)
                    fail(tokens[at].line,
                         fmt::format("expected ; after {} but got a directive", names.back()));
                // In an expression no word follows an operand, and no body follows a `)`.
                const bool operand = is_word(at - 1) || tokens[at - 1].kind == TokenKind::Number ||
                                     is(at - 1, ")") || is(at - 1, "}");
                if (operand && (is_word(at) || is(at, "{")))
                    fail(tokens[at - 1].line,
                         fmt::format("expected ; after {} but got {}", names.back(), str(at)));
                at = next(at);
            }
            if (!is(at, ",")) return;
            name = at + 1;
            if (!is_word(name)) fail(tokens[at].line, "expected a name after the comma");
            at = name + 1;
        }
    }

    void variables(std::size_t first, std::size_t name) {
        std::vector<std::string> names;
        declarators(name, names);
        expect_semicolon(tokens[name].line);
        if (is_snippet()) read_ramp(*this, first, name, names.size());
        add(Item::Kind::Declaration, first, std::move(names), tokens[name].line);
    }

    void function(std::size_t first, std::size_t name) {
        const std::string word(str(name));
        const int line = tokens[name].line;
        check_name(name, word);
        at = next(at);
        if (is(at, ";")) {
            ++at;
            add(Item::Kind::Prototype, first, {word}, line);
            return;
        }
        if (!is(at, "{"))
            fail(line, fmt::format("expected {{ or ; after the head of {} but got {}", word,
                                   written(at)));
        at = next(at);
        add(Item::Kind::Function, first, {word}, line);
        if (is_snippet() && word.substr(owner.size(), 4) == "_on_") check_unconditional(line, word);
    }
};

}  // namespace

std::vector<Lifted> Source::lifted() const {
    std::vector<Lifted> all;
    for (const Param& param : params)
        all.push_back({param.name, owner, param.file, param.line});
    for (const Sampler& sampler : samplers)
        all.push_back({sampler.name, owner, sampler.file, sampler.line, &sampler});
    for (const Varying& varying : varyings)
        all.push_back({varying.name, owner, varying.file, varying.line, nullptr, &varying});
    return all;
}

Signature Source::signature(const Item& item) const {
    std::size_t open = item.first;
    while (!is(open, "("))
        ++open;
    const std::size_t begin = tokens[item.first].offset;
    return parse_signature(
        std::string_view(text).substr(begin, tokens[tokens[open].partner].offset + 1 - begin));
}

std::size_t Source::until(std::size_t i, std::string_view marks) const {
    while (i < tokens.size() && (str(i).size() != 1 || marks.find(str(i)) == marks.npos))
        i = next(i);
    return i;
}

std::size_t Source::after_statement(std::size_t i) const {
    constexpr std::array<std::string_view, 6> kBefore = {"for",    "if",   "while",
                                                         "switch", "else", "do"};
    int left = 1000;  // Longer chains take too long to follow.
    do {
        for (; i < tokens.size() &&
               (tokens[i].kind == TokenKind::Directive || contains(kBefore, str(i)));
             i = is(i + 1, "(") ? next(i + 1) : i + 1)
            if (--left == 0) return i;
        i = is(i, "{") ? next(i) : until(i, ";") + 1;
    } while (is(i, "else"));
    return i;
}

std::string_view Source::writes(std::size_t i) const {
    constexpr std::array<std::string_view, 4> kComparing = {"==", "!=", "<=", ">="};
    if (is(i - 1, "++") || is(i - 1, "--")) return str(i - 1);
    ++i;
    while (is(i, ".") || is(i, "["))
        i = is(i, ".") ? i + 2 : next(i);
    const bool is_writing =
        is(i, "++") || is(i, "--") || (str(i).ends_with('=') && !contains(kComparing, str(i)));
    return is_writing ? str(i) : "";
}

std::string joined(const Source& source, std::span<const Token> tokens) {
    std::string text;
    for (const Token& token : tokens)
        text.append(source.str(token)) += ' ';
    return text;
}

const Item* Source::function(std::string_view name) const {
    const auto found = std::ranges::find_if(items, [&](const Item& item) {
        return item.kind == Item::Kind::Function && item.names[0] == name;
    });
    return found == items.end() ? nullptr : &*found;
}

Source parse_source(SourceKind kind, std::string_view owner, std::string_view file,
                    std::string_view text) {
    return Parser(kind, owner, file, text).run();
}

}  // namespace relevo::shader
