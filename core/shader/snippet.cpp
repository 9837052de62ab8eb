#include "shader/snippet.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/text.h"
#include "shader/conditions.h"

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
    if (!text.starts_with(kHasPrefix)) return;
    const std::string capability(text.substr(kHasPrefix.size()));
    if (std::ranges::find(snippet.wanted, capability, &Wanted::word) == snippet.wanted.end())
        snippet.wanted.push_back({capability, word.line});
}

void check_unique(const Snippet& snippet) {
    std::map<std::string, int> seen;
    for (const Lifted& lifted : snippet.source.lifted()) {
        const auto [first, is_new] = seen.try_emplace(lifted.name, lifted.line);
        if (!is_new)
            source_error(
                snippet.file, lifted.line,
                fmt::format("{}: declared already in line {}", lifted.name, first->second));
    }
}

}  // namespace

const HookFunction* Snippet::find(std::string_view hook_name) const {
    const auto found = std::ranges::find_if(
        hooks, [&](const HookFunction& function) { return function.hook->name == hook_name; });
    return found == hooks.end() ? nullptr : &*found;
}

bool changes_arguments(const Snippet& snippet, const HookFunction& function, std::string_view word,
                       bool is_provided) {
    const Source& source = snippet.source;
    const Item& item = *source.function(function.name);
    const Signature signature = source.signature(item);
    if (signature.type != "void") return true;
    Macros macros{{std::string(kHasPrefix).append(word), is_provided ? "1" : "0"}};
    // Other files may define the other words.
    for (const Token& token : source.tokens)
        for (const Token& other : token.words)
            macros.try_emplace(std::string(source.str(other)));
    const Conditions conditions = evaluate_conditions(source, macros);
    std::vector<std::string_view> words;
    for (std::size_t i = item.first; i < item.last; ++i)
        if (conditions.active[i]) words.push_back(source.str(i));
    // Core's own function does what is done without the effect.
    const auto core = std::ranges::find(words, fmt::format("core_on_{}", function.hook->name));
    words.erase(core, std::ranges::find(core, words.end(), ")"));
    return std::ranges::any_of(signature.arguments, [&](const Argument& argument) {
        // Once in the head.
        return argument.qualifier != "in" && std::ranges::count(words, argument.name) > 1;
    });
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
    snippet.source.each([&](const Token& word) { read_wanted(snippet, word); });
    check_unique(snippet);
    return snippet;
}

}  // namespace relevo::shader
