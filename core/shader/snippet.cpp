#include "shader/snippet.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/text.h"

namespace relevo::shader {
namespace {

std::vector<std::string> hook_names() {
    std::vector<std::string> names;
    for (const Hook& hook : hooks())
        names.emplace_back(hook.name);
    return names;
}

[[noreturn]] void fail_signature(const Snippet& snippet, const Item& item,
                                 std::string_view expected) {
    source_error(snippet.file, item.name_line,
                 fmt::format("{}: wrong signature, expected {} but got {}", item.names[0], expected,
                             snippet.source.signature(item).text()));
}

/// @param head  of a function, apart from its name
Signature named(std::string_view head, const Item& item) {
    Signature signature = parse_signature(head);
    signature.name = item.names[0];
    return signature;
}

void check_signature(const Snippet& snippet, const Item& item, std::string_view head) {
    const Signature expected = named(head, item);
    if (!snippet.source.signature(item).matches(expected))
        fail_signature(snippet, item, expected.text());
}

void read_hook(Snippet& snippet, const Item& item) {
    const std::string& function = item.names[0];
    const std::string prefix = snippet.id + "_on_";
    if (function.substr(0, prefix.size()) != prefix) return;
    const std::string name = function.substr(prefix.size());
    const Hook* const hook = find_hook(name);
    if (!hook) {
        const std::optional<std::string> near = nearest(name, hook_names());
        source_error(
            snippet.file, item.name_line,
            fmt::format("{}: there is no hook {}; {}", function, name,
                        near ? fmt::format("did you mean {}{}?", prefix, *near)
                             : fmt::format("hooks are {}", fmt::join(hook_names(), ", "))));
    }
    check_signature(snippet, item, hook->signature);
    if (item.kind != Item::Kind::Function) return;
    if (const HookFunction* other = snippet.find(name))
        source_error(snippet.file, item.name_line,
                     fmt::format("{}: defined already in line {}", function, other->line));
    snippet.hooks.push_back({hook, function, item.name_line});
}

/// The name of a function `<id>_<word>_<name>`; none of another function.
std::optional<std::string> name_after(const Snippet& snippet, const Item& item,
                                      std::string_view word) {
    const std::string& function = item.names[0];
    const std::string prefix = fmt::format("{}_{}_", snippet.id, word);
    if (!function.starts_with(prefix)) return std::nullopt;
    return function.substr(prefix.size());
}

void read_pass(Snippet& snippet, const Item& item) {
    using Kind = PluginPass::Kind;
    const std::optional<std::string> name = name_after(snippet, item, "pass");
    if (!name) return;
    const Signature found = snippet.source.signature(item);
    std::vector<std::string> expected;
    for (const Kind kind : {Kind::Full, Kind::Volume, Kind::Compute}) {
        const Signature signature = named(signature_of(kind), item);
        expected.push_back(signature.text());
        if (!found.matches(signature)) continue;
        if (item.kind == Item::Kind::Function)
            snippet.passes.push_back({*name, item.name_line, kind});
        return;
    }
    fail_signature(snippet, item,
                   fmt::format("{}, or of kind 3d {}, or of kind compute {}", expected[0],
                               expected[1], expected[2]));
}

void read_place(Snippet& snippet, const Item& item) {
    const std::optional<std::string> name = name_after(snippet, item, "place");
    if (!name) return;
    check_signature(snippet, item, "void place(in InstanceSite at, inout Instance it)");
    if (item.kind == Item::Kind::Function) snippet.places.push_back({*name, item.name_line});
}

void read_wanted(Snippet& snippet, const Token& word) {
    const std::string_view text = snippet.source.str(word);
    if (word.kind != TokenKind::Word || text.substr(0, kHasPrefix.size()) != kHasPrefix) return;
    const std::string_view capability = text.substr(kHasPrefix.size());
    const bool known = std::ranges::any_of(
        snippet.wanted, [&](const Wanted& wanted) { return wanted.word == capability; });
    if (!known) snippet.wanted.push_back({std::string(capability), word.line});
}

// HAS_ macros are 0 or 1: a misspelt one is an error, not a missing capability.
void check_has(const Snippet& snippet, const std::vector<Token>& directive) {
    for (std::size_t i = 1; i < directive.size(); ++i) {
        const std::string_view text = snippet.source.str(directive[i]);
        if (text.substr(0, kHasPrefix.size()) != kHasPrefix) continue;
        std::string_view before = snippet.source.str(directive[i - 1]);
        if (before == "(" && i >= 2) before = snippet.source.str(directive[i - 2]);
        if (before == "ifdef" || before == "ifndef" || before == "defined")
            source_error(
                snippet.file, directive[i].line,
                fmt::format("{} is always defined, as 0 or as 1; write #if {}", text, text));
    }
}

void check_unique(const Snippet& snippet) {
    std::vector<std::pair<std::string, int>> seen;
    const auto add = [&](const std::string& name, int line) {
        for (const auto& [other, other_line] : seen)
            if (other == name)
                source_error(snippet.file, line,
                             fmt::format("{}: declared already in line {}", name, other_line));
        seen.emplace_back(name, line);
    };
    for (const Param& param : snippet.source.params)
        add(param.name, param.line);
    for (const Sampler& sampler : snippet.source.samplers)
        add(sampler.name, sampler.line);
    for (const Varying& varying : snippet.source.varyings)
        add(varying.name, varying.line);
}

/// The words of a function's code where HAS_<word> is 0 or 1.
std::vector<std::string_view> words_left(const Source& source, const Item& item,
                                         std::string_view word, bool is_provided) {
    const std::string has = fmt::format("{}{}", kHasPrefix, word);
    const std::string met = (is_provided ? "#if " : "#if !") + has;
    const std::string unmet = (is_provided ? "#if !" : "#if ") + has;
    struct Condition {
        bool omits, omits_else;
    };
    std::vector<Condition> around;
    std::vector<std::string_view> words;
    for (std::size_t i = item.first; i < item.last; ++i) {
        const std::string_view text = source.str(source.tokens[i]);
        if (source.tokens[i].kind != TokenKind::Directive) {
            if (std::ranges::none_of(around, &Condition::omits)) words.push_back(text);
        } else if (text.starts_with("#if")) {
            around.push_back({text == unmet, text == met || text.starts_with(met + " ||")});
        } else if (text.starts_with("#endif")) {
            around.pop_back();
        } else if (!around.empty()) {
            around.back().omits = around.back().omits_else;
        }
    }
    return words;
}

}  // namespace

const HookFunction* Snippet::find(std::string_view hook_name) const {
    const auto found = std::ranges::find_if(
        hooks, [&](const HookFunction& function) { return function.hook->name == hook_name; });
    return found == hooks.end() ? nullptr : &*found;
}

bool changes_arguments(const Snippet& snippet, const HookFunction& function, std::string_view word,
                       bool is_provided) {
    for (const Item& item : snippet.source.items) {
        if (item.kind != Item::Kind::Function || item.names[0] != function.name) continue;
        const Signature signature = snippet.source.signature(item);
        if (signature.type != "void") return true;
        auto words = words_left(snippet.source, item, word, is_provided);
        // Core's own function does what is done without the effect.
        const auto core = std::ranges::find(words, fmt::format("core_on_{}", function.hook->name));
        words.erase(core, std::ranges::find(core, words.end(), ")"));
        return std::ranges::any_of(signature.arguments, [&](const Argument& argument) {
            // Once in the head.
            return argument.qualifier != "in" && std::ranges::count(words, argument.name) > 1;
        });
    }
    return false;
}

Snippet parse_snippet(std::string_view id, std::string_view file, std::string_view text) {
    Snippet snippet;
    snippet.id = id;
    snippet.file = file;
    snippet.source = parse_source(SourceKind::Snippet, id, file, text);
    for (const Item& item : snippet.source.items)
        if (item.kind == Item::Kind::Function || item.kind == Item::Kind::Prototype) {
            read_hook(snippet, item);
            read_pass(snippet, item);
            read_place(snippet, item);
        }
    for (const Token& token : snippet.source.tokens) {
        if (token.kind != TokenKind::Directive) {
            read_wanted(snippet, token);
            continue;
        }
        const std::vector<Token> words = directive_tokens(snippet.source.text, token, snippet.file);
        check_has(snippet, words);
        for (const Token& word : words)
            read_wanted(snippet, word);
    }
    check_unique(snippet);
    return snippet;
}

}  // namespace relevo::shader
