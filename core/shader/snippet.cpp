#include "shader/snippet.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/text.h"

namespace relevo::shader {
namespace {

constexpr std::string_view kHasPrefix = "HAS_";

std::vector<std::string> hook_names() {
    std::vector<std::string> names;
    for (const Hook& hook : hooks())
        names.emplace_back(hook.name);
    return names;
}

/// @param head  of the expected function, apart from its name
void check_signature(const Snippet& snippet, const Item& item, std::string_view head) {
    Signature expected = parse_signature(head);
    expected.name = item.names[0];
    const Signature found = snippet.source.signature(item);
    if (!found.matches(expected))
        source_error(snippet.file, item.name_line,
                     fmt::format("{}: wrong signature, expected {} but got {}", item.names[0],
                                 expected.text(), found.text()));
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

/// @param found  receives a function `<id>_<word>_<name>`
void read_named(Snippet& snippet, const Item& item, const std::string& word,
                std::string_view signature, std::vector<PassFunction>& found) {
    const std::string& function = item.names[0];
    const std::string prefix = snippet.id + '_' + word + '_';
    if (function.substr(0, prefix.size()) != prefix) return;
    check_signature(snippet, item, signature);
    if (item.kind == Item::Kind::Function)
        found.push_back({function.substr(prefix.size()), item.name_line});
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

}  // namespace

const HookFunction* Snippet::find(std::string_view hook_name) const {
    const auto found = std::ranges::find_if(
        hooks, [&](const HookFunction& function) { return function.hook->name == hook_name; });
    return found == hooks.end() ? nullptr : &*found;
}

Snippet parse_snippet(std::string_view id, std::string_view file, std::string_view text) {
    Snippet snippet;
    snippet.id = id;
    snippet.file = file;
    snippet.source = parse_source(SourceKind::Snippet, id, file, text);
    for (const Item& item : snippet.source.items)
        if (item.kind == Item::Kind::Function || item.kind == Item::Kind::Prototype) {
            read_hook(snippet, item);
            read_named(snippet, item, "pass", "vec4 pass(in Texel t)", snippet.passes);
            read_named(snippet, item, "place", "void place(in InstanceSite at, inout Instance it)",
                       snippet.places);
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
