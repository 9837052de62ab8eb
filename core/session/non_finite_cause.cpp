// Which hook and which value of it is NaN or infinite: the picture is drawn without each in turn.
#include <algorithm>

#include <fmt/format.h>

#include "base/contains.h"
#include "base/error.h"
#include "session/non_finite.h"

namespace relevo::session {
namespace {

using shader::HookFunction;
using shader::Snippet;

/// A hook's function in a file.
struct HookPlace {
    const Snippet* snippet;
    const HookFunction* hook;

    const shader::Item& item() const { return *snippet->source.function(hook->name); }
};

/// Number of such pixels with another file in the place of one.
int pixels_with(const FaultyPicture& picture, const Snippet* replaced, const Snippet& by) {
    render::EffectInputs inputs = picture.effects.inputs();
    std::ranges::replace(inputs.stitch.snippets, replaced, &by);
    render::Renderer renderer(picture.context, inputs, picture.options);
    renderer.render_frame(picture.terrain, picture.ground, picture.frame);
    return renderer.non_finite().count;
}

int pixels_without(const FaultyPicture& picture, const HookPlace& place) {
    Snippet without = *place.snippet;
    std::erase_if(without.hooks,
                  [&](const HookFunction& hook) { return hook.name == place.hook->name; });
    // The hook is a function that nothing calls.
    return pixels_with(picture, place.snippet, without);
}

/// The name of the first argument of a hook that it may write; empty without one.
/// @param type  of the argument; empty: any
std::string output_of(const HookPlace& place, std::string_view type) {
    for (const shader::Argument& argument : place.snippet->source.signature(place.item()).arguments)
        if (argument.qualifier == "inout" && (type.empty() || argument.type == type))
            return argument.name;
    return {};
}

/// Members that some line of the file names after a dot, in order.
std::vector<std::string> members_in(const shader::Source& source) {
    std::vector<std::string> members;
    for (std::size_t i = 1; i < source.tokens.size(); ++i) {
        const std::string member(source.str(i));
        if (source.is_word(i) && source.is(i - 1, ".") && member.size() > 1 &&
            !contains(members, member))
            members.push_back(member);
    }
    return members;
}

/// The file with another function in the place of one.
/// @param inner  the new name of the old one
Snippet replaced(const Snippet& snippet, const std::string& function, const std::string& inner,
                 const std::string& by) {
    const shader::Source& source = snippet.source;
    std::string text = source.text;
    for (std::size_t i = source.tokens.size(); i-- > 0;)
        if (source.is(i, function))
            text.replace(source.tokens[i].offset, source.tokens[i].length, inner);
    return shader::parse_snippet(snippet.id, snippet.file, text + by);
}

/// The file with a hook that leaves one member of its Surface unchanged.
Snippet keeping(const HookPlace& place, const std::string& surface, const std::string& member) {
    const std::string inner = fmt::format("{}_kept_{}", place.snippet->id, place.hook->hook->name);
    return replaced(
        *place.snippet, place.hook->name, inner,
        fmt::format("\nvoid {0}(inout Surface {1}) {{\n    Surface before = {1};\n    {2}({1});\n"
                    "    {1}.{3} = before.{3};\n}}\n",
                    place.hook->name, surface, inner, member));
}

/// The first line of a hook that writes a value, such as `s.diffuse`; 0: none.
int line_of_write(const HookPlace& place, const std::string& variable, const std::string& member) {
    const shader::Source& source = place.snippet->source;
    const shader::Item& item = place.item();
    for (std::size_t i = item.first; i < item.last; ++i) {
        if (!source.is(i, variable)) continue;
        if (!member.empty() && !(source.is(i + 1, ".") && source.is(i + 2, member))) continue;
        if (!source.writes(member.empty() ? i : i + 2).empty()) return source.tokens[i].line;
    }
    return 0;
}

/// The file with a pass whose texels are 0 where they would be NaN or infinite.
Snippet cleaned(const Snippet& snippet, const shader::PassFunction& pass) {
    const std::string function = fmt::format("{}_pass_{}", snippet.id, pass.name);
    const std::string inner = fmt::format("{}_cleaned_{}", snippet.id, pass.name);
    // By bits: compilers may fold comparisons with NaN.
    return replaced(
        snippet, function, inner,
        fmt::format(
            "\nvec4 {}(in {} t) {{\n    vec4 v = {}(t);\n    const uint ones = 0x7f800000u;\n"
            "    return mix(v, vec4(0.0), equal(floatBitsToUint(v) & ones, uvec4(ones)));\n}}\n",
            function, pass.kind == shader::PluginPass::Kind::Volume ? "Voxel" : "Texel", inner));
}

/// A pass of a plugin without whose NaN and infinite texels fewer pixels are so.
/// @param fewest  such pixels without any one hook; a pass that a hook reads has as few
std::optional<NonFiniteCause> pass_at_fault(const FaultyPicture& picture, const Snippet& snippet,
                                            int& fewest) {
    std::optional<NonFiniteCause> cause;
    for (const shader::PassFunction& pass : snippet.passes) {
        if (pass.kind == shader::PluginPass::Kind::Compute) continue;  // its stores are not seen
        const int without = pixels_with(picture, &snippet, cleaned(snippet, pass));
        if (without > fewest || without >= picture.pixels || (cause && without == fewest)) continue;
        fewest = without;
        cause = {snippet.file, pass.line, fmt::format("{}_pass_{}", snippet.id, pass.name), {}};
    }
    return cause;
}

NonFiniteCause cause_at(const FaultyPicture& picture, const HookPlace& place, int without) {
    NonFiniteCause cause{place.snippet->file, place.hook->line, place.hook->name, {}};
    const std::string surface = output_of(place, "Surface");
    std::string variable = output_of(place, ""), member;
    if (!surface.empty()) {
        for (const std::string& candidate : members_in(place.snippet->source)) {
            try {
                if (pixels_with(picture, place.snippet, keeping(place, surface, candidate)) >
                    without)
                    continue;
            } catch (const Error&) {
                continue;  // no member of a Surface
            }
            member = candidate;
            break;
        }
        variable = surface;
        if (member.empty()) return cause;
    }
    if (variable.empty()) return cause;
    cause.value = member.empty() ? variable : variable + "." + member;
    if (const int line = line_of_write(place, variable, member)) cause.line = line;
    return cause;
}

}  // namespace

std::optional<NonFiniteCause> find_cause(const FaultyPicture& picture, const std::string& id) {
    std::optional<HookPlace> worst;
    int fewest = picture.pixels;
    for (const Snippet* snippet : picture.effects.loaded.selection.snippets()) {
        if (snippet->id != id) continue;
        for (const HookFunction& hook : snippet->hooks) {
            const HookPlace place{snippet, &hook};
            const int without = pixels_without(picture, place);
            if (without >= fewest) continue;
            fewest = without;
            worst = place;
        }
    }
    std::optional<NonFiniteCause> pass;
    for (const Snippet* snippet : picture.effects.loaded.selection.snippets())
        if (snippet->id == id)
            if (auto found = pass_at_fault(picture, *snippet, fewest)) pass = found;
    if (pass) return pass;
    if (!worst) return std::nullopt;
    return cause_at(picture, *worst, fewest);
}

}  // namespace relevo::session
